"""The mesh of a boundary: vertices on the surfaces, on the curves where two meet and on the corners of three.

`Sheets` are points that lie on one surface, on two where they meet, or on more.
"""

from dataclasses import dataclass, fields
from itertools import product

import numpy as np
from scipy.spatial import KDTree

from wsrender.geometry.components import components
from wsrender.geometry.spatial.cells import SpatialCellLoops
from wsrender.geometry.spatial.critical_sets import CommonCurve, CrossedSurfaces
from wsrender.geometry.spatial.measures import INNER, Triangles
from wsrender.geometry.spatial.patches import Patch, neighbours, smooth

_ITERATIONS = 12
_SETTLED = 1e-13  # relative to the size of the coordinates
# Normals nearer than twice the arc tangent of this (6°) give no direction along which surfaces part.
_TANGENT = 0.05
_FARTHEST = 2.0  # from the middle of a cell's crossings to its vertex, in cells
_THIN = 20.0  # how far, in cells, the edge of a part that is thinner than a cell may be from the last cells that see it
_SLANTED = 0.5  # sine of the angle between sheets below which the edge may be far
_ROUNDING = 1e-9  # of a product of sines
_PASSES = 2  # a corner at which two sheets touch is found from the curve in which they do
_SAME = 1e-6  # of a cell: corners of neighbouring cells that are one


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


@dataclass(frozen=True, eq=False)
class SharpSides:
    """Sides (E, 2) of the mesh between patches (E, 2), points (E, 3, 3) [m] of the boundary along each, angles there.

    ``angle`` (E, 3) [rad]: between the outward normals of both patches; 0 where they touch.
    """

    vertices: np.ndarray
    patches: np.ndarray
    points: np.ndarray
    angle: np.ndarray


@dataclass(frozen=True, eq=False)
class PatchMesh:
    """Vertices (V, 3) [m], triangles (T, 3) and the patch of each (T,); sharp sides; triangles with curved sides."""

    vertices: np.ndarray
    faces: np.ndarray
    patch: np.ndarray
    sharp: SharpSides
    curved: Triangles


def patch_mesh(
    loops: SpatialCellLoops, crossed: CrossedSurfaces, patches: list[Patch], patch_of: np.ndarray, width: float
) -> PatchMesh:
    """A closed mesh with one vertex for each loop of crossed edges (dual contouring, Ju et al. 2002)."""
    sheets, sheet_of, middle = sheets_of_loops(loops, crossed, patch_of)
    x = middle
    for _ in range(_PASSES):
        x, sheets = _on_edges(x, sheets, patches, width)
    corner_sheets = sheet_of[loops.quads]
    quads = _joined_corners(x, sheets, width)[loops.loop[loops.quads]]
    sharp, bulges = _sharp_sides(x, quads, corner_sheets, sheets, patches, width)
    pick = np.where(_first_diagonal(x[quads])[:, None], [[0, 1, 2, 0, 2, 3]], [[1, 2, 3, 1, 3, 0]]).reshape(-1, 2, 3)
    rows = np.arange(len(quads))[:, None, None]
    faces = quads[rows, pick]
    triangles = Triangles(
        x[faces].reshape(-1, 3, 3),
        sheets.normal[corner_sheets[rows, pick]].reshape(-1, 3, 3),
        _triangle_bulges(bulges, pick).reshape(-1, 3, 3, 3),
        np.repeat(patch_of, 2),
        np.repeat(crossed.d, 2, axis=0),
    )
    faces, patch = faces.reshape(-1, 3), np.repeat(patch_of, 2)
    kept = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return PatchMesh(x, faces[kept], patch[kept], sharp, triangles)


def _on_edges(x: np.ndarray, sheets: Sheets, patches: list[Patch], width: float) -> tuple[np.ndarray, Sheets]:
    """Points x (V, 3) [m] moved onto all their sheets, and the sheets there.

    Where two sheets hardly part, the curve in which they meet may be cells away: it is looked for first.
    """
    x, sheets = x.copy(), sheets.copy()
    first, second = _pairs(sheets.point)
    sine = _sine(sheets.normal[first], sheets.normal[second])
    farthest = np.full(len(x), _FARTHEST * width)
    np.maximum.at(farthest, sheets.point[first], np.minimum(_FARTHEST / np.maximum(sine, 1e-9), _THIN) * width)
    first, second = first[sine < _SLANTED], second[sine < _SLANTED]
    between = np.stack([sheets.patch[first], sheets.patch[second]], axis=1)
    for a, b in np.unique(between, axis=0):
        of = (between == (a, b)).all(axis=1)
        for curve in (CommonCurve(*sets) for sets in product(patches[a].sets, patches[b].sets)):
            if curve.exists:
                _moved_to(curve, first[of], second[of], x, sheets, width)
    return settled(x, sheets, patches, farthest)


