"""Distances of closed surfaces from line segments and from each other, triangle by triangle."""

import numpy as np

from wsrender.pipeline.constraints.leg_distance import segment_distance
from wsrender.robots.triangles import AT_ONCE, closest_points, winding_numbers

CROSSED = 1e-12  # of the size, or [m]: how far a segment that meets a triangle is said to be in it


def from_surface(corners: np.ndarray, segments: np.ndarray, limit: float) -> np.ndarray:
    """Distances (N,) [m] of segments (N, 2, 3) from what closed triangles (F, 3, 3) enclose, cut at ``limit``.

    Those of segments that are within it or cross its surface are negative, and say no depth.
    """
    found = np.full(len(segments), limit)
    centers = corners.mean(axis=1)
    radii = np.linalg.norm(corners - centers[:, None], axis=2).max(axis=1)
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    beyond = np.maximum(low - segments.max(axis=1), segments.min(axis=1) - high).max(axis=1)
    near = np.flatnonzero(beyond < limit)
    step = max(AT_ONCE // len(corners), 1)
    for some in (near[start : start + step] for start in range(0, len(near), step)):
        first, along = segments[some, 0], segments[some, 1] - segments[some, 0]
        share = np.einsum("fni,ni->nf", centers[:, None] - first, along)
        share = np.clip(share / np.maximum((along**2).sum(axis=1), 1e-300)[:, None], 0, 1)
        away = np.linalg.norm(first[:, None] + share[..., None] * along[:, None] - centers, axis=2)
        rows, faces = np.nonzero(away - radii < limit)
        np.minimum.at(found, some[rows], _from_triangles(corners[faces], segments[some[rows]]))
        inside = some[(found[some] > 0) & (winding_numbers(corners, first) > 0.5)]
        found[inside] *= -1
    return found


def between_surfaces(a: np.ndarray, b: np.ndarray, limit: float) -> float:
    """Distance [m] of what closed triangles (F, 3, 3) and (G, 3, 3) enclose, cut at ``limit``; negative: they overlap.

    It is that of an edge of one from the other, whichever is nearest.
    """
    return min(float(from_surface(of, _edges(edged), limit).min()) for of, edged in ((a, b), (b, a)))


def _edges(corners: np.ndarray) -> np.ndarray:
    """The edges (E, 2, 3) of closed triangles, each as the triangle has it that runs along it upwards."""
    edges = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2, 3)
    step = edges[:, 1] - edges[:, 0]
    leading = np.take_along_axis(step, (step != 0).argmax(axis=1)[:, None], axis=1)[:, 0]
    return edges[leading > 0]


def _from_triangles(corners: np.ndarray, segments: np.ndarray) -> np.ndarray:
    """Distances (N,) of segments (N, 2, 3) from triangles (N, 3, 3), one by one; negative where they cross."""
    p, q = segments[:, 0], segments[:, 1]
    sides = [segment_distance(p, q, corners[:, k], corners[:, (k + 1) % 3]) for k in range(3)]
    ends = [np.linalg.norm(end - closest_points(corners, end), axis=1) for end in (p, q)]
    least = np.min([*sides, *ends], axis=0)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    above, below = (np.einsum("ni,ni->n", end - corners[:, 0], normal) for end in (p, q))
    through = np.flatnonzero(above * below < 0)
    share = above[through] / (above[through] - below[through])
    at = p[through] + share[:, None] * (q[through] - p[through])
    slack = CROSSED * (1 + np.abs(at).max(axis=1, initial=0))
    crossed = np.linalg.norm(at - closest_points(corners[through], at), axis=1) <= slack
    least[through[crossed]] = -CROSSED
    return least
