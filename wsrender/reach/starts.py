"""Configurations that tries of inverse kinematics start from: those nearest to a target, then the same for all."""

from collections.abc import Callable
from functools import cached_property

import numpy as np
from scipy.spatial import KDTree

from wsrender.documents.sampling import Sobol
from wsrender.engine import configurations
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.robots.kinematics import Kinematics

NEAR, NEAR_LIMITS, FURTHER = "near", "near limits", "further"
EPS = 1.0  # neighbours may be farther by this share: exact ones of far targets cost more than the tries
ON_LIMITS = 0.5  # share of a coordinate's values that stand on a limit, among the samples of the limits
MOST_CORNERS = 1 << 11
FURTHER_SAMPLES = 128  # of either kind


class Starts:
    """Starts for the targets of one chain: among ``count`` samples of the joint space, and of its limits.

    Few starts lead to a target whose configurations all stand near limits, and rarely the samples nearest to it. Of
    the second kind half the coordinates stand on limits; the corners of the joint space are among them.

    ``features`` of configurations (N, n) are coordinates (N, f) whose distances tries reduce.
    """

    def __init__(
        self, chain: Kinematics, features: Callable[[np.ndarray], np.ndarray], *, count: int, seed: int, workers: int
    ):
        self._chain, self._seed, self._count = chain, seed, count
        self._features, self._workers = features, workers

    def of(self, source: str, features: np.ndarray, first: int, last: int) -> np.ndarray:
        """Starts from number ``first`` of targets with ``features`` (P, f), (P, last - first, n).

        ``source``: NEAR, the nearest samples of the joint space; NEAR_LIMITS, those of its limits; else `further`.
        """
        if source == FURTHER:
            return np.tile(self.further(first, last), (len(features), 1, 1))
        q, tree = self._near if source == NEAR else self._near_limits
        # k as a list gives a column per neighbour.
        neighbours = list(range(first + 1, last + 1))
        _, at = tree.query(features, k=neighbours, eps=EPS, workers=self._workers)  # type: ignore[arg-type]
        return q[at]

    def further(self, first: int, last: int) -> np.ndarray:
        """Samples of both kinds by turns, the same for every target, (last - first, n)."""
        return self._further[first:last]

    @cached_property
    def _near(self) -> tuple[np.ndarray, KDTree]:
        q = self._anywhere[: self._count]
        return q, KDTree(self._features(q))

    @cached_property
    def _near_limits(self) -> tuple[np.ndarray, KDTree]:
        q = np.vstack([corners(self._chain), towards_limits(self._chain, self._anywhere[: self._count])])
        return q, KDTree(self._features(q))

    @cached_property
    def _anywhere(self) -> np.ndarray:
        """Samples of the joint space: those of the trees, then the further ones of either kind."""
        count = self._count + 2 * FURTHER_SAMPLES
        return configurations(tip_pipeline(self._chain, Sobol(count, seed=self._seed)))

    @cached_property
    def _further(self) -> np.ndarray:
        anywhere, limits = np.split(self._anywhere[self._count :], 2)
        return np.stack([anywhere, towards_limits(self._chain, limits)], axis=1).reshape(-1, self._chain.n)


def towards_limits(chain: Kinematics, q: np.ndarray) -> np.ndarray:
    """Uniform samples (N, n) spread so that a share ON_LIMITS of the values stands on limits, the others between.

    Hinges without limits keep theirs.
    """
    width = chain.upper_limits - chain.lower_limits
    spread = chain.lower_limits + ((q - chain.lower_limits) - ON_LIMITS / 2 * width) / (1 - ON_LIMITS)
    return np.where(chain.periodic, q, np.clip(spread, chain.lower_limits, chain.upper_limits))


def corners(chain: Kinematics) -> np.ndarray:
    """Configurations (C, n) with every coordinate at one of its limits: all, or so many drawn at random."""
    if 1 << chain.n <= MOST_CORNERS:
        upper = np.arange(1 << chain.n)[:, None] >> np.arange(chain.n) & 1
    else:
        upper = np.random.Generator(np.random.Philox(key=0)).integers(0, 2, (MOST_CORNERS, chain.n))
    return np.where(upper, chain.upper_limits, chain.lower_limits)


def inwards(chain: Kinematics, q: np.ndarray, share: float) -> np.ndarray:
    """Configurations (N, n) moved so that every coordinate is at least so much of its range off its limits."""
    margin = share * (chain.upper_limits - chain.lower_limits)
    return np.where(chain.periodic, q, np.clip(q, chain.lower_limits + margin, chain.upper_limits - margin))
