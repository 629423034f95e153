"""The kinematic chain from a base to an end effector, taken from a compiled MuJoCo model."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Self

import numpy as np

from wsrender.robots.kinematics import FAR, Kinematics
from wsrender.robots.reachable_box import reachable_boxes
from wsrender.robots.small_matrices import applied, product
from wsrender.short_repr import short_repr


def _identity() -> np.ndarray:
    return np.eye(4)


def _first_moved(T_joint: np.ndarray, by: np.ndarray) -> np.ndarray:
    T_joint = T_joint.copy()
    T_joint[0, :3, 3] -= by
    return T_joint


def _of_point(at: np.ndarray) -> np.ndarray:
    """Inertia (3, 3) [m²] of a unit mass at a point (3,) [m]."""
    return (at * at).sum() * np.eye(3) - np.outer(at, at)


def _motions(turns: bool, by: np.ndarray) -> np.ndarray:
    """Turns about z by angles (N,), or slides along it, (N, 4, 4)."""
    T = np.tile(np.eye(4), (len(by), 1, 1))
    if turns:
        c, s = np.cos(by), np.sin(by)
        T[:, 0, 0], T[:, 0, 1], T[:, 1, 0], T[:, 1, 1] = c, -s, s, c
    else:
        T[:, 2, 3] = by
    return T


@dataclass(frozen=True, eq=False)
class Chain(Kinematics):
    """Joints in order from base to end effector, with everything the kernels need, as float64 arrays.

    A chain has ``L`` joints driven by ``n`` coordinates (the configuration ``q``); ``L > n`` only where
    joints are coupled (mimic joints, linear joint equalities). Joint ``i`` is displaced by
    ``joint_scale[i] * q[joint_source[i]] + joint_offset[i]`` [rad or m]. The value of a coordinate is that of the
    joint of its name, which need not be one of the L: a leader may stand on another branch. Coordinates stand in the
    order of the first joints that they move.

    Every joint frame has the joint axis as its local z, its origin on the axis. ``T_joint[i]`` is the
    frame of joint ``i`` at zero displacement in the frame of joint ``i-1`` after its motion (in the base
    frame for ``i = 0``); the joint then rotates about, or translates along, its z.
    """

    joint_is_revolute: np.ndarray  # (L,) bool
    joint_source: np.ndarray  # (L,) int
    joint_scale: np.ndarray  # (L,)
    joint_offset: np.ndarray  # (L,) [rad or m]
    T_joint: np.ndarray  # (L, 4, 4)
    T_tip: np.ndarray  # (4, 4) end effector in the frame of the last joint
    mass: np.ndarray  # (L,) [kg] of everything rigidly attached to joint i, before joint i+1
    center_of_mass: np.ndarray  # (L, 3) [m] in the frame of joint i
    inertia: np.ndarray  # (L, 3, 3) [kg m²] about the centre of mass, axes of the frame of joint i
    armature: np.ndarray  # (L,) [kg m² or kg] rotor inertia, added to the diagonal of M
    has_inertia: bool
    T_world_base: np.ndarray = field(default_factory=_identity)  # (4, 4) placement of the base frame
    T_tip_tool: np.ndarray = field(default_factory=_identity)  # (4, 4) tool in the end-effector frame
    leader_is_revolute: np.ndarray | None = None  # (n,) bool; None: as the first joint that each coordinate moves
    with_branches: "Chain | None" = None  # where bodies on other branches move too: see `dynamic`

    __repr__ = short_repr

    @property
    def geometry(self) -> "Chain":
        """Itself."""
        return self

    @property
    def revolute(self) -> np.ndarray:
        """Whether coordinate k is an angle, shape (n,) bool."""
        if self.leader_is_revolute is not None:
            return self.leader_is_revolute
        return np.array([bool(self.joint_is_revolute[self.joint_source == k][0]) for k in range(self.n)])

    @property
    def dynamic(self) -> "Chain":
        """The chain that has this one's joint-space inertia: itself, or one with leaders on other branches as joints.

        Each is followed, after those that it carries, by a joint at the same place that undoes its motion, so that
        nothing beyond moves with it.
        """
        if self.with_branches is None:
            return self
        names = ("lower_limits", "upper_limits", "periodic", "T_world_base", "T_tip_tool")
        return replace(self.with_branches, **{name: getattr(self, name) for name in names})

    @property
    def coupling(self) -> np.ndarray:
        """(L, n) derivative of the joints' displacements by the configuration."""
        matrix = np.zeros((len(self.joint_source), self.n))
        matrix[np.arange(len(matrix)), self.joint_source] = self.joint_scale
        return matrix

    def frames(self, q: np.ndarray) -> np.ndarray:
        """Frames of the joints after their motion, then of the tool point, in the world, (N, L + 1, 4, 4) float64."""
        moved = self.joint_scale * q[:, self.joint_source] + self.joint_offset
        T, frames = self.T_world_base, []
        for T_joint, turns, by in zip(self.T_joint, self.joint_is_revolute, moved.T, strict=True):
            T = T @ T_joint @ _motions(turns, by)
            frames.append(T)
        return np.stack([*frames, T @ self.T_tip @ self.T_tip_tool], axis=1)

    def step(self, joint: int, q: np.ndarray) -> np.ndarray:
        """Frames (N, 4, 4) of a joint after its motion, in that of the joint before it or of the base, at q (N, n)."""
        moved = self.joint_scale[joint] * q[:, self.joint_source[joint]] + self.joint_offset[joint]
        return self.T_joint[joint] @ _motions(self.joint_is_revolute[joint], moved)

    def poses(self, q: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4) of the tool point in the world at ``q`` (N, n), by the host in float64."""
        return self.frames(q)[:, -1]

    def jacobians(self, q: np.ndarray) -> np.ndarray:
        """Jacobians (N, 6, n), linear then angular rows, at the tool point in world axes; by the host in float64."""
        T = self.frames(q)
        axes, arms = T[:, :-1, :3, 2], T[:, -1:, :3, 3] - T[:, :-1, :3, 3]
        turns = self.joint_is_revolute[:, None]
        columns = np.where(turns, np.cross(axes, arms), axes), np.where(turns, axes, 0.0)
        return np.concatenate(columns, axis=2).transpose(0, 2, 1) @ self.coupling

    def boxes(self, lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Corners (N, 3) [m] of boxes around all positions with q in lower … upper (N, n), never too small."""
        return reachable_boxes(self, lower, upper)

    @cached_property
    def reach(self) -> float:
        """Upper bound of the distance from the first joint's origin to the end effector [m]; infinite where endless."""
        links = np.linalg.norm(self.T_joint[1:, :3, 3], axis=1).sum()
        tip = np.linalg.norm((self.T_tip @ self.T_tip_tool)[:3, 3])
        return float(links + self.largest_slide.sum() + tip)

    @cached_property
    def center(self) -> np.ndarray:
        """Centre of a sphere of radius `reach` that holds every position, (3,) [m]: the first joint's origin."""
        return (self.T_world_base @ self.T_joint[0])[:3, 3]

    @cached_property
    def origin(self) -> np.ndarray:
        """Where positions on a device are counted from, (3,) [m]: the world's origin, or far from it the center."""
        far = np.linalg.norm(self.center) > FAR * self.reach
        return self.center if far else np.zeros(3)

    @property
    def foot(self) -> np.ndarray:
        """Where drawings of the arm begin, (3,) [m]: at its base frame, or far from that at its first joint."""
        far = np.linalg.norm(self.T_joint[0, :3, 3]) > FAR * self.reach > 0.0
        return self.center if far else self.T_world_base[:3, 3]

    def relative_to(self, origin: np.ndarray) -> Self:
        """The same chain in a world whose origin stands at ``origin`` (3,) [m].

        The offset of the first joint moves to the base: what is far away is subtracted before it is rounded.
        """
        if not origin.any():
            return self
        offset = self.T_joint[0, :3, 3]
        T_world_base = self.T_world_base.copy()
        T_world_base[:3, 3] = self.center - origin
        whole = self.with_branches
        return replace(
            self,
            T_world_base=T_world_base,
            T_joint=_first_moved(self.T_joint, offset),
            with_branches=whole and replace(whole, T_joint=_first_moved(whole.T_joint, offset)),
        )

    def carrying(self, mass: float, at: np.ndarray, inertia: np.ndarray | None = None) -> Self:
        """The same with a mass [kg] at ``at`` (3,) [m] in the tool's frame.

        ``inertia`` (3, 3) [kg m²]: about there, in the tool's axes; None: it is a point.
        """
        link, total = self.mass[-1], self.mass[-1] + mass
        if not mass:
            return self
        T = product(self.T_tip, self.T_tip_tool)
        place, R = applied(T[:3], [*at, 1.0]), T[:3, :3]
        center = (link * self.center_of_mass[-1] + mass * place) / total
        about = link * _of_point(self.center_of_mass[-1] - center) + mass * _of_point(place - center)
        if inertia is not None:
            about += product(R, inertia, R.T)
        return replace(
            self,
            mass=np.append(self.mass[:-1], total),
            center_of_mass=np.vstack([self.center_of_mass[:-1], center]),
            inertia=np.concatenate([self.inertia[:-1], [self.inertia[-1] + about]]),
        )

    @property
    def largest_slide(self) -> np.ndarray:
        """Largest distance that each joint slides from zero within its limits, 0 for revolute ones, (L,) [m]."""
        limits = np.stack([self.lower_limits, self.upper_limits])[:, self.joint_source]
        largest = np.abs(self.joint_scale * limits + self.joint_offset).max(axis=0)
        return np.where(self.joint_is_revolute, 0.0, largest)
