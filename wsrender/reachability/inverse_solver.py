"""Inverse kinematics that decides: a target is reachable, unreachable, or undecided."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from scipy.spatial import KDTree

from wsrender.engine import Accuracy, Tries, configurations, evaluate_poses, solve_inverse, thread_count
from wsrender.reachability.moving_joints import moving_joints
from wsrender.robots.chain import Chain
from wsrender.robots.host_chain import HostChain
from wsrender.robots.reachable_box import reachable_box
from wsrender.sampling import plan_sampling
from wsrender.spec.sampling import Sobol

REACHABLE, UNREACHABLE, UNDECIDED = 1, 0, -1
LABELS = {REACHABLE: "reachable", UNREACHABLE: "unreachable", UNDECIDED: "undecided"}

NEAREST = 8  # first starts: the nearest of a set of samples
EPS = 1.0  # they may be farther by this share: exact neighbours of far targets cost more than the tries
FRESH = 248  # then the same further samples for every target, so that a label depends on its target alone
BATCH = 1 << 15  # targets that are solved together: their starts are held in memory
GROUPS = (1, 7, 8, 16, 32, 64, 128)  # starts between two looks at what they found
SAMPLES = {"position": 1 << 12, "axis": 1 << 13, "pose": 1 << 13}  # of the set
# Evidence that a target is unreachable: so many tries came to rest where no motion within the limits leads nearer,
# clearly off the target, and so many of them at the least residual of all, within 1 %.
LEAST_ENDS = {"position": 12, "axis": 32, "pose": 32}
LEAST_AGREEING, AGREEING, CLEARLY = 3, 1.01, 2.0
# Nor is it clear so near, relative to the reach: beside a stretched arm a try comes to rest where the slope is below
# the solver's FLAT, 3e-4, and the edge of a fold of curvature 1 / reach is up to reach · FLAT² / 2 away there.
FOLD = 1e-7
AT_END = 1e-6  # share of a slide's range within which it stands at its end


@dataclass(frozen=True, eq=False)
class Solutions:
    """Configurations (N, n) nearest to the targets, what is left to them, and labels (N,) int8.

    ``distance_m``, ``angle_rad`` (N,): residuals. ``proven`` (N,) bool: the target lies outside a sphere and a box
    that hold every position of the chain.
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
        chain: Chain,
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
        whole = chain, np.arange(chain.n)
        self.chain, self._kept = whole if kind == "pose" else moving_joints(chain, axis=kind == "axis")
        self.accuracy = Accuracy(position_m, angle_rad, length_m or chain.reach / 2 or 1.0)
        self._workers = thread_count(threads)
        self._execution = {"precision": precision, "device": device, "threads": threads}

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

    def _solve(self, position: np.ndarray, orientation: np.ndarray | None) -> Solutions:
        targets = _targets(position, orientation)
        search = _Search(len(targets), self.chain, self.kind, self.accuracy, self._out_of_reach(position))
        for starts in self._starts(targets, search):
            pending = search.pending
            each = starts.shape[1]
            tries = self._tries(np.repeat(targets[pending], each, axis=0), starts.reshape(-1, self.chain.n))
            search.record(pending, tries, self._residual(tries).reshape(-1, each))
        q = np.tile((self.whole.lower_limits + self.whole.upper_limits) / 2, (len(targets), 1))
        q[:, self._kept] = self._within_a_turn(search.q)
        return Solutions(q, search.distance, search.angle, search.label, search.proven)

    def held_by_limits(self, q: np.ndarray, position: np.ndarray, orientation: np.ndarray | None = None) -> np.ndarray:
        """Whether limits alone keep the chain from targets, (N,) bool; ``q`` (N, n): a first start.

        So it is where hinges that turn for ever reach the target, or come nearest with a slide at its end.
        """
        targets = _targets(position, orientation)
        fresh = np.tile(self._fresh(0, NEAREST - 1), (len(targets), 1, 1))
        starts = np.concatenate([q[:, None, self._kept], fresh], axis=1).reshape(-1, self.chain.n)
        tries = self._tries(np.repeat(targets, NEAREST, axis=0), starts, without_limits=True)
        residual = np.where(tries.reached, 0.0, self._residual(tries)).reshape(-1, NEAREST)
        best = np.arange(len(targets)) * NEAREST + np.argmin(residual, axis=1)
        chain, nearest = self.chain, tries.q[best]
        margin = AT_END * (chain.upper_limits - chain.lower_limits)
        ended = (nearest <= chain.lower_limits + margin) | (nearest >= chain.upper_limits - margin)
        return tries.reached[best] | np.any(ended & ~chain.revolute, axis=1)

    def _residual(self, tries: Tries) -> np.ndarray:
        """What the solver reduces, (N,) [m]."""
        return np.hypot(tries.distance, 2 * self.accuracy.length * np.sin(tries.angle / 2))

    def _tries(self, targets: np.ndarray, starts: np.ndarray, without_limits: bool = False) -> Tries:
        return solve_inverse(
            self.chain, targets, starts, self.accuracy, without_limits=without_limits, **self._execution
        )

    def _starts(self, targets: np.ndarray, search: "_Search") -> Iterator[np.ndarray]:
        """Starts (P, g, m) of the targets that are pending when each group's turn comes."""
        first = 0
        for each in GROUPS:
            if not len(search.pending):
                return
            last = first + each
            if last <= NEAREST:
                features = self._features(targets[search.pending])
                # k as a list gives a column per neighbour.
                neighbours = list(range(first + 1, last + 1))
                _, near = self._tree.query(features, k=neighbours, eps=EPS, workers=self._workers)  # type: ignore[arg-type]
                yield self._samples[near]
            else:
                yield np.tile(self._fresh(first - NEAREST, last - NEAREST), (len(search.pending), 1, 1))
            first = last

    def _fresh(self, first: int, last: int) -> np.ndarray:
        return self._samples[SAMPLES[self.kind] :][first:last]

    def _out_of_reach(self, position: np.ndarray) -> np.ndarray:
        """Whether positions (N, 3) are farther than the tolerance from a sphere or a box that hold the workspace.

        None of a robot that is defined by a Python class: nothing is known to hold that.
        """
        chain, slack = self.chain, self.accuracy.position_m
        if isinstance(chain, HostChain):
            return np.zeros(len(position), bool)
        far = np.linalg.norm(position - chain.center, axis=1) > chain.reach + slack
        low, high = reachable_box(chain, chain.lower_limits, chain.upper_limits)
        return far | (position < low - slack).any(axis=1) | (position > high + slack).any(axis=1)

    @cached_property
    def _samples(self) -> np.ndarray:
        """Configurations to start from (S, m): those of the tree, then the fresh ones."""
        count = SAMPLES[self.kind] + FRESH
        return configurations(plan_sampling(self.chain, Sobol(count, seed=self.seed)), np.arange(count))

    @cached_property
    def _tree(self) -> KDTree:
        pose = evaluate_poses(self.chain, self._samples[: SAMPLES[self.kind]], device="cpu")
        orientation = {"position": None, "axis": pose[:, :3, 2], "pose": pose[:, :3, :3]}[self.kind]
        return KDTree(self._features(_targets(pose[:, :3, 3], orientation)))

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


