"""Segments of a boundary, the inside on the left, and tables of them.

Fitted ones are lines and arcs along ordered points: each as long as it fits, joined to loops without gaps.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wsrender.geometry.fits import CircleFit, fit_circle, fit_line
from wsrender.geometry.planar.curves import Curves, cross, crossings, turned_left
from wsrender.geometry.planar.distances import point_distances
from wsrender.short_repr import short_repr
from wsrender.volume.table import Table

GEOMETRY = ("x_s", "y_s", "x_e", "y_e", "x_o", "y_o", "R", "sweep")
FARTHEST = 1.0  # of a point from the segment that stands for it, in cell widths: what scatter alone reaches
# Variance that an arc takes off a line's residual, over what it leaves: scatter alone exceeds it once in 200 runs of
# ten points, once in 35 of the least number.
_BENT = 16.0
_MEETING = 0.8  # cell widths from the point that neighbours have in common to where they cross: a third inside of 25°
_ON_CIRCLE = 1e-9  # of the radius: the rounding of a crossing
_LEAST = 6  # points that tell whether they bend


@dataclass(frozen=True, eq=False)
class Segment:
    """A line or arc from ``start`` to ``end`` (2,) [m].

    An arc has a ``center`` (2,) [m], a ``radius`` [m] and a signed ``sweep`` [rad], counter-clockwise positive; of a
    line they are None.
    """

    start: np.ndarray
    end: np.ndarray
    center: np.ndarray | None
    radius: float | None
    sweep: float | None

    __repr__ = short_repr

    @property
    def kind(self) -> str:
        """``line`` or ``arc``."""
        return "line" if self.center is None else "arc"

    @property
    def curve(self) -> Curves:
        """The segment as a curve, an arc from the end at which its angle is less."""
        if self.center is None or self.radius is None or self.sweep is None:
            along = self.end - self.start
            length = np.linalg.norm(along)
            direction = along / max(float(length), 1e-300)
            return Curves.of_lines(self.start[None], direction[None], np.zeros(1), np.array([length]))
        begin = self.start if self.sweep > 0 else self.end
        angle = np.arctan2(*(begin - self.center)[::-1])
        return Curves.of_arcs(
            self.center[None], np.array([self.radius]), np.array([angle]), np.array([angle + abs(self.sweep)])
        )

    @property
    def area(self) -> float:
        """What it adds to the area of a loop [m²]: of the triangle with the origin, and between arc and chord."""
        triangle = cross(self.start, self.end) / 2
        if self.radius is None or self.sweep is None:
            return float(triangle)
        return float(triangle + self.radius**2 / 2 * (self.sweep - np.sin(self.sweep)))

    def distances(self, points: np.ndarray) -> np.ndarray:
        """Distance of points (K, 2) from the segment, (K,) [m]."""
        return point_distances(points, self.curve)[:, 0]

    def along(self, step_m: float) -> np.ndarray:
        """Points (K, 2) [m] from one end to the other, at most a step apart."""
        curve = self.curve
        count = 2 + int(curve.length[0] / step_m)
        return np.concatenate([curve.at(t) for t in np.linspace(curve.low, curve.high, count)])


@dataclass(frozen=True, eq=False)
class ExactSegment(Segment):
    """A segment and how the chain draws it, each way that there is.

    ``generated_by`` names the joints at their limits: joint name → "lower" or "upper". ``postures`` are configurations
    (n,) [rad or m] that reach its middle.
    """

    generated_by: tuple[dict[str, str], ...]
    postures: tuple[np.ndarray, ...]

    __repr__ = short_repr

    @property
    def limits_text(self) -> str:
        """``generated_by`` in words: ``joint1 lower, joint2 upper``; other ways after a bar."""
        ways = (", ".join(f"{joint} {limit}" for joint, limit in way.items()) for way in self.generated_by)
        return " | ".join(way or "no joint" for way in ways)


def segment_table(loops: Sequence[Sequence[Segment]]) -> Table:
    """One row per segment: loop, kind, start, end [m]; centre, R [m] and sweep [rad] of arcs, NaN of lines."""
    rows = [(k, segment) for k, loop in enumerate(loops) for segment in loop]
    numbers = np.array([_numbers(segment) for _, segment in rows], np.float64).reshape(-1, len(GEOMETRY))
    columns = {"loop": np.array([k for k, _ in rows], np.int64), "kind": np.array([s.kind for _, s in rows], "<U4")}
    columns |= dict(zip(GEOMETRY, numbers.T, strict=True))
    if rows and all(isinstance(segment, ExactSegment) for _, segment in rows):
        columns["limits"] = np.array([segment.limits_text for _, segment in rows])  # type: ignore[attr-defined]
    return Table(columns, dict.fromkeys(GEOMETRY[:-1], "m") | {"sweep": "rad"})


def _numbers(segment: Segment) -> list[float]:
    center = (np.nan, np.nan) if segment.center is None else segment.center
    arc = (np.nan if value is None else value for value in (segment.radius, segment.sweep))
    return [*segment.start, *segment.end, *center, *arc]


def segment_entry(segment: Segment) -> dict[str, object]:
    """A segment for the result document: plain JSON values."""
    entry: dict[str, object] = {"kind": segment.kind, "start_m": segment.start.tolist(), "end_m": segment.end.tolist()}
    if segment.center is not None:
        entry |= {"center_m": segment.center.tolist(), "radius_m": segment.radius, "sweep_rad": segment.sweep}
    if isinstance(segment, ExactSegment):
        postures = [posture.tolist() for posture in segment.postures]
        entry |= {"generated_by": list(segment.generated_by), "configurations": postures}
    return entry


def drawn(table: Table, row: int, step_rad: float = 0.02) -> np.ndarray:
    """Points (K, 2) [m] along a segment of a table, close enough to draw it."""
    x_s, y_s, x_e, y_e, x_o, y_o, radius, sweep = (float(table[name][row]) for name in GEOMETRY)
    if table["kind"][row] == "line":
        return np.array([[x_s, y_s], [x_e, y_e]])
    angle = np.arctan2(y_s - y_o, x_s - x_o) + np.linspace(0, sweep, 2 + int(abs(sweep) / step_rad))
    return np.array([x_o, y_o]) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


@dataclass(frozen=True, eq=False)
class FittedSegment(Segment):
    """A segment and the ``points`` (K, 2) [m] that it stands for, from its start to its end."""

    points: np.ndarray

    __repr__ = short_repr

    @property
    def farthest(self) -> float:
        """Largest distance of the points from the segment [m]."""
        return float(self.distances(self.points).max())

    @property
    def squares(self) -> float:
        """Sum of the points' squared distances from the segment [m²]."""
        return float((self.distances(self.points) ** 2).sum())


