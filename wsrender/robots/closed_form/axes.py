"""A chain as axes in space: what classes of closed forms are told by.

Motions of a chain are a product of exponentials (Brockett 1984): joint i turns about, or slides along, an axis that
stands in the base frame where it does at zero displacement. Seen from the tip the same chain is one with the axes in
reverse order, whose pose is the inverse.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from wsrender.robots.chain import Chain

SAME = 1e-7  # sine of an angle, and distance over the reach, that count as none: of axes that are meant to be in line
JOINTS = 6  # of a chain that closed forms solve


@dataclass(frozen=True, eq=False)
class Axis:
    """A joint at zero displacement: ``direction`` (3,), unit length, and a ``point`` (3,) on it [m].

    ``lower`` … ``upper``: displacements that are allowed [rad or m]. ``coordinate``: which of the configuration's
    values it is, None for a joint that the chain does not have: a displacement is value * ``sign`` + ``offset``.
    """

    revolute: bool
    direction: np.ndarray
    point: np.ndarray
    lower: float = 0.0
    upper: float = 0.0
    coordinate: int | None = None
    sign: float = 1.0
    offset: float = 0.0

    def moved(self, T: np.ndarray) -> Self:
        """The same after a rigid motion (4, 4)."""
        return replace(self, direction=T[:3, :3] @ self.direction, point=T[:3, :3] @ self.point + T[:3, 3])

    def flipped(self) -> Self:
        """The same joint with its axis the other way round."""
        ends = {"lower": -self.upper, "upper": -self.lower}
        return replace(self, direction=-self.direction, sign=-self.sign, offset=-self.offset, **ends)

    def displaced(self, by: float) -> np.ndarray:
        """The motion (4, 4) of a displacement [rad or m]."""
        T, h = np.eye(4), self.direction
        if not self.revolute:
            T[:3, 3] = by * h
            return T
        K = np.cross(h, np.eye(3)).T  # columns h × e
        T[:3, :3] += np.sin(by) * K + (1 - np.cos(by)) * K @ K
        T[:3, 3] = self.point - T[:3, :3] @ self.point
        return T


@dataclass(frozen=True, eq=False)
class Axes:
    """Axes from base to tip, the tip's pose (4, 4) at zero displacement, and a length [m] that tolerances go by.

    ``reversed``: they are a chain's from tip to base; they are solved for the inverse of its poses.
    """

    axes: tuple[Axis, ...]
    T_tip: np.ndarray
    reach: float
    reversed: bool = False

    @classmethod
    def of(cls, chain: Chain) -> "Axes | None":
        """The joints of a chain that move, the others folded in; None where coordinates drive several joints."""
        own = np.array_equal(chain.joint_source, np.arange(chain.n)) and np.all(chain.joint_scale == 1.0)
        if not own:
            return None
        T, found = np.eye(4), []
        for i in range(chain.n):
            T = T @ chain.T_joint[i]
            revolute, offset = bool(chain.joint_is_revolute[i]), float(chain.joint_offset[i])
            lower, upper = chain.lower_limits[i] + offset, chain.upper_limits[i] + offset
            axis = Axis(revolute, T[:3, 2], T[:3, 3], float(lower), float(upper), i, 1.0, offset)
            if lower == upper:
                T = axis.displaced(lower) @ T
            else:
                found.append(axis)
        points = np.array([axis.point for axis in found] or [np.zeros(3)])
        T_tip = T @ chain.T_tip @ chain.T_tip_tool
        return cls(tuple(found), T_tip, max(float(chain.reach), float(np.ptp(points, axis=0).max()), 1e-9))

    def backwards(self) -> "Axes":
        """The chain seen from the tip."""
        T = np.linalg.inv(self.T_tip)
        axes = tuple(axis.moved(T) for axis in self.axes[::-1])
        axes = tuple(replace(axis, direction=-axis.direction) for axis in axes)
        return replace(self, axes=axes, T_tip=T, reversed=not self.reversed)

    def orders(self) -> Iterator["Axes"]:
        """These, and those with a hinge and a slide along it exchanged, which move the same way in either order."""
        yield self
        for i, (first, second) in enumerate(zip(self.axes, self.axes[1:], strict=False)):
            if first.revolute != second.revolute and parallel(first, second):
                yield replace(self, axes=(*self.axes[:i], second, first, *self.axes[i + 2 :]))

    def free(self, directions: Sequence[np.ndarray]) -> "Axes":
        """With hinges through the tip that nothing limits: what a target leaves open."""
        tip = self.T_tip[:3, 3]
        more = tuple(Axis(True, each, tip, -np.pi, np.pi) for each in directions)
        return replace(self, axes=(*self.axes, *more))

    def completed(self) -> Iterator["Axes"]:
        """Axes of JOINTS joints that move as these do: the others are held, so that the tip stands where they do.

        Joints behind make a wrist with what the chain has of one. A slide makes two joints before a wrist, or an arm
        that moves in a plane, an arm in space.
        """
        axes, tip = self.axes, self.T_tip[:3, 3]
        if len(axes) == JOINTS:
            yield self
        if len(axes) == 5 and axes[4].revolute:
            yield self._with(_across(axes[4], axes[3]))
            center = meeting_point(axes[2:], self.reach)
            if center is not None and axes[1].revolute:
                yield replace(self, axes=(*axes[:2], _reaching(axes[0], axes[1], center), *axes[2:]))
        if len(axes) == 4 and axes[3].revolute:
            yield self._with(*_wrist(axes[3], tip))
        if len(axes) == 3:
            roll = Axis(True, self.T_tip[:3, 2], tip)
            yield self._with(roll, *_wrist(roll, tip))
            hinges = [axis for axis in axes if axis.revolute]
            if axes[2].revolute and all(parallel(axes[2], axis) for axis in hinges):
                slide = replace(axes[2], revolute=False, lower=0.0, upper=0.0, coordinate=None)
                yield replace(self, axes=(*axes[:2], slide, axes[2], *_wrist(axes[2], tip)))

    def _with(self, *held: Axis) -> "Axes":
        return replace(self, axes=(*self.axes, *held))


def parallel(first: Axis, second: Axis, within: float = SAME) -> bool:
    """Whether two axes have one direction, or opposite ones."""
    return bool(np.linalg.norm(np.cross(first.direction, second.direction)) < within)


def meeting_point(axes: Sequence[Axis], reach: float, within: float = SAME) -> np.ndarray | None:
    """The point (3,) that axes go through, by least squares; None where there is none, or more than one."""
    across = [np.eye(3) - np.outer(axis.direction, axis.direction) for axis in axes]
    A = np.sum(across, axis=0)
    if np.linalg.cond(A) > 1e10:
        return None
    point = np.linalg.solve(A, np.sum([P @ axis.point for P, axis in zip(across, axes, strict=True)], axis=0))
    off = max(np.linalg.norm(P @ (point - axis.point)) for P, axis in zip(across, axes, strict=True))
    return point if off < within * reach else None


def nearest_points(first: Axis, second: Axis) -> tuple[np.ndarray, np.ndarray]:
    """Ends (3,) of the common normal of two axes that are not parallel."""
    between, k = second.point - first.point, first.direction @ second.direction
    u, v = between @ first.direction, between @ second.direction
    s, t = (u - v * k) / (1 - k * k), (u * k - v) / (1 - k * k)
    return first.point + s * first.direction, second.point + t * second.direction


def perpendicular(direction: np.ndarray) -> np.ndarray:
    """A unit vector (3,) across a direction (3,)."""
    across = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    return across / np.linalg.norm(across)


def _across(last: Axis, before: Axis) -> Axis:
    """A held hinge across the last axis and the one before, where they are nearest."""
    if parallel(last, before):
        return Axis(True, perpendicular(last.direction), last.point)
    across = np.cross(before.direction, last.direction)
    return Axis(True, across / np.linalg.norm(across), nearest_points(before, last)[1])


def _reaching(first: Axis, second: Axis, center: np.ndarray) -> Axis:
    """A held slide that moves the centre of a wrist on two joints where they do not."""
    along, off = second.direction, center - second.point
    across = off - along * (along @ off)
    length = float(np.linalg.norm(across))
    if parallel(first, second) or length == 0.0:
        return Axis(False, along, center)
    return Axis(False, across / length, center)


def _wrist(roll: Axis, tip: np.ndarray) -> tuple[Axis, Axis]:
    """Two held hinges that make a wrist with a roll, at the point of its axis that is nearest to the tip."""
    at = roll.point + roll.direction * (roll.direction @ (tip - roll.point))
    pitch = perpendicular(roll.direction)
    return Axis(True, pitch, at), Axis(True, np.cross(roll.direction, pitch), at)
