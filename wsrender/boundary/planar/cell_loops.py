"""Grid cells that hold points of a plane, and the loops of cells at their border."""

from dataclasses import dataclass

import numpy as np

Edge = tuple[int, int, int]  # corner of the grid where an edge starts, and its heading: +x, +y, −x, −y
_STEP = ((1, 0), (0, 1), (-1, 0), (0, -1))
_STARTS = ((0, 0), (1, 0), (1, 1), (0, 1))  # corner of the cell on the left where an edge of each heading starts


@dataclass(frozen=True, eq=False)
class CellLoops:
    """Loops (K_i, 2) [m] of centroids of the points in boundary cells, the inside on the left, and the cell width."""

    loops: list[np.ndarray]
    width_m: float


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
    return CellLoops([centroids[tuple(np.array(cells).T)] for cells in _border_loops(occupied)], float(width))


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
