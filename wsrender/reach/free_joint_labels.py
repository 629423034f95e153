"""What searches along a free joint of an arm say of targets before any other."""

from dataclasses import dataclass

import numpy as np

from wsrender.engine import Accuracy, closed_postures, search_free_joint
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
        found = self._search(poses_of(position, orientation), unlimited=unlimited)
        return np.select([found.reached, found.unreachable], [REACHABLE, UNREACHABLE], UNDECIDED).astype(np.int8)

    def unreachable(self, position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
        """Whether targets are proven to be out of reach, (N,) bool."""
        return self.labels(position, orientation) == UNREACHABLE

    def postures(
        self, position: np.ndarray, orientation: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Postures (N, 8, n) [rad] and their slacks (N, 8), all those where the free joint stands as in the best found.

        None is known to be no posture, or to be alone, (N, 8) bool: there are families of them.
        """
        T = poses_of(position, orientation)
        at = self._search(T).at
        standing = self.form.standing(T, at)
        found = closed_postures(self.form.rest, standing, keep=True, device=self.device, threads=self.threads)
        assert found.rows is not None
        slack = found.rows[..., 12]
        no = np.zeros(slack.shape, bool)
        return self.form.configurations(found.rows[..., :12], at), slack, no, no

    def _search(self, T: np.ndarray, *, unlimited: bool = False):
        near = {"position_m": self.accuracy.position_m, "angle_rad": self.accuracy.angle_rad}
        return search_free_joint(self.form, T, unlimited=unlimited, device=self.device, threads=self.threads, **near)
