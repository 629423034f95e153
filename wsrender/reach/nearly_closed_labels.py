"""What the closed form of a chain nearby says of targets before any other."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from wsrender.engine import Accuracy
from wsrender.reach.closed_labels import ClosedLabels
from wsrender.reach.evidence import UNDECIDED, UNREACHABLE
from wsrender.robots.closed_form import NearlyClosedForm

MADE = 1 << 16  # poses that are made at a time


@dataclass(frozen=True)
class NearlyClosedLabels:
    """Targets of a ``form``, asked as `ClosedLabels` are: what its chain is off counts as a tolerance does.

    That a target is not reached is certain; that it is, no posture of a chain nearby says: it is one to start from.
    """

    form: NearlyClosedForm
    accuracy: Accuracy
    device: str
    threads: int | None

    @cached_property
    def nearby(self) -> ClosedLabels:
        """Those of the chain nearby, of which no target is unreachable that this chain reaches."""
        form, near = self.form, self.accuracy
        near = replace(near, position_m=near.position_m + form.off_m, angle_rad=near.angle_rad + form.off_rad)
        return ClosedLabels(form.rest, near, self.device, self.threads)

    def labels(self, position: np.ndarray, orientation: np.ndarray | None, *, unlimited: bool = False) -> np.ndarray:
        """What is certain of targets, else UNDECIDED, (N,) int8; ``unlimited``: as if hinges had no limits."""
        return _certain(self.nearby.labels(position, orientation, unlimited=unlimited))

    def labels_by_quaternions(self, position: np.ndarray, quat_wxyz: np.ndarray | None) -> np.ndarray:
        """`labels` of positions, or of whole poses with quaternions (N, 4) of any length but 0; families left open."""
        return _certain(self.nearby.labels_by_quaternions(position, quat_wxyz))

    def labels_from(self, T: np.ndarray, T_tip: np.ndarray) -> np.ndarray:
        """What is certain of the products of motions (P, 4, 4) and poses (K, 4, 4), (P * K,) int8."""
        parts = [np.zeros(0, np.int8)]
        for first in range(0, len(T), each := max(1, MADE // len(T_tip))):
            made = (T[first : first + each, None] @ T_tip).reshape(-1, 4, 4)
            parts.append(self.labels(made[:, :3, 3], made[:, :3, :3]))
        return np.concatenate(parts)

    def unreachable(self, position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
        """Whether targets are proven to be out of reach, (N,) bool."""
        return self.nearby.unreachable(position, orientation)

    def nearest(self, position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
        """The posture (N, n) [rad] of each target with the largest slack, of the chain nearby."""
        return self.nearby.nearest(position, orientation)

    def postures(
        self, position: np.ndarray, orientation: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Postures of the chain nearby, as `ClosedLabels.postures`: which are none, and alone, of this chain too."""
        return self.nearby.postures(position, orientation)


def _certain(found: np.ndarray) -> np.ndarray:
    """Labels (N,) int8 without those that hold for the chain nearby alone."""
    return np.where(found == UNREACHABLE, UNREACHABLE, UNDECIDED).astype(np.int8)
