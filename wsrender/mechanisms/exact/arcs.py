"""Edges of ball regions: parts of the circles and lines in which pairs of surfaces meet, with their end vertices.

All of a batch of regions at a time; vertices are among the points in which three surfaces meet.
"""

from dataclasses import dataclass

import numpy as np

from wsrender.errors import NumericalError
from wsrender.mechanisms.exact.surfaces import Surfaces

PARALLEL = 1e-26  # squared sine below which planes of circles are parallel: rounding of collinear centres
ATTEMPTS = 3


@dataclass(frozen=True, eq=False)
class Circles:
    """Circle of every pair of surfaces, Q to a region; all lines of pairs of planes are among them.

    ``axis`` (M, Q, 3): from the first centre to the second, or into the half space; a line's direction. ``height``
    (M, Q) is the distance of the circle's plane from the first centre along the axis, ``other_height`` that from the
    second centre against it. ``middle`` (M, Q, 3), a point of a line; ``radius`` (M, Q); ``exists`` (M, Q), false for
    lines; ``across``, ``up`` (M, Q, 3): with the axis a right-handed frame.
    """

    axis: np.ndarray
    height: np.ndarray
    other_height: np.ndarray
    middle: np.ndarray
    radius: np.ndarray
    exists: np.ndarray
    across: np.ndarray
    up: np.ndarray

    def point(self, angle: np.ndarray) -> np.ndarray:
        """Points (M, Q, 3) at angles (M, Q) about the axis."""
        turned = np.cos(angle)[..., None] * self.across + np.sin(angle)[..., None] * self.up
        return self.middle + self.radius[..., None] * turned


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross products along the last axis."""
    (a0, a1, a2), (b0, b1, b2) = np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0)
    return np.stack([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0], axis=-1)


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Scalar products along the last axis."""
    return (a * b).sum(axis=-1)


def circles(surfaces: Surfaces) -> Circles:
    """The circles of every pair."""
    first, second = surfaces.combinatorics.pairs.T
    spheres = surfaces.spheres
    of_two, of_plane = second < spheres, (first < spheres) & (second >= spheres)
    shape = (len(surfaces), len(first))
    axis, height, other = np.zeros((*shape, 3)), np.zeros(shape), np.zeros(shape)
    middle, radius, exists = np.zeros((*shape, 3)), np.zeros(shape), np.zeros(shape, bool)
    c, r = surfaces.centres, surfaces.radii
    i, j = first[of_two], second[of_two]
    between = c[:, j] - c[:, i]
    distance = np.sqrt(dot(between, between))
    apart = np.where(distance > 0, distance, 1.0)
    axis[:, of_two] = between / apart[..., None]
    height[:, of_two] = (distance + (r[:, i] - r[:, j]) * (r[:, i] + r[:, j]) / apart) / 2
    other[:, of_two] = distance - height[:, of_two]
    i, j = first[of_plane], second[of_plane] - spheres
    axis[:, of_plane] = -surfaces.normals[j]
    height[:, of_plane] = dot(c[:, i], surfaces.normals[j]) - surfaces.offsets[:, j]
    is_circle = of_two | of_plane
    i = first[is_circle]
    square = (r[:, i] - height[:, is_circle]) * (r[:, i] + height[:, is_circle])
    radius[:, is_circle] = np.sqrt(np.maximum(square, 0.0))
    exists[:, is_circle] = (square > 0) & (dot(axis[:, is_circle], axis[:, is_circle]) > 0)
    middle[:, is_circle] = c[:, i] + height[:, is_circle, None] * axis[:, is_circle]
    _lines(surfaces, axis, middle)
    across = _perpendicular(axis)
    return Circles(axis, height, other, middle, radius, exists, across, cross(axis, across))


def _lines(surfaces: Surfaces, axis: np.ndarray, middle: np.ndarray) -> None:
    """Directions and points of the lines of pairs of planes, whose normals are at right angles."""
    tables, n = surfaces.combinatorics, surfaces.normals
    p, q = (tables.pairs[tables.is_line] - surfaces.spheres).T
    axis[:, tables.is_line] = cross(n[p], n[q])
    middle[:, tables.is_line] = surfaces.offsets[:, p, None] * n[p] + surfaces.offsets[:, q, None] * n[q]


def _perpendicular(axis: np.ndarray) -> np.ndarray:
    """A unit vector at right angles to each."""
    least = np.abs(axis).argmin(axis=-1)
    found = cross(axis, np.eye(3)[least])
    length = np.sqrt(dot(found, found))
    return found / np.where(length > 0, length, 1.0)[..., None]


def candidates(surfaces: Surfaces, circles: Circles) -> tuple[np.ndarray, np.ndarray]:
    """Points (M, N, 3) in which three surfaces meet, and which of them are real (M, N); others are 0.

    With the first of the three a sphere, x = c + y, the circles with the second and the third lie in the planes
    a·y = h and b·y = k: y = h a + m e ± t n with n along a × b and e = n × a, which loses no digit more than the
    angle between a and b costs.
    """
    tables = surfaces.combinatorics
    ij, ik = tables.sphere_circles[:, 0], tables.sphere_circles[:, 1]
    a, b = circles.axis[:, ij], circles.axis[:, ik]
    h, k = circles.height[:, ij], circles.height[:, ik]
    w = cross(a, b)
    sine2 = dot(w, w)
    crossing = circles.exists[:, ij] & circles.exists[:, ik] & (sine2 > PARALLEL)
    sine = np.sqrt(np.where(crossing, sine2, 1.0))
    n = w / sine[..., None]
    m = (k - dot(a, b) * h) / sine
    square = circles.radius[:, ij] ** 2 - m**2
    real = crossing & (square > 0)
    t = np.sqrt(np.where(real, square, 0.0))[..., None] * n
    foot = circles.middle[:, ij] + m[..., None] * cross(n, a)
    points = np.concatenate([foot + t, foot - t], axis=1)
    real = np.concatenate([real, real], axis=1)
    at = tables.corners - surfaces.spheres
    corners = (surfaces.offsets[:, at, None] * surfaces.normals[at]).sum(axis=2)
    points = np.concatenate([np.where(real[..., None], points, 0.0), corners], axis=1)
    return points, np.concatenate([real, np.ones(corners.shape[:2], bool)], axis=1)


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
