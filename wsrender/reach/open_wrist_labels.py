"""What searches along the last joint of an open arm of six hinges say of targets before any other."""

from dataclasses import dataclass

import numpy as np

from wsrender.engine import Accuracy, open_wrist_postures, search_open_wrist
from wsrender.reach.closed_labels import poses_of, rotations_of
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.robots.closed_form import OpenWristForm

TOGETHER = 1 << 16  # poses that are made at a time


@dataclass(frozen=True)
class OpenWristLabels:
    """Targets of a ``form``, asked as `ClosedLabels` are; proofs hold for all poses within the tolerances."""

    form: OpenWristForm
    accuracy: Accuracy
    device: str
    threads: int | None

    def labels(self, position: np.ndarray, orientation: np.ndarray | None, *, unlimited: bool = False) -> np.ndarray:
        """What is certain of targets, else UNDECIDED, (N,) int8; ``unlimited``: as if hinges had no limits."""
        found = self._search(position, orientation, unlimited=unlimited)
        return np.select([found.reached, found.unreachable], [REACHABLE, UNREACHABLE], UNDECIDED).astype(np.int8)

    def labels_by_quaternions(self, position: np.ndarray, quat_wxyz: np.ndarray | None) -> np.ndarray:
        """`labels` of positions, or of whole poses with quaternions (N, 4) of any length but 0."""
        parts = [np.zeros(0, np.int8)]
        for part in (slice(first, first + TOGETHER) for first in range(0, len(position), TOGETHER)):
            parts.append(self.labels(position[part], None if quat_wxyz is None else rotations_of(quat_wxyz[part])))
        return np.concatenate(parts)

    def labels_from(self, T: np.ndarray, T_tip: np.ndarray) -> np.ndarray:
        """What is certain of the products of motions (P, 4, 4) and poses (K, 4, 4), (P * K,) int8."""
        parts = [np.zeros(0, np.int8)]
        for first in range(0, len(T), each := max(1, TOGETHER // len(T_tip))):
            made = (T[first : first + each, None] @ T_tip).reshape(-1, 4, 4)
            parts.append(self.labels(made[:, :3, 3], made[:, :3, :3]))
        return np.concatenate(parts)

    def unreachable(self, position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
        """Whether targets are proven to be out of reach, (N,) bool."""
        return self.labels(position, orientation) == UNREACHABLE

    def nearest(self, position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
        """The posture (N, n) [rad] of each target with the largest slack that was found, it or others within limits."""
        return self.form.rest.configurations(self._search(position, orientation).rows[:, :12])

    def postures(
        self, position: np.ndarray, orientation: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Postures (N, B, n) [rad], as many as any target has, and their slacks (N, B), of none -4.

        None is known to be no posture, or to be alone, (N, B) bool: that they are all rests on an assumption.
        """
        T = poses_of(position, orientation)
        rows = open_wrist_postures(self.form, T, device=self.device, threads=self.threads).rows
        assert rows is not None
        rows = rows[:, : max(1, int((rows[..., 12] > -4).sum(axis=1).max(initial=0)))]
        no = np.zeros(rows.shape[:2], bool)
        return self.form.rest.configurations(rows[..., :12]), rows[..., 12], no, no

    def _search(self, position: np.ndarray, orientation: np.ndarray | None, *, unlimited: bool = False):
        near = {"position_m": self.accuracy.position_m, "angle_rad": self.accuracy.angle_rad}
        execution = {"device": self.device, "threads": self.threads}
        return search_open_wrist(self.form, poses_of(position, orientation), unlimited=unlimited, **near, **execution)