def _targets(position: np.ndarray, orientation: np.ndarray | None) -> np.ndarray:
    """Rows of targets as `solve_inverse` takes them: position (3), and the columns of ``orientation``."""
    if orientation is None:
        return position
    columns = orientation if orientation.ndim == 2 else orientation.transpose(0, 2, 1).reshape(-1, 9)
    return np.hstack([position, columns])


class _Search:
    """The best of all tries of every target, and the evidence that nothing better exists."""

    def __init__(self, count: int, chain: Chain, kind: str, accuracy: Accuracy, proven: np.ndarray):
        self.accuracy, self.proven = accuracy, proven
        self.q = np.zeros((count, chain.n))
        self.distance, self.angle = np.full(count, np.inf), np.full(count, np.inf)
        self.label = np.full(count, UNDECIDED, np.int8)
        self.pending = np.arange(count)
        self._residual = np.full(count, np.inf)  # of the best try
        self._nearest_end = np.full(count, np.inf)  # least residual at which a try came to rest
        self._least_ends = LEAST_ENDS[kind]
        tolerance = np.hypot(accuracy.position_m, accuracy.length * accuracy.angle_rad * (kind != "position"))
        self._clearly_off = max(CLEARLY * tolerance, FOLD * chain.reach)
        self._ends, self._agreeing = np.zeros(count, np.int32), np.zeros(count, np.int32)

    def record(self, pending: np.ndarray, tries: Tries, residual: np.ndarray) -> None:
        """Take in the tries of every pending target, residuals (P, tries each), and settle what is decided."""
        each = residual.shape[1]
        reached, ended = tries.reached.reshape(residual.shape), tries.stationary.reshape(residual.shape)
        best = np.argmin(np.where(reached, -1.0, residual), axis=1)
        chosen = np.arange(len(pending)) * each + best
        found = reached.any(axis=1)
        better = found | (residual.ravel()[chosen] < self._residual[pending])
        at, chosen = pending[better], chosen[better]
        self._residual[at] = residual.ravel()[chosen]
        self.q[at], self.distance[at], self.angle[at] = tries.q[chosen], tries.distance[chosen], tries.angle[chosen]
        self._count_ends(pending, np.where(ended, residual, np.inf))
        self.label[pending] = np.where(found, REACHABLE, np.where(self._unreachable(pending), UNREACHABLE, UNDECIDED))
        self.pending = pending[self.label[pending] == UNDECIDED]

    def _count_ends(self, pending: np.ndarray, ends: np.ndarray) -> None:
        """Count tries that came to rest (residuals ``ends`` (P, g), infinite for others), and those at the best."""
        before = self._nearest_end[pending]
        nearest = np.minimum(before, ends.min(axis=1))
        limit = AGREEING * nearest + self.accuracy.position_m
        still = np.where(before <= limit, self._agreeing[pending], 0)
        self._agreeing[pending] = still + (ends <= limit[:, None]).sum(axis=1) * np.isfinite(nearest)
        self._ends[pending] += np.isfinite(ends).sum(axis=1)
        self._nearest_end[pending] = nearest

    def _unreachable(self, pending: np.ndarray) -> np.ndarray:
        nearest = self._nearest_end[pending]
        consistent = (self._ends[pending] >= self._least_ends) & (self._agreeing[pending] >= LEAST_AGREEING)
        clear = np.isfinite(nearest) & (self._residual[pending] * AGREEING >= nearest)
        off = self._residual[pending] > self._clearly_off
        return self.proven[pending] | (consistent & clear & off)
