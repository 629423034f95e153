"""What moves an end effector, whether a model says it or functions of the host do."""

from abc import ABC, abstractmethod
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np

from wsrender.robots.joint_space import JointSpace
from wsrender.short_repr import short_repr

if TYPE_CHECKING:
    from wsrender.robots.chain import Chain

FAR = 8  # reaches away from the world's origin that single precision bears: three of its 24 bits


class Kinematics(JointSpace, ABC):
    """From configurations to the end effector: what a model's `Chain` and a Python class's `HostKinematics` both are.

    A device evaluates, and proofs stand on, the `geometry`; where that is None only the functions are known.
    """

    T_world_base: np.ndarray  # (4, 4) placement of the base frame
    T_tip_tool: np.ndarray  # (4, 4) tool in the end-effector frame
    has_inertia: bool

    __repr__ = short_repr

    @property
    @abstractmethod
    def geometry(self) -> "Chain | None":
        """The joints' frames and inertias; None where nothing but functions of the host is known."""

    @property
    @abstractmethod
    def revolute(self) -> np.ndarray:
        """Whether coordinate k is an angle, shape (n,) bool."""

    @abstractmethod
    def poses(self, q: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4) of the tool point in the world at ``q`` (N, n), by the host in float64."""

    @abstractmethod
    def jacobians(self, q: np.ndarray) -> np.ndarray:
        """Jacobians (N, 6, n), linear then angular rows, at the tool point in world axes; by the host in float64."""

    @abstractmethod
    def boxes(self, lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Corners (N, 3) [m] of boxes around all positions with q in lower … upper (N, n); a proof from a geometry."""

    @cached_property
    @abstractmethod
    def reach(self) -> float:
        """Upper bound of the distance from the `center` to the end effector [m]; infinite where endless."""

    @cached_property
    @abstractmethod
    def center(self) -> np.ndarray:
        """Centre of a sphere of radius `reach` that holds every position, (3,) [m]."""

    @cached_property
    @abstractmethod
    def origin(self) -> np.ndarray:
        """Where positions on a device are counted from, (3,) [m]: the world's origin, or one near a far base."""

    @property
    @abstractmethod
    def foot(self) -> np.ndarray:
        """Where drawings of the arm begin, (3,) [m]."""

    @abstractmethod
    def relative_to(self, origin: np.ndarray) -> Self:
        """The same in a world whose origin stands at ``origin`` (3,) [m]."""

    def placed(self, T_world_base: np.ndarray | None = None, T_tip_tool: np.ndarray | None = None) -> Self:
        """The same with its base placed in the world and a tool added at its tip ((4, 4) each)."""
        changes = {"T_world_base": T_world_base, "T_tip_tool": T_tip_tool}
        return replace(self, **{name: value for name, value in changes.items() if value is not None})
