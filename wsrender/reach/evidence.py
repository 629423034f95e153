"""What the tries of inverse kinematics found of every target, and whether that says it is unreachable."""

import numpy as np

from wsrender.engine import REACHABLE, UNDECIDED, UNREACHABLE, Accuracy, Tries
from wsrender.robots.kinematics import Kinematics

LABELS = {REACHABLE: "reachable", UNREACHABLE: "unreachable", UNDECIDED: "undecided"}

# Evidence that a target is unreachable: enough tries came to rest where no motion within the limits leads nearer,
# clearly off the target, and so many of them at the least residual of all, within 1 %.
LEAST_AGREEING, AGREEING, CLEARLY = 3, 1.01, 2.0
# How many ends are enough. Where no joint stands on a limit, a try came to rest with the arm stretched towards its
# target, in a singular configuration: few suffice.
STRETCHED = {"position": 12, "axis": 32, "pose": 32}
COORDINATES = {"position": 3, "axis": 5, "pose": 6}  # an arm of fewer joints comes to rest anywhere
# Where some do, ends prove nothing, however well they agree: almost every combination of limits has its nearest point,
# whether the target is reached elsewhere or not. Only a long search, near all limits too, tells something.
ON_LIMITS = {"position": 24, "axis": 100, "pose": 100}
# Targets that are missed by less than a share of the reach need the longest: another posture may just reach them.
NARROWLY = {"position": 0.01, "axis": 0.03, "pose": 0.03}
NARROWLY_MISSED = {"position": 40, "axis": 200, "pose": 200}
ON_LIMIT = 1e-6  # share of a coordinate's range within which it stands on a limit
# Targets missed by less than this share of the reach are tried once more, from the nearest configuration, until the
# slope is flatter by FLATTER, or little is gained: beside a fold a try comes to rest where the slope is below the
# solver's FLAT, up to reach · FLAT² / 2 before its edge, and more where links are thin or a lever is short.
FOLD, FLATTER, LITTLE = 1e-3, 0.01, 1.1


class Evidence:
    """The best of all tries of every target, and the evidence that nothing better exists.

    ``q`` (N, n), ``distance`` (N,) [m], ``angle`` (N,) [rad], ``label`` (N,) int8.
    ``proven`` (N,) bool: targets known to be out of reach.
    """

    def __init__(self, chain: Kinematics, kind: str, accuracy: Accuracy, proven: np.ndarray):
        self.accuracy, self.proven = accuracy, proven
        count = len(proven)
        self.q = np.zeros((count, chain.n))
        self.distance, self.angle = np.full(count, np.inf), np.full(count, np.inf)
        self.label = np.full(count, UNDECIDED, np.int8)
        self._kind, self._chain = kind, chain
        self._residual = np.full(count, np.inf)  # of the best try
        self._nearest_end = np.full(count, np.inf)  # least residual at which a try came to rest
        tolerance = np.hypot(accuracy.position_m, accuracy.length * accuracy.angle_rad * (kind != "position"))
        self._clearly_off = CLEARLY * tolerance
        # Ends, those at the least residual, and those of these on no limit.
        self._ends, self._agreeing, self._stretched = (np.zeros(count, np.int32) for _ in range(3))

    @property
    def pending(self) -> np.ndarray:
        """Undecided targets, (P,)."""
        return np.flatnonzero(self.label == UNDECIDED)

    def exhaust(self, at: np.ndarray) -> None:
        """Decide targets (P,) that were tried from every posture near to any that reaches them, and clearly missed."""
        self.label[at[self._residual[at] > self._clearly_off]] = UNREACHABLE

    def record(self, pending: np.ndarray, tries: Tries, residual: np.ndarray) -> None:
        """Take in tries of pending targets (P,), residuals (P, tries each) [m], and settle what is decided."""
        each = residual.shape[1]
        reached, ended = tries.reached.reshape(residual.shape), tries.stationary.reshape(residual.shape)
        best = np.argmin(np.where(reached, -1.0, residual), axis=1)
        chosen = np.arange(len(pending)) * each + best
        found = reached.any(axis=1)
        better = found | (residual.ravel()[chosen] < self._residual[pending])
        at, chosen = pending[better], chosen[better]
        self._residual[at] = residual.ravel()[chosen]
        self.q[at], self.distance[at], self.angle[at] = tries.q[chosen], tries.distance[chosen], tries.angle[chosen]
        self._count_ends(pending, np.where(ended, residual, np.inf), self._off_limits(tries.q).reshape(residual.shape))
        self.label[pending] = np.where(found, REACHABLE, np.where(self._unreachable(pending), UNREACHABLE, UNDECIDED))

    @property
    def narrow(self) -> np.ndarray:
        """Targets that were missed so narrowly that they are worth a last try, (M,)."""
        near = self._residual < FOLD * self._chain.reach
        return np.flatnonzero((self.label != REACHABLE) & near & ~self.proven)

    def settle(self, narrow: np.ndarray, tries: Tries, residual: np.ndarray) -> None:
        """Take in the last tries of targets ``narrow`` (M,), residuals (M,) [m]; "unreachable" is kept or undone."""
        better = tries.reached | (residual < self._residual[narrow])
        at = narrow[better]
        self.q[at], self.distance[at], self.angle[at] = tries.q[better], tries.distance[better], tries.angle[better]
        still = tries.stationary | (residual * LITTLE > self._residual[narrow])
        off = still & (residual > self._clearly_off)
        settled = (self.label[narrow] == UNREACHABLE) & off
        self.label[narrow] = np.select([tries.reached, settled], [REACHABLE, UNREACHABLE], UNDECIDED)

    def _off_limits(self, q: np.ndarray) -> np.ndarray:
        """Whether no coordinate of configurations (T, n) stands on a limit, and they suffice for any target, (T,)."""
        chain = self._chain
        width = chain.upper_limits - chain.lower_limits
        off = (q > chain.lower_limits + ON_LIMIT * width) & (q < chain.upper_limits - ON_LIMIT * width)
        enough = (width > 0).sum() >= COORDINATES[self._kind]
        return (off | chain.periodic | (width == 0)).all(axis=1) & enough

    def _count_ends(self, pending: np.ndarray, ends: np.ndarray, off_limits: np.ndarray) -> None:
        """Count tries that came to rest (residuals ``ends`` (P, g), infinite for others), and those at the best."""
        before = self._nearest_end[pending]
        nearest = np.minimum(before, ends.min(axis=1))
        limit = AGREEING * nearest + self.accuracy.position_m
        still, at_best = before <= limit, (ends <= limit[:, None]) & np.isfinite(ends)
        for counts, agreeing in ((self._agreeing, at_best), (self._stretched, at_best & off_limits)):
            counts[pending] = np.where(still, counts[pending], 0) + agreeing.sum(axis=1)
        self._ends[pending] += np.isfinite(ends).sum(axis=1)
        self._nearest_end[pending] = nearest

    def _unreachable(self, pending: np.ndarray) -> np.ndarray:
        nearest, ends = self._nearest_end[pending], self._ends[pending]
        needed = np.where(self._stretched[pending] >= LEAST_AGREEING, STRETCHED[self._kind], ON_LIMITS[self._kind])
        needed[nearest < NARROWLY[self._kind] * self._chain.reach] = NARROWLY_MISSED[self._kind]
        consistent = (ends >= needed) & (self._agreeing[pending] >= LEAST_AGREEING)
        clear = np.isfinite(nearest) & (self._residual[pending] * AGREEING >= nearest)
        off = self._residual[pending] > self._clearly_off
        return self.proven[pending] | (consistent & clear & off)
