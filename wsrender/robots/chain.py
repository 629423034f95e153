"""The kinematic chain from a base to an end effector, taken from a compiled MuJoCo model."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Self

import numpy as np

FAR = 8  # reaches away from the world's origin that single precision bears: three of its 24 bits


def _identity() -> np.ndarray:
    return np.eye(4)


def _first_moved(T_joint: np.ndarray, by: np.ndarray) -> np.ndarray:
    T_joint = T_joint.copy()
    T_joint[0, :3, 3] -= by
    return T_joint


@dataclass(frozen=True, eq=False)
class Chain:
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

    name: str
    base_frame: str
    tip_frame: str
    joint_names: tuple[str, ...]  # of the n coordinates
    lower_limits: np.ndarray  # (n,) [rad or m]; -pi where periodic, -inf where endless
    upper_limits: np.ndarray  # (n,) [rad or m]; +pi where periodic, inf where endless
    periodic: np.ndarray  # (n,) bool: a hinge without limits
    effort_limits: np.ndarray | None  # (n,) [N m or N], None where the model has none for some joint
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

    def __post_init__(self):
        for f in fields(self):
            value = getattr(self, f.name)
            if isinstance(value, np.ndarray):
                value = np.array(value, order="C")
                value.setflags(write=False)
                object.__setattr__(self, f.name, value)

    @property
    def n(self) -> int:
        """Number of coordinates: the length of a configuration."""
        return len(self.joint_names)

    @property
    def revolute(self) -> np.ndarray:
        """Whether coordinate k is an angle, shape (n,) bool."""
        if self.leader_is_revolute is not None:
            return self.leader_is_revolute
        return np.array([bool(self.joint_is_revolute[self.joint_source == k][0]) for k in range(self.n)])

    @cached_property
    def content_hash(self) -> str:
        """SHA-256 of every number and name of the chain, hexadecimal."""
        digest = hashlib.sha256()
        for f in fields(Chain):
            value = getattr(self, f.name)
            digest.update(f.name.encode())
            if isinstance(value, np.ndarray):
                digest.update(f"{value.dtype.str}{value.shape}".encode() + value.tobytes())
            elif isinstance(value, Chain):
                digest.update(value.content_hash.encode())
            else:
                digest.update(repr(value).encode())
        return digest.hexdigest()

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

    def placed(self, T_world_base: np.ndarray | None = None, T_tip_tool: np.ndarray | None = None) -> Self:
        """The same chain with its base placed in the world and a tool added at its tip ((4, 4) each)."""
        changes = {"T_world_base": T_world_base, "T_tip_tool": T_tip_tool}
        return replace(self, **{name: value for name, value in changes.items() if value is not None})

    def held(self, values: Mapping[str, float]) -> Self:
        """The same chain with joints, by name, held at a value [rad or m]."""
        held = np.array([name in values for name in self.joint_names])
        value = np.array([values.get(name, 0.0) for name in self.joint_names])
        return replace(
            self,
            lower_limits=np.where(held, value, self.lower_limits),
            upper_limits=np.where(held, value, self.upper_limits),
            periodic=self.periodic & ~held,
        )

    @property
    def endless(self) -> tuple[str, ...]:
        """Names of the coordinates without usable limits: slides without any, hinges that whole turns do not suit."""
        bounded = np.isfinite(self.lower_limits) & np.isfinite(self.upper_limits)
        return tuple(name for name, ends in zip(self.joint_names, bounded, strict=True) if not ends)

    def within(self, share: float) -> np.ndarray:
        """The configuration (n,) at a share 0 … 1 of every range [rad or m]; 0 where a coordinate is endless."""
        ends = np.stack([self.lower_limits, self.upper_limits])
        lower, upper = np.where(np.isfinite(ends).all(axis=0), ends, 0.0)
        return lower + share * (upper - lower)

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

    @property
    def largest_slide(self) -> np.ndarray:
        """Largest distance that each joint slides from zero within its limits, 0 for revolute ones, (L,) [m]."""
        limits = np.stack([self.lower_limits, self.upper_limits])[:, self.joint_source]
        largest = np.abs(self.joint_scale * limits + self.joint_offset).max(axis=0)
        return np.where(self.joint_is_revolute, 0.0, largest)
