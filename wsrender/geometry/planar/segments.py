"""Segments of a boundary, the inside on the left, and tables of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wsrender.geometry.planar.curves import Curves, cross
from wsrender.geometry.planar.distances import point_distances
from wsrender.volume.table import Table

GEOMETRY = ("x_s", "y_s", "x_e", "y_e", "x_o", "y_o", "R", "sweep")


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
