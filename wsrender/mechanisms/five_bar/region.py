"""The workspace of a working mode: the plane region that both legs reach, bounded by circle arcs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from wsrender.mechanisms.five_bar.mechanism import WORKING_MODES, FiveBar, sign_of

SLACK = 1e-11  # of the mechanism's size: how far rounding separates arcs that meet or coincide
LEGS = ("left", "right")


@dataclass(frozen=True)
class Arc:
    """An oriented arc: from the angle ``start`` on, over ``sweep`` (negative: clockwise) [rad].

    ``name`` says what it bounds; ``first`` and ``last`` are the values at its ends of the joint angle that varies
    along it [rad].
    """

    name: str
    center: tuple[float, float]
    radius: float
    start: float
    sweep: float
    first: float
    last: float

    def points(self, u: np.ndarray) -> np.ndarray:
        """Points at shares u (N,) of the arc, (N, 2)."""
        angle = self.start + u * self.sweep
        return np.array(self.center) + self.radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)

    @property
    def ends(self) -> np.ndarray:
        """First and last point, (2, 2)."""
        return self.points(np.array([0.0, 1.0]))

    @property
    def length(self) -> float:
        """Length [m]."""
        return self.radius * abs(self.sweep)

    @property
    def area(self) -> float:
        """½ ∫ x dy − y dx along the arc; summed over a closed boundary, interior on the left, its area [m²]."""
        (x, y), end, r = self.center, self.start + self.sweep, self.radius
        chord = x * (np.sin(end) - np.sin(self.start)) - y * (np.cos(end) - np.cos(self.start))
        return 0.5 * (r**2 * self.sweep + r * chord)

    def part(self, low: float, high: float) -> "Arc":
        """The arc between two shares of it."""
        span = self.last - self.first
        return replace(
            self,
            start=self.start + low * self.sweep,
            sweep=(high - low) * self.sweep,
            first=self.first + low * span,
            last=self.first + high * span,
        )

    def extended(self, following: "Arc") -> "Arc":
        """The arc and the one of its circle that follows it."""
        return replace(self, sweep=self.sweep + following.sweep, last=self.last + following.last - following.first)

    def shares(self, angles: np.ndarray, slack: float) -> np.ndarray:
        """Shares of the arc at angles [rad] about its centre, of those that lie on it within ``slack`` [rad]."""
        turned = np.remainder((angles - self.start) * np.sign(self.sweep) + slack, 2 * np.pi) - slack
        return np.clip(turned[turned <= abs(self.sweep) + slack] / abs(self.sweep), 0.0, 1.0)

    def same_circle(self, other: "Arc", slack: float) -> bool:
        """Whether both lie on one circle within ``slack`` [m]."""
        return abs(self.radius - other.radius) <= slack and np.hypot(*np.subtract(self.center, other.center)) <= slack

    def meetings(self, other: "Arc", slack: float) -> np.ndarray:
        """Shares of this arc where it meets another; the ends of what they have in common, if on one circle.

        ``slack`` [m] is how near circles that touch may come.
        """
        if not self.radius:
            return np.empty(0)
        if self.same_circle(other, slack):
            points = other.ends
        else:
            points = _common_points(self, other, slack)
            if other.radius:
                near = slack / other.radius
                points = points[[len(other.shares(_angles(other, point[None]), near)) > 0 for point in points]]
        return self.shares(_angles(self, points), slack / self.radius)


def _angles(arc: Arc, points: np.ndarray) -> np.ndarray:
    x, y = (points - arc.center).T
    return np.arctan2(y, x)


def _common_points(a: Arc, b: Arc, slack: float) -> np.ndarray:
    """Points of two circles, (0, 1 or 2, 2); one where they touch within the slack."""
    between = np.subtract(b.center, a.center)
    distance = float(np.hypot(*between))
    if distance <= slack or not abs(a.radius - b.radius) - slack <= distance <= a.radius + b.radius + slack:
        return np.empty((0, 2))
    along = between / distance
    foot = (distance**2 + a.radius**2 - b.radius**2) / (2 * distance)
    squared = a.radius**2 - foot**2
    across = np.array([-along[1], along[0]])
    heights = np.sqrt(squared) * np.array([1.0, -1.0]) if squared > slack**2 else np.zeros(1)
    return np.array(a.center) + foot * along + heights[:, None] * across


@dataclass(frozen=True)
class ArcRegion:
    """Closed loops of arcs with the interior on their left: outlines run anticlockwise, holes clockwise.

    A leg with equal links folds onto its base point, which then is a hole of radius 0: θ1 is free there.
    """

    loops: tuple[tuple[Arc, ...], ...]

    @property
    def area_m2(self) -> float:
        """Area, exact but for rounding [m²]."""
        return float(sum(arc.area for loop in self.loops for arc in loop))

    @property
    def perimeter_m(self) -> float:
        """Length of the boundary [m]."""
        return float(sum(arc.length for loop in self.loops for arc in loop))


def workspace(five_bar: FiveBar, working_mode: str) -> ArcRegion:
    """What P reaches in a working mode, within the limits; without loops where it reaches nothing.

    Without limits it is the intersection of two annuli, whatever the mode. Raises InputError for another mode.
    """
    signs = sign_of(working_mode, WORKING_MODES, "working_mode")
    slack = SLACK * five_bar.size_m
    left, right = (leg_loops(five_bar, leg, sign) for leg, sign in enumerate(signs))
    kept = _inside(left, right, five_bar, 1, signs[1], slack, shared=True)
    kept += _inside(right, left, five_bar, 0, signs[0], slack, shared=False)
    return ArcRegion(tuple(_chained(kept, 1e3 * slack)))


def leg_loops(five_bar: FiveBar, leg: int, sign: int) -> list[list[Arc]]:
    """The boundary of what one leg (0 left, 1 right) reaches with its elbow on one side, interior on the left.

    Along "outer" and "inner" (stretched and folded leg) θ1 or θ2 varies, along "low" and "high" (base joint at a limit)
    the magnitude of the elbow's angle.
    """
    first, second = five_bar.proximal_m[leg], five_bar.distal_m[leg]
    base, side = five_bar.bases[leg], LEGS[leg]
    inner, outer = five_bar.reach_m(leg)
    turn = 0.0 if first >= second else np.pi  # a folded leg points along the longer link
    x, y = map(float, base)
    limits = five_bar.limits_rad[leg]
    low, high = limits or (-np.pi, np.pi)
    stretched = Arc(f"{side} outer", (x, y), outer, low, high - low, low, high)
    folded = Arc(f"{side} inner", (x, y), inner, high + turn, low - high, high, low)
    if limits is None:
        return [[stretched], [folded]]
    at_high, at_low = (
        Arc(f"{side} {name}", (x + first * np.cos(q), y + first * np.sin(q)), second, q, sign * np.pi, 0.0, np.pi)
        for name, q in (("high", high), ("low", low))
    )
    back = replace(at_low, start=low + sign * np.pi, sweep=-sign * np.pi, first=np.pi, last=0.0)
    return [[stretched, at_high, folded, back]]


def _inside(
    loops: list[list[Arc]],
    others: list[list[Arc]],
    five_bar: FiveBar,
    leg: int,
    sign: int,
    slack: float,
    *,
    shared: bool,
) -> list[Arc]:
    """The parts of the arcs that lie in what ``leg`` reaches; ``shared`` keeps those on its boundary as well.

    Of a boundary that both regions have, on the same side of it, one copy stays; where the regions lie on opposite
    sides none does.
    """
    kept = []
    boundary = [arc for loop in others for arc in loop]
    for arc in (arc for loop in loops for arc in loop):
        for part in _divided(arc, boundary, slack):
            middle = part.points(np.array([0.5]))
            twins = [other for other in boundary if _holds(other, part, middle, slack)]
            if twins:
                inside = shared and np.sign(twins[0].sweep) == np.sign(part.sweep)
            else:
                inside = not np.isnan(five_bar.leg_angles(middle, leg, sign)[0][0])
            if inside:
                kept.append(part)
    return kept


def _divided(arc: Arc, others: Sequence[Arc], slack: float) -> list[Arc]:
    """The arc, cut where it meets others."""
    shares = np.concatenate([arc.meetings(other, slack) for other in others])
    cuts = np.unique(np.concatenate([[0.0, 1.0], shares]))
    nearest = 4 * slack / max(arc.length, slack)  # nearer cuts are one
    wide = np.concatenate([[True], np.diff(cuts) > nearest])
    cuts = cuts[wide]
    cuts[-1] = 1.0
    return [arc.part(low, high) for low, high in pairwise(cuts)] or [arc]


def _holds(other: Arc, part: Arc, middle: np.ndarray, slack: float) -> bool:
    if not part.radius or not part.same_circle(other, slack):
        return False
    x, y = (middle - other.center).T
    return len(other.shares(np.arctan2(y, x), slack / other.radius)) > 0


def _chained(arcs: list[Arc], slack: float) -> list[tuple[Arc, ...]]:
    """The arcs as closed loops: each is followed by the one that starts where it ends.

    Where boundaries touch, several do; the one of another circle is taken, so that loops do not lead through the point
    at which the region has no inside.
    """
    left, loops = list(arcs), []
    while left:
        loop = [left.pop(0)]
        while left:
            gaps = np.array([np.hypot(*(arc.ends[0] - loop[-1].ends[1])) for arc in left])
            near = np.flatnonzero(gaps <= gaps.min() + slack)
            best = int(next((k for k in near if left[k].name != loop[-1].name), near[0]))
            closing = np.hypot(*(loop[0].ends[0] - loop[-1].ends[1]))
            touches = closing >= gaps[best] - slack and left[best].name != loop[-1].name
            if closing <= gaps[best] + slack and not touches:
                break
            loop.append(left.pop(best))
        loops.append(_joined(loop))
    return loops


def _joined(loop: list[Arc]) -> tuple[Arc, ...]:
    """The loop with arcs that continue each other, cut where nothing changes, as one."""
    joined = [loop[0]]
    for arc in loop[1:]:
        if _continues(joined[-1], arc):
            joined[-1] = joined[-1].extended(arc)
        else:
            joined.append(arc)
    if len(joined) > 1 and _continues(joined[-1], joined[0]):
        joined[0] = joined.pop().extended(joined[0])
    return tuple(joined)


def _continues(arc: Arc, following: Arc) -> bool:
    turns = (following.first - arc.last) / (2 * np.pi)
    return arc.name == following.name and abs(turns - round(turns)) < 1e-9
