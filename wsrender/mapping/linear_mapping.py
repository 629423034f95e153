"""From a slave's workspace into its master's: slave' = S R slave + offset ([WSR] III.D)."""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np


class MeasuredSet(Protocol):
    """A workspace that knows its volume and what lies in it: an alpha shape or a voxel set."""

    @property
    def volume_m3(self) -> float:
        """Volume."""
        ...

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether each point (N, 3) [m] lies in it, (N,) bool."""
        ...


@dataclass(frozen=True, eq=False)
class LinearMapping:
    """Scales along the master's axes (3,), rotation (3, 3), offset (3,) [m]."""

    scale: np.ndarray
    rotation: np.ndarray
    offset: np.ndarray

    def apply(self, points: np.ndarray) -> np.ndarray:
        """Points (N, 3) of the slave in the master's space [m]."""
        return (points @ self.rotation.T) * self.scale + self.offset

    @property
    def volume_factor(self) -> float:
        """Volume of what is mapped, relative to what it was."""
        return float(np.abs(np.prod(self.scale)))

    def scaled(self, factor: float | np.ndarray, about: np.ndarray | None = None) -> "LinearMapping":
        """The same mapping with all scales times a factor, or each times its own (3,).

        The offset stays, or with ``about`` (3,), a point of the slave, the place to which that is mapped.
        """
        scale = self.scale * factor
        moved = 0.0 if about is None else (self.scale - scale) * (self.rotation @ about)
        return replace(self, scale=scale, offset=self.offset + moved)

    def succeeds(self, master: MeasuredSet, points: np.ndarray) -> bool:
        """Whether every slave point (N, 3) lies in the master's space."""
        return bool(master.contains(self.apply(points)).all())