@dataclass(frozen=True)
class FitTolerances:
    """What fits: mean squared distance from a line [m²], mean of (r² − R²)² of an arc [m⁴], and others that default.

    ``scatter_m``: root mean square of r − R; ``farthest_m``: of any point from its segment; ``bent``: the ratio of
    variances from which points that fit a line are an arc. All are infinite where they are not asked for.
    """

    line_m2: float
    arc_m4: float
    scatter_m: float = np.inf
    farthest_m: float = np.inf
    bent: float = np.inf

    @classmethod
    def of(
        cls, line_m2: float | None, arc_m4: float | None, scatter_m: float, width_m: float, extent_m: float
    ) -> "FitTolerances":
        """Those given; by default both allow a scatter, the latter of arcs with a radius of half the extent.

        ``width_m``: of the cells whose centroids the points are.
        """
        own = line_m2 is None and arc_m4 is None
        return cls(
            line_m2=scatter_m**2 if line_m2 is None else line_m2,
            arc_m4=(scatter_m * extent_m) ** 2 if arc_m4 is None else arc_m4,
            scatter_m=scatter_m if arc_m4 is None else np.inf,
            farthest_m=FARTHEST * width_m if own else np.inf,
            bent=_BENT if own else np.inf,
        )

    def allow_arc(self, circle: CircleFit) -> bool:
        """Whether the circle fits; a mean of (r² − R²)² ≈ 4 R² (r − R)²."""
        return circle.error <= min(self.arc_m4, (2 * circle.radius * self.scatter_m) ** 2)

    def bend(self, line_error: float, circle: CircleFit, count: int) -> bool:
        """Whether so many points bend: the circle leaves far less of the line's squared distance (an F test)."""
        left = circle.error / (2 * circle.radius) ** 2
        return count >= _LEAST and (line_error - left) * (count - 3) > self.bent * left


def fitted_segments(points: np.ndarray, tolerances: FitTolerances) -> list[FittedSegment]:
    """Segments along points (K, 2) [m], each as long as it fits, by bisection, then with the best common ends."""
    out, at, last = [], 0, len(points) - 1
    while at < last:
        fits, fails = at + 1, last + 1
        end = last
        while fails - fits > 1:
            if _fitted(points[at : end + 1], tolerances) is None:
                fails = end
            else:
                fits = end
            end = (fits + fails) // 2
        out.append(_fitted(points[at : fits + 1], tolerances) or _chord(points[at : fits + 1]))
        at = fits
    for k in range(len(out) - 1):
        out[k : k + 2] = _best_pair(out[k], out[k + 1], tolerances)
    return out


