"""The joint space of an arm: names, limits and what follows from them, whatever its geometry."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np

from wsrender.content import Content
from wsrender.errors import InputError
from wsrender.short_repr import short_repr


def unlimited(n: int) -> np.ndarray:
    """`JointSpace.efforts` (2, n) that nothing limits."""
    return np.tile([[-np.inf], [np.inf]], n)


@dataclass(frozen=True, eq=False)
class JointSpace(Content):
    """The n coordinates of an arm, in order from base to end effector: what sampling, documents and results need."""

    name: str
    base_frame: str
    tip_frame: str
    joint_names: tuple[str, ...]  # of the n coordinates
    lower_limits: np.ndarray  # (n,) [rad or m]; -pi where periodic, -inf where endless
    upper_limits: np.ndarray  # (n,) [rad or m]; +pi where periodic, inf where endless
    periodic: np.ndarray  # (n,) bool: a hinge without limits
    efforts: np.ndarray  # (2, n) [N m or N]: least, negative, and largest; infinite where nothing limits them
    velocity_limits: np.ndarray  # (n,) [rad/s or m/s]; infinite where nothing limits them

    __repr__ = short_repr

    def __post_init__(self):
        for f in fields(self):
            value = getattr(self, f.name)
            if isinstance(value, np.ndarray):
                value = np.array(value, order="C")
                value.setflags(write=False)
                object.__setattr__(self, f.name, value)

    @property
    def effort_limits(self) -> np.ndarray | None:
        """Largest efforts in both directions [N m or N], (n,); None where some coordinate has no limit."""
        return None if self.unlimited_efforts else np.abs(self.efforts).min(axis=0)

    @property
    def unlimited_efforts(self) -> tuple[str, ...]:
        """Names of the coordinates whose efforts nothing limits."""
        return self._named(~np.isfinite(self.efforts).all(axis=0))

    @property
    def unlimited_velocities(self) -> tuple[str, ...]:
        """Names of the coordinates whose speeds nothing limits."""
        return self._named(~np.isfinite(self.velocity_limits))

    @property
    def n(self) -> int:
        """Number of coordinates: the length of a configuration."""
        return len(self.joint_names)

    def held(self, values: Mapping[str, float]) -> Self:
        """The same with joints, by name, held at a value [rad or m]."""
        held = np.array([name in values for name in self.joint_names])
        value = np.array([values.get(name, 0.0) for name in self.joint_names])
        return replace(
            self,
            lower_limits=np.where(held, value, self.lower_limits),
            upper_limits=np.where(held, value, self.upper_limits),
            periodic=self.periodic & ~held,
        )

    def limited(self, limits: Mapping[str, tuple[float, float]]) -> Self:
        """The same with limits of joints, by name, (lower, upper) [rad or m], in place of its own.

        As the field ``limits`` of a robot gives them. Raises InputError for an unknown joint and an empty range.
        """
        lower, upper, periodic = self.lower_limits.copy(), self.upper_limits.copy(), self.periodic.copy()
        for name, (low, high) in limits.items():
            if name not in self.joint_names:
                raise InputError(f"limits.{name}", f"unknown joint; allowed: {', '.join(self.joint_names)}")
            if not low < high:
                raise InputError(f"limits.{name}", f"must have the lower limit below the upper one, not {low}, {high}")
            k = self.joint_names.index(name)
            lower[k], upper[k], periodic[k] = low, high, False
        return replace(self, lower_limits=lower, upper_limits=upper, periodic=periodic)

    @property
    def endless(self) -> tuple[str, ...]:
        """Names of the coordinates without usable limits: slides without any, hinges that whole turns do not suit."""
        return self._named(~(np.isfinite(self.lower_limits) & np.isfinite(self.upper_limits)))

    def _named(self, which: Any) -> tuple[str, ...]:
        return tuple(name for name, this in zip(self.joint_names, which, strict=True) if this)

    def within(self, share: float) -> np.ndarray:
        """The configuration (n,) at a share 0 … 1 of every range [rad or m]; 0 where a coordinate is endless."""
        ends = np.stack([self.lower_limits, self.upper_limits])
        lower, upper = np.where(np.isfinite(ends).all(axis=0), ends, 0.0)
        return lower + share * (upper - lower)
