"""Edges of ball regions: the parts of circles and lines that bound them, with their end vertices."""

from dataclasses import dataclass

import numpy as np

from wsrender.errors import NumericalError
from wsrender.mechanisms.exact.circles import Circles, candidates, circles
from wsrender.mechanisms.exact.surfaces import Surfaces

ATTEMPTS = 3


@dataclass(frozen=True, eq=False)
class Arcs:
    """Edges of a batch of regions, in the scaled frames of its ``surfaces``, and their vertices.

    ``vertices`` (V, 3) are those of all regions. Edges: ``region`` (E,), ``pair`` (E,) of surfaces, from vertex
    ``start`` to vertex ``end`` (−1: a whole circle) along ``sweep`` (E,), the angle about the circle's axis from
    ``angle`` (E,), or the length of a straight edge; ``first_point``, ``last_point`` (E, 3).
    """

    surfaces: Surfaces
    circles: Circles
    vertices: np.ndarray
    region: np.ndarray
    pair: np.ndarray
    start: np.ndarray
    end: np.ndarray
    angle: np.ndarray
    sweep: np.ndarray
    first_point: np.ndarray
    last_point: np.ndarray

    @property
    def is_line(self) -> np.ndarray:
        """Whether an edge is straight, (E,)."""
        return self.surfaces.combinatorics.is_line[self.pair]

    @property
    def both(self) -> np.ndarray:
        """The two surfaces of each edge, (E, 2)."""
        return self.surfaces.combinatorics.pairs[self.pair]

    @property
    def lengths(self) -> np.ndarray:
        """Lengths of the edges (E,), scaled."""
        return self.sweep * np.where(self.is_line, 1.0, self.of_circle("radius"))

    def of_circle(self, name: str) -> np.ndarray:
        """A field of its circle for each edge."""
        return getattr(self.circles, name)[self.region, self.pair]


def arcs(surfaces: Surfaces) -> Arcs:
    """The edges of all regions; NumericalError where they do not close, whatever small moves are tried."""
    for attempt in range(ATTEMPTS):
        found = _closed_arcs(surfaces.moved_apart(attempt))
        if found is not None:
            return found
    raise NumericalError("the edges of the exact workspace do not close; its surfaces are too nearly the same")


def _closed_arcs(surfaces: Surfaces) -> Arcs | None:
    """The edges; None where entering and leaving vertices do not alternate on every circle."""
    tables, rings = surfaces.combinatorics, circles(surfaces)
    points, real = candidates(surfaces, rings)
    feasible = real & (surfaces.allowed(points) | tables.own).all(axis=2)
    region, column = np.nonzero(feasible)
    vertices = points[region, column]
    total = len(tables.pairs)
    ring = (region[:, None] * total + tables.circles[column]).ravel()
    entering = tables.entering[column].ravel()
    vertex = np.repeat(np.arange(len(vertices)), 3)
    position = _positions(rings, ring // total, ring % total, vertices[vertex], tables.is_line)
    order = np.lexsort((position, ring))
    ring, entering, vertex, position = ring[order], entering[order], vertex[order], position[order]
    following = _following(ring)
    if (entering == entering[following]).any():
        return None
    begins, ends = np.flatnonzero(entering), following[entering]
    sweep = position[ends] - position[begins]
    whole = _whole_circles(surfaces, rings, ring)
    none = np.full(len(whole[0]), -1)
    start_points = rings.point(np.zeros(rings.radius.shape))[whole]
    first, last = vertex[begins], vertex[ends]
    return Arcs(
        surfaces,
        rings,
        vertices,
        np.concatenate([ring[begins] // total, whole[0]]),
        np.concatenate([ring[begins] % total, whole[1]]),
        np.concatenate([first, none]),
        np.concatenate([last, none]),
        np.concatenate([position[begins], np.zeros(len(none))]),
        np.concatenate([np.where(sweep < 0, sweep + 2 * np.pi, sweep), np.full(len(none), 2 * np.pi)]),
        np.concatenate([vertices[first], start_points]),
        np.concatenate([vertices[last], start_points]),
    )


def _positions(rings: Circles, region: np.ndarray, pair: np.ndarray, points: np.ndarray, is_line: np.ndarray):
    """Angles of points (n, 3) about the axes of their circles, lengths along their lines."""
    from_middle = points - rings.middle[region, pair]
    up, across, axis = ((getattr(rings, name)[region, pair] * from_middle).sum(axis=1) for name in _FRAME)
    return np.where(is_line[pair], axis, np.arctan2(up, across))


_FRAME = ("up", "across", "axis")


def _following(ring: np.ndarray) -> np.ndarray:
    """Of each entry of sorted rings the next on the same ring, after the last the first."""
    if not len(ring):
        return np.zeros(0, int)
    begins = np.flatnonzero(np.diff(ring, prepend=ring[0] - 1))
    following = np.arange(1, len(ring) + 1)
    following[np.append(begins[1:], len(ring)) - 1] = begins
    return following


def _whole_circles(surfaces: Surfaces, rings: Circles, with_vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Region and pair of circles without vertices that bound their region."""
    without = rings.exists.copy()
    without.ravel()[with_vertices] = False
    tested = surfaces.allowed(rings.point(np.zeros(rings.radius.shape))) | surfaces.combinatorics.pair_own
    region, pair = np.nonzero(without & tested.all(axis=2))
    return region, pair
