"""Membership in what a chain reaches, and the reached points nearest to others, by inverse kinematics."""

import numpy as np

from wsrender.engine import sampled_positions
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.evidence import REACHABLE, UNDECIDED
from wsrender.reach.inverse_solver import InverseSolver
from wsrender.reach.reached_set import tolerance_m
from wsrender.robots.kinematics import Kinematics


class ReachedPoints:
    """Decides positions in the world; ``undecided`` counts those of `reaches` that it could not decide."""

    def __init__(self, chain: Kinematics, device: str = "cpu", threads: int | None = None):
        self._solver = InverseSolver(chain, position_m=tolerance_m(chain), device=device, threads=threads)
        self._chain, self._threads = chain, threads
        self.undecided = 0

    def reaches(self, points: np.ndarray) -> np.ndarray:
        """Whether points (N, 3) [m] are reached, (N,) bool; those that are undecided count as not."""
        label = self._solver.solve(points).label
        self.undecided += int((label == UNDECIDED).sum())
        return label == REACHABLE

    def nearest(self, points: np.ndarray) -> np.ndarray:
        """The reached points (N, 3) nearest to points (N, 3) [m], as far as the solver found them."""
        q = self._solver.solve(points).q
        return sampled_positions(tip_pipeline(self._chain, q), threads=self._threads)
