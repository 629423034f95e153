"""What the narrow phase knows of solids beforehand: points that are farthest along a direction, segments within."""

import numpy as np
from scipy.spatial import ConvexHull

from wsrender.collision.solids import Solid

EDGE = 8  # cells of directions along the edge of a cube, as the kernel has it
BESIDE = 1e-4  # by which cells are wider: float32 takes directions beside a border for one or the other
PAD = 8  # points of a cell are padded to lanes of so many
CORE = 0.7  # of how far a segment within a solid could go


def vertices_by_direction(solids: tuple[Solid, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Points of hulls by cells of directions, x, y and z of each cell in turn; and where they are (S, cells, 2)."""
    parts, first = [np.zeros(0)], 0
    ranges = np.zeros((len(solids), 6 * EDGE**2, 2), np.int32)
    for solid, own in zip(solids, ranges, strict=True):
        if solid.kind != "hull":
            continue
        known: dict[bytes, tuple[int, int]] = {}
        for cell, numbers in enumerate(supports(points := solid.points - center_of(solid))):
            if (key := numbers.tobytes()) not in known:
                found = np.pad(points[numbers], ((0, -len(numbers) % PAD), (0, 0)), mode="edge")
                known[key] = first, len(found)
                parts.append(found.T.ravel())
                first += found.size
            own[cell] = known[key]
    return np.concatenate(parts), ranges


def supports(points: np.ndarray) -> list[np.ndarray]:
    """For each cell of directions the numbers of ``points`` (V, 3) that may be farthest along any of them.

    Cells are squares of the faces of a cube, -x, x, -y …; in rows by the next axis, then the one after. A cell's
    directions are sums of those to its corners: a point behind another along all four is farthest along none.
    """
    found = []
    if len(points) <= PAD:
        return [np.arange(len(points))] * (6 * EDGE**2)
    for face in range(6):
        axis, sign = face // 2, face % 2 * 2 - 1
        for cell in np.ndindex(EDGE, EDGE):
            low, high = ((2 * (np.array(cell) + k) / EDGE) - 1 + (2 * k - 1) * BESIDE for k in (0, 1))
            corners = np.empty((4, 3))
            corners[:, axis] = sign
            corners[:, (axis + 1) % 3] = low[0], low[0], high[0], high[0]
            corners[:, (axis + 2) % 3] = low[1], high[1], low[1], high[1]
            height, left = points @ corners.T, np.arange(len(points))
            for others in (np.r_[height.argmax(axis=0), height.sum(axis=1).argmax()], None):
                before = height[left if others is None else others]
                left = left[~np.any(np.all(before > height[left][:, None], axis=2), axis=1)]
            found.append(left)
    return found


def core(solid: Solid) -> np.ndarray:
    """Half a segment (3,) within a solid, about `center_of` and along what it is longest."""
    if solid.is_round:
        return solid.points[-1]
    if solid.kind == "cylinder":
        return CORE * solid.points[-1]
    if solid.kind not in ("box", "hull"):
        return np.zeros(3)
    faces, center = ConvexHull(solid.points).equations, center_of(solid)
    axis = np.linalg.svd(solid.points - center, full_matrices=False)[2][0]
    depth, slope = -faces[:, :3] @ center - faces[:, 3], np.abs(faces[:, :3] @ axis)
    return CORE * axis * (depth / np.maximum(slope, 1e-12)).min()


def center_of(solid: Solid) -> np.ndarray:
    """A point inside, (3,) in its own frame."""
    return solid.points.mean(axis=0)
