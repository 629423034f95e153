"""Targets under constraints: inverse kinematics looks for a solution that they admit.

A target is free where a solution is admitted. It is blocked where many solutions were found, from starts of all kinds,
and every one was rejected: evidence of a search, no proof; where an admitted sample lies near, the search is longer.
Where a closed form knows all configurations of a pose, and each was rejected, it is a proof.
Else it is unreachable or undecided as without constraints, or undecided because too few solutions were found.

Near what is free it walks too: an admitted sample is moved towards the target, part of the way and all of it, from
configurations that differ a little from it, and the admitted one that is nearest goes on from there.

Redundant arms come from every start to another point of their self-motions, and joints that do not move the target
stand where they stood in the start.
"""

from collections.abc import Callable, Iterable
from copy import copy
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Self

import numpy as np
from scipy.spatial import KDTree

from wsrender.documents.sampling import Sobol
from wsrender.engine import Tries, configurations
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.admission import Admission
from wsrender.reach.evidence import REACHABLE, UNDECIDED
from wsrender.reach.inverse_solver import BATCH, MOST_TRIES, VERIFIED, InverseSolver, Labels, parts_of
from wsrender.reach.starts import EPS, inwards, towards_limits
from wsrender.robots.kinematics import Kinematics

BLOCKED = 2  # beside the labels of evidence
SAMPLES, NEIGHBOURS = 1 << 20, 1 << 18  # drawn; admitted ones that starts are chosen from
NEAR, FURTHER = "near", "further"
# Starts between two looks, by number: the admitted samples nearest to the target, and of all kinds the same for every
# target.
FIRST = ((NEAR, 0, 1), (NEAR, 1, 8))
FURTHER_SAMPLES = 128
LATER = ((NEAR, 8, 32), (FURTHER, 0, 32), (FURTHER, 32, FURTHER_SAMPLES))
# Rejected solutions that say that a target is blocked: at once where no admitted sample is nearer than a share of the
# reach, else after all starts.
CLEARLY_BLOCKED, NARROWLY, BLOCKED_AFTER_ALL = 24, 0.1, 8

# Constraints that see where links are, not how often a joint has turned.
TURN_FREE = {"region", "leg_distance", "orientation", "environment", "self_collision", "torque"}

# Walks: of so many samples, in so many steps, of which each tries these shares of the way, each after changes of all
# coordinates by these deviations [rad, or reaches for slides].
WALKS, STEPS, SHARES, DEVIATIONS = 8, 16, (1.0, 0.4, 0.1), (0.01, 0.03, 0.1, 0.3)
LONGER = 3  # times as many walks tell how many free targets others miss


@dataclass(frozen=True, eq=False)
class Admissible:
    """What the search found of N targets.

    ``q`` (N, n): admitted, else rejected, else nearest; ``distance_m``, ``angle_rad`` (N,): what is left there to the
    target; ``label`` (N,) int8, BLOCKED among them; ``rejected`` (N, C): solutions that each of the constraints was the
    first to reject; ``near_m`` (N,): how near an admitted sample is, by the residual that tries reduce; ``proven`` (N,)
    bool: the target is known to be out of reach, or to be blocked; ``met`` (N,) bool: a try ended at the pose itself.
    """

    q: np.ndarray
    distance_m: np.ndarray
    angle_rad: np.ndarray
    label: np.ndarray
    rejected: np.ndarray
    near_m: np.ndarray
    proven: np.ndarray
    met: np.ndarray

    @property
    def reason(self) -> np.ndarray:
        """Of blocked targets the constraint, from 1, that rejected most solutions, else 0, (N,) int64."""
        if not self.rejected.shape[1]:
            return np.zeros(len(self.label), np.int64)
        return np.where(self.label == BLOCKED, 1 + self.rejected.argmax(axis=1), 0)

    @property
    def pending(self) -> np.ndarray:
        """Undecided targets, (P,)."""
        return np.flatnonzero(self.label == UNDECIDED)

    def take(self, at: np.ndarray, tries: Tries, reasons: np.ndarray) -> None:
        """Record as many tries of each of the targets ``at`` (P,), and what rejects them (T,), 0 what nothing does."""
        solved = tries.reached.reshape(len(at), -1)
        reasons = reasons.reshape(solved.shape)
        admitted = solved & (reasons == 0)
        best = np.argmax(2 * admitted + solved, axis=1)
        free = admitted.any(axis=1)
        better = free | (solved.any(axis=1) & ~self.rejected[at].any(axis=1))
        chosen = (np.arange(len(at)) * solved.shape[1] + best)[better]
        self.q[at[better]] = tries.q[chosen]
        self.distance_m[at[better]], self.angle_rad[at[better]] = tries.distance[chosen], tries.angle[chosen]
        self.label[at[free]] = REACHABLE
        for k in range(self.rejected.shape[1]):
            self.rejected[at, k] += (solved & (reasons == k + 1)).sum(axis=1)


