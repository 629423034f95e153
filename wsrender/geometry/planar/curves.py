"""Lines and arcs of a plane, many at a time, and where whole ones cross or touch."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Self

import numpy as np

from wsrender.short_repr import short_repr

TURN = 2 * np.pi
FULL = TURN - 1e-12  # sweep [rad] from which an arc is a circle: the rounding of a sum of angles


@dataclass(frozen=True, eq=False)
class Curves:
    """N pieces of lines and circles, each the points of a parameter t from ``low`` to ``high``.

    A line's points are ``base + t direction``, t [m]; those of an arc ``base + radius (cos t, sin t)``, t [rad],
    counter-clockwise.
    """

    arc: np.ndarray  # (N,) bool
    base: np.ndarray  # (N, 2) [m]: a point of the line, or the centre
    direction: np.ndarray  # (N, 2) of unit length; of lines
    radius: np.ndarray  # (N,) [m]; 0 of lines
    low: np.ndarray  # (N,) [m or rad]
    high: np.ndarray  # (N,) [m or rad]

    __repr__ = short_repr

    @classmethod
    def of_lines(cls, base: np.ndarray, direction: np.ndarray, low: np.ndarray, high: np.ndarray) -> Self:
        """Lines from ``base`` (N, 2) along ``direction`` (N, 2), ``low`` to ``high`` (N,)."""
        count = len(base)
        return cls(np.zeros(count, bool), base, np.broadcast_to(direction, (count, 2)), np.zeros(count), low, high)

    @classmethod
    def of_arcs(cls, base: np.ndarray, radius: np.ndarray, low: np.ndarray, high: np.ndarray) -> Self:
        """Arcs about ``base`` (N, 2) from angle ``low`` to ``high`` (N,) [rad]."""
        count = len(base)
        return cls(np.ones(count, bool), base, np.zeros((count, 2)), radius, low, high)

    @classmethod
    def none(cls) -> Self:
        """No curve."""
        return cls.of_arcs(np.empty((0, 2)), np.empty(0), np.empty(0), np.empty(0))

    @classmethod
    def joined(cls, parts: "Sequence[Curves]") -> Self:
        """The curves of several one after the other."""
        return cls(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(cls)))

    def __len__(self) -> int:
        return len(self.arc)

    def __getitem__(self, rows: np.ndarray) -> Self:
        return type(self)(*(getattr(self, f.name)[rows] for f in fields(self)))

    def between(self, low: np.ndarray, high: np.ndarray) -> Self:
        """The same lines and circles from ``low`` to ``high`` (N,)."""
        return replace(self, low=low, high=high)

    @property
    def span(self) -> np.ndarray:
        """Length of the parameter's range, (N,) [m or rad]."""
        return self.high - self.low

    @property
    def length(self) -> np.ndarray:
        """Length of each curve, (N,) [m]."""
        return np.where(self.arc, self.radius * self.span, self.span)

    @property
    def full(self) -> np.ndarray:
        """Whether a curve is a whole circle, (N,)."""
        return self.arc & (self.span >= FULL)

    @cached_property
    def start(self) -> np.ndarray:
        """Points at ``low``, (N, 2) [m]."""
        return self.at(self.low)

    @cached_property
    def end(self) -> np.ndarray:
        """Points at ``high``, (N, 2) [m]."""
        return self.at(self.high)

    def at(self, t: np.ndarray) -> np.ndarray:
        """The point of each curve at its parameter ``t`` (N,), (N, 2) [m]."""
        along = t[:, None] * self.direction
        return self.base + np.where(self.arc[:, None], self.radius[:, None] * unit(t), along)

    def normal(self, t: np.ndarray) -> np.ndarray:
        """Unit normal on the left of increasing t, (N, 2)."""
        return np.where(self.arc[:, None], -unit(t), turned_left(self.direction))

    def parameter(self, points: np.ndarray) -> np.ndarray:
        """Parameter of the nearest point of each whole line or circle, ``points`` (N, 2); angles in [0, 2π)."""
        offset = points - self.base
        angle = np.mod(np.arctan2(offset[:, 1], offset[:, 0]), TURN)
        return np.where(self.arc, angle, (offset * self.direction).sum(axis=1))

    def shifted(self, offset: np.ndarray) -> Self:
        """The curves moved by ``offset`` (2,) [m]."""
        return replace(self, base=self.base + offset)

    def rotated(self, center: np.ndarray, angle: float) -> Self:
        """The curves turned about ``center`` (2,) by an angle [rad]."""
        R = rotation(angle)
        t = np.where(self.arc, angle, 0.0)
        base = center + (self.base - center) @ R.T
        return replace(self, base=base, direction=self.direction @ R.T, low=self.low + t, high=self.high + t)

    def holds(self, t: np.ndarray, slack: np.ndarray | float = 0.0) -> np.ndarray:
        """Whether parameters ``t`` (N,) lie within the ranges of their curves, give or take ``slack``."""
        turned = np.mod(t - self.low, TURN)
        on_arc = (turned <= self.span + slack) | (turned >= TURN - slack)
        on_line = (t >= self.low - slack) & (t <= self.high + slack)
        return np.where(self.arc, on_arc, on_line)


