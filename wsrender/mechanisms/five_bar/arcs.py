"""Circle arcs in the plane: points, meetings, and what they contribute to an area."""

from dataclasses import dataclass, replace

import numpy as np


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
