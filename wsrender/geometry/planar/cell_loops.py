"""Grid cells that hold points of a plane, and the loops of cells at their border."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.ndimage import binary_dilation, find_objects, label

Edge = tuple[int, int, int]  # corner of the grid where an edge starts, and its heading: +x, +y, −x, −y
_STEP = ((1, 0), (0, 1), (-1, 0), (0, -1))
_STARTS = ((0, 0), (1, 0), (1, 1), (0, 1))  # corner of the cell on the left where an edge of each heading starts


_TOUCHING = np.ones((3, 3), bool)
MOST_SINGLE = 0.05  # share of boundary cells with one point: the border cuts slivers off cells of 20 points and more
CHANCE_POINTS = 20.0  # expected in a hole, by the cells around it, that is empty by chance once in 5e8


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
