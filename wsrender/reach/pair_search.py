"""Points that two arms reach together: a configuration of each, both admitted, in which the arms keep apart.

A point is free where such a pair is found. It is blocked where solutions of both arms were found from starts of all
kinds, and every pair of them that was tried was rejected: evidence of a search, no proof.
"""

from typing import TYPE_CHECKING

import numpy as np

from wsrender.reach.admissible_search import BLOCKED, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.evidence import REACHABLE, UNDECIDED
from wsrender.reach.inverse_solver import parts_of
from wsrender.reach.reached_set import FalseNegatives

if TYPE_CHECKING:
    from wsrender.robot.arms_collision import ArmsApart

# Starts of either arm by number, each the admitted sample so near to the point, and with how many of the other's
# solutions each solution is tried.
ROUNDS = ((0, 8, 8), (8, 40, 16))
LONGER = ((40, 104, 24),)  # tells how many free points the others miss
LEAST_OF_EACH, LEAST_PAIRS = 8, 32  # solutions, and pairs of them that were rejected, of a blocked point


class PairSearch:
    """Decides points of two searches of one world, whose chains are those of the arms that are ``apart``."""

    def __init__(self, first: AdmissibleSearch, second: AdmissibleSearch, apart: "ArmsApart"):
        self.arms, self.apart = (first, second), apart
        own = first.admission
        self.together = Admission(apart.chain, (apart.constraint,), own.device, own.threads)

    @property
    def names(self) -> tuple[str, ...]:
        """Of what keeps the arms apart."""
        return self.together.names

    def decide(self, points: np.ndarray) -> np.ndarray:
        """Labels (N,) int8 of points (N, 3) [m] that both arms are free to reach."""
        label, pairs = np.full(len(points), UNDECIDED, np.int8), np.zeros(len(points), int)
        solved = np.zeros((len(points), 2), int)
        for each in ROUNDS:
            self._search(points, label, solved, pairs, each)
        enough = (solved >= LEAST_OF_EACH).all(axis=1) & (pairs >= LEAST_PAIRS)
        label[enough & (label == UNDECIDED)] = BLOCKED
        return label

    def found_later(self, points: np.ndarray) -> FalseNegatives:
        """The search tried beside a longer one at points (N, 3) [m] that both arms are free to reach."""
        label = self.decide(points)
        free, blocked = int((label == REACHABLE).sum()), np.flatnonzero(label == BLOCKED)
        later = np.full(len(blocked), UNDECIDED, np.int8)
        for each in LONGER:
            self._search(points[blocked], later, np.zeros((len(blocked), 2), int), np.zeros(len(blocked), int), each)
        missed = int((later == REACHABLE).sum())
        return FalseNegatives(free + missed, missed)

    def _search(
        self, points: np.ndarray, label: np.ndarray, solved: np.ndarray, pairs: np.ndarray, of: tuple[int, int, int]
    ) -> None:
        """Try one of the rounds at undecided points: which are free, and how many solutions and pairs were tried."""
        first, last, others = of
        for at in parts_of(np.flatnonzero(label == UNDECIDED), (last - first) * others):
            (q_a, ok_a), (q_b, ok_b) = (arm.solutions(points[at], first, last) for arm in self.arms)
            count = ok_a.shape[1], ok_b.shape[1]
            if not all(count):
                return
            i, k = np.arange(count[0])[:, None], np.arange(min(others, count[1]))
            i, k = np.broadcast_to(i, (count[0], len(k))).ravel(), ((i + k) % count[1]).ravel()
            point, pair = np.nonzero(ok_a[:, i] & ok_b[:, k])
            q = self.apart.configurations(q_a[point, i[pair]], q_b[point, k[pair]])
            admitted = self.together.rejected(q) == 0 if len(q) else np.zeros(0, bool)
            label[at[point[admitted]]] = REACHABLE
            solved[at] += np.stack([ok_a.sum(axis=1), ok_b.sum(axis=1)], axis=1)
            pairs[at] += np.bincount(point, minlength=len(at))
