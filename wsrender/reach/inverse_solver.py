"""Inverse kinematics that decides: a target is reachable, unreachable, or undecided."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.engine import Accuracy, Tries, evaluate_poses, solve_inverse, thread_count, try_bytes
from wsrender.reach.closed_labels import ClosedLabels, rotations_of
from wsrender.reach.evidence import FLATTER, REACHABLE, UNDECIDED, Evidence
from wsrender.reach.free_joint_labels import FreeJointLabels
from wsrender.reach.moving_joints import moving_joints
from wsrender.reach.nearly_closed_labels import NearlyClosedLabels
from wsrender.reach.open_wrist_labels import OpenWristLabels
from wsrender.reach.posture_solver import PoseHolder
from wsrender.reach.starts import FURTHER, NEAR, NEAR_LIMITS, Starts, inwards
from wsrender.robots.closed_form import ClosedForm, Form, FreeJointForm, NearlyClosedForm, OpenWristForm, form_of
from wsrender.robots.kinematics import Kinematics
from wsrender.robots.reachable_box import reachable_box
from wsrender.tolerances import TOLERANCES

BATCH = 1 << 15  # targets that are solved together
MOST_TRIES = 1 << 17  # held in memory at a time, and a launch
TRIES_EACH = {"position": 1.0, "axis": 2.5, "pose": 24.0}  # of a target at a time, as some take many
TARGET_ROW = 16  # bytes of every number of a target or a sample: what was asked and what was found
VERIFIED = 1 << 14  # targets whose postures are held in memory at a time
# Of a target whose postures are held, and of one that a closed form decides.
POSTURES_BYTES, CLOSED_BYTES = 1850.0, 300.0
# Starts between two looks at what they found, by kind of target: a label depends on its target alone.
LATER = ((FURTHER, 8), (FURTHER, 32), (FURTHER, 64), (FURTHER, 128))
GROUPS = {
    "position": ((NEAR, 1), (NEAR, 7), (NEAR_LIMITS, 8), *LATER),
    "axis": ((NEAR, 1), (NEAR, 7), (NEAR_LIMITS, 16), *LATER),
    "pose": ((NEAR, 1), (NEAR, 7), (NEAR_LIMITS, 16), *LATER),
}
SAMPLES = {"position": 1 << 12, "axis": 1 << 13, "pose": 1 << 13}  # of either kind of starts
WITHOUT_LIMITS = 8  # tries of what limits keep the chain from
ALL_JOINTS = 6  # of an arm that reaches whole poses all about one
MEMBERS_TRIED = 4  # of families, of a target
SOLVED_TOGETHER = 1 << 11  # targets that are tried from their families, or from all postures, for memory
STEP_BACK = 1e-3  # share of their ranges by which coordinates leave their limits before a last try
AT_END = 1e-6  # share of a slide's range within which it stands at its end


Labels = ClosedLabels | FreeJointLabels | OpenWristLabels | NearlyClosedLabels


@dataclass(frozen=True, eq=False)
class Solutions:
    """Configurations (N, n) nearest to the targets, what is left to them, and labels (N,) int8.

    ``distance_m``, ``angle_rad`` (N,): residuals. ``proven`` (N,) bool: the target lies outside a sphere and a box
    that hold every position of the chain, or a closed form, or a search along a joint of one, has no configuration that
    reaches it.
    """

    q: np.ndarray
    distance_m: np.ndarray
    angle_rad: np.ndarray
    label: np.ndarray
    proven: np.ndarray


class InverseSolver:
    """Solves for one ``kind`` of targets of one chain: "position", "axis" (with the direction of the tip's z), "pose".

    ``position_m`` and ``angle_rad`` are the largest residuals that count as reached; ``length_m`` makes an angle
    comparable to a distance (None: half the reach). Starts depend on ``seed`` alone.
    """

    def __init__(
        self,
        chain: Kinematics,
        *,
        kind: str = "position",
        position_m: float = 1e-6,
        angle_rad: float = 1e-6,
        length_m: float | None = None,
        seed: int = 0,
        precision: str = "float64",
        device: str = "cpu",
        threads: int | None = None,
    ):
        self.whole, self.kind, self.seed = chain, kind, seed
        self.chain, self._kept = that_matter(chain, kind)
        self.accuracy = Accuracy(position_m, angle_rad, length_m or chain.reach / 2 or 1.0)
        self._workers = thread_count(threads)
        self._execution = {"precision": precision, "device": device, "threads": threads}
        self.closed = self._closed_labels(device, threads)

    def solve(
        self,
        position: np.ndarray,
        orientation: np.ndarray | None = None,
        progress: Callable[[int], None] | None = None,
    ) -> Solutions:
        """Decide targets in the world: positions (N, 3) [m], and ``orientation``.

        That is nothing for positions, unit vectors (N, 3) for the tip's z, rotation matrices (N, 3, 3) for poses.
        ``progress``: called with the targets decided.
        """
        parts = []
        for first in range(0, max(len(position), 1), BATCH):
            batch = slice(first, first + BATCH)
            parts.append(self._solve(position[batch], None if orientation is None else orientation[batch]))
            if progress:
                progress(min(first + BATCH, len(position)))
        return Solutions(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Solutions)))

    def labels(self, position: np.ndarray, quat_wxyz: np.ndarray | None = None) -> np.ndarray:
        """Labels (N,) int8 alone, as `solve` has them, of a solver of positions, or of whole poses by quaternions.

        What a closed form leaves open is searched as there; ``quat_wxyz`` (N, 4): of any length but 0.
        """
        if self.closed:
            label = self.closed.labels_by_quaternions(position, quat_wxyz)
        else:
            label = np.full(len(position), UNDECIDED, np.int8)
        at = np.flatnonzero(label == UNDECIDED)
        for part in (at[first : first + BATCH] for first in range(0, len(at), BATCH)):
            R = None if quat_wxyz is None else rotations_of(quat_wxyz[part])
            label[part] = self._solve(position[part], R).label
        return label

    def _solve(self, position: np.ndarray, orientation: np.ndarray | None) -> Solutions:
        targets = _targets(position, orientation)
        proven = self._out_of_reach(position)
        if self.closed:
            proven |= self.closed.unreachable(position, orientation)
        search = Evidence(self.chain, self.kind, self.accuracy, proven)
        if self.closed:
            self._verify(search, self.closed, targets, position, orientation)
        for source, first, last in _groups(self.kind):
            each = last - first
            for part in parts_of(search.pending, each):
                starts = self._starts.of(source, self._features(targets[part]), first, last)
                tries = self._tries(np.repeat(targets[part], each, axis=0), starts.reshape(-1, self.chain.n))
                search.record(part, tries, self.residual(tries).reshape(-1, each))
        narrow = search.narrow
        tries = self._tries(targets[narrow], inwards(self.chain, search.q[narrow], STEP_BACK), flatness=FLATTER)
        search.settle(narrow, tries, self.residual(tries))
        q = np.tile((self.whole.lower_limits + self.whole.upper_limits) / 2, (len(targets), 1))
        q[:, self._kept] = self._within_a_turn(search.q)
        return Solutions(q, search.distance, search.angle, search.label, search.proven)

    def _verify(
        self,
        search: Evidence,
        closed: Labels,
        targets: np.ndarray,
        position: np.ndarray,
        orientation: np.ndarray | None,
    ) -> None:
        """Try what may be reached from the posture with the largest slack: it is there but for rounding.

        Of singular targets also from members of families. Where there are none, what is reached is close to one of the
        postures: after a try from each, others say no more.
        """
        at = np.flatnonzero(~search.proven)
        for part in parts_of(at, MOST_TRIES // VERIFIED):
            tries = self._tries(targets[part], closed.nearest(position[part], _some(orientation, part)))
            search.record(part, tries, self.residual(tries)[:, None])
        if not isinstance(closed, ClosedLabels):
            return
        pending, n = search.pending, self.chain.n
        known = np.full(len(position), self.kind == "pose" and n >= ALL_JOINTS)
        if known.any():
            for part in parts_of(pending, MOST_TRIES // SOLVED_TOGETHER):
                q, *_ = closed.postures(position[part], _some(orientation, part))
                tries = self._tries(np.repeat(targets[part], q.shape[1], axis=0), q.reshape(-1, n))
                search.record(part, tries, self.residual(tries).reshape(len(part), -1))
        for part in parts_of(search.pending, MOST_TRIES // SOLVED_TOGETHER):
            target, q = closed.members(position[part], _some(orientation, part))
            known[part[target]] = False
            number = np.arange(len(target)) - np.searchsorted(target, target)
            for k in range(min(MEMBERS_TRIED, number.max(initial=-1) + 1)):
                some = number == k
                tries = self._tries(targets[part[target[some]]], q[some])
                search.record(part[target[some]], tries, self.residual(tries)[:, None])
        search.exhaust(search.pending[known[search.pending]])

    def tries(self, starts: np.ndarray, position: np.ndarray, orientation: np.ndarray | None = None) -> Tries:
        """One try from each configuration (N, n) to its target; joints that do not move it keep their values.

        Those that reach a whole pose end as near to it as rounding lets them.
        """
        targets = _targets(position, orientation)
        tries = self._tries(targets, starts[:, self._kept])
        if self.kind == "pose":
            tries = self._polished(tries, targets)
        q = starts.copy()
        q[:, self._kept] = self._within_a_turn(tries.q)
        return replace(tries, q=q)

    def meets(self, tries: Tries) -> np.ndarray:
        """Whether tries end at their targets but for rounding, not beside them within the tolerances, (N,) bool."""
        rounding = TOLERANCES["float64"]
        there = tries.distance <= rounding.position(self.chain.reach)
        return there & (tries.angle <= rounding.kinematics)

    def positions_at(self, q: np.ndarray) -> np.ndarray:
        """Positions (N, 3) [m] of the end point at configurations (N, n)."""
        return evaluate_poses(self.chain, q[:, self._kept], device="cpu", threads=self._workers)[:, :3, 3]

    def features(self, position: np.ndarray, orientation: np.ndarray | None = None) -> np.ndarray:
        """Coordinates (N, f) of targets whose distance is the residual that tries reduce [m]."""
        return self._features(_targets(position, orientation))

    def features_at(self, q: np.ndarray) -> np.ndarray:
        """Those of the poses at configurations (N, n)."""
        return self._features_at(q[:, self._kept])

    def held_by_limits(self, q: np.ndarray, position: np.ndarray, orientation: np.ndarray | None = None) -> np.ndarray:
        """Whether limits alone keep the chain from targets, (N,) bool; ``q`` (N, n): a first start.

        So it is where hinges that turn for ever reach the target, or come nearest with a slide at its end.
        """
        targets, label = _targets(position, orientation), np.full(len(position), UNDECIDED, np.int8)
        if self.closed and self.chain.revolute.all():
            label = self.closed.labels(position, orientation, unlimited=True)
        held = label == REACHABLE
        for part in parts_of(np.flatnonzero(label == UNDECIDED), WITHOUT_LIMITS):
            held[part] = self._held(q[part], targets[part])
        return held

    def _held(self, q: np.ndarray, targets: np.ndarray) -> np.ndarray:
        further = np.tile(self._starts.further(0, WITHOUT_LIMITS - 1), (len(targets), 1, 1))
        starts = np.concatenate([q[:, None, self._kept], further], axis=1).reshape(-1, self.chain.n)
        tries = self._tries(np.repeat(targets, WITHOUT_LIMITS, axis=0), starts, without_limits=True)
        residual = np.where(tries.reached, 0.0, self.residual(tries)).reshape(-1, WITHOUT_LIMITS)
        best = np.arange(len(targets)) * WITHOUT_LIMITS + np.argmin(residual, axis=1)
        chain, nearest = self.chain, tries.q[best]
        margin = AT_END * (chain.upper_limits - chain.lower_limits)
        ended = (nearest <= chain.lower_limits + margin) | (nearest >= chain.upper_limits - margin)
        return tries.reached[best] | np.any(ended & ~chain.revolute, axis=1)

    def residual(self, tries: Tries) -> np.ndarray:
        """What the solver reduces, (N,) [m]."""
        return np.hypot(tries.distance, 2 * self.accuracy.length * np.sin(tries.angle / 2))

    def _tries(
        self, targets: np.ndarray, starts: np.ndarray, *, without_limits: bool = False, flatness: float = 1.0
    ) -> Tries:
        """A try from each start; what single precision takes for reached is taken on in double, for it must be so."""
        accuracy = replace(self.accuracy, flatness=flatness)
        options = {"without_limits": without_limits, **self._execution}
        tries = solve_inverse(self.chain, targets, starts, accuracy, **options)
        if options["precision"] == "float64":
            return tries
        options["precision"], at = "float64", np.flatnonzero(tries.reached)
        return tries.replaced(at, solve_inverse(self.chain, targets[at], tries.q[at], accuracy, **options))

    def _polished(self, tries: Tries, targets: np.ndarray) -> Tries:
        """The same, those that reached whole poses (T, 12) taken on until they stall.

        Near singular poses what is within the tolerances holds postures of any other turn of some joints. Where tries
        enter that first depends on rounding, and what constraints say of them would.
        """
        at = np.flatnonzero(tries.reached)
        accuracy = replace(self.accuracy, position_m=0.0, angle_rad=0.0, flatness=0.0)
        options: dict[str, Any] = self._execution | {"precision": "float64"}
        on = solve_inverse(self.chain, targets[at], tries.q[at], accuracy, **options)
        if len(left := np.flatnonzero(~self.meets(on))):
            on = on.replaced(left, self._held_at(on.q[left], targets[at[left]]))
        near = (on.distance <= self.accuracy.position_m) & (on.angle <= self.accuracy.angle_rad)
        on.reached[:] = True
        return tries.replaced(at[near], on.taken(np.flatnonzero(near)))

    def _held_at(self, q: np.ndarray, targets: np.ndarray) -> Tries:
        """Tries that stalled at ``q`` (T, n) near whole poses (T, 12), taken on with hardly any damping."""
        chain, T = self.chain.relative_to(self.chain.origin), np.tile(np.eye(4), (len(q), 1, 1))
        T[:, :3, 3] = targets[:, :3] - self.chain.origin
        T[:, :3, :3] = targets[:, 3:].reshape(-1, 3, 3).transpose(0, 2, 1)
        best, left = PoseHolder(chain).polished(q, T)
        no = np.zeros(len(q), bool)
        return Tries(best, np.linalg.norm(left[:, :3], axis=1), np.linalg.norm(left[:, 3:], axis=1), no, no)

    def _out_of_reach(self, position: np.ndarray) -> np.ndarray:
        """Whether positions (N, 3) are farther than the tolerance from a sphere or a box that hold the workspace.

        None of a robot that is defined by a Python class: nothing is known to hold that.
        """
        chain, slack = self.chain, self.accuracy.position_m
        if chain.geometry is None:
            return np.zeros(len(position), bool)
        far = np.linalg.norm(position - chain.center, axis=1) > chain.reach + slack
        low, high = reachable_box(chain, chain.lower_limits, chain.upper_limits)
        return far | (position < low - slack).any(axis=1) | (position > high + slack).any(axis=1)

    def _closed_labels(self, device: str, threads: int | None) -> Labels | None:
        form = form_of(self.chain, self.kind)
        if form is None:
            return None
        labels = {
            ClosedForm: ClosedLabels,
            FreeJointForm: FreeJointLabels,
            OpenWristForm: OpenWristLabels,
            NearlyClosedForm: NearlyClosedLabels,
        }
        return labels[type(form)](form, self.accuracy, device, threads)

    @cached_property
    def _starts(self) -> Starts:
        return Starts(self.chain, self._features_at, count=SAMPLES[self.kind], seed=self.seed, workers=self._workers)

    def _features_at(self, q: np.ndarray) -> np.ndarray:
        pose = evaluate_poses(self.chain, q, device="cpu", threads=self._workers)
        orientation = {"position": None, "axis": pose[:, :3, 2], "pose": pose[:, :3, :3]}[self.kind]
        return self._features(_targets(pose[:, :3, 3], orientation))

    def _features(self, targets: np.ndarray) -> np.ndarray:
        """Coordinates whose distance is the residual that the solver reduces."""
        scale = np.full(targets.shape[1], self.accuracy.length / (np.sqrt(2) if self.kind == "pose" else 1.0))
        scale[:3] = 1.0
        return targets * scale

    def _within_a_turn(self, q: np.ndarray) -> np.ndarray:
        """Hinges without limits brought into -pi … pi."""
        turning = self.chain.periodic
        q[:, turning] = np.remainder(q[:, turning] + np.pi, 2 * np.pi) - np.pi
        return q


def closed_form_of(chain: Kinematics, kind: str) -> Form | None:
    """What decides targets of a ``kind`` before any search; None for a chain without a closed form."""
    return form_of(that_matter(chain, kind)[0], kind)


def that_matter(chain: Kinematics, kind: str) -> tuple[Kinematics, np.ndarray]:
    """The chain without last joints that do not change a ``kind`` of target, and which coordinates it keeps (m,)."""
    if kind == "pose" or not chain.geometry:  # where axes are, functions do not say
        return chain, np.arange(chain.n)
    return moving_joints(chain.geometry, axis=kind == "axis")


def solved_bytes(targets: float, kind: str, chain: Kinematics, precision: str = "float64") -> float:
    """Bytes that are held while so many targets of a ``kind`` are decided for an arm, about."""
    row, each = try_bytes(kind, chain.n, precision)
    together = min(targets, BATCH)
    if closed_form_of(chain, kind):
        return POSTURES_BYTES * min(targets, VERIFIED) + CLOSED_BYTES * together
    tries = min(TRIES_EACH[kind] * together, MOST_TRIES)
    return each * tries + TARGET_ROW * (row + 5) * (together + SAMPLES[kind])


def _some(orientation: np.ndarray | None, at: np.ndarray) -> np.ndarray | None:
    return None if orientation is None else orientation[at]


def _groups(kind: str) -> Iterator[tuple[str, int, int]]:
    """Of every group its source, and the first and last number of its starts."""
    taken = {NEAR: 0, NEAR_LIMITS: 0, FURTHER: 0}
    for source, each in GROUPS[kind]:
        first, taken[source] = taken[source], taken[source] + each
        yield source, first, first + each


def parts_of(targets: np.ndarray, tries: int) -> list[np.ndarray]:
    """Targets by number (P,) in parts, none empty, that hold at most MOST_TRIES of so many tries each."""
    return np.array_split(targets, -(-len(targets) * tries // MOST_TRIES)) if len(targets) else []


def _targets(position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
    """Rows of targets as `solve_inverse` takes them: position (3), and the columns of ``orientation``."""
    if orientation is None:
        return position
    columns = orientation if orientation.ndim == 2 else orientation.transpose(0, 2, 1).reshape(-1, 9)
    return np.hstack([position, columns])