def _pairs(point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Every two sheets of one point; points are sorted."""
    rows = np.arange(len(point))
    found = [np.empty((2, 0), int)]
    for apart in range(1, int(np.bincount(point).max(initial=1))):
        first = rows[:-apart][point[:-apart] == point[apart:]]
        found.append(np.stack([first, first + apart]))
    first, second = np.concatenate(found, axis=1)
    return first, second


def _moved_to(
    curve: CommonCurve, first: np.ndarray, second: np.ndarray, x: np.ndarray, sheets: Sheets, width: float
) -> None:
    """Move the points of two sheets each to the curve, where both sheets meet in it.

    A part of the boundary that ends in a curve where its sheets touch is thinner than two cells up to a distance of
    four over the sine of the angle that they have there; one of flat sheets up to half that. Sheets that are inclined
    the other way there, as one that has bent back, meet in another curve nearer by.
    """
    arm, at = curve.first.arm, sheets.point[first]
    d = arm.nearest_turn(curve.nearest(x[at], sheets.d[first]))
    p, J, _ = arm.motion(d)
    good = (((d >= arm.low - 1e-9) & (d <= arm.high + 1e-9)) | arm.full).all(axis=1)
    if len(curve.stops) == 1:
        good &= np.linalg.svd(J, compute_uv=False)[:, 2] <= 1e-9 * np.linalg.norm(J, axis=(1, 2))
    between, at_curve = _axes(curve, J, sheets.normal[first], sheets.normal[second])
    sine, there = np.linalg.norm(between, axis=1), np.linalg.norm(at_curve, axis=1)
    near = np.minimum(2 * _FARTHEST / np.maximum(sine, 1e-9) + _FARTHEST, _THIN) * width
    good &= (np.linalg.norm(p - x[at], axis=1) <= near) & (there <= 1.2 * sine + 1e-6)
    good &= (between * at_curve).sum(axis=1) >= -_ROUNDING
    x[at[good]] = p[good]
    sheets.d[first[good]] = sheets.d[second[good]] = d[good]


def _axes(curve: CommonCurve, J: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cross products (N, 3) of the normals a and b of two sheets, and of those that they have in the curve."""
    there = []
    for critical_set, normal in ((curve.first, a), (curve.second, b)):
        n = critical_set.normal(J)
        there.append(n * np.sign((n * normal).sum(axis=1))[:, None])
    return np.cross(a, b), np.cross(*there)


def _sine(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.cross(a, b), axis=1)


def _joined_corners(x: np.ndarray, sheets: Sheets, width: float) -> np.ndarray:
    """The vertex (V,) that stands for each: the first of those corners that are at one place."""
    vertex = np.arange(len(x))
    corners = np.flatnonzero(np.bincount(sheets.point, minlength=len(x)) > 2)
    for a, b in sorted(KDTree(x[corners]).query_pairs(_SAME * width)) if len(corners) else []:
        vertex[vertex == vertex[corners[b]]] = vertex[corners[a]]
    return vertex


def _first_diagonal(corners: np.ndarray) -> np.ndarray:
    """Whether the diagonal 0-2 of quads (N, 4, 3) is the shorter one, (N,)."""
    return np.linalg.norm(corners[:, 0] - corners[:, 2], axis=1) <= np.linalg.norm(
        corners[:, 1] - corners[:, 3], axis=1
    )


def _sharp_sides(
    x: np.ndarray, quads: np.ndarray, corner_sheets: np.ndarray, sheets: Sheets, patches: list[Patch], width: float
) -> tuple[SharpSides, np.ndarray]:
    """The sides between two patches, and the bulges (C, 4, 3, 3) of each quad's sides, from corner k to k + 1."""
    ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)
    patch = np.repeat(sheets.patch[corner_sheets[:, 0]], 4)
    key = ends.min(axis=1) * len(x) + ends.max(axis=1)
    order = np.lexsort((patch, key))
    pairs = np.flatnonzero((np.diff(key[order]) == 0) & (np.diff(patch[order]) != 0))
    pairs = pairs[ends[order[pairs], 0] != ends[order[pairs], 1]]
    _, first = np.unique(key[order[pairs]], return_index=True)  # four patches may share a side: of those two
    one, two = order[pairs[first]], order[pairs[first] + 1]
    start, end = x[ends[one, 0]], x[ends[one, 1]]
    chord = start[:, None] + INNER[:, None] * (end - start)[:, None]
    both = _side_sheets(one, two, corner_sheets, sheets)
    points, there = _on_edges(chord.reshape(-1, 3), both, patches, width)
    bulge = points.reshape(chord.shape) - chord
    bulges = np.zeros((len(ends), 3, 3))
    if len(one):
        number = np.minimum(np.searchsorted(key[one], key), len(one) - 1)
        found = np.flatnonzero(key[one[number]] == key)
        number = number[found]
        along = ends[found, 0] == ends[one[number], 0]
        bulges[found] = np.where(along[:, None, None], bulge[number], bulge[number, ::-1])
    normal = there.normal.reshape(-1, 2, 3)
    sine = np.linalg.norm(np.cross(normal[:, 0], normal[:, 1]), axis=1)
    angle = np.arctan2(sine, (normal[:, 0] * normal[:, 1]).sum(axis=1)).reshape(-1, len(INNER))
    between = np.sort(np.stack([patch[one], patch[two]], axis=1), axis=1)
    sharp = SharpSides(ends[one], between, points.reshape(chord.shape), angle)
    return sharp, bulges.reshape(-1, 4, 3, 3)


def _side_sheets(one: np.ndarray, two: np.ndarray, corner_sheets: np.ndarray, sheets: Sheets) -> Sheets:
    """Both sheets at each of the three points inside of every side, one after the other."""
    at = corner_sheets.ravel()[np.stack([one, two], axis=1)]  # of the corner at which a side begins
    at = np.repeat(at, len(INNER), axis=0).ravel()
    point = np.repeat(np.arange(len(at) // 2), 2)
    return Sheets(point, sheets.patch[at], sheets.normal[at], sheets.d[at])


def _triangle_bulges(bulges: np.ndarray, pick: np.ndarray) -> np.ndarray:
    """Bulges (C, 2, 3, 3, 3) of the sides of both triangles, from those of the quads' sides; 0 along the diagonal."""
    following = np.roll(pick, -1, axis=2)
    outer = following == (pick + 1) % 4
    rows = np.arange(len(bulges))[:, None, None]
    return np.where(outer[..., None, None], bulges[rows, pick], 0.0)
