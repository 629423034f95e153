"""A base that may stand anywhere in a space, as joints before those of the arm it carries."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from wsrender.documents.placements import IN_DEGREES, placed
from wsrender.robots.chain import Chain
from wsrender.robots.small_matrices import product

ORDER = (0, 1, 2, 5, 4, 3)  # of coordinates x, y, z, roll, pitch, yaw: R = Rz(yaw) Ry(pitch) Rx(roll)
AXES = (0, 1, 2, 0, 1, 2)
NAMES = ("base x", "base y", "base z", "base roll", "base pitch", "base yaw")


@dataclass(frozen=True, eq=False)
class MovingBase:
    """Coordinates (6,) from ``lower`` to ``upper``: x, y, z [m], roll, pitch, yaw [rad] of a frame in the world.

    The base of an arm stands in that frame at ``T_frame_base`` (4, 4). Coordinates of one value are no joints; others
    are counted from the middle of their range.
    """

    lower: np.ndarray
    upper: np.ndarray
    T_frame_base: np.ndarray

    @cached_property
    def varying(self) -> np.ndarray:
        """Which coordinates are joints, in the order of these, (m,)."""
        return np.array([k for k in ORDER if self.upper[k] > self.lower[k]], int)

    @cached_property
    def _middle(self) -> np.ndarray:
        return (self.lower + self.upper) / 2

    @cached_property
    def _joints(self) -> tuple[list[np.ndarray], np.ndarray]:
        """``T_joint`` of each, and the base's pose in the frame of the last of them."""
        T, joints = np.eye(4), []
        for k in ORDER:
            if k > 2:
                T = product(T, _turned(AXES[k], self._middle[k]))
            if k in self.varying:
                along = _turned_to(AXES[k])
                joints.append(product(T, along))
                T = along.T
        return joints, product(T, self.T_frame_base)

    @property
    def base_on_last(self) -> np.ndarray:
        """The base's pose (4, 4) in the frame of the last joint, or in the world's frame moved to the middle."""
        return self._joints[1]

    def configurations(self, coordinates: np.ndarray) -> np.ndarray:
        """Values of the joints (N, m) at coordinates (N, 6) [m and rad]."""
        return (coordinates - self._middle)[:, self.varying]

    def poses(self, values: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4) of the arm's base in the world at values (N, m) of the joints."""
        coordinates = np.tile(self._middle, (len(values), 1))
        coordinates[:, self.varying] += values
        return placed(coordinates / IN_DEGREES) @ self.T_frame_base

    def carrying(self, chain: Chain) -> Chain:
        """The chain with the joints of the base before its own, whose values come first."""
        m, kinds = len(self.varying), self.varying > 2
        T_world = np.eye(4)
        T_world[:3, 3] = self._middle[:3]
        if not m:
            return chain.placed(product(T_world, self.base_on_last))
        joints, T_base = self._joints
        free = np.full(m, np.inf)
        before = {
            "joint_names": tuple(NAMES[k] for k in self.varying),
            "lower_limits": (self.lower - self._middle)[self.varying],
            "upper_limits": (self.upper - self._middle)[self.varying],
            "periodic": np.zeros(m, bool),
            "velocity_limits": free,
            "joint_is_revolute": kinds,
            "joint_source": np.arange(m),
            "joint_scale": np.ones(m),
            "joint_offset": np.zeros(m),
            "mass": np.zeros(m),
            "center_of_mass": np.zeros((m, 3)),
            "inertia": np.zeros((m, 3, 3)),
            "armature": np.zeros(m),
        }
        changes = {name: np.concatenate([each, getattr(chain, name)]) for name, each in before.items()
                   if name not in ("joint_names", "joint_source")}  # fmt: skip
        changes |= {
            "joint_names": before["joint_names"] + chain.joint_names,
            "joint_source": np.concatenate([np.arange(m), chain.joint_source + m]),
            "efforts": np.concatenate([np.stack([-free, free]), chain.efforts], axis=1),
            "T_joint": np.concatenate([joints, [product(T_base, chain.T_joint[0])], chain.T_joint[1:]]),
            "T_world_base": T_world,
            "with_branches": None,
        }
        if chain.leader_is_revolute is not None:
            changes["leader_is_revolute"] = np.concatenate([kinds, chain.leader_is_revolute])
        return replace(chain, **changes)


def _turned(axis: int, angle: float) -> np.ndarray:
    T, (j, k) = np.eye(4), ((axis + 1) % 3, (axis + 2) % 3)
    T[j, j] = T[k, k] = np.cos(angle)
    T[k, j] = np.sin(angle)
    T[j, k] = -T[k, j]
    return T


def _turned_to(axis: int) -> np.ndarray:
    """A rotation whose z is along an axis."""
    T = np.eye(4)
    T[:3, :3] = np.roll(np.eye(3), (axis + 1) % 3, axis=0)
    return T
