"""Poses that two arms can both hold: of every pair of their placements which, and of one pair the best postures.

Where the arms must keep apart, a pair of configurations is looked for in which they do, those with the largest joint
limit margin first. A pose is *open* where none was found, and other postures than those tried may exist.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from wsrender.reach.admission import Admission
from wsrender.reach.placements import Placements
from wsrender.robots.kinematics import Kinematics

if TYPE_CHECKING:
    from wsrender.robot.arms_collision import ArmsApart

PLACES = 1 << 10  # of either arm that are looked at together
SOLVED = 1 << 14  # placements and poses of an arm whose configurations are held in memory
TOGETHER, ROUND = 1 << 14, 8  # hand-overs that are tried together, and pairs of configurations of each at a time
LABELS = ("free", "blocked", "undecided", "none")
FREE, BLOCKED, UNDECIDED, NONE = range(len(LABELS))


@dataclass(frozen=True, eq=False)
class Held:
    """What is known of an arm's placements and poses, (P, H) bool: those that it holds, and those that are undecided.

    ``search`` finds configurations; ``coordinates`` (P, 6) [m and rad] and ``T_world_frame`` (P, 4, 4): the placements.
    """

    served: np.ndarray
    undecided: np.ndarray
    search: Placements
    coordinates: np.ndarray
    T_world_frame: np.ndarray

    def solutions(self, place: np.ndarray, pose: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """`Placements.solutions` of placements and poses by number, (N,) each."""
        return self.search.solutions(place * self.served.shape[1] + pose, self.coordinates, self.T_world_frame)

    def with_base(self, place: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Configurations (N, n) with the coordinates of the base before them."""
        return np.hstack([self.search.base.configurations(self.coordinates[place]), q])


@dataclass(frozen=True, eq=False)
class HandOversOf:
    """Poses of one pair of placements: labels (H,) of LABELS by number, and the best configurations, NaN where none is.

    ``margin`` (H,): the lesser joint limit margin [1] of both.
    """

    label: np.ndarray
    margin: np.ndarray
    q: tuple[np.ndarray, np.ndarray]


