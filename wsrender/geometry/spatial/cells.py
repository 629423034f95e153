"""The cells of a lattice that the boundary of a set passes through, and their edges that it crosses."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from scipy.ndimage import binary_erosion, label

Membership = Callable[[np.ndarray], np.ndarray]
Report = Callable[[int], None]

# Corner c of a cell is at its bits: x + 2 y + 4 z. Edges from corner to corner, in order of their axis.
CORNERS = np.array([[c & 1, c >> 1 & 1, c >> 2 & 1] for c in range(8)])
EDGES = np.array([(c, c | 1 << axis) for axis in range(3) for c in range(8) if not c >> axis & 1])
_FACES = [[c for c in range(8) if c >> axis & 1 == side] for axis in range(3) for side in (0, 1)]
_BISECTIONS = 26  # leaves 1e-8 of a cell


@dataclass(frozen=True, eq=False)
class LatticeCrossings:
    """Edges of the lattice with one end in the set: the last points ``inside`` and first ones ``outside`` it found.

    ``at`` (C, 3): corner of the lattice at which the edge starts, along ``axis`` (C,); ``starts_inside`` (C,) bool:
    whether that corner is in the set. ``inside`` and ``outside`` (C, 3) [m] are 1e-8 of a cell apart, after the
    default number of bisections.
    """

    at: np.ndarray
    axis: np.ndarray
    starts_inside: np.ndarray
    inside: np.ndarray
    outside: np.ndarray

    def __len__(self) -> int:
        return len(self.at)

    @property
    def outward(self) -> np.ndarray:
        """Unit vectors (C, 3) along the edges, out of the set."""
        return np.eye(3)[self.axis] * np.where(self.starts_inside, 1.0, -1.0)[:, None]


@dataclass(frozen=True, eq=False)
class SpatialCellLoops:
    """Where the boundary passes through cells: in each, one or more loops of crossed edges.

    Pairs (``loop``, ``crossing``), sorted by loop; ``center`` (number of loops, 3) [m]: of the loops' cells;
    ``quads`` (C, 4): for each crossing the pairs of the four cells around its edge, seen from outside the set
    anticlockwise.
    """

    loop: np.ndarray
    crossing: np.ndarray
    center: np.ndarray
    quads: np.ndarray


@dataclass(frozen=True, eq=False)
class CellLattice:
    """Cells between planes across x, y and z at ``axes`` [m], ``width`` [m] apart and some nearer to each other.

    ``inside`` (…): which corners the set holds.
    """

    axes: tuple[np.ndarray, ...]
    width: float
    inside: np.ndarray

    @classmethod
    def around(
        cls, low: np.ndarray, high: np.ndarray, cells: int, reaches: Membership, report: Report
    ) -> "CellLattice":
        """Cubes, ``cells`` along the longest edge of the box low … high and one around; ``report(corners)``."""
        width = float((high - low).max()) / cells
        # Not where the faces of an arm's workspace like to be.
        margin = np.array([1.3591, 1.2718, 1.3142]) * width
        origin = low - margin
        shape = np.ceil((high + margin - origin) / width).astype(int) + 1
        axes = tuple(start + np.arange(size) * width for start, size in zip(origin, shape, strict=True))
        return cls.between(axes, width, reaches, report)

    @classmethod
    def between(cls, axes: tuple[np.ndarray, ...], width: float, reaches: Membership, report: Report) -> "CellLattice":
        """Cells between planes, whose corners are tested; ``report(corners)``."""
        layers = []
        for x in axes[0]:
            layer = np.stack(np.meshgrid([x], *axes[1:], indexing="ij"), axis=-1).reshape(-1, 3)
            layers.append(reaches(layer).reshape(len(axes[1]), len(axes[2])))
            report(len(layer))
        return cls(axes, width, _thick_parts(np.array(layers)))

    def divided(self, planes: Sequence[np.ndarray], reaches: Membership, report: Report) -> "CellLattice":
        """With more ``planes`` [m] across x, y and z."""
        axes = tuple(np.union1d(axis, more) for axis, more in zip(self.axes, planes, strict=True))
        return CellLattice.between(axes, self.width, reaches, report)

    def corners(self, at: np.ndarray) -> np.ndarray:
        """Positions (N, 3) [m] of corners ``at`` (N, 3)."""
        return np.stack([axis[k] for axis, k in zip(self.axes, at.T, strict=True)], axis=1)

    @property
    def closed(self) -> bool:
        """Whether the set ends within the lattice."""
        return not any(np.take(self.inside, end, axis).any() for axis in range(3) for end in (0, -1))

    def crossings(self, reaches: Membership, report: Report, bisections: int = _BISECTIONS) -> LatticeCrossings:
        """The crossed edges, by so many ``bisections``; ``report(points tested)``."""
        starts, axes = [], []
        for axis in range(3):
            changes = np.argwhere(np.diff(self.inside, axis=axis))
            starts.append(changes)
            axes.append(np.full(len(changes), axis))
        at, axis = np.concatenate(starts), np.concatenate(axes)
        starts_inside = self.inside[tuple(at.T)]
        begin, along = self.corners(at), np.eye(3, dtype=int)[axis]
        length = self.corners(at + along) - begin
        # Differences of coordinates are rounded: edges of whole cells are exactly a width long.
        whole = np.abs(length - self.width) <= 1e-9 * self.width
        end = begin + along * np.where(whole, self.width, length)
        inside = np.where(starts_inside[:, None], begin, end)
        outside = np.where(starts_inside[:, None], end, begin)
        for _ in range(bisections):
            middle = (inside + outside) / 2
            held = reaches(middle)[:, None]
            inside, outside = np.where(held, middle, inside), np.where(held, outside, middle)
            report(len(middle))
        return LatticeCrossings(at, axis, starts_inside, inside, outside)

    def loops(self, crossings: LatticeCrossings) -> SpatialCellLoops:
        """The loops of crossed edges in every cell (dual marching cubes, Nielson 2004)."""
        corners = np.stack([self.inside[_shifted(self.inside.shape, c)] for c in CORNERS], axis=-1)
        case = (corners * (1 << np.arange(8))).sum(axis=-1)
        lookup = np.full((3, *self.inside.shape), -1)
        lookup[crossings.axis, *crossings.at.T] = np.arange(len(crossings))
        rows, cells, counted = [], [], 0
        for each in np.unique(case):
            where = np.argwhere(case == each)
            for edges in _loops_of_case(int(each)):
                starts, axes = CORNERS[EDGES[edges, 0]], edges // 4
                place = where[:, None] + starts
                ids = lookup[axes, place[..., 0], place[..., 1], place[..., 2]]
                loop = counted + np.arange(len(where))
                counted += len(where)
                cells.append(where)
                rows.append(np.stack([np.repeat(loop, len(edges)), ids.ravel(), np.tile(edges, len(where))], axis=1))
        table = np.concatenate(rows) if rows else np.empty((0, 3), int)
        table = table[np.argsort(table[:, 0], kind="stable")]
        at = np.concatenate(cells) if cells else np.empty((0, 3), int)
        center = (self.corners(at) + self.corners(at + 1)) / 2
        return SpatialCellLoops(table[:, 0], table[:, 1], center, _quads(table, crossings))


def _thick_parts(inside: np.ndarray) -> np.ndarray:
    """The corners of connected parts that hold a whole cell: what is thinner falls into meaningless bits."""
    found: Any = label(inside)
    parts, count = found
    if count < 2:
        return inside
    whole = binary_erosion(inside, np.ones((2, 2, 2)), origin=-1)
    return inside & np.isin(parts, np.unique(parts[whole]))


def _shifted(shape: tuple[int, ...], corner: np.ndarray) -> tuple[slice, ...]:
    return tuple(slice(c, c + size - 1) for c, size in zip(corner.tolist(), shape, strict=True))


def _quads(table: np.ndarray, crossings: LatticeCrossings) -> np.ndarray:
    """The pairs of each crossing; local edge 4 axis + k is the k-th of its axis, seen from the cell."""
    quads = np.full((len(crossings), 4), -1)
    quads[table[:, 1], table[:, 2] % 4] = np.arange(len(table))
    # The cells that see the edge as their edge 0, 1, 3, 2 go round it; about y the order of the others is (x, z).
    order = np.tile([0, 1, 3, 2], (len(crossings), 1))
    anticlockwise = (crossings.axis == 1) ^ crossings.starts_inside
    order[~anticlockwise] = order[~anticlockwise][:, ::-1]
    return np.take_along_axis(quads, order, axis=1)


@cache
def _loops_of_case(case: int) -> list[np.ndarray]:
    """Crossed edges (0 … 11) of a cell whose inner corners are the bits of ``case``, loop by loop.

    On a face with four crossed edges each inner corner is cut off by itself, the same seen from both cells.
    """
    inside = [bool(case >> c & 1) for c in range(8)]
    crossed = [e for e, (a, b) in enumerate(EDGES) if inside[a] != inside[b]]
    loop_of = {e: {e} for e in crossed}

    def join(edges: list[int]) -> None:
        merged = set().union(*(loop_of[e] for e in edges))
        for e in merged:
            loop_of[e] = merged

    for face in _FACES:
        on_face = [e for e in crossed if set(EDGES[e].tolist()) <= set(face)]
        if len(on_face) == 2:
            join(on_face)
        elif len(on_face) == 4:
            for corner in (c for c in face if inside[c]):
                join([e for e in on_face if corner in EDGES[e]])
    distinct = {min(loop): sorted(loop) for loop in loop_of.values()}
    return [np.array(loop) for _, loop in sorted(distinct.items())]