class AdmissibleSearch:
    """Decides targets of a ``solver``, whose chain is that of the ``admission``, wherever it stands."""

    def __init__(self, solver: InverseSolver, admission: Admission):
        self.solver, self.admission = solver, admission

    def decide(
        self,
        position: np.ndarray,
        orientation: np.ndarray | None = None,
        progress: Callable[[int], None] | None = None,
    ) -> Admissible:
        """Targets in the solver's world, and ``progress``, as `InverseSolver.solve` takes them."""
        parts = []
        for first in range(0, max(len(position), 1), BATCH):
            batch = slice(first, first + BATCH)
            parts.append(self._among(batch)._decide(position[batch], _some(orientation, batch)))
            if progress:
                progress(min(first + BATCH, len(position)))
        return Admissible(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Admissible)))

    def prepare(self) -> None:
        """Draw the samples that all targets start from, which copies share."""
        _ = self._tree

    def _among(self, batch: slice) -> Self:
        """The search of a batch of the targets."""
        self.prepare()
        search = copy(self)
        search.admission = self.admission.among(batch)
        return search

    def _decide(self, position: np.ndarray, orientation: np.ndarray | None) -> Admissible:
        found = self._nothing(self.solver.features(position, orientation))
        if (closed := self.solver.closed) and self.solver.kind == "pose":
            out = closed.unreachable(position, orientation)
            self._solved(found, np.flatnonzero(out), position, orientation)
            for part in parts_of(found.pending, MOST_TRIES // VERIFIED):
                self._all_postures(found, closed, part, position, orientation)
        for source, first, last in FIRST:
            self._search(found, found.pending, source, first, last, position, orientation)
        self._solved(found, found.pending, position, orientation)
        clearly = found.near_m > NARROWLY * self.solver.chain.reach
        for source, first, last in LATER:
            self._search(found, found.pending, source, first, last, position, orientation)
            found.label[self._rejected(found, CLEARLY_BLOCKED) & clearly] = BLOCKED
        if orientation is None:
            at = found.pending[found.rejected[found.pending].any(axis=1)]
            for part in parts_of(at, WALKS * len(SHARES) * len(DEVIATIONS)):
                self._walk(found, part, position, WALKS, self.solver.seed)
        found.label[self._rejected(found, BLOCKED_AFTER_ALL)] = BLOCKED
        return found

    def _solved(
        self, found: Admissible, rest: np.ndarray, position: np.ndarray, orientation: np.ndarray | None
    ) -> None:
        """Take what the solver says of targets ``rest`` (P,)."""
        solved = self.solver.solve(position[rest], _some(orientation, rest))
        # What was reached once is reached, whatever the other search says.
        missed = (solved.label != REACHABLE) & ~found.rejected[rest].any(axis=1)
        at = rest[missed]
        found.q[at], found.label[at], found.proven[at] = solved.q[missed], solved.label[missed], solved.proven[missed]
        found.distance_m[at], found.angle_rad[at] = solved.distance_m[missed], solved.angle_rad[missed]
        self._tried(found, rest[~missed], solved.q[~missed, None], position, orientation)

    def _all_postures(
        self,
        found: Admissible,
        closed: Labels,
        at: np.ndarray,
        position: np.ndarray,
        orientation: np.ndarray | None,
    ) -> None:
        """Try all postures of poses ``at`` (P,): where there are no others, and none is admitted, they are blocked."""
        q, slack, none, alone = closed.postures(position[at], _some(orientation, at))
        targets = np.repeat(at, slack.shape[1])
        tries = self.solver.tries(q.reshape(len(targets), -1), position[targets], _some(orientation, targets))
        # From what is no posture of a pose that others are known of, tries end beside one of these, off the pose: there
        # constraints may admit what they reject of the posture.
        known = np.all(none | alone, axis=1)
        tries.reached[(none & known[:, None]).ravel()] = False
        self._leave_those_beside(found, at, tries)
        found.take(at, tries, self._reasons(tries, targets))
        solved = tries.reached.reshape(slack.shape)
        all_rejected = known & (solved == alone).all(axis=1) & solved.any(axis=1) & (found.label[at] == UNDECIDED)
        if turns_matter(self.solver.whole, self.admission.names):
            return
        found.label[at[all_rejected]] = BLOCKED
        found.proven[at[all_rejected]] = True

    def _nothing(self, features: np.ndarray) -> Admissible:
        """What is known before any try of targets with ``features`` (N, f)."""
        count = len(features)
        return Admissible(
            np.zeros((count, self.solver.whole.n)),
            np.full(count, np.inf),
            np.full(count, np.inf),
            np.full(count, UNDECIDED, np.int8),
            np.zeros((count, len(self.admission.names)), np.int32),
            self._tree.query(features, eps=EPS)[0] if self._tree else np.full(count, np.inf),
            np.zeros(count, bool),
            np.zeros(count, bool),
        )

    @staticmethod
    def _rejected(found: Admissible, least: int) -> np.ndarray:
        """Undecided targets of which at least so many solutions were rejected, (N,) bool."""
        return (found.label == UNDECIDED) & (found.rejected.sum(axis=1) >= least)

    def _search(
        self,
        found: Admissible,
        at: np.ndarray,
        source: str,
        first: int,
        last: int,
        position: np.ndarray,
        orientation: np.ndarray | None,
    ) -> None:
        """Try targets ``at`` (P,) from starts number ``first`` … ``last`` - 1 of a source."""
        if source == NEAR and not self._tree:
            return
        for part in parts_of(at, last - first):
            if source == NEAR:
                features = self.solver.features(position[part], _some(orientation, part))
                starts = self._near(features, first, last)
            else:
                starts = np.tile(self._further[first:last], (len(part), 1, 1))
            self._tried(found, part, starts, position, orientation)

    def nearest(self, position: np.ndarray, orientation: np.ndarray | None, count: int) -> np.ndarray:
        """The admitted samples nearest to targets (N,), (N, count, n), fewer where there are not so many."""
        if not self._tree:
            return np.zeros((len(position), 0, self.solver.whole.n))
        return self._near(self.solver.features(position, orientation), 0, count)

    def solutions(self, position: np.ndarray, first: int, last: int) -> tuple[np.ndarray, np.ndarray]:
        """Configurations (N, s, n) from the admitted samples nearest to positions (N, 3), ``first`` … ``last`` - 1.

        And whether each is admitted and reaches its position, (N, s) bool; s is 0 where no sample is admitted.
        """
        if not self._tree:
            return np.zeros((len(position), 0, self.solver.whole.n)), np.zeros((len(position), 0), bool)
        starts = self._near(self.solver.features(position), first, last)
        P, s, n = starts.shape
        of = np.repeat(np.arange(P), s)
        tries = self.solver.tries(starts.reshape(-1, n), position[of])
        return tries.q.reshape(P, s, n), (tries.reached & (self._reasons(tries, of) == 0)).reshape(P, s)

    def blocked_wrongly(self, found: Admissible, position: np.ndarray) -> int:
        """How many of the blocked positions a LONGER search, of other changes, finds free; their labels are lost."""
        blocked = np.flatnonzero(found.label == BLOCKED)
        found.label[blocked] = UNDECIDED
        for part in parts_of(blocked, LONGER * WALKS * len(SHARES) * len(DEVIATIONS)):
            self._walk(found, part, position, LONGER * WALKS, (self.solver.seed + 1) % 2**63)
        return int((found.label[blocked] == REACHABLE).sum())

    def _walk(self, found: Admissible, at: np.ndarray, position: np.ndarray, walks: int, key: int) -> None:
        """Walk from so many admitted samples nearest to targets ``at`` (P,)."""
        if not self._tree or not len(at):
            return
        q = self._near(self.solver.features(position[at]), 0, walks)
        chain, (P, W, n), S, D = self.solver.whole, q.shape, len(SHARES), len(DEVIATIONS)
        scale = np.where(chain.revolute, 1.0, chain.reach)
        random = np.random.Generator(np.random.Philox(key=key))
        T = self.solver.positions_at(q.reshape(-1, n)).reshape(P, W, 3)
        for _ in range(STEPS):
            changes = random.normal(size=(S, D, n)) * np.array(DEVIATIONS)[:, None] * scale
            open_ = found.label[at] == UNDECIDED
            at, q, T = at[open_], q[open_], T[open_]
            if not len(at):
                return
            starts = inwards(chain, q[:, :, None, None] + changes, 0.0)
            way = position[at][:, None] - T
            targets = T[:, :, None] + np.array(SHARES)[:, None] * way[:, :, None]
            targets = np.broadcast_to(targets[:, :, :, None], (*starts.shape[:-1], 3))
            tries = self.solver.tries(starts.reshape(-1, n), targets.reshape(-1, 3))
            reasons = self._reasons(tries, np.repeat(at, W * S * D))
            shape = (len(at), W, S * D)
            admitted = (tries.reached & (reasons == 0)).reshape(shape)
            # All of the way comes first, so that the first that is admitted is the farthest.
            best = admitted.argmax(axis=2)
            moved = np.take_along_axis(admitted, best[..., None], axis=2)
            q = np.where(
                moved, np.take_along_axis(tries.q.reshape(*shape, n), best[..., None, None], axis=2)[:, :, 0], q
            )
            T = np.where(
                moved, np.take_along_axis(targets.reshape(*shape, 3), best[..., None, None], axis=2)[:, :, 0], T
            )
            whole = np.zeros((len(at), W, S, D), bool)
            whole[:, :, 0] = True
            at_target = np.flatnonzero(whole.ravel())
            found.take(at, tries.taken(at_target), reasons[at_target])

    def _tried(
        self,
        found: Admissible,
        at: np.ndarray,
        starts: np.ndarray,
        position: np.ndarray,
        orientation: np.ndarray | None,
    ) -> None:
        """One try from each of the starts (P, s, n) of targets ``at`` (P,), and what the constraints say of it."""
        if not len(at):
            return
        targets = np.repeat(at, starts.shape[1])
        tries = self.solver.tries(starts.reshape(len(targets), -1), position[targets], _some(orientation, targets))
        self._leave_those_beside(found, at, tries)
        found.take(at, tries, self._reasons(tries, targets))

    def _leave_those_beside(self, found: Admissible, at: np.ndarray, tries: Tries) -> None:
        """Leave out tries of poses ``at`` (P,) that end beside a pose, within the tolerances, which others meet.

        Limits stop them there, and near a singular pose that may be far from every posture: whether one comes by there
        depends on rounding.
        """
        if self.solver.kind != "pose":
            return
        meets = (tries.reached & self.solver.meets(tries)).reshape(len(at), -1)
        found.met[at] |= meets.any(axis=1)
        tries.reached[:] &= (meets | ~found.met[at, None]).ravel()

    def _reasons(self, tries: Tries, targets: np.ndarray) -> np.ndarray:
        """What rejects those tries (T,) that reached their ``targets``, by number, 0: nothing."""
        reasons = np.zeros(len(tries.q), np.int8)
        if tries.reached.any():
            reasons[tries.reached] = self.admission.rejected(tries.q[tries.reached], targets[tries.reached])
        return reasons

    def _near(self, features: np.ndarray, first: int, last: int) -> np.ndarray:
        """The admitted samples nearest to targets with ``features`` (P, f), (P, last - first, n)."""
        assert self._tree
        neighbours = list(range(first + 1, min(last, self._tree.n) + 1)) or [self._tree.n]
        _, at = self._tree.query(features, k=neighbours, eps=EPS)  # type: ignore[arg-type]
        return self.samples[0][at]

    @cached_property
    def samples(self) -> tuple[np.ndarray, np.ndarray]:
        """Admitted configurations (N, n) and their positions (N, 3) [m] in the solver's world."""
        q, position = self.admission.samples(SAMPLES, self.solver.seed)
        T = self.solver.whole.T_world_base @ np.linalg.inv(self.admission.chain.T_world_base)
        return q, position @ T[:3, :3].T + T[:3, 3]

    @cached_property
    def _tree(self) -> KDTree | None:
        """Of admitted samples; None where none is."""
        q = self.samples[0][:NEIGHBOURS]
        return KDTree(self.solver.features_at(q)) if len(q) else None

    @cached_property
    def _further(self) -> np.ndarray:
        """Samples of the joint space and of its limits, and admitted ones, by turns, (FURTHER_SAMPLES, n)."""
        chain, each = self.solver.whole, FURTHER_SAMPLES // 2
        anywhere = configurations(tip_pipeline(chain, Sobol(2 * each, seed=self.solver.seed)))
        kinds = [anywhere[:each], towards_limits(chain, anywhere[each:]), self.samples[0][-each:]]
        number = np.concatenate([np.arange(len(kind)) for kind in kinds])
        return np.concatenate(kinds)[np.argsort(number, kind="stable")][:FURTHER_SAMPLES]


def turns_matter(chain: Kinematics, names: Iterable[str]) -> bool:
    """Whether joints turn further than once, and a constraint may see how far: postures leave turns out."""
    turns = chain.revolute & (chain.upper_limits - chain.lower_limits > 2 * np.pi * (1 + 1e-9))
    return bool(turns.any()) and not TURN_FREE.issuperset(names)


def _some(orientation: np.ndarray | None, at: np.ndarray | slice) -> np.ndarray | None:
    """Those of some targets, where there are any."""
    return None if orientation is None else orientation[at]
