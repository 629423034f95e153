"""What closed forms say of targets before any search."""

from dataclasses import dataclass

import numpy as np

from wsrender.engine import CLOSED_MARGIN, Accuracy, ClosedPostures, closed_postures
from wsrender.robots.closed_form import ClosedForm, FreeJointForm
from wsrender.robots.kinematics import Kinematics

TOLERANCES = 10  # a target within so many tolerances of one whose label is another's is left to a search


@dataclass(frozen=True)
class ClosedLabels:
    """Targets of a closed ``form``, decided up to ``margin``: rounding, and what counts as reached."""

    form: ClosedForm
    margin: float
    device: str
    threads: int | None

    @classmethod
    def of(
        cls, chain: Kinematics, kind: str, accuracy: Accuracy, device: str, threads: int | None
    ) -> "ClosedLabels | None":
        """None for a chain without a closed form."""
        form = ClosedForm.of(chain, kind)
        if form is None:
            return None
        tolerance = accuracy.position_m / form.solved.axes.reach
        if kind != "position":
            tolerance = max(tolerance, accuracy.angle_rad)
        return cls(form, TOLERANCES * tolerance, device, threads)

    def unreachable(
        self, position: np.ndarray, orientation: np.ndarray | None, *, unlimited: bool = False
    ) -> np.ndarray:
        """Whether targets are proven to be out of reach, (N,) bool; ``unlimited``: even if no limit held hinges."""
        found = self._found(position, orientation, unlimited=unlimited)
        return found.slack < -(found.margin + self.margin)

    def postures(
        self, position: np.ndarray, orientation: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """All postures (N, 8, n) [rad or m], their slacks (N, 8), and whether they are all there are, (N,) bool.

        Those with a slack below 0 are not within the limits, or the nearest that exist. That there is no other is
        not known of singular poses, whose postures are families, nor near where one comes or goes.
        """
        found = self._found(position, orientation, keep=True)
        assert found.rows is not None
        slack = found.rows[..., 12]
        clear = (np.abs(slack) > found.margin + self.margin).all(axis=1)
        whole = clear & (found.flags == 0) & (found.slack > found.margin)
        return self.form.configurations(found.rows[..., :12]), slack, whole

    def _found(
        self, position: np.ndarray, orientation: np.ndarray | None, *, keep: bool = False, unlimited: bool = False
    ) -> ClosedPostures:
        T, device, threads = poses_of(position, orientation), self.device, self.threads
        return closed_postures(self.form, T, keep=keep, unlimited=unlimited, device=device, threads=threads)


def evidence(form: ClosedForm | FreeJointForm) -> str:
    """What decides, as results say it."""
    name = f"closed form ({form.name})" if isinstance(form, ClosedForm) else form.name
    return f"{name}, margin {CLOSED_MARGIN:.0e}".replace("e-0", "e-")


def poses_of(position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
    """Poses (N, 4, 4) of targets (N, 3) [m]: any that have the directions (N, 3) of z or the rotations (N, 3, 3)."""
    T = np.tile(np.eye(4), (len(position), 1, 1))
    T[:, :3, 3] = position
    if orientation is not None:
        T[:, :3, :3] = orientation if orientation.ndim == 3 else _with_z(orientation)
    return T


def _with_z(axes: np.ndarray) -> np.ndarray:
    """Rotations (N, 3, 3) whose z is along the unit vectors (N, 3)."""
    other = np.where(np.abs(axes[:, :1]) < 0.7, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    x = np.cross(other, axes)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    return np.stack([x, np.cross(axes, x), axes], axis=2)
