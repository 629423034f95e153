"""The boundary from samples: boundary cells of a grid, critical points, lines and arcs by least squares.

Alciatore & Ng 1994. The centroid of a boundary cell lies inside the boundary, by 0.24–0.33 cell widths on average over
an outer loop, however many samples there are: least where they crowd at a singular boundary, and less around small
holes (0.15 at a radius of six cells). Where a line goes over into an arc smoothly the joint cannot be located; bands
thinner than a cell are not seen.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any

import numpy as np
from scipy.ndimage import binary_dilation, find_objects, label

from wsrender.geometry.planar.planar_chain import PlanarChain
from wsrender.geometry.planar.segments import FittedSegment, FitTolerances, fitted_segments, joined_segments
from wsrender.short_repr import short_repr

Edge = tuple[int, int, int]  # corner of the grid where an edge starts, and its heading: +x, +y, −x, −y
_STEP = ((1, 0), (0, 1), (-1, 0), (0, -1))
_STARTS = ((0, 0), (1, 0), (1, 1), (0, 1))  # corner of the cell on the left where an edge of each heading starts


_TOUCHING = np.ones((3, 3), bool)
MOST_SINGLE = 0.05  # share of boundary cells with one point: the border cuts slivers off cells of 20 points and more
CHANCE_POINTS = 20.0  # expected in a hole, by the cells around it, that is empty by chance once in 5e8
SCATTER = 0.3  # of centroids about the boundary, in cell widths: what the tolerances allow by default
CELLS = tuple(int(2500 / 2 ** (k / 2)) for k in range(10))  # as published, or as few as the samples fill: 110


@dataclass(frozen=True, eq=False)
class CellLoops:
    """Loops (K_i, 2) [m] of centroids of the points in boundary cells, the inside on the left, and the cell width.

    Whether there are enough points for the cells: the share ``single`` of boundary cells that hold one point alone, the
    number of ``parts`` of occupied cells that touch at an edge, and of holes that may be empty by ``chance``.
    """

    loops: list[np.ndarray]
    width_m: float
    single: float = 0.0
    parts: int = 0
    chance: int = 0

    __repr__ = short_repr

    @property
    def whole(self) -> bool:
        """Whether one region is seen that more points would not change much."""
        return self.parts == 1 and self.chance == 0 and self.single <= MOST_SINGLE


def cell_loops(points: np.ndarray, cells: int) -> CellLoops:
    """Loops of boundary cells of points (N, 2) [m] on a grid of about ``cells`` square cells over their box.

    A boundary cell holds points and has an empty 8-neighbour; it is represented by the centroid of its points
    (Alciatore & Ng 1994). Loops go around each region of empty cells that touch at an edge or corner.
    """
    lower, extent = points.min(axis=0), np.ptp(points, axis=0)
    width = max(np.sqrt(extent.prod() / cells), extent.max() / cells)
    if width == 0:
        return CellLoops([], 0.0)
    shape = np.maximum(np.ceil(extent / width - 1e-9), 1).astype(int) + 2  # a border of empty cells
    at = np.minimum(((points - lower) / width).astype(int) + 1, shape - 2)
    flat = np.ravel_multi_index(tuple(at.T), tuple(shape))
    count = np.bincount(flat, minlength=shape.prod())
    sums = [np.bincount(flat, weights=points[:, k], minlength=shape.prod()) for k in (0, 1)]
    centroids = (np.stack(sums, axis=-1) / np.maximum(count, 1)[:, None]).reshape(*shape, 2)
    occupied = (count > 0).reshape(shape)
    loops = [centroids[tuple(np.array(cells).T)] for cells in _border_loops(occupied)]
    return CellLoops(loops, float(width), *_evidence(count.reshape(shape)))


def _evidence(count: np.ndarray) -> tuple[float, int, int]:
    """``single``, ``parts`` and ``chance`` of the numbers of points in cells."""
    occupied = count > 0
    border = occupied & _grown(~occupied)
    parts = _labelled(occupied)[1]
    empty, regions = _labelled(~occupied, _TOUCHING)
    chance = 0
    for number, place in enumerate(find_objects(empty)[1:regions], 2):  # the first is the outside
        around = tuple(slice(side.start - 1, side.stop + 1) for side in place)
        hole = empty[around] == number
        ring = _grown(hole) & ~hole
        chance += bool(hole.sum() * count[around][ring].mean() < CHANCE_POINTS)
    return float((count[border] == 1).mean()), parts, chance


def _grown(cells: np.ndarray) -> np.ndarray:
    """The cells and their 8-neighbours."""
    return np.asarray(binary_dilation(cells, _TOUCHING), bool)


def _labelled(cells: np.ndarray, structure: np.ndarray | None = None) -> tuple[np.ndarray, int]:
    found: Any = label(cells, structure)
    return found


def _border_loops(occupied: np.ndarray) -> list[list[tuple[int, int]]]:
    """Cells along the border of each region of empty cells, occupied cells on the left."""
    left, loops = _edges(occupied), []
    while left:
        loop, edge = [], next(iter(left))
        while edge in left:
            del left[edge]
            loop += [_left_cell(edge)]
            edge = _next(edge, occupied, loop)
        loops.append([cell for k, cell in enumerate(loop) if cell != loop[k - 1]])
    return [loop for loop in loops if loop]


def _edges(occupied: np.ndarray) -> dict[Edge, None]:
    """Edges between an occupied cell, on the left, and an empty one: (corner, corner, heading)."""
    edges: dict[Edge, None] = {}
    for heading in range(4):
        step = _STEP[(heading + 3) % 4]  # towards the right
        empty_beside = ~np.roll(occupied, (-step[0], -step[1]), axis=(0, 1))
        for i, j in np.argwhere(occupied & empty_beside).tolist():
            edges[i + _STARTS[heading][0], j + _STARTS[heading][1], heading] = None
    return edges


def _left_cell(edge: Edge) -> tuple[int, int]:
    x, y, heading = edge
    return x - _STARTS[heading][0], y - _STARTS[heading][1]


def _next(edge: Edge, occupied: np.ndarray, loop: list[tuple[int, int]]) -> Edge:
    """The edge that follows; a cell that touches the empty region with its corner only is put into the loop."""
    x, y, heading = edge
    x, y = x + _STEP[heading][0], y + _STEP[heading][1]
    ahead = _left_cell((x, y, heading))
    if not occupied[ahead]:
        return x, y, (heading + 1) % 4
    if not occupied[_left_cell((x, y, (heading + 3) % 4))]:
        return x, y, heading
    loop.append(ahead)
    return x, y, (heading + 3) % 4


@dataclass(frozen=True, eq=False)
class MonteCarloBoundary:
    """Loops of ``segments``, the inside on the left, with what they were fitted to.

    ``cells`` are the loops of cells and whether the samples fill them. ``loops`` hold the centroids (K, 2) of boundary
    cells, those next to ``critical`` (C, 2) replaced: points with all joints at limits that lie on the boundary [m].
    """

    segments: list[list[FittedSegment]]
    cells: CellLoops
    loops: list[np.ndarray]
    critical: np.ndarray
    cell_width_m: float
    tolerances: FitTolerances

    __repr__ = short_repr


def monte_carlo_boundary(
    chain: PlanarChain,
    points: np.ndarray,
    cells: int | None = None,
    line_tolerance_m2: float | None = None,
    arc_tolerance_m4: float | None = None,
) -> MonteCarloBoundary:
    """The boundary of sampled points (N, 2) [m] of a chain, coordinates of its plane.

    ``cells`` is N_g; None: 2500, or the most down to 110 that the points fill. The tolerances are TOLL and TOLA:
    largest mean squared perpendicular distance from a line, and mean of (r² − R²)² of an arc. By default both allow a
    scatter of 0.3 cell widths, the latter of arcs with a radius of half the workspace's width; smaller ones, which a
    tolerance in m⁴ would allow more, fit by the same scatter. Then no centroid is farther than a cell width from its
    segment, and what bends is an arc.
    """
    found = _filled(points, CELLS if cells is None else (cells,))
    extent = float(np.ptp(points, axis=0).max())
    tolerances = FitTolerances.of(line_tolerance_m2, arc_tolerance_m4, SCATTER * found.width_m, found.width_m, extent)
    limits = _at_limits(chain)
    loops, critical, segments = [], [], []
    for loop in found.loops:
        corners, places = _critical(loop, limits, found.width_m)
        loop = loop.copy()
        loop[places] = corners
        critical.append(corners)
        loops.append(loop)
        segments.append(_segments(loop, np.sort(places), tolerances, found.width_m))
    places = np.concatenate(critical or [np.empty((0, 2))])
    return MonteCarloBoundary(segments, found, loops, places, found.width_m, tolerances)


def _filled(points: np.ndarray, counts: Sequence[int]) -> CellLoops:
    """The loops of the first number of cells that the points fill, else of the last."""
    for count in counts[:-1]:
        found = cell_loops(points, count)
        if found.whole:
            return found
    return cell_loops(points, counts[-1])


def _at_limits(chain: PlanarChain) -> np.ndarray:
    """Positions (2^k, 2) [m] with each joint that has limits at one of them; whole turns have none."""
    points = [chain.tip]
    for joint in reversed(chain.joints):
        limits = (0.0,) if joint.full else (joint.low, joint.high)
        points = [joint.move(point, limit) for point, limit in product(points, limits)]
    return np.array(points) + chain.shift


def _critical(loop: np.ndarray, limits: np.ndarray, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions at joint limits that lie on a loop, and the places of the centroids that they replace."""
    apart = np.linalg.norm(limits[:, None] - loop, axis=-1)
    near, at_place = apart.min(axis=1), apart.argmin(axis=1)
    order = np.argsort(near, kind="stable")
    order = order[near[order] <= width]
    _, first = np.unique(at_place[order], return_index=True)
    chosen = order[np.sort(first)]
    return limits[chosen], at_place[chosen]


def _segments(loop: np.ndarray, critical: np.ndarray, tolerances: FitTolerances, width_m: float) -> list[FittedSegment]:
    """Lines and arcs along a closed loop, split at its critical points, each from where it meets its neighbours."""
    first = int(critical[0]) if len(critical) else 0
    closed = np.roll(loop, -first, axis=0)
    closed = np.concatenate([closed, closed[:1]])
    splits = [*(critical - first).tolist(), len(loop)] if len(critical) else [0, len(loop)]
    out = []
    for begin, end in pairwise(splits):
        out += fitted_segments(closed[begin : end + 1], tolerances)
    return joined_segments(out, width_m)
