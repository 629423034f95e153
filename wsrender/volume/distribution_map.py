"""Distribution map: one row per sample ([WSR] II.C.2)."""

from dataclasses import dataclass, field, replace

import numpy as np

from wsrender.notebook import mime_bundle
from wsrender.short_repr import short_names


@dataclass(frozen=True, eq=False)
class DistributionMap:
    """End-effector positions and local indices, one row per sample.

    Positions [m] are in the world frame, shape (N, 3); ``configuration`` [rad or m] has shape (N, n) and
    ``quat_wxyz`` (N, 4), both None unless kept; each index is an array of shape (N,).
    """

    position: np.ndarray
    indices: dict[str, np.ndarray]
    units: dict[str, str] = field(default_factory=dict)
    configuration: np.ndarray | None = None
    joint_names: tuple[str, ...] = ()
    quat_wxyz: np.ndarray | None = None

    def __len__(self) -> int:
        return len(self.position)

    def __repr__(self) -> str:
        return f"<DistributionMap: {len(self):,} samples of {short_names(self.indices, self.units) or 'positions'}>"

    _repr_mimebundle_ = mime_bundle

    def only(self, rows: np.ndarray) -> "DistributionMap":
        """The map of some rows (N,) bool."""
        return replace(
            self,
            position=self.position[rows],
            indices={name: values[rows] for name, values in self.indices.items()},
            configuration=None if self.configuration is None else self.configuration[rows],
            quat_wxyz=None if self.quat_wxyz is None else self.quat_wxyz[rows],
        )
