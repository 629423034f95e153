"""A set of points of a plane, by its boundary of lines and arcs: its inside, its loops, and postures that reach it."""

from dataclasses import dataclass, field

import numpy as np

from wsrender.errors import NumericalError
from wsrender.geometry.planar.curves import TURN, Curves, cross
from wsrender.geometry.planar.distances import orbit_distances
from wsrender.geometry.planar.planar_chain import Candidates, PlanarJoint, Source
from wsrender.short_repr import short_repr

_AT_ONCE = 1 << 20  # angles that are held in memory at once


@dataclass(frozen=True)
class Span:
    """A part of a piece's parameter range and the candidates (rows) that made it."""

    low: float
    high: float
    made_by: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class PlanarSet:
    """What the part of a chain from a joint to the tip reaches: a point, a curve or a region.

    ``curves`` (P,) are the boundary of a region, a curve itself, or none. ``sign`` (P,) is 1 where the region lies on
    the left of increasing parameter, −1 where on the right. ``vertices`` (V, 2) [m] are the boundary's corners, the
    ends of a curve, or the point; ``ends`` (P, 2) are rows of them, −1 where a circle has none. ``spans`` (P lists)
    say how the curves came about: from the set ``inner`` that ``joint`` moves.
    """

    dimension: int
    curves: Curves
    sign: np.ndarray
    vertices: np.ndarray
    ends: np.ndarray
    spans: list[list[Span]] = field(default_factory=list)
    candidates: Candidates | None = None
    joint: PlanarJoint | None = None
    inner: "PlanarSet | None" = None

    __repr__ = short_repr

    @classmethod
    def of_point(cls, point: np.ndarray, **made: "PlanarJoint | PlanarSet | None") -> "PlanarSet":
        """A single point (2,) [m]."""
        return cls(0, Curves.none(), np.empty(0), point[None], np.empty((0, 2), np.int64), **made)  # type: ignore[arg-type]

    @property
    def piece_of_vertex(self) -> np.ndarray:
        """A piece that ends at each vertex, (V,); −1 of the point."""
        out = np.full(len(self.vertices), -1)
        for k, ends in enumerate(self.ends):
            out[ends[ends >= 0]] = k
        return out

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether points (K, 2) that lie on no boundary piece lie in the region, (K,)."""
        if self.dimension < 2:
            return np.zeros(len(points), bool)
        return winding_numbers(points, self.curves, self.sign) > 0.5

    def met_by(self, joint: PlanarJoint, points: np.ndarray, margin: np.ndarray) -> np.ndarray:
        """Whether ``joint`` moves some point of the set to each of ``points`` (K, 2): their orbits meet the set.

        The points keep ``margin`` (K,) [m] from the boundary of the moved set: their orbits, moved rigidly, keep it
        from this set too if they miss it.
        """
        orbits = joint.orbits(points)
        met = self.contains(orbits.start)
        rest = np.flatnonzero(~met)
        if len(rest):
            met[rest] = orbit_distances(orbits[rest], self.curves) < margin[rest] / 2
        return met


def winding_numbers(points: np.ndarray, curves: Curves, sign: np.ndarray) -> np.ndarray:
    """Winding number of the curves around points (K, 2) that lie on none of them, (K,) float: a whole number.

    ``sign`` (N,) is 1 where a curve is run through by increasing parameter, −1 where against it.
    """
    step = max(1, _AT_ONCE // max(len(curves), 1))
    parts = [points[first : first + step] for first in range(0, len(points), step)]
    return np.concatenate([_turns(part, curves) @ sign for part in parts] or [np.empty(0)])


def _turns(points: np.ndarray, curves: Curves) -> np.ndarray:
    """Angle that each curve subtends at each point, in turns, (K, N)."""
    a, b = curves.start - points[:, None], curves.end - points[:, None]
    area = cross(a, b) + 0.0  # never −0, whose arctan2 is −π
    angle = np.arctan2(area, (a * b).sum(axis=-1))
    offset = points[:, None] - curves.base
    inside = curves.arc & (np.hypot(offset[..., 0], offset[..., 1]) < curves.radius)
    # Between an arc and its chord the arc subtends a turn more than the chord.
    angle = np.where(inside & (area < 0), angle + TURN, angle)
    return np.where(curves.full, TURN * inside, angle) / TURN


@dataclass(frozen=True, eq=False)
class Loop:
    """Rows of pieces in the order they are run through, inside on the left: an outer loop turns counter-clockwise."""

    rows: np.ndarray
    signed_area: float  # [m²]; of a hole negative

    __repr__ = short_repr

    @property
    def hole(self) -> bool:
        """Whether the loop goes around a hole."""
        return self.signed_area < 0


def loops_of(region: PlanarSet) -> list[Loop]:
    """The loops of a region, the outer one first, then the holes by falling size.

    Where pieces meet at a point that is not passed twice in a row, the path turns to the right: a region stays one
    where it touches itself. Raises NumericalError where pieces do not follow each other.
    """
    areas = signed_areas(region.curves, region.sign)
    following = _following(region)
    if len(set(following)) < len(following):
        raise NumericalError("boundary pieces do not follow each other: curves nearly coincide")
    left, loops = dict.fromkeys(range(len(following))), []
    while left:
        rows = [next(iter(left))]
        while (row := following[rows[-1]]) != rows[0]:
            rows.append(row)
        left = {row: None for row in left if row not in rows}
        loops.append(Loop(np.array(rows), float(areas[rows].sum())))
    return sorted(loops, key=lambda loop: -loop.signed_area)


def closes(ends: np.ndarray, sign: np.ndarray, vertices: int) -> bool:
    """Whether pieces leave every vertex as often as they arrive; by their sign from the first end, or from the second.

    Ends are numbers of vertices, (P, 2), −1 of circles.
    """
    leaving, arriving = (np.where(sign > 0, ends[:, k], ends[:, 1 - k]) for k in (0, 1))
    degrees = [np.bincount(side[side >= 0], minlength=vertices) for side in (leaving, arriving)]
    return bool((degrees[0] == degrees[1]).all())


def _following(region: PlanarSet) -> list[int]:
    """The piece that comes after each, inside on the left."""
    forward = region.sign > 0
    leaving = np.where(forward, region.ends[:, 0], region.ends[:, 1])
    arriving = np.where(forward, region.ends[:, 1], region.ends[:, 0])
    out = []
    for row, vertex in enumerate(arriving):
        others = np.flatnonzero(leaving == vertex) if vertex >= 0 else np.array([row])
        out.append(int(others[0]) if len(others) == 1 else _rightmost(region, row, others))
    return out


def signed_areas(curves: Curves, sign: np.ndarray) -> np.ndarray:
    """Contribution of each curve to ½ ∮ x dy − y dx, (N,) [m²]."""
    a, b, center = curves.start, curves.end, curves.base
    lines = (a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]) / 2
    moment = center[:, 0] * (b - a)[:, 1] - center[:, 1] * (b - a)[:, 0]
    return sign * np.where(curves.arc, (curves.radius**2 * curves.span + moment) / 2, lines)


def _rightmost(region: PlanarSet, row: int, following: np.ndarray) -> int:
    """The piece that turns most to the right, seen a little way off the vertex where tangents may agree."""
    rows = np.array([row, *following])
    curves, forward = region.curves[rows], region.sign[rows] > 0
    # Backwards along the piece that arrives, forwards along those that leave.
    from_low = forward.copy()
    from_low[0] = not forward[0]
    step = curves.length.min() / 8
    t = step / np.where(curves.arc, curves.radius, 1.0)
    near = curves.at(np.where(from_low, curves.low + t, curves.high - t))
    ends = region.ends[row]
    offset = near - region.vertices[ends[1] if forward[0] else ends[0]]
    angle = np.arctan2(offset[:, 1], offset[:, 0])
    return int(following[np.mod(angle[1:] - angle[0], 2 * np.pi).argmin()])


def postures(swept: PlanarSet, row: int, t: float) -> list[list[float]]:
    """Displacements [rad or m] of the joints, base to tip, that reach the point at ``t`` of a piece.

    One list for each way in which the piece came about: pieces of different origin may coincide.
    """
    point = swept.curves[np.array([row])].at(np.array([t]))[0]
    found = []
    for source in _span(swept, row, t):
        found += [[first, *rest] for first, rest in _through(swept, source, point)]
    return found


def _span(swept: PlanarSet, row: int, t: float) -> tuple[int, ...]:
    """The candidates that made a piece at ``t``."""
    spans = swept.spans[row]
    if swept.curves.arc[row]:
        t = spans[0].low + np.mod(t - spans[0].low, TURN)
    return next((span.made_by for span in spans if t <= span.high), spans[-1].made_by)


def _through(swept: PlanarSet, source: int, point: np.ndarray) -> list[tuple[float, list[float]]]:
    """(displacement of the first joint, displacements of the rest) of the postures by way of one candidate."""
    joint, inner, found = swept.joint, swept.inner, swept.candidates
    assert joint is not None and inner is not None and found is not None
    kind, parent = found.source[source], int(found.parent[source])
    if kind == Source.PATH:
        start = found.point[source]
        first = joint.displacement(start, point)
    else:
        first = joint.low if kind == Source.LOWER else joint.high
        start = joint.move(point, -first)
    if parent < 0:
        return [(first, rest) for rest in _of_point(inner)]
    return [(first, rest) for rest in postures(inner, parent, _parameter(inner, parent, start))]


def _of_point(point: PlanarSet) -> list[list[float]]:
    """Displacements that leave a point where it is: of joints that do not move it, the nearest to 0."""
    rest = []
    while point.joint is not None and point.inner is not None:
        rest.append(float(np.clip(0.0, point.joint.low, point.joint.high)))
        point = point.inner
    return [rest]


def _parameter(inner: PlanarSet, row: int, point: np.ndarray) -> float:
    return float(inner.curves[np.array([row])].parameter(point[None])[0])
