"""Joints hold the arm and what it carries within their torque limits."""

from dataclasses import dataclass

import numpy as np
from numpy.linalg import cholesky, norm, solve, svd

from wsrender.pipeline.constraints.constraint import OfChain, Structure
from wsrender.pipeline.constraints.region import Point
from wsrender.robots.chain import Chain
from wsrender.robots.dynamics import gravity_torques, inertia_matrices
from wsrender.robots.kinematics import Kinematics

SINGULAR = 1e-12  # ratio of singular values at and below which there is no acceleration in some direction


@dataclass(frozen=True)
class Torque:
    """Joints of ``chain``, which carries the payload, hold it in ``gravity`` (3,) [m/s²] within its effort limits.

    ``acceleration`` [m/s²]: at rest 0, else of the tip in any direction of the linear task ``rows``, added to what
    gravity asks: |τ_i| = |g_i| + a ‖row i of J_v' Λ‖, Λ = (J_v M^-1 J_v')^-1 (Khatib 1987); a sufficient test.
    """

    chain: Chain
    gravity: Point
    acceleration: float = 0.0
    rows: tuple[int, ...] = ()
    name: str = "torque"
    keeps: frozenset[Structure] = frozenset()

    @property
    def device(self) -> OfChain:
        """The module, for the rows in which the tip accelerates."""
        return OfChain("torque", (self.rows if self.acceleration else (),), self.chain)

    def pack(self, chain: Kinematics, origin: np.ndarray, precision: str) -> np.ndarray:
        """Gravity (3,), acceleration, efforts back and forth (n,) each."""
        return np.array([*self.gravity, self.acceleration, *np.abs(self.chain.efforts).ravel()])

    def margin(self, q: np.ndarray) -> np.ndarray:
        """Least (limit - |τ|) / limit of the joints at ``q`` (N, n), (N,); -1 at least, and where J_v is singular.

        The limit is that in the direction of the torque.
        """
        held, more = gravity_torques(self.chain, q, np.array(self.gravity)), 0.0
        if self.acceleration:
            more = self.acceleration * self._per_acceleration(q)
        sides = zip(np.abs(self.chain.efforts), (-held, held), strict=True)
        return np.maximum(
            np.min([((limit - torque - more) / limit).min(axis=1) for limit, torque in sides], axis=0), -1.0
        )

    def _per_acceleration(self, q: np.ndarray) -> np.ndarray:
        """Norms of the rows of J_v' Λ, (N, n); infinite where J_v is singular."""
        axes = self.chain.T_world_base[:3, :3].T
        J, L = (axes @ self.chain.jacobians(q)[:, :3])[:, self.rows], cholesky(inertia_matrices(self.chain, q))
        U, s, _ = svd(solve(L, J.swapaxes(1, 2)), full_matrices=False)  # J_v' Λ = L U / s V'
        regular = s[:, -1:] > SINGULAR * s[:, :1]
        return np.where(regular, norm((L @ U) / np.where(regular, s, 1.0)[:, None], axis=2), np.inf)

    def host(self, q: np.ndarray, frames: np.ndarray) -> np.ndarray:
        """See `Constraint.host`."""
        return (self.margin(q) < 0).astype(np.int8)
