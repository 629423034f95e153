"""One joint of a planar chain: it turns what follows about a point, or slides it along a direction.

The boundary of the set that it sweeps can lie at its limits, and along paths of points of the set within.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from wsrender.geometry.planar.curves import FULL, TURN, Curves, cross, rotation, turned_left


@dataclass(frozen=True, eq=False)
class PlanarJoint:
    """A joint at the chain's reference configuration, where it is displaced by 0.

    It moves what follows by ``displacement`` = ``sign`` × (scale q + offset), between ``low`` and ``high`` [rad or m].
    """

    name: str
    revolute: bool
    center: np.ndarray  # (2,) [m] of a revolute joint
    direction: np.ndarray  # (2,) of unit length, of a prismatic joint
    low: float
    high: float
    scale: float = 1.0  # displacement = scale q + offset, sign included
    offset: float = 0.0

    @property
    def full(self) -> bool:
        """Whether the joint makes a whole turn."""
        return self.revolute and self.high - self.low >= FULL

    def coordinate(self, displacement: float) -> float:
        """Value of the joint's coordinate q [rad or m] at a displacement."""
        return (displacement - self.offset) / self.scale

    def move(self, points: np.ndarray, displacement: float) -> np.ndarray:
        """Points (…, 2) [m] moved by a displacement."""
        if self.revolute:
            return self.center + (points - self.center) @ rotation(displacement).T
        return points + displacement * self.direction

    def move_curves(self, curves: Curves, displacement: float) -> Curves:
        """Curves moved by a displacement."""
        if self.revolute:
            return curves.rotated(self.center, displacement)
        return curves.shifted(displacement * self.direction)

    def paths(self, points: np.ndarray) -> Curves:
        """Where the joint moves points (K, 2): arcs or lines from ``low`` to ``high``."""
        return self._traces(points, self.low, self.high)

    def orbits(self, points: np.ndarray) -> Curves:
        """What the joint can move to points (K, 2): their paths under the inverse motion."""
        return self._traces(points, -self.high, -self.low)

    def _traces(self, points: np.ndarray, low: float, high: float) -> Curves:
        count = len(points)
        if not self.revolute:
            return Curves.of_lines(points, self.direction, np.full(count, low), np.full(count, high))
        offset = points - self.center
        angle = np.arctan2(offset[:, 1], offset[:, 0])
        radius = np.hypot(offset[:, 0], offset[:, 1])
        last = low + TURN if self.full else high
        return Curves.of_arcs(np.broadcast_to(self.center, (count, 2)), radius, angle + low, angle + last)

    def displacement(self, start: np.ndarray, point: np.ndarray) -> float:
        """Displacement within the limits that moves ``start`` (2,) to ``point`` (2,), or nearest to it."""
        if not self.revolute:
            return float(np.clip((point - start) @ self.direction, self.low, self.high))
        a, b = start - self.center, point - self.center
        angle = float(np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b))
        middle = (self.low + self.high) / 2
        nearest = angle + TURN * np.round((middle - angle) / TURN)
        return float(np.clip(nearest, self.low, self.high))

    def along_itself(self, curves: Curves, tolerance: float) -> np.ndarray:
        """Whether the joint moves whole curves along their own lines or circles, (N,)."""
        if not self.revolute:
            return ~curves.arc & (np.abs(cross(curves.direction, self.direction)) * curves.span <= tolerance)
        offset = self.center - curves.base
        return curves.arc & (np.hypot(offset[:, 0], offset[:, 1]) <= tolerance)

    def stationary(self, curves: Curves, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
        """(rows (K,), points (K, 2)) of curves where the motion runs along them: there the swept set may end.

        Turning: points nearest and farthest from the centre, feet of perpendiculars; of an arc about the centre, whose
        every point is one, the start. Sliding: points of arcs whose tangent is parallel to the slide.
        """
        if not self.revolute:
            middle = np.arctan2(*turned_left(self.direction)[::-1])
            return _held(curves, [np.where(curves.arc, middle + k * np.pi, np.nan) for k in (0, 1)])
        offset = self.center - curves.base
        foot = (offset * curves.direction).sum(axis=1)
        towards = np.arctan2(offset[:, 1], offset[:, 0])
        concentric = self.along_itself(curves, tolerance)
        nearest = np.where(concentric, curves.low, np.where(curves.arc, towards, foot))
        farthest = np.where(curves.arc & ~concentric, towards + np.pi, np.nan)
        return _held(curves, [nearest, farthest])


def _held(curves: Curves, parameters: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Rows and points of those parameters that their curves hold; NaN is none."""
    rows, points = [], []
    for t in parameters:
        with np.errstate(invalid="ignore"):
            held = np.flatnonzero(curves.holds(t))
        rows.append(held)
        points.append(curves[held].at(t[held]))
    return np.concatenate(rows), np.concatenate(points)


class Source(IntEnum):
    """Where a candidate comes from: the inner boundary at a limit of the joint, or the path of one of its points."""

    LOWER = 0
    UPPER = 1
    PATH = 2


@dataclass(frozen=True, eq=False)
class Candidates:
    """N curves that may hold a boundary, each moved from piece ``parent`` of the set before, (N,), −1: from its point.

    ``point`` (N, 2) [m] is the point whose path a curve is, where it is one.
    """

    curves: Curves
    source: np.ndarray
    parent: np.ndarray
    point: np.ndarray


def candidates(
    joint: PlanarJoint, curves: Curves, points: np.ndarray, piece_of_point: np.ndarray, tolerance: float
) -> Candidates:
    """Candidates of a set with the boundary, or all points, ``curves`` and the vertices ``points`` on them.

    A whole turn has no limits. Points that the joint does not move have no path.
    """
    rows, stationary = joint.stationary(curves, tolerance)
    points = np.concatenate([points, stationary])
    piece = np.concatenate([piece_of_point, rows])
    paths = joint.paths(points)
    moving = paths.length > tolerance
    parts = [(paths[moving], Source.PATH, piece[moving], points[moving])]
    if not joint.full:
        nowhere = np.full((len(curves), 2), np.nan)
        for source, limit in ((Source.LOWER, joint.low), (Source.UPPER, joint.high)):
            parts.append((joint.move_curves(curves, limit), source, np.arange(len(curves)), nowhere))
    return Candidates(
        Curves.joined([part[0] for part in parts]),
        np.concatenate([np.full(len(part[0]), part[1]) for part in parts]),
        np.concatenate([part[2] for part in parts]),
        np.concatenate([part[3] for part in parts]),
    )
