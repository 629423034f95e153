"""Ramps before joint limits."""

import numpy as np

from wsrender.documents.kinetostatics import JointLimitForce
from wsrender.robots.chain import Chain


class JointLimits:
    """The joint-limit force of [CB]: a linear ramp over a margin Δ before each limit; joints without limits have none.

    ``peak`` is the largest force F_max [N], ``length`` the characteristic length [m].
    """

    def __init__(self, chain: Chain, choice: JointLimitForce, peak: float, length: float):
        self.peak = peak
        self.lower = np.where(chain.periodic, -np.inf, chain.lower_limits)
        self.upper = np.where(chain.periodic, np.inf, chain.upper_limits)
        self.margin = np.where(chain.revolute, choice.margin_rad, choice.margin_m)
        turning = choice.stiffness_n_m_per_rad or peak * length / choice.margin_rad
        sliding = choice.stiffness_n_per_m or peak / choice.margin_m
        stiffness = np.where(chain.revolute, turning, sliding)
        self._torque, self._energy = stiffness * self.margin, 0.5 * stiffness * self.margin**2  # at a limit
        # Shares of the ramps before the lower and the upper limit, linear in q.
        self._starts = np.stack([self.lower, -self.upper]) / self.margin + 1.0
        self._slopes = np.stack([1 / self.margin, -1 / self.margin])

    def distances(self, q: np.ndarray) -> np.ndarray:
        """Distance of every joint to its nearer limit (n,) [rad or m]; negative beyond, infinite without."""
        return np.minimum(q - self.lower, self.upper - q)

    def shares(self, q: np.ndarray) -> np.ndarray:
        """How deep every joint is in the ramps before its lower and its upper limit, (2, n): 1 at the limit, or more.

        Ramps wider than half of a joint's range overlap.
        """
        return np.maximum(self._starts - self._slopes * q, 0.0)

    def ramps(self, shares: np.ndarray) -> np.ndarray:
        """f_i / F_max = clip((q_min + Δ − q)/Δ, 0, 1) − clip((q − q_max + Δ)/Δ, 0, 1), (n,)."""
        clipped = np.minimum(shares, 1.0)
        return clipped[0] - clipped[1]

    def torques(self, shares: np.ndarray) -> np.ndarray:
        """Minus the gradient of the energy, (n,) [N m or N]."""
        return self._torque * (shares[0] - shares[1])

    def energy(self, shares: np.ndarray) -> float:
        """Σ ½ k d² over the ramps [J]."""
        return float(np.vdot(shares, self._energy * shares))
