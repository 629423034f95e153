"""Many solids that stand: by cells of a grid, how near the nearest is, and which are near at all.

A moving solid is held by balls, whose middles are looked up. Distances change by no more than a point moves: what holds
at the middle of a cell holds all over it within half its diagonal, and a point beyond the grid is no nearer to what
stands within it than the point of its border that it is taken to.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from wsrender.collision.covers import Capsules, Cover, from_segment
from wsrender.collision.grids import CELLS, LEVEL, QUANTA, ROUNDING, DistanceGrid
from wsrender.collision.solids import BASE, Pairs, Solid

LEAST = 8  # solids that stand; fewer are tested one by one
NOTHING = 32767  # is near
MOST_SETS = 1 << 16
AT_ONCE = 32  # balls of a solid
SPACING = 1.5  # of balls along a capsule, in its radii


@dataclass(frozen=True, eq=False)
class Crowd:
    """Of ``solids`` that stand, bit k of a set being the k-th.

    ``grid``: in the lower half of a word the least distance of any over a cell, NOTHING beyond what is asked; in the
    upper half the row of ``sets`` (K, W) uint32 of those that are no farther than is asked. ``balls`` by moving solid
    (B, 4): middle in the frame of its joint [m], and the bound, in the grid's quanta, above which nothing touches it.
    """

    solids: tuple[int, ...]
    grid: DistanceGrid
    sets: np.ndarray
    balls: Mapping[int, np.ndarray]


def crowded(pairs: Pairs, numbers: Iterable[int]) -> list[int]:
    """Those of pairs ``numbers`` that are of a moving solid and one of a crowd, which stands around; none of a few."""
    found = [
        number
        for number in numbers
        if pairs.around[pairs.reason[number]]
        and pairs.solids[pairs.pairs[number, 0]].joint == BASE != pairs.solids[pairs.pairs[number, 1]].joint
        and pairs.solids[pairs.pairs[number, 0]].kind not in ("half_space", "surface")
    ]
    return found if len({int(pairs.pairs[number, 0]) for number in found}) >= LEAST else []


def crowd(pairs: Pairs, numbers: Iterable[int], covers: Mapping[int, Cover], reach: float, epsilon: float) -> Crowd:
    """The crowd of pairs ``numbers``, at least one.

    ``reach``: no origin of a joint is farther from the base [m]; ``epsilon``: what float32 may be off [m].
    """
    margins: dict[int, float] = {}
    for number in numbers:
        moving = int(pairs.pairs[number, 1])
        margins[moving] = max(margins.get(moving, 0.0), pairs.margin(number))
    solids = tuple(sorted({int(pairs.pairs[number, 0]) for number in numbers}))
    balls = {k: _balls(pairs.solids[k], covers[k], margin + epsilon) for k, margin in sorted(margins.items())}
    limit = max(own[:, 3].max() for own in balls.values())
    around = [_box(pairs.solids[k], covers[k]) for k in solids]
    far = reach + max(np.linalg.norm(own[:, :3], axis=1).max() for own in balls.values())
    low = np.clip(np.min([low for low, _ in around], axis=0) - limit, -far, far)
    high = np.maximum(np.clip(np.max([high for _, high in around], axis=0) + limit, -far, far), low + limit)
    cells = CELLS
    while True:
        grid, sets = _cells(pairs.solids, solids, covers, (low, high), limit, cells)
        if len(sets) <= MOST_SETS:
            break
        cells //= 2
    return Crowd(solids, grid, sets, {k: own / [1, 1, 1, grid.quantum] for k, own in balls.items()})


def wide_boxes(solid: Solid, capsules: Capsules) -> list[tuple[np.ndarray, float]]:
    """Rows (16,) and radii of a box that stands, or of what are boxes in place of another solid's capsules.

    In the base's frame: axes, of a capsule its own first (9), middle (3), half sizes (3) [m], nothing (1).
    """
    R, at = solid.T[:3, :3], solid.T[:3, 3]
    if solid.kind == "box":
        return [(np.r_[R.T.ravel(), at, solid.size, 0.0], 0.0)]
    found = []
    for a, b, radius in zip(capsules.a, capsules.b, capsules.radius, strict=True):
        half = R @ (b - a) / 2
        _, _, axes = np.linalg.svd(half[None])  # the first along the capsule
        size = [np.linalg.norm(half), 0.0, 0.0]
        found.append((np.r_[axes.ravel(), at + R @ (a + b) / 2, size, 0.0], float(radius)))
    return found


def _balls(solid: Solid, cover: Cover, margin: float) -> np.ndarray:
    """Balls (B, 4) that hold a solid, in the frame of its joint; the radii are wider by ``margin``."""
    capsules, rows = cover.outer[0 if cover.exact else LEVEL], []
    for a, b, radius in zip(capsules.a, capsules.b, capsules.radius, strict=True):
        length = float(np.linalg.norm(b - a))
        steps = min(int(np.ceil(length / (SPACING * radius))), AT_ONCE // len(capsules) - 1)
        held = np.hypot(radius, length / max(steps, 1) / 2) + margin
        for share in np.linspace(0, 1, steps + 1):
            rows.append([*(solid.T[:3, :3] @ (a + (b - a) * share) + solid.T[:3, 3]), held])
    return np.array(rows)


def _box(solid: Solid, cover: Cover) -> tuple[np.ndarray, np.ndarray]:
    """Corners (3,) [m] of a box around a solid that stands, in the base's frame."""
    (a, b, radius), T = _finest(cover), solid.T
    ends = np.concatenate([a, b]) @ T[:3, :3].T + T[:3, 3]
    wide = np.tile(radius, 2)[:, None]
    return (ends - wide).min(axis=0), (ends + wide).max(axis=0)


