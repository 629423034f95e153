"""What searches along a free joint of an arm say of targets before any other."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.engine import Accuracy, FreeJointSearch, closed_postures, search_free_joint
from wsrender.reach.closed_labels import poses_of
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.robots.closed_form import FreeJointForm


@dataclass(frozen=True)
class FreeJointLabels:
    """Targets of a ``form``, asked as `ClosedLabels` are; proofs hold for all poses within the tolerances."""

    form: FreeJointForm
    accuracy: Accuracy
    device: str
    threads: int | None

    def labels(self, position: np.ndarray, orientation: np.ndarray | None, *, unlimited: bool = False) -> np.ndarray:
        """What is certain of targets, else UNDECIDED, (N,) int8; ``unlimited``: as if hinges had no limits."""
        return self._labels(poses_of(position, orientation), unlimited=unlimited)

    def labels_by_quaternions(self, position: np.ndarray, quat_wxyz: np.ndarray | None) -> np.ndarray:
        """`labels` of positions, or of whole poses with quaternions (N, 4) of any length but 0."""
        return self.labels(position, None) if quat_wxyz is None else self._labels(position, quat_wxyz=quat_wxyz)

    def labels_from(self, T: np.ndarray, T_tip: np.ndarray) -> np.ndarray:
        """What is certain of the products of motions (P, 4, 4) and poses (K, 4, 4), (P * K,) int8."""
        return self._labels(T, T_tip=T_tip)

    def unreachable(self, position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
        """Whether targets are proven to be out of reach, (N,) bool."""
        return self.labels(position, orientation) == UNREACHABLE

    def nearest(self, position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
        """The posture (N, n) [rad] of each target with the largest slack that was found."""
        q, slack, _, _ = self.postures(position, orientation)
        return q[np.arange(len(q)), np.argmax(slack, axis=1)]

    def postures(
        self, position: np.ndarray, orientation: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Postures (N, 8, n) [rad] and their slacks (N, 8), all those where the free joint stands as in the best found.

        None is known to be no posture, or to be alone, (N, 8) bool: there are families of them.
        """
        T = poses_of(position, orientation)
        at = self._search(T).at
        assert at is not None
        standing = self.form.standing(T, at)
        found = closed_postures(self.form.rest, standing, keep=True, device=self.device, threads=self.threads)
        assert found.rows is not None
        slack = found.rows[..., 12]
        no = np.zeros(slack.shape, bool)
        return self.form.configurations(found.rows[..., :12], at), slack, no, no

    def _labels(self, T: np.ndarray, **asked: Any) -> np.ndarray:
        found = self._search(T, places=False, **asked)
        return np.select([found.reached, found.unreachable], [REACHABLE, UNREACHABLE], UNDECIDED).astype(np.int8)

    def _search(self, T: np.ndarray, **asked: Any) -> FreeJointSearch:
        tolerances = {"position_m": self.accuracy.position_m, "angle_rad": self.accuracy.angle_rad}
        return search_free_joint(self.form, T, device=self.device, threads=self.threads, **tolerances, **asked)