def _best_pair(one: FittedSegment, other: FittedSegment, tolerances: FitTolerances) -> list[FittedSegment]:
    """Two neighbours with the least squared distances from their points: as long as it fits may go round a corner."""
    points = np.concatenate([one.points, other.points[1:]])
    best, least = [one, other], one.squares + other.squares
    for at in range(_LEAST - 1, len(points) - _LEAST + 1):
        pair = [_fitted(part, tolerances) for part in (points[: at + 1], points[at:])]
        found = [each for each in pair if each is not None]
        if len(found) == 2 and (squares := sum(each.squares for each in found)) < least:
            best, least = found, squares
    return best


def _fitted(points: np.ndarray, tolerances: FitTolerances) -> FittedSegment | None:
    """The line through the ends of points if it fits and they do not bend, else the arc; None where neither does.

    Two points always have a line.
    """
    if len(points) == 2:
        return _chord(points)
    line_error, circle = fit_line(points), fit_circle(points)
    straight, round_ = line_error <= tolerances.line_m2, tolerances.allow_arc(circle)
    choices = []
    if straight and not (round_ and tolerances.bend(line_error, circle, len(points))):
        choices.append(_chord(points))
    if round_:
        choices.append(_fitted_arc(points, circle))
    return next((each for each in choices if each.farthest <= tolerances.farthest_m), None)


def joined_segments(segments: list[FittedSegment], width_m: float) -> list[FittedSegment]:
    """The segments of a closed loop, each from where it meets the one before to where it meets the one after.

    Where two neighbours do not meet near the point they have in common, such as where a line goes over into an arc
    smoothly, they end at that point, and an arc is fitted through its ends.
    """
    if len(segments) < 2:
        return segments
    starts = [_meeting(segments[k - 1], each, width_m) for k, each in enumerate(segments)]
    ends = [*starts[1:], starts[0]]
    return [_between(*each) for each in zip(segments, starts, ends, strict=True)]


def _meeting(before: FittedSegment, after: FittedSegment, width_m: float) -> np.ndarray:
    """Where the lines or circles of two segments cross, or the point (2,) that both stand for where none is near."""
    common = after.points[0]
    chords = [float(np.linalg.norm(np.ptp(each.points, axis=0))) for each in (before, after)]
    points = crossings(Curves.joined([before.curve, after.curve]), 0.0).points
    apart = np.linalg.norm(points - common, axis=1)
    return points[apart.argmin()] if apart.min(initial=np.inf) <= min(_MEETING * width_m, *chords) else common


def _between(segment: FittedSegment, start: np.ndarray, end: np.ndarray) -> FittedSegment:
    """The segment from another start to another end, (2,)."""
    points = segment.points
    if segment.center is None or segment.radius is None:
        return _line(points, start, end)
    off = np.abs(np.linalg.norm([start - segment.center, end - segment.center], axis=1) - segment.radius)
    if off.max() > _ON_CIRCLE * segment.radius:
        return _arc(points, _through_ends(points, start, end), start, end)
    return _arc(points, segment.center, start, end)


def _chord(points: np.ndarray) -> FittedSegment:
    return _line(points, points[0], points[-1])


def _line(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> FittedSegment:
    return FittedSegment(start, end, None, None, None, points)


def _arc(points: np.ndarray, center: np.ndarray, start: np.ndarray, end: np.ndarray) -> FittedSegment:
    """The arc about a centre along the points, a circle where start and end are one point."""
    spoke = np.concatenate([[start], points[1:-1], [end]]) - center
    turns = np.arctan2(cross(spoke[:-1], spoke[1:]), (spoke[:-1] * spoke[1:]).sum(axis=1))
    return FittedSegment(start, end, center, float(np.linalg.norm(spoke[0])), float(turns.sum()), points)


def _fitted_arc(points: np.ndarray, circle: CircleFit) -> FittedSegment:
    """The arc of the circle, between the places on it that are nearest to the first and the last of the points."""
    spoke = points[[0, -1]] - circle.center
    length = np.maximum(np.linalg.norm(spoke, axis=1, keepdims=True), 1e-300)
    start, end = circle.center + spoke * circle.radius / length
    return _arc(points, circle.center, start, end)


def _through_ends(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """The centre (2,) of the circle through start and end with the least squares of r² − R² of the points."""
    middle, half = (start + end) / 2, (end - start) / 2
    normal = turned_left(half) / np.linalg.norm(half)
    offset = points - middle
    height = offset @ normal
    power = (offset**2).sum(axis=1) - half @ half
    return middle + normal * float(height @ power / max(2 * height @ height, 1e-300))