def _finest(cover: Cover) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    capsules = cover.outer[-1]
    return capsules.a, capsules.b, capsules.radius


def _below(solid: Solid, cover: Cover, points: np.ndarray) -> np.ndarray:
    """What the distances (N,) of points (N, 3) from a solid that stands are no less than [m]; exact of boxes."""
    points = (points - solid.T[:3, 3]) @ solid.T[:3, :3]
    if solid.kind == "box":
        return np.linalg.norm(np.maximum(np.abs(points) - solid.size, 0), axis=1)
    return np.min([from_segment(points, a, b) - radius for a, b, radius in zip(*_finest(cover), strict=True)], axis=0)


def _cells(
    solids: tuple[Solid, ...],
    standing: tuple[int, ...],
    covers: Mapping[int, Cover],
    box: tuple[np.ndarray, np.ndarray],
    limit: float,
    cells: int,
) -> tuple[DistanceGrid, np.ndarray]:
    """The grid of about so many cells of a box, and its sets."""
    low, high = box
    cell = float((np.prod(high - low) / cells) ** (1 / 3))
    shape = np.ceil((high - low) / cell).astype(int)
    beyond, quantum = (np.sqrt(3) / 2 + ROUNDING) * cell, cell / QUANTA
    least = np.full(shape, NOTHING)
    members = np.zeros((*shape, -(-len(standing) // 32)), np.uint32)
    for bit, number in enumerate(standing):
        own_low, own_high = _box(solids[number], covers[number])
        first = np.clip((own_low - limit - beyond - low) // cell, 0, shape).astype(int)
        end = np.clip((own_high + limit + beyond - low) // cell + 1, 0, shape).astype(int)
        near = tuple(slice(*ends) for ends in zip(first, end, strict=True))
        axes = [low[k] + (np.arange(first[k], end[k]) + 0.5) * cell for k in range(3)]
        middles = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        below = _below(solids[number], covers[number], middles.reshape(-1, 3)).reshape(middles.shape[:3])
        bound = np.floor((below - beyond) / quantum)
        asked = bound <= np.ceil(limit / quantum)
        least[near] = np.where(asked, np.minimum(least[near], bound), least[near])
        members[(*near, bit // 32)] |= np.where(asked, np.uint32(1 << bit % 32), np.uint32(0))
    rows = members.reshape(-1, members.shape[-1])
    sets, number = np.unique(np.vstack([np.zeros_like(rows[:1]), rows]), axis=0, return_inverse=True)
    number = number.ravel()[1:].reshape(shape)
    low16 = np.clip(least, -32768, NOTHING).astype(np.int16).view(np.uint16)
    return DistanceGrid(low, cell, 0.0, low16 | number.astype(np.uint32) << 16), sets
