"""Targets of an arm whose base stands elsewhere: which of them it reaches from where.

Targets are moved against the base instead. Where the arm has a closed form, their poses are made on the device, and all
postures are known; one of seven joints may be searched along one of them. What is near a boundary, and targets of other
arms, are tried from many starts (`InverseSolver`).
Under constraints a target is served where a configuration is admitted: of all postures, or else of a search.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Self

import numpy as np

from wsrender.documents.placements import IN_DEGREES, PlacementSpace, placed
from wsrender.engine import evaluate_samples, placed_bits, placed_slacks
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.constraints.expression import ExpressionConstraint
from wsrender.pipeline.constraints.host_function import HostConstraint
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.reach.admissible_search import BLOCKED, AdmissibleSearch, turns_matter
from wsrender.reach.admission import WORTH_THREADS, Admission
from wsrender.reach.closed_labels import ClosedLabels
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.inverse_solver import BATCH, VERIFIED, InverseSolver, parts_of
from wsrender.robots.chain import Chain
from wsrender.robots.frames import inverse_of_rigid
from wsrender.robots.moving_base import MovingBase

PAIRS_TOLD = 1 << 22  # whose bits are told apart at a time
SEARCHED = 16  # tries from the nearest admitted samples, of a pose that may have other postures than those known

Value = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True, eq=False)
class PlacedAdmission(Admission):
    """What constraints say of configurations that reach targets from bases that stand at ``values`` (N, m) of joints.

    ``moved``: constraints of the chain ``on_base``, whose coordinates those of the base lead; they are asked first.
    ``added``: those of users, which see where the ``base`` stands; NumPy evaluates them, last.
    """

    moved: Sequence[Constraint] = ()
    on_base: Chain | None = None
    added: Sequence[ExpressionConstraint | HostConstraint] = ()
    base: MovingBase | None = None
    values: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))

    @property
    def names(self) -> tuple[str, ...]:
        """Those of all constraints, in the order in which they are asked."""
        return tuple(each.name for each in (*self.moved, *self.constraints, *self.added))

    def among(self, batch: slice | np.ndarray) -> Self:
        """The same for a batch of targets."""
        return replace(self, values=self.values[batch])

    def rejected(self, q: np.ndarray, targets: np.ndarray | None = None) -> np.ndarray:
        """As `Admission.rejected`; ``targets`` (N,): from whose bases."""
        assert targets is not None
        found = np.zeros(len(q), np.int8)
        if self.moved and self.on_base and len(q):
            rows = np.hstack([self.values[targets], q])
            plan = plan_sampling(self.on_base, rows)
            pipeline = Pipeline(Evaluation(self.on_base), plan, tuple(self.moved), kept_rows=frozenset())
            threads = 1 if len(q) < WORTH_THREADS else self.threads
            labels = evaluate_samples(pipeline, self.device, threads=threads).rejected
            assert labels is not None
            found[:] = labels
        left = np.flatnonzero(found == 0)
        if self.constraints and len(left):
            own = super().rejected(q[left])
            found[left] = np.where(own > 0, own + len(self.moved), 0)
        left = np.flatnonzero(found == 0)
        if self.added and len(left):
            moved = self.motions(targets[left])
            poses = moved @ self.chain.poses(q[left])
            for number, each in enumerate(self.added, len(self.moved) + len(self.constraints) + 1):
                rejects = each.host(q[left], poses, moved) > 0
                found[left[rejects & (found[left] == 0)]] = number
        return found

    def motions(self, targets: np.ndarray) -> np.ndarray:
        """The motions of the world (N, 4, 4) that bring the chain to the bases of ``targets`` (N,)."""
        assert self.base
        return self.base.poses(self.values[targets]) @ np.linalg.inv(self.chain.T_world_base)

    def samples(self, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
        """Those that no base that stands somewhere rejects, as `Admission.samples`."""
        return Admission(self.chain, self.constraints, self.device, self.threads).samples(count, seed)


@dataclass(frozen=True, eq=False)
class Decided:
    """What is known of pairs of a placement and a target, all of one shape.

    ``label``: of `reach.evidence`, or BLOCKED, int8; ``reason``: the constraint, from 1, that blocks, int8; ``value``:
    the largest at the configurations that serve a target, NaN where it is not served, or none was asked for;
    ``proven``: that it is out of reach, or blocked, is proven, as `Reachability` has it, bool.
    """

    label: np.ndarray
    reason: np.ndarray
    value: np.ndarray
    proven: np.ndarray

    @classmethod
    def nothing(cls, shape: tuple[int, ...], label: int = UNDECIDED) -> Self:
        """All of one label, without reason, value or proof."""
        none = np.zeros(shape, np.int8)
        return cls(np.full(shape, label, np.int8), none, np.full(shape, np.nan), np.zeros(shape, bool))

    @property
    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Label, reason, value and proven."""
        return self.label, self.reason, self.value, self.proven