def unit(angle: np.ndarray) -> np.ndarray:
    """(cos, sin) of angles (…), shape (…, 2)."""
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def turned_left(vectors: np.ndarray) -> np.ndarray:
    """Vectors (…, 2) turned by 90°."""
    return np.stack([-vectors[..., 1], vectors[..., 0]], axis=-1)


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The z component of the cross product of vectors (…, 2)."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def rotation(angle: float) -> np.ndarray:
    """Rotation by an angle [rad], (2, 2)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


@dataclass(frozen=True, eq=False)
class Crossings:
    """K points common to two of the curves; ``sharpness`` is the sine of the angle at which they cross, 0 touching."""

    first: np.ndarray  # (K,) row of a curve
    second: np.ndarray  # (K,) row of another
    points: np.ndarray  # (K, 2) [m]
    sharpness: np.ndarray  # (K,)

    __repr__ = short_repr


def crossings(curves: Curves, tolerance: float) -> Crossings:
    """Every point common to two different whole lines or circles, ranges of parameters left aside.

    Curves that miss or pass each other by at most ``tolerance`` [m] touch: that gives one point, found without loss
    of digits, where the two points of a crossing would each have lost half of them.
    """
    i, j = np.triu_indices(len(curves), k=1)
    swap = curves.arc[i] & ~curves.arc[j]
    i, j = np.where(swap, j, i), np.where(swap, i, j)  # lines first
    both_lines, both_arcs = ~curves.arc[j], curves.arc[i]
    parts = [
        _line_line(curves, i[both_lines], j[both_lines], tolerance),
        _line_circle(curves, i[~both_lines & ~both_arcs], j[~both_lines & ~both_arcs], tolerance),
        _circle_circle(curves, i[both_arcs], j[both_arcs], tolerance),
    ]
    names = ("first", "second", "points", "sharpness")
    return Crossings(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def _line_line(curves: Curves, i: np.ndarray, j: np.ndarray, tolerance: float) -> Crossings:
    sine = cross(curves.direction[i], curves.direction[j])
    crossing = np.abs(sine) > tolerance
    i, j, sine = i[crossing], j[crossing], sine[crossing]
    t = cross(curves.base[j] - curves.base[i], curves.direction[j]) / sine
    return Crossings(i, j, curves.base[i] + t[:, None] * curves.direction[i], np.abs(sine))


def _line_circle(curves: Curves, i: np.ndarray, j: np.ndarray, tolerance: float) -> Crossings:
    offset, u, r = curves.base[j] - curves.base[i], curves.direction[i], curves.radius[j]
    height = np.abs(cross(u, offset))
    foot = curves.base[i] + (offset * u).sum(axis=1)[:, None] * u
    half = np.sqrt(np.maximum((r - height) * (r + height), 0.0))
    return _pairs(i, j, foot, u, half, half / r, height - r, tolerance)


def _circle_circle(curves: Curves, i: np.ndarray, j: np.ndarray, tolerance: float) -> Crossings:
    offset, r1, r2 = curves.base[j] - curves.base[i], curves.radius[i], curves.radius[j]
    d = np.hypot(offset[:, 0], offset[:, 1])
    apart = d > tolerance
    i, j, offset, r1, r2, d = i[apart], j[apart], offset[apart], r1[apart], r2[apart], d[apart]
    u = offset / d[:, None]
    outside, within = d - (r1 + r2), np.abs(r1 - r2) - d
    gap = np.maximum(outside, within)
    touch = np.where(outside > within, r1, np.where(r1 > r2, r1, -r1))  # along u, where the circles touch
    # Heron's formula for the height of the triangle of centres and crossing: no cancellation in the small factor.
    half = np.sqrt(np.maximum(-outside * -within * (d + np.abs(r1 - r2)) * (d + r1 + r2), 0.0)) / (2 * d)
    along = np.where(np.abs(gap) <= tolerance, touch, (d + (r1 - r2) * ((r1 + r2) / d)) / 2)
    sharpness = np.minimum(half * d / (r1 * r2), 1.0)
    return _pairs(i, j, curves.base[i] + along[:, None] * u, turned_left(u), half, sharpness, gap, tolerance)


def _pairs(i, j, middle, along, half, sharpness, gap, tolerance) -> Crossings:
    """One point where curves touch, two where they cross: ``half`` to either side of ``middle``."""
    touching, crossing = np.flatnonzero(np.abs(gap) <= tolerance), np.flatnonzero(gap < -tolerance)
    step = half[crossing, None] * along[crossing]
    rows = np.concatenate([touching, crossing, crossing])
    points = np.concatenate([middle[touching], middle[crossing] - step, middle[crossing] + step])
    sharpness = np.concatenate([np.zeros(len(touching)), sharpness[crossing], sharpness[crossing]])
    return Crossings(i[rows], j[rows], points, sharpness)
