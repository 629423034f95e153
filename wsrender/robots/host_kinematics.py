"""Kinematics that are functions of the host: those of a robot defined by a Python class."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Self

import numpy as np

from wsrender.robots.kinematics import FAR, Kinematics
from wsrender.short_repr import short_repr

SAMPLES = 1 << 14
MARGIN, FLAT = 0.25, 1e-3  # beyond the samples, of their extent along an axis; where that is nothing, of the diagonal


@dataclass(frozen=True, eq=False)
class HostKinematics(Kinematics):
    """Names, kinds and limits of joints, and functions; ``content_hash`` knows nothing of the functions.

    ``base_pose(q: (N, n)) -> (N, 4, 4)`` and ``base_jacobian(q) -> (N, 6, n)`` give the end effector's poses and
    geometric Jacobians in the base frame.
    """

    turning: np.ndarray  # (n,) bool: whether a coordinate is an angle
    has_inertia: bool
    base_pose: Callable[[np.ndarray], np.ndarray]
    base_jacobian: Callable[[np.ndarray], np.ndarray]
    T_world_base: np.ndarray = field(default_factory=lambda: np.eye(4))
    T_tip_tool: np.ndarray = field(default_factory=lambda: np.eye(4))

    __repr__ = short_repr

    @property
    def geometry(self) -> None:
        """None: what lies between base and tip, the functions do not say."""
        return None

    @property
    def revolute(self) -> np.ndarray:
        """Whether coordinate k is an angle, shape (n,) bool."""
        return self.turning

    def poses(self, q: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4) of the tool point in the world."""
        return self.T_world_base @ self.base_pose(q) @ self.T_tip_tool

    def jacobians(self, q: np.ndarray) -> np.ndarray:
        """Jacobians (N, 6, n), linear then angular rows, at the tool point in world axes."""
        J, R, offset = self.base_jacobian(q), self.T_world_base[:3, :3], self.T_tip_tool[:3, 3]
        linear, angular = J[:, :3], J[:, 3:]
        if offset.any():
            linear = linear + np.cross(angular, (self.base_pose(q)[:, :3, :3] @ offset)[:, :, None], axis=1)
        return np.concatenate([R @ linear, R @ angular], axis=1)

    def boxes(self, lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Corners (N, 3) [m] of boxes around positions at samples with q in lower … upper (N, n), with a margin.

        A function says nothing of where it has not been evaluated: unlike those of a geometry, no proof.
        """
        low, high = zip(*(self._box(*part) for part in zip(lower, upper, strict=True)), strict=True)
        return np.array(low), np.array(high)

    def _box(self, lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        positions = self.poses(lower + _spread(SAMPLES, self.n) * (upper - lower))[:, :3, 3]
        low, high = positions.min(axis=0), positions.max(axis=0)
        margin = MARGIN * (high - low) + FLAT * np.linalg.norm(high - low)
        return low - margin, high + margin

    @cached_property
    def origin(self) -> np.ndarray:
        """As a chain's; that of a placement alone, for nothing is known of where the functions reach."""
        placement = self.T_world_base[:3, 3]
        far = placement.any() and np.linalg.norm(placement) > FAR * self.reach
        return placement if far else np.zeros(3)

    @property
    def foot(self) -> np.ndarray:
        """As a chain's: its base frame, (3,) [m]."""
        return self.T_world_base[:3, 3]

    def relative_to(self, origin: np.ndarray) -> Self:
        """The same in a world whose origin stands at ``origin`` (3,) [m]."""
        T = self.T_world_base.copy()
        T[:3, 3] -= origin
        return replace(self, T_world_base=T)

    @cached_property
    def reach(self) -> float:
        """Half the diagonal of the box [m]."""
        low, high = self._whole_box
        return float(np.linalg.norm(high - low) / 2)

    @cached_property
    def center(self) -> np.ndarray:
        """Middle of the box, (3,) [m]."""
        low, high = self._whole_box
        return (low + high) / 2

    @cached_property
    def _whole_box(self) -> tuple[np.ndarray, np.ndarray]:
        return self._box(self.lower_limits, self.upper_limits)


def _spread(count: int, n: int) -> np.ndarray:
    """Points (count, n) spread evenly over the unit cube.

    After Roberts, *The unreasonable effectiveness of quasirandom sequences*, 2018.
    """
    ratio = 2.0
    for _ in range(64):
        ratio = (1 + ratio) ** (1 / (n + 1))
    return (0.5 + np.arange(1, count + 1)[:, None] * ratio ** -np.arange(1.0, n + 1)) % 1.0