class Placements:
    """Decides K targets, poses (K, 4, 4) in the world, from bases of the chain of a ``solver``.

    ``base``: where bases may stand; ``admission``: of the constraints, None without. ``value`` is largest at the best
    posture, of configurations (N, n) on bases at (N, m); None: no value is asked for. The chain of the solver stands
    where gravity is that of all bases.
    """

    def __init__(
        self,
        solver: InverseSolver,
        base: MovingBase,
        T_world_tip: np.ndarray,
        admission: PlacedAdmission | None,
        value: Value | None = None,
    ):
        self.solver, self.base, self.value = solver, base, value
        self.admission = admission or (None if value is None else PlacedAdmission(solver.whole, ()))
        self._origin = np.array(base.lower[:3])  # near what stands far from the world's
        self._targets = T_world_tip.copy()
        self._targets[:, :3, 3] -= self._origin

    def decide(self, coordinates: np.ndarray, T_world_frame: np.ndarray) -> Decided:
        """What is known of all targets, (P, K), from frames ``T_world_frame`` (P, 4, 4) that carry bases.

        ``coordinates`` (P, 6) [m and rad]: where these are, as the ``base`` has them.
        """
        P, K = len(coordinates), len(self._targets)
        bases = self._bases(T_world_frame)
        found = Decided.nothing((P, K))
        label, closed = found.label, self.solver.closed
        if isinstance(closed, ClosedLabels):
            slack = self._slacks(closed, bases).T
            label[slack < -closed.margin] = UNREACHABLE
            if self.admission is None:
                label[slack > closed.margin] = REACHABLE
        elif closed:
            certain = closed.labels_from(self._seen_from(bases), self._targets).reshape(P, K)
            there = (certain == UNREACHABLE) | ((certain == REACHABLE) & (self.admission is None))
            label[there] = certain[there]
        found.proven[label == UNREACHABLE] = True
        rest = np.flatnonzero(label.ravel() == UNDECIDED)
        for first in range(0, len(rest), BATCH):
            at = rest[first : first + BATCH]
            part, _ = self._decided(at, bases, coordinates)
            for array, each in zip(found.arrays, part.arrays, strict=True):
                array.ravel()[at] = each
        return found

    @property
    def by_bits(self) -> bool:
        """Whether `bits` can tell: closed forms decide, without constraints and a value."""
        return self.solver.closed is not None and self.admission is None

    def bits(self, space: PlacementSpace, numbers: range, targets: np.ndarray) -> tuple[np.ndarray, ...]:
        """Labels that `decide` has of N placements of a ``space`` by number, as bits (N, B) uint8.

        Served, undecided, and proven to be out of reach. Target k sets bit ``targets[k]`` modulo 8 of byte
        ``targets[k]`` // 8. What closed forms leave open is decided pair by pair.
        """
        turns, K = math.prod(space.shape[3:]), len(targets)
        first, last = (number // turns for number in (numbers[0], numbers[-1]))
        angles, positions = space.coordinates(np.arange(turns)), space.coordinates(turns * np.arange(first, last + 1))
        angles[:, :3] = 0.0
        moved = range(numbers.start - turns * first, numbers.stop - turns * first, numbers.step)
        motions = placed(angles) @ self.base.T_frame_base
        served, proven, left = self._certain_bits(motions, positions[:, :3], moved, targets)
        undecided = np.zeros_like(served)
        for places in _parts(left, PAIRS_TOLD // K):
            coordinates = space.coordinates(numbers.start + numbers.step * places)
            bases = self._bases(placed(coordinates))
            is_open = ~_unpacked(served[places] | proven[places], targets)
            at = np.flatnonzero(is_open)
            masks = np.zeros((3, *is_open.shape), bool)
            for some in _parts(at, BATCH):
                of, _ = self._decided(some, bases, coordinates * IN_DEGREES)
                for mask, each in zip(masks, (of.label == REACHABLE, of.label == UNDECIDED, of.proven), strict=True):
                    mask.ravel()[some] = each
            for bits, mask in zip((served, undecided, proven), masks, strict=True):
                each = np.zeros((len(places), 8 * bits.shape[1]), bool)
                each[:, targets] = mask
                bits[places] |= np.packbits(each, axis=1, bitorder="little")
        return served, undecided, proven

    def _certain_bits(
        self, motions: np.ndarray, positions: np.ndarray, numbers: range, targets: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What closed forms alone say of bases, as `placed_bits` has them."""
        closed = self.solver.closed
        assert closed
        if isinstance(closed, ClosedLabels):
            execution = {"device": closed.device, "threads": closed.threads}
            asked = {"origin": self._origin, "margin": closed.margin} | execution
            return placed_bits(closed.form, motions, positions, numbers, self._targets, targets, **asked)
        place, turn = np.divmod(np.array(numbers), len(motions))
        back = self._seen_from(motions)
        T = back[turn]
        T[:, :3, 3] -= np.einsum("nij,nj->ni", T[:, :3, :3], positions[place] - self._origin)
        label = closed.labels_from(T, self._targets).reshape(len(T), -1)
        each = np.zeros((len(T), 8 * (int(targets.max()) // 8 + 1)), bool)
        found = []
        for name in (REACHABLE, UNREACHABLE):
            each[:, targets] = label == name
            found.append(np.packbits(each, axis=1, bitorder="little"))
        return found[0], found[1], np.flatnonzero((label == UNDECIDED).any(axis=1))

    def configurations(self, coordinates: np.ndarray, T_world_frame: np.ndarray) -> tuple[Decided, np.ndarray]:
        """Of one placement, (1, …) as above, what is known (K,), and configurations (K, n) [rad or m].

        Of served targets the best that was found, of others the nearest that was looked at.
        """
        return self._decided(np.arange(len(self._targets)), self._bases(T_world_frame), coordinates)

    def continued(
        self, coordinates: np.ndarray, T_world_frame: np.ndarray, starts: np.ndarray
    ) -> tuple[Decided, np.ndarray]:
        """As `decide`, and configurations (P, K, n), by a try from each of ``starts`` (P, K, S, n) [rad or m] alone.

        What none of them serves stays UNDECIDED, at the nearest.
        """
        assert self.value and self.admission
        (P, K, S, n), bases = starts.shape, self._bases(T_world_frame)
        if self.exhaustive:
            of, q = self._decided(np.arange(P * K), bases, coordinates)
            return Decided(*(each.reshape(P, K) for each in of.arrays)), q.reshape(P, K, n)
        q, value = np.zeros((P * K, n)), np.full(P * K, np.nan)
        for part in parts_of(np.arange(P * K), S):
            at = np.repeat(part, S)
            tries = self.solver.tries(starts.reshape(P * K, S, n)[part].reshape(-1, n), *self._asked_from(at, bases))
            admission = replace(self.admission, values=self.base.configurations(coordinates[at // K]))
            good, reached = np.full(len(at), np.nan), np.flatnonzero(tries.reached)
            served = reached[admission.rejected(tries.q[reached], reached) == 0]
            if len(served):
                good[served] = self.value(tries.q[served], admission.values[served])
            rank = np.where(np.isnan(good), -np.inf, good).reshape(-1, S)
            far = self.solver.residual(tries).reshape(-1, S)
            best = np.where(np.isfinite(rank).any(axis=1), rank.argmax(axis=1), far.argmin(axis=1))
            best += np.arange(len(part)) * S
            q[part], value[part] = tries.q[best], good[best]
        found = Decided.nothing((P, K))
        found.value[:] = value.reshape(P, K)
        found.label[~np.isnan(found.value)] = REACHABLE
        return found, q.reshape(P, K, n)

    def solutions(
        self, at: np.ndarray, coordinates: np.ndarray, T_world_frame: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Configurations (N, s, n) [rad or m] of poses, of pairs of a base and a target by number (N,).

        Whether each is admitted and reaches its pose, (N, s) bool, and whether those are all there are, (N,) bool: so
        it is where closed forms know all postures, of which turns are left out. ``at`` counts targets first.
        """
        assert self.admission
        position, orientation = self._asked_from(at, self._bases(T_world_frame))
        assert orientation is not None
        admission = replace(self.admission, values=self.base.configurations(coordinates[at // len(self._targets)]))
        every, n = np.zeros(len(at), bool), self.solver.whole.n
        q, ok = np.zeros((len(at), 0, n)), np.zeros((len(at), 0), bool)
        if closed := self.solver.closed:
            q, _, none, ok = closed.postures(position, orientation)
            # Of other labels postures are those of a chain nearby, or some of a family.
            every[:] = (none | ok).all(axis=1) & isinstance(closed, ClosedLabels) & (not self._turns_matter)
            ok[ok] = admission.rejected(q[ok], np.nonzero(ok)[0]) == 0
        left = np.flatnonzero(~every)
        if closed and len(left):
            q[left], ok[left] = self._tried(q[left], position[left], orientation[left], admission.among(left))
        if isinstance(closed, ClosedLabels):
            left = left[~ok[left].any(axis=1)]
        if len(left):
            near = self._search.nearest(position[left], orientation[left], SEARCHED)
            own, s = self._tried(near, position[left], orientation[left], admission.among(left)), q.shape[1]
            q, ok = (np.pad(each, [(0, 0), (0, near.shape[1]), (0, 0)][: each.ndim]) for each in (q, ok))
            q[left, s:], ok[left, s:] = own
        return q, ok, every

    def _tried(
        self, starts: np.ndarray, position: np.ndarray, orientation: np.ndarray, admission: PlacedAdmission
    ) -> tuple[np.ndarray, np.ndarray]:
        """A try from each of starts (N, s, n) to poses (N,): where it ends, and whether it is admitted and reaches."""
        N, s, n = starts.shape
        of = np.repeat(np.arange(N), s)
        tries = self.solver.tries(starts.reshape(-1, n), position[of], orientation[of])
        ok = tries.reached.copy()
        ok[ok] = admission.rejected(tries.q[ok], of[ok]) == 0
        return tries.q.reshape(N, s, n), ok.reshape(N, s)

    @property
    def exhaustive(self) -> bool:
        """Whether the value of a target is that of the best of all postures, not of the first that a search finds."""
        return isinstance(self.solver.closed, ClosedLabels) and self.solver.kind == "pose" and not self._turns_matter

    def _bases(self, T_world_frame: np.ndarray) -> np.ndarray:
        """Bases (P, 4, 4), seen from the origin."""
        bases = T_world_frame @ self.base.T_frame_base
        bases[:, :3, 3] -= self._origin
        return bases

    def _slacks(self, closed: ClosedLabels, bases: np.ndarray) -> np.ndarray:
        return placed_slacks(closed.form, bases, self._targets, device=closed.device, threads=closed.threads)

    def _decided(self, at: np.ndarray, bases: np.ndarray, coordinates: np.ndarray) -> tuple[Decided, np.ndarray]:
        """Of pairs of a base and a target, by number (N,), and configurations (N, n)."""
        place = at // len(self._targets)
        position, orientation = self._asked_from(at, bases)
        found = Decided.nothing((len(at),))
        q = np.zeros((len(at), self.solver.whole.n))
        if self.admission is None:
            solved = self.solver.solve(position, orientation)
            found.label[:], q[:] = solved.label, solved.q
            found.proven[:] = solved.proven & (solved.label == UNREACHABLE)
            return found, q
        admission = replace(self.admission, values=self.base.configurations(coordinates[place]))
        if orientation is not None and self.exhaustive:
            for first in range(0, len(at), VERIFIED):
                part = slice(first, first + VERIFIED)
                of, q[part] = self._of_postures(admission.among(part), position[part], orientation[part])
                for array, each in zip(found.arrays, of.arrays, strict=True):
                    array[part] = each
        left = np.flatnonzero(found.label == UNDECIDED)
        if len(left):
            search = copy(self._search)
            search.admission = admission.among(left)
            of = search.decide(position[left], None if orientation is None else orientation[left])
            found.label[left], found.reason[left], q[left] = of.label, of.reason, of.q
            found.proven[left] = of.proven & np.isin(of.label, (UNREACHABLE, BLOCKED))
            served = left[of.label == REACHABLE]
            if self.value and len(served):
                found.value[served] = self.value(q[served], admission.values[served])
        return found, q

    def _seen_from(self, bases: np.ndarray) -> np.ndarray:
        """The motions (P, 4, 4) that move targets so that the solver's base is to them as each of ``bases``."""
        return self.solver.whole.T_world_base @ inverse_of_rigid(bases)

    def _asked_from(self, at: np.ndarray, bases: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
        """Positions (N, 3) and orientations, as `InverseSolver.solve` has them, of pairs by number (N,)."""
        place, target = np.divmod(at, len(self._targets))
        T = self._seen_from(bases[place]) @ self._targets[target]
        return T[:, :3, 3], {"position": None, "axis": T[:, :3, 2], "pose": T[:, :3, :3]}[self.solver.kind]

    def _of_postures(
        self, admission: PlacedAdmission, position: np.ndarray, orientation: np.ndarray
    ) -> tuple[Decided, np.ndarray]:
        """Of poses (N,) all of whose postures are known, and the best of these; others stay UNDECIDED."""
        assert self.solver.closed
        q, slack, none, alone = self.solver.closed.postures(position, orientation)
        whole = np.all(none | alone, axis=1) & np.any(alone, axis=1)
        there = alone & whole[:, None]
        pose, _ = np.nonzero(there)
        rejected = np.zeros(slack.shape, np.int8)
        rejected[there] = admission.rejected(q[there], pose)
        admitted = there & (rejected == 0)
        free, good = admitted.any(axis=1), np.where(admitted, slack, -np.inf)
        if self.value and admitted.any():
            good[admitted] = self.value(q[admitted], admission.values[np.nonzero(admitted)[0]])
        label = np.where(free, REACHABLE, np.where(whole, BLOCKED, UNDECIDED)).astype(np.int8)
        times = [(rejected == k + 1).sum(axis=1) for k in range(len(admission.names))] or [np.zeros(len(q))]
        reason = np.where(label == BLOCKED, 1 + np.argmax(times, axis=0), 0).astype(np.int8)
        best = np.where(free, good.argmax(axis=1), slack.argmax(axis=1))
        value = np.where(free & (self.value is not None), good.max(axis=1), np.nan)
        return Decided(label, reason, value, label == BLOCKED), q[np.arange(len(q)), best]

    @property
    def _turns_matter(self) -> bool:
        assert self.admission
        return turns_matter(self.solver.whole, self.admission.names)

    @cached_property
    def _search(self) -> AdmissibleSearch:
        """What the searches of all pairs have in common: where they start."""
        assert self.admission
        search = AdmissibleSearch(self.solver, self.admission)
        search.prepare()
        return search


@dataclass(frozen=True, eq=False)
class PlacementsOfKinds:
    """As `Placements`, of K targets of several kinds: each of ``parts`` decides those ``at`` (M,) their numbers."""

    parts: Sequence[Placements]
    at: Sequence[np.ndarray]

    @property
    def closed(self) -> bool:
        """Whether closed forms know all postures of all targets."""
        return all(isinstance(part.solver.closed, ClosedLabels) for part in self.parts)

    def decide(self, coordinates: np.ndarray, T_world_frame: np.ndarray) -> Decided:
        """As `Placements.decide`."""
        return self._joined([part.decide(coordinates, T_world_frame) for part in self.parts])

    @property
    def by_bits(self) -> bool:
        """As `Placements.by_bits`, of all parts."""
        return all(part.by_bits for part in self.parts)

    def bits(self, space: PlacementSpace, numbers: range) -> tuple[np.ndarray, ...]:
        """As `Placements.bits`, of target k that of byte k // 8 and weight 2^(k % 8)."""
        first, *others = (part.bits(space, numbers, at) for part, at in zip(self.parts, self.at, strict=True))
        if not others:
            return first
        found = tuple(np.zeros((len(numbers), -(-sum(map(len, self.at)) // 8)), np.uint8) for _ in first)
        for part in (first, *others):
            for bits, each in zip(found, part, strict=True):
                bits[:, : each.shape[1]] |= each
        return found

    def configurations(self, coordinates: np.ndarray, T_world_frame: np.ndarray) -> tuple[Decided, np.ndarray]:
        """As `Placements.configurations`."""
        found = [part.configurations(coordinates, T_world_frame) for part in self.parts]
        return self._joined([of for of, _ in found]), np.concatenate([q for _, q in found])[self._back]

    def continued(
        self, coordinates: np.ndarray, T_world_frame: np.ndarray, starts: np.ndarray
    ) -> tuple[Decided, np.ndarray]:
        """As `Placements.continued`."""
        parts = zip(self.parts, self.at, strict=True)
        found = [part.continued(coordinates, T_world_frame, starts[:, at]) for part, at in parts]
        return self._joined([of for of, _ in found]), np.concatenate([q for _, q in found], axis=1)[:, self._back]

    @property
    def exhaustive(self) -> bool:
        """Whether all values are those of the best of all postures."""
        return all(part.exhaustive for part in self.parts)

    def _joined(self, found: list[Decided]) -> Decided:
        if len(found) == 1:
            return found[0]
        parts = zip(*(of.arrays for of in found), strict=True)
        return Decided(*(np.concatenate(part, axis=-1)[..., self._back] for part in parts))

    @cached_property
    def _back(self) -> np.ndarray:
        return np.argsort(np.concatenate(self.at), kind="stable")


def _parts(at: np.ndarray, count: int) -> Iterator[np.ndarray]:
    """Numbers (P,) in parts of at most so many, and at least one."""
    each = max(1, count)
    return (at[first : first + each] for first in range(0, len(at), each))


def _unpacked(bits: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """Of bits (N, B) uint8 those of targets (K,), (N, K) bool."""
    return np.unpackbits(bits, axis=1, bitorder="little")[:, targets].astype(bool)
