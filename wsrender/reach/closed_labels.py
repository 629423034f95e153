"""What closed forms say of targets before any search."""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.engine import CLOSED_MARGIN, Accuracy, ClosedPostures, closed_postures
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.starts import towards_limits
from wsrender.robots.chain import Chain
from wsrender.robots.closed_form import ClosedForm, FreeJointForm
from wsrender.robots.kinematics import Kinematics

# What may be reached within the tolerances is no proof. How much slack reached poses lose at most where they move a
# little is a number of the arm: SURE times the most that SAMPLES lost, most at limits, which moved and turned by STEP
# [reach, rad]. Forty times as many lost up to 1.8 times as much, of arms with a quartic 2.9 times.
SAMPLES, STEP, SURE = 1 << 14, 1e-5, 4.0
TOGETHER = 1 << 11  # of them, for memory
ALONE = 0.1  # rad: bound of what joints of a posture move where the pose does within the tolerances; mostly a tenth


@dataclass(frozen=True)
class ClosedLabels:
    """Targets of a closed ``form``, decided up to a `margin`: rounding, and what counts as reached."""

    form: ClosedForm
    accuracy: Accuracy
    device: str
    threads: int | None

    @classmethod
    def of(
        cls, chain: Kinematics, kind: str, accuracy: Accuracy, device: str, threads: int | None
    ) -> "ClosedLabels | None":
        """None for a chain without a closed form."""
        form = ClosedForm.of(chain, kind)
        return None if form is None else cls(form, accuracy, device, threads)

    @cached_property
    def margin(self) -> float:
        """Slack that a target lacks at most which is reached within the tolerances."""
        form, accuracy = self.form, self.accuracy
        moved, turned = _lost(form.chain, form.kind, self.threads)
        margin = CLOSED_MARGIN + SURE * moved * accuracy.position_m / form.solved.axes.reach
        return margin + (SURE * turned * accuracy.angle_rad if form.kind != "position" else 0.0)

    def labels(self, position: np.ndarray, orientation: np.ndarray | None, *, unlimited: bool = False) -> np.ndarray:
        """What is certain of targets, else UNDECIDED, (N,) int8; ``unlimited``: as if hinges had no limits."""
        found = self._found(position, orientation, unlimited=unlimited)
        there, out = found.slack > found.margin, found.slack < -self.margin
        return np.select([there, out], [REACHABLE, UNREACHABLE], UNDECIDED).astype(np.int8)

    def unreachable(self, position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
        """Whether targets are proven to be out of reach, (N,) bool."""
        return self.labels(position, orientation) == UNREACHABLE

    def postures(
        self, position: np.ndarray, orientation: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """All postures (N, 8, n) [rad or m], their slacks (N, 8), and which are none, and alone, (N, 8) bool.

        Those with a slack below 0 are not within the limits, or the nearest that exist: none are postures of any target
        within the tolerances. Others are alone where all such targets have them, but for ALONE: not where one comes or
        goes, nor those of singular poses, which are families.
        """
        found = self._found(position, orientation, keep=True)
        assert found.rows is not None
        slack, sure = found.rows[..., 12], found.rows[..., 13]
        return self.form.configurations(found.rows[..., :12]), slack, sure < -self.margin, sure * ALONE > self.margin

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


@lru_cache(maxsize=256)
def _lost(chain: Chain, kind: str, threads: int | None) -> tuple[float, float]:
    """The most slack that reached poses lose where they move by STEP, and where they turn by it, over STEP.

    A number of the chain: kept for all solvers of it, whatever their tolerances. Its origin is not far away.
    """
    form, random = ClosedForm.of(chain, kind), np.random.default_rng(0)
    assert form
    q = towards_limits(chain, random.uniform(chain.lower_limits, chain.upper_limits, (SAMPLES, chain.n)))
    shift, turn = STEP * form.solved.axes.reach * _directions(random), STEP * _directions(random)
    most = np.full(2, CLOSED_MARGIN)
    for part in (slice(first, first + TOGETHER) for first in range(0, SAMPLES, TOGETHER)):
        moved = chain.poses(q[part])
        turned = moved.copy()
        moved[:, :3, 3] += shift[part]
        turned[:, :3, :3] = Rotation.from_rotvec(turn[part]).as_matrix() @ turned[:, :3, :3]
        for k, T in enumerate((moved, turned)):
            found = closed_postures(form, T, device="cpu", threads=threads)
            most[k] = max(most[k], float(-found.slack.min()))
    lost = (most - CLOSED_MARGIN) / STEP
    return float(lost[0]), float(lost[1])


def _directions(random: np.random.Generator) -> np.ndarray:
    """Unit vectors (SAMPLES, 3)."""
    vectors = random.normal(size=(SAMPLES, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _with_z(axes: np.ndarray) -> np.ndarray:
    """Rotations (N, 3, 3) whose z is along the unit vectors (N, 3)."""
    other = np.where(np.abs(axes[:, :1]) < 0.7, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    x = np.cross(other, axes)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    return np.stack([x, np.cross(axes, x), axes], axis=2)
