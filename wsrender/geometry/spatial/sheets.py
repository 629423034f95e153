"""Points that lie on one surface, on two where they meet, or on more: vertices, edges and corners of a boundary."""

from dataclasses import dataclass, fields

import numpy as np

from wsrender.geometry.components import components
from wsrender.geometry.spatial.cells import SpatialCellLoops
from wsrender.geometry.spatial.crossed_surfaces import CrossedSurfaces
from wsrender.geometry.spatial.patches import Patch, neighbours, smooth

_ITERATIONS = 12
_SETTLED = 1e-13  # relative to the size of the coordinates
# Normals nearer than twice the arc tangent of this (6°) give no direction along which surfaces part.
_TANGENT = 0.05


@dataclass(frozen=True, eq=False)
class Sheets:
    """S surfaces near points: sheet s is that of ``patch`` [s] near point ``point`` [s].

    ``normal`` (S, 3) outward and ``d`` (S, n), displacements that reach the surface nearby.
    """

    point: np.ndarray
    patch: np.ndarray
    normal: np.ndarray
    d: np.ndarray

    def copy(self, rows: np.ndarray | slice = slice(None)) -> "Sheets":
        """Some of the sheets, with arrays of their own."""
        return Sheets(*(np.array(getattr(self, f.name)[rows]) for f in fields(self)))


def settled(x: np.ndarray, sheets: Sheets, patches: list[Patch], farthest: np.ndarray) -> tuple[np.ndarray, Sheets]:
    """Points x (V, 3) [m] moved onto all their sheets, and the sheets there.

    Where surfaces touch, a point is moved to their middle. One that would go beyond ``farthest`` (V,) [m] is moved onto
    the first of its sheets alone.
    """
    there = sheets.copy()
    moved = _moved(x, there, patches, farthest)
    lost = ~(np.linalg.norm(moved - x, axis=1) <= farthest)
    if lost.any():
        first = np.flatnonzero(np.diff(sheets.point, prepend=-1))
        onto = _moved(x, sheets.copy(first[lost[sheets.point[first]]]), patches, farthest)
        near = np.linalg.norm(onto - x, axis=1) <= farthest
        moved[lost] = np.where(near[lost, None], onto[lost], x[lost])
    return moved, there


def _moved(x: np.ndarray, sheets: Sheets, patches: list[Patch], farthest: np.ndarray) -> np.ndarray:
    """Newton's method on the planes that touch the sheets, each step the shortest there is."""
    x, slot = x.copy(), _places(sheets.point)
    size = max(float(np.abs(x).max(initial=0)), 1e-300)
    moving = np.ones(len(x), bool)
    for _ in range(_ITERATIONS):
        rows = np.flatnonzero(moving[sheets.point])
        off = _meet(x, sheets, rows, patches)
        A = np.zeros((len(x), slot.max(initial=0) + 1, 3))
        b = np.zeros(A.shape[:2])
        A[sheets.point[rows], slot[rows]], b[sheets.point[rows], slot[rows]] = sheets.normal[rows], off
        step = (np.linalg.pinv(A[moving], rcond=_TANGENT) @ b[moving][:, :, None])[:, :, 0]
        length = np.linalg.norm(step, axis=1, keepdims=True)
        x[moving] += step * np.minimum(1.0, farthest[moving, None] / np.maximum(length, 1e-300))
        moving[moving] = length[:, 0] > _SETTLED * size
        if not moving.any():
            break
    _meet(x, sheets, np.arange(len(slot)), patches)
    return x


def _meet(x: np.ndarray, sheets: Sheets, rows: np.ndarray, patches: list[Patch]) -> np.ndarray:
    """Distance (R,) of sheets ``rows`` from their points along the normal; the normals and d found there are kept.

    0 where a sheet is not met.
    """
    off = np.zeros(len(rows))
    for k in np.unique(sheets.patch[rows]):
        chosen = np.flatnonzero(sheets.patch[rows] == k)
        of = rows[chosen]
        meeting = patches[k].surface.meet(x[sheets.point[of]], sheets.normal[of], sheets.d[of])
        good = np.isfinite(meeting.s)
        kept = of[good]
        off[chosen[good]] = meeting.s[good] * (meeting.normal[good] * sheets.normal[kept]).sum(axis=1)
        sheets.normal[kept], sheets.d[kept] = meeting.normal[good], meeting.d[good]
    return off


def _places(point: np.ndarray) -> np.ndarray:
    """Of each sheet how many of its point are before it, (S,); points are sorted."""
    starts = np.flatnonzero(np.diff(point, prepend=-1))
    return np.arange(len(point)) - np.repeat(starts, np.diff(starts, append=len(point)))


def sheets_of_loops(
    loops: SpatialCellLoops, crossed: CrossedSurfaces, patch_of: np.ndarray
) -> tuple[Sheets, np.ndarray, np.ndarray]:
    """The sheets in each loop; the sheet of each pair; the middle (V, 3) of each loop's crossings."""
    a, b = neighbours(loops)
    one, two = loops.crossing[a], loops.crossing[b]
    joined = (patch_of[one] == patch_of[two]) & smooth(crossed.normal[one], crossed.normal[two])
    part = components(len(loops.loop), a[joined], b[joined])
    _, first, sheet = np.unique(part, return_index=True, return_inverse=True)
    loop = loops.loop[first]
    order = np.lexsort((-np.bincount(sheet), loop))
    rank = np.argsort(order)
    sheet, first = rank[sheet], first[order]
    middle = _means(loops.loop, crossed.point[loops.crossing], len(loops.center))
    normal = _means(sheet, crossed.normal[loops.crossing], len(first))
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    seed = loops.crossing[first]
    return Sheets(loops.loop[first], patch_of[seed], normal, crossed.d[seed]), sheet, middle


def _means(group: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    sums = np.stack([np.bincount(group, values[:, k], count) for k in range(3)], axis=1)
    return sums / np.maximum(np.bincount(group, minlength=count), 1)[:, None]
