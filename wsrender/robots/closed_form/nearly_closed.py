"""Chains whose axes miss those of a class by little, as calibrated ones do: the closed form of the nearest of it."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.robots.chain import Chain
from wsrender.robots.closed_form.axes import Axes, Axis, meeting_point, nearest_points, parallel
from wsrender.robots.closed_form.closed_form import ClosedForm
from wsrender.robots.kinematics import Kinematics

NEARLY = 1e-5  # sine of an angle, and distance over the reach, by which axes miss what they are moved to
SECOND = 1.01  # what is added to first-order bounds of what moves of NEARLY come to together
ROUNDING = 1e-12  # of poses [reach, rad]


@dataclass(frozen=True, eq=False)
class NearlyClosedForm:
    """The closed form ``rest`` of a chain beside the one that is asked for.

    Their poses differ by at most ``off_m`` and ``off_rad`` wherever the joints stand: what the one does not reach
    within that much more than a tolerance, the other does not within the tolerance.
    """

    rest: ClosedForm
    off_m: float
    off_rad: float

    @classmethod
    def of(cls, chain: Kinematics, kind: str = "pose") -> "NearlyClosedForm | None":
        """That of a chain of hinges, from its axes; None where those nearby have none either."""
        if chain.geometry is None:
            return None
        for moved, off_m, off_rad in _beside(chain.geometry.relative_to(chain.origin)):
            if rest := ClosedForm.of(moved, kind):
                return cls(replace(rest, origin=chain.origin), off_m, off_rad)
        return None

    @property
    def name(self) -> str:
        """The class in words, and how far from it the chain is."""
        return f"{self.rest.name}, but for {self.off_m:.0e} m and {self.off_rad:.0e} rad".replace("e-0", "e-")


@lru_cache(maxsize=256)
def _beside(chain: Chain) -> list[tuple[Chain, float, float]]:
    """Chains whose axes are parallel, or meet, where the chain's nearly do, and how far poses are off [m, rad]."""
    axes = Axes.of(chain)
    if axes is None or not axes.axes or not all(axis.revolute for axis in axes.axes):
        return []
    found = []
    for way in (axes, axes.backwards()):
        moved = replace(way, axes=_meeting(_aligned(way.axes), axes.reach))
        moved = moved.backwards() if moved.reversed else moved
        motions = [_motion(old, new) for old, new in zip(axes.axes, moved.axes, strict=True)]
        found.append((_with_axes(chain, axes, motions), *_off(axes, motions)))
    return found


def _aligned(axes: tuple[Axis, ...]) -> list[Axis]:
    """Each in the direction of the one before where it nearly is."""
    found = [axes[0]]
    for axis in axes[1:]:
        before = found[-1].direction
        along = parallel(found[-1], axis, NEARLY)
        found.append(replace(axis, direction=before * np.sign(before @ axis.direction)) if along else axis)
    return found


def _meeting(axes: list[Axis], reach: float) -> tuple[Axis, ...]:
    """Where nearly so, the last three through a point, else the last two; before three, each through the next."""
    for last in (3, 2):
        point = meeting_point(axes[-last:], reach, NEARLY)
        if point is not None:
            axes = [*axes[:-last], *(replace(axis, point=point) for axis in axes[-last:])]
            break
    for i in (1, 0) if len(axes) == 6 and last == 3 else ():
        if not parallel(axes[i], axes[i + 1]):
            here, there = nearest_points(axes[i], axes[i + 1])
            if np.linalg.norm(there - here) < NEARLY * reach:
                axes[i] = replace(axes[i], point=axes[i].point + there - here)
    return tuple(axes)


def _motion(old: Axis, new: Axis) -> np.ndarray:
    """The least motion (4, 4) that takes an axis to another nearby: of its ``point`` to the nearest there."""
    T, across = np.eye(4), np.cross(old.direction, new.direction)
    T[:3, :3] = Rotation.from_rotvec(across).as_matrix()
    at = new.point + new.direction * (new.direction @ (old.point - new.point))
    T[:3, 3] = at - T[:3, :3] @ old.point
    return T


def _with_axes(chain: Chain, axes: Axes, motions: list[np.ndarray]) -> Chain:
    """The chain with its moving joints elsewhere by ``motions`` [4, 4] at zero displacement; the tip stays there."""
    by = {axis.coordinate: motion for axis, motion in zip(axes.axes, motions, strict=True)}
    T, T_moved, T_joint = np.eye(4), np.eye(4), chain.T_joint.copy()
    for i in range(chain.n):
        frame = T @ chain.T_joint[i]
        moved = by.get(i, np.eye(4)) @ frame
        T_joint[i] = np.linalg.inv(T_moved) @ moved
        held = np.eye(4)
        if i not in by:
            at = Axis(bool(chain.joint_is_revolute[i]), np.array([0.0, 0.0, 1.0]), np.zeros(3))
            held = at.displaced(float(chain.lower_limits[i] + chain.joint_offset[i]))
        T, T_moved = frame @ held, moved @ held
    return replace(chain, T_joint=T_joint, T_tip=np.linalg.inv(T_moved) @ T @ chain.T_tip)


def _off(axes: Axes, motions: list[np.ndarray]) -> tuple[float, float]:
    """How far the tip is off at most, wherever the joints stand, where each axis is moved so [m, rad].

    A joint that turns about an axis elsewhere is one between the motion and its inverse: each moves a point by what it
    moves the axis's, and turns the rest, which is no farther away than links are long.
    """
    points = np.array([*(axis.point for axis in axes.axes), axes.T_tip[:3, 3]])
    beyond = np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)[::-1])[::-1]
    turned = np.array([np.linalg.norm(Rotation.from_matrix(T[:3, :3]).as_rotvec()) for T in motions])
    moved = np.array([np.linalg.norm(T[:3, :3] @ p + T[:3, 3] - p) for T, p in zip(motions, points, strict=False)])
    off_m, off_rad = 2 * SECOND * (moved + turned * beyond).sum(), 2 * SECOND * turned.sum()
    return float(off_m) + ROUNDING * axes.reach, float(off_rad) + ROUNDING
