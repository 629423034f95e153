"""What closed forms say of targets before any search."""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.engine import CLOSED_MARGIN, Accuracy, ClosedPostures, closed_labels, closed_postures
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.starts import towards_limits
from wsrender.robots.chain import Chain
from wsrender.robots.closed_form import ClosedForm, Families, Form, NearlyClosedForm, families

# What may be reached within the tolerances is no proof. How much slack reached poses lose at most where they move a
# little is a number of the arm: SURE times the most that SAMPLES lost, most at limits, which moved and turned by STEP
# [reach, rad], or by the tolerances where they are larger: of arms that are singular everywhere slack falls with the
# square of a move. Forty times as many lost up to 1.8 times as much, of arms with a quartic 2.9 times.
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

    @cached_property
    def margin(self) -> float:
        """Slack that a target lacks at most which is reached within the tolerances."""
        form, near = self.form, self._tolerances
        lost = [_lost(form.chain, form.kind, step, self.threads) for step in {STEP, max(STEP, *near)}]
        return CLOSED_MARGIN + SURE * float(np.max(lost, axis=0) @ near)

    @property
    def _tolerances(self) -> tuple[float, float]:
        """Of positions [reach], and of angles where they count [rad]."""
        accuracy, form = self.accuracy, self.form
        return accuracy.position_m / form.solved.axes.reach, accuracy.angle_rad * (form.kind != "position")

    def labels(self, position: np.ndarray, orientation: np.ndarray | None, *, unlimited: bool = False) -> np.ndarray:
        """What is certain of targets, else UNDECIDED, (N,) int8; ``unlimited``: as if hinges had no limits."""
        found = self._found(position, orientation, unlimited=unlimited)
        there, out = found.slack > found.margin, found.slack < -self.margin
        label = np.select([there, out], [REACHABLE, UNREACHABLE], UNDECIDED).astype(np.int8)
        if not unlimited:
            for at in _parts(np.flatnonzero(label == UNDECIDED)):
                none = self.postures(position[at], None if orientation is None else orientation[at])[2]
                label[at[none.all(axis=1)]] = UNREACHABLE
        return label

    def labels_by_quaternions(self, position: np.ndarray, quat_wxyz: np.ndarray | None) -> np.ndarray:
        """`labels` of positions, or of whole poses with quaternions (N, 4) of any length; families are left open."""
        execution = {"device": self.device, "threads": self.threads}
        return closed_labels(self.form, position, quat_wxyz, margin=self.margin, **execution)

    def unreachable(self, position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
        """Whether targets are proven to be out of reach, (N,) bool."""
        return self.labels(position, orientation) == UNREACHABLE

    def nearest(self, position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
        """The posture (N, n) [rad or m] of each target with the largest slack."""
        q, slack, _, _ = self.postures(position, orientation)
        return q[np.arange(len(q)), np.argmax(slack, axis=1)]

    def postures(
        self, position: np.ndarray, orientation: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """All postures (N, 8, n) [rad or m], their slacks (N, 8), and which are none, and alone, (N, 8) bool.

        Those with a slack below 0 are not within the limits, or the nearest that exist: none are postures of any target
        within the tolerances. Others are alone where all such targets have them, but for ALONE: not where one comes or
        goes, nor those of singular poses, which are families.
        """
        rows = self._found(position, orientation, keep=True).rows
        assert rows is not None
        slack, sure = rows[..., 12], rows[..., 13]
        none = sure < -self.margin
        for at in _parts(np.flatnonzero((np.abs(sure) <= self.margin).any(axis=1))):
            none[at] |= self._families(position[at], None if orientation is None else orientation[at], rows[at]).none
        return self.form.configurations(rows[..., :12]), slack, none, sure * ALONE > self.margin

    def members(self, position: np.ndarray, orientation: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
        """Postures of families within the limits, of targets that are singular or close to that.

        The target of each, ascending, (M,), and configurations (M, n) [rad or m].
        """
        rows = self._found(position, orientation, keep=True).rows
        assert rows is not None
        found = self._families(position, orientation, rows)
        return found.pose, self.form.configurations(found.rows)

    def _families(self, position: np.ndarray, orientation: np.ndarray | None, rows: np.ndarray) -> Families:
        return families(self.form, poses_of(position, orientation), rows, max(self._tolerances))

    def _found(
        self, position: np.ndarray, orientation: np.ndarray | None, *, keep: bool = False, unlimited: bool = False
    ) -> ClosedPostures:
        T, device, threads = poses_of(position, orientation), self.device, self.threads
        return closed_postures(self.form, T, keep=keep, unlimited=unlimited, device=device, threads=threads)


def evidence(form: Form) -> str:
    """What decides, as results say it."""
    name = f"closed form ({form.name})" if isinstance(form, ClosedForm | NearlyClosedForm) else form.name
    return f"{name}, margin {CLOSED_MARGIN:.0e}".replace("e-0", "e-")


def poses_of(position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
    """Poses (N, 4, 4) of targets (N, 3) [m]: any that have the directions (N, 3) of z or the rotations (N, 3, 3)."""
    T = np.tile(np.eye(4), (len(position), 1, 1))
    T[:, :3, 3] = position
    if orientation is not None:
        T[:, :3, :3] = orientation if orientation.ndim == 3 else _with_z(orientation)
    return T


def _parts(at: np.ndarray) -> list[np.ndarray]:
    """Targets by number (P,) in parts, none empty, whose postures may be held together."""
    return np.array_split(at, -(-len(at) // TOGETHER)) if len(at) else []


def rotations_of(quat_wxyz: np.ndarray) -> np.ndarray:
    """Rotation matrices (N, 3, 3) of quaternions (N, 4) of any length but 0."""
    return Rotation.from_quat(quat_wxyz, scalar_first=True).as_matrix()


@lru_cache(maxsize=256)
def _lost(chain: Chain, kind: str, step: float, threads: int | None) -> tuple[float, float]:
    """The most slack that reached poses lose where they move by a step [reach], and turn by it [rad], over the step.

    A number of the chain, at any turn that targets leave open: kept for all its solvers. Its origin is not far away.
    """
    form, random = ClosedForm.of(chain, kind), np.random.default_rng(0)
    assert form
    q = towards_limits(chain, random.uniform(chain.lower_limits, chain.upper_limits, (SAMPLES, chain.n)))
    shift, turn = step * form.solved.axes.reach * _directions(random), step * _directions(random)
    opened = _open_turns(kind, random)
    most = np.full(2, CLOSED_MARGIN)
    for part in (slice(first, first + TOGETHER) for first in range(0, SAMPLES, TOGETHER)):
        moved = chain.poses(q[part])
        moved[:, :3, :3] = moved[:, :3, :3] @ opened[part]
        turned = moved.copy()
        moved[:, :3, 3] += shift[part]
        turned[:, :3, :3] = Rotation.from_rotvec(turn[part]).as_matrix() @ turned[:, :3, :3]
        for k, T in enumerate((moved, turned)):
            found = closed_postures(form, T, device="cpu", threads=threads)
            most[k] = max(most[k], float(-found.slack.min()))
    lost = (most - CLOSED_MARGIN) / step
    return float(lost[0]), float(lost[1])


def _directions(random: np.random.Generator) -> np.ndarray:
    """Unit vectors (SAMPLES, 3)."""
    vectors = random.normal(size=(SAMPLES, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _open_turns(kind: str, random: np.random.Generator) -> np.ndarray:
    """Turns (SAMPLES, 3, 3) of the tip that targets of a kind leave open."""
    if kind == "pose":
        return np.tile(np.eye(3), (SAMPLES, 1, 1))
    if kind == "axis":
        return Rotation.from_rotvec(random.uniform(-np.pi, np.pi, (SAMPLES, 1)) * [0, 0, 1]).as_matrix()
    return Rotation.random(SAMPLES, rng=random).as_matrix()


def _with_z(axes: np.ndarray) -> np.ndarray:
    """Rotations (N, 3, 3) whose z is along the unit vectors (N, 3)."""
    other = np.where(np.abs(axes[:, :1]) < 0.7, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    x = np.cross(other, axes)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    return np.stack([x, np.cross(axes, x), axes], axis=2)
