"""The tip stays in a region: a box, a ball and a half-space, as far as each is given."""

from dataclasses import dataclass

import numpy as np

from wsrender.pipeline.constraints.constraint import Structure
from wsrender.robots.kinematics import Kinematics
from wsrender.tolerances import TOLERANCES

Point = tuple[float, float, float]


@dataclass(frozen=True)
class RegionConstraint:
    """What is admitted is in each of the shapes that are given, in the world.

    ``box``: lower and upper corner [m]; ``ball``: centre and radius [m]; ``half_space``: a point [m], and the normal
    that points into it.
    """

    box: tuple[Point, Point] | None = None
    ball: tuple[Point, float] | None = None
    half_space: tuple[Point, Point] | None = None
    name: str = "region"
    keeps: frozenset[Structure] = frozenset({"trailing_joints"})
    device: str = "region"

    def pack(self, chain: Kinematics, origin: np.ndarray, precision: str) -> np.ndarray:
        """Corners (6,), centre and squared radius (4,), unit normal and offset (4,), seen from ``origin``.

        All borders lie farther out by what rounding may add to a position: an arm may move in one of them.
        """
        reach = chain.reach if np.isfinite(chain.reach) else 1.0
        return self._numbers(origin, TOLERANCES[precision].position(reach) + np.spacing(np.abs(origin).max()))

    def _numbers(self, origin: np.ndarray, wider: float = 0.0) -> np.ndarray:
        """Those of `pack`, for borders that lie so much farther out [m]."""
        infinite = np.full(3, np.inf)
        lower, upper = (np.array(corner) - origin for corner in self.box) if self.box else (-infinite, infinite)
        center, radius = (np.array(self.ball[0]) - origin, self.ball[1]) if self.ball else (np.zeros(3), np.inf)
        normal, offset = np.zeros(3), -np.inf
        if self.half_space:
            point, normal = np.array(self.half_space[0]) - origin, np.array(self.half_space[1])
            normal = normal / np.linalg.norm(normal)
            offset = float(normal @ point)
        return np.concatenate([lower - wider, upper + wider, center, [(radius + wider) ** 2], normal, [offset - wider]])

    def holds(self, points: np.ndarray) -> np.ndarray:
        """Whether points (N, 3) [m] in the world lie in the region, (N,) bool; its border belongs to it."""
        numbers = self._numbers(np.zeros(3))
        inside = ((points >= numbers[:3]) & (points <= numbers[3:6])).all(axis=1)
        inside &= ((points - numbers[6:9]) ** 2).sum(axis=1) <= numbers[9]
        return inside & (points @ numbers[10:13] >= numbers[13])

    def distance(self, points: np.ndarray) -> np.ndarray:
        """How far points (N, 3) [m] in the world are from the region at least, (N,) [m]; 0 inside."""
        numbers = self._numbers(np.zeros(3))
        beside = np.maximum(np.maximum(numbers[:3] - points, points - numbers[3:6]), 0.0)
        outside = np.linalg.norm(points - numbers[6:9], axis=1) - np.sqrt(numbers[9])
        below = numbers[13] - points @ numbers[10:13]
        return np.maximum.reduce([np.linalg.norm(beside, axis=1), outside, below, np.zeros(len(points))])

    def host(self, q: np.ndarray, frames: np.ndarray) -> np.ndarray:
        """See `Constraint.host`."""
        points = frames[:, :3, 3]
        rounding = TOLERANCES["float64"].position(np.abs(points).max(initial=0.0))
        return (self.distance(points) > rounding).astype(np.int8)