class HandOvers:
    """Hand-overs of two arms; ``apart``: what keeps them apart, None where nothing is asked of that."""

    def __init__(
        self, arms: Sequence[Held], apart: "ArmsApart | None", device: str = "cpu", threads: int | None = None
    ):
        self.arms, self.apart = arms, apart
        self.together = apart and Admission(apart.chain, (apart.constraint,), device, threads)

    def offered(self) -> tuple[np.ndarray, np.ndarray]:
        """Of every pair of placements bits of the poses that it offers, (P, Q, B) uint8, and how many are open, (P, Q).

        Pose k is that of byte k // 8 and weight 2^(k % 8).
        """
        a, b = self.arms
        P, Q, H = len(a.served), len(b.served), a.served.shape[1]
        bits, open_ = np.zeros((P, Q, -(-H // 8)), np.uint8), np.zeros((P, Q), np.int64)
        step = 8 * max(1, SOLVED // (8 * min(max(P, Q), PLACES)))
        for i, k, poses in product(_parts(P, PLACES), _parts(Q, PLACES), _parts(H, step)):
            both = a.served[i, None, poses] & b.served[None, k, poses]
            possible = [each.served[own, poses] | each.undecided[own, poses] for each, own in ((a, i), (b, k))]
            unsure = possible[0][:, None] & possible[1] & ~both
            if self.apart:
                self._keep_apart(both, unsure, (i.start, k.start, poses.start))
            bits[i, k, poses.start // 8 : -(-poses.stop // 8)] = np.packbits(both, axis=2, bitorder="little")
            open_[i, k] += unsure.sum(axis=2)
        return bits, open_

    def _keep_apart(self, both: np.ndarray, unsure: np.ndarray, first: tuple[int, int, int]) -> None:
        """Take from ``both`` (P, Q, h), which begins at ``first``, what is not found apart: it may be ``unsure``."""
        solved, number = [], []
        for k, arm in enumerate(self.arms):
            asked = both.any(axis=1 - k)
            place, pose = np.nonzero(asked)
            solved.append(Solved.of(arm, first[k] + place, first[2] + pose))
            number.append(np.cumsum(asked).reshape(asked.shape) - 1)
        places = np.nonzero(both)
        for begin in range(0, len(places[0]), TOGETHER):
            p, q, h = (each[begin : begin + TOGETHER] for each in places)
            rows = solved[0][number[0][p, h]], solved[1][number[1][q, h]]
            found = self._best((first[0] + p, first[1] + q), rows)
            both[p, q, h], unsure[p, q, h] = found.label == FREE, found.label == UNDECIDED

    def of_pair(self, pair: tuple[int, int]) -> HandOversOf:
        """All poses from one pair of placements, by number."""
        a, b = self.arms
        served, open_ = ([each[k] for each, k in zip(of, pair, strict=True)] for of in (
            (a.served, b.served), (a.undecided, b.undecided)))  # fmt: skip
        both, H = served[0] & served[1], len(served[0])
        label = np.where((served[0] | open_[0]) & (served[1] | open_[1]), UNDECIDED, NONE)
        margin = np.full(H, np.nan)
        q = tuple(np.full((H, arm.search.solver.whole.n), np.nan) for arm in self.arms)
        poses = np.flatnonzero(both)
        for begin in range(0, len(poses), TOGETHER):
            at = poses[begin : begin + TOGETHER]
            places = tuple(np.full(len(at), k) for k in pair)
            solved = [Solved.of(arm, place, at) for arm, place in zip(self.arms, places, strict=True)]
            found = self._best(places, solved)
            # Without anything that keeps the arms apart both hold what each of them holds.
            label[at], margin[at] = found.label if self.apart else FREE, found.margin
            q[0][at], q[1][at] = found.q
        return HandOversOf(label, margin, (q[0], q[1]))

    def _best(self, places: Sequence[np.ndarray], solved: "Sequence[Solved]") -> HandOversOf:
        """Of poses (N,) the pair of configurations with the largest lesser margin in which the arms are apart."""
        a, b = solved
        N, s, t = len(a.ok), a.ok.shape[1], b.ok.shape[1]
        worth = np.minimum(a.margin[:, :, None], b.margin[:, None, :]).reshape(N, s * t)
        order = np.argsort(-worth, axis=1, kind="stable")
        chosen = np.full(N, -1)
        for begin in range(0, s * t, ROUND):
            open_ = np.flatnonzero(chosen < 0)
            tried = order[open_, begin : begin + ROUND]
            there = np.isfinite(np.take_along_axis(worth[open_], tried, axis=1))
            if not there.any():
                break
            row, column = np.nonzero(there)
            at, (i, k) = open_[row], np.divmod(tried[row, column], t)
            apart = there.copy()
            apart[row, column] = self._apart(places, at, a.q[at, i], b.q[at, k])
            some = apart.any(axis=1)
            chosen[open_[some]] = tried[some, apart[some].argmax(axis=1)]
        free = chosen >= 0
        i, k = np.divmod(np.maximum(chosen, 0), max(t, 1))
        label = np.where(free, FREE, np.where(a.every & b.every, BLOCKED, UNDECIDED))
        margin, q = np.full(N, np.nan), [np.full((N, each.q.shape[2]), np.nan) for each in solved]
        margin[free] = worth[free, chosen[free]]
        for own, each, number in zip(q, solved, (i, k), strict=True):
            own[free] = each.q[free, number[free]]
        return HandOversOf(label, margin, (q[0], q[1]))

    def _apart(self, places: Sequence[np.ndarray], at: np.ndarray, q_a: np.ndarray, q_b: np.ndarray) -> np.ndarray:
        if self.apart is None or self.together is None:
            return np.ones(len(at), bool)
        q = [arm.with_base(place[at], each) for arm, place, each in zip(self.arms, places, (q_a, q_b), strict=True)]
        return self.together.rejected(self.apart.configurations(*q)) == 0


@dataclass(frozen=True, eq=False)
class Solved:
    """Configurations (N, s, n) of poses: which are admitted (N, s), whether they are all (N,), and margins (N, s)."""

    q: np.ndarray
    ok: np.ndarray
    every: np.ndarray
    margin: np.ndarray

    @classmethod
    def of(cls, arm: Held, place: np.ndarray, pose: np.ndarray) -> "Solved":
        """Of an arm's placements and poses by number, (N,) each."""
        q, ok, every = arm.solutions(place, pose)
        return cls(q, ok, every, np.where(ok, joint_limit_margin(arm.search.solver.whole, q), -np.inf))

    def __getitem__(self, rows: np.ndarray) -> "Solved":
        return Solved(self.q[rows], self.ok[rows], self.every[rows], self.margin[rows])


def joint_limit_margin(chain: Kinematics, q: np.ndarray) -> np.ndarray:
    """The index of that name (DEFINITIONS 15) at configurations (..., n): the least room to a limit, by ranges [1]."""
    lower, upper = chain.lower_limits, chain.upper_limits
    limited = np.isfinite(lower) & np.isfinite(upper) & ~chain.periodic & (lower < upper)
    q, lower, upper = q[..., limited], lower[limited], upper[limited]
    room = np.minimum(q - lower, upper - q) / (upper - lower)
    return np.minimum(room.min(axis=-1, initial=0.5), 0.5)


def _parts(count: int, each: int) -> list[slice]:
    return [slice(first, min(first + each, count)) for first in range(0, count, each)]
