"""Ramps before joint limits."""

import numpy as np

from wsrender.robots.chain import Chain
from wsrender.spec.kinetostatics import JointLimitForce


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
        self.stiffness = np.where(chain.revolute, turning, sliding)
        self._first, self._last = self.lower + self.margin, self.upper - self.margin  # where the ramps begin

    def distances(self, q: np.ndarray) -> np.ndarray:
        """Distance of every joint to its nearer limit (n,) [rad or m]; negative beyond, infinite without."""
        return np.minimum(q - self.lower, self.upper - q)

    def penetration(self, q: np.ndarray) -> np.ndarray:
        """How far every joint is in a ramp (n,) [rad or m]: positive at the lower limit, negative at the upper."""
        return np.maximum(self._first - q, 0.0) - np.maximum(q - self._last, 0.0)

    def ramps(self, penetration: np.ndarray) -> np.ndarray:
        """f_i = F_max (clip((q_min + Δ − q)/Δ, 0, 1) − clip((q − q_max + Δ)/Δ, 0, 1)), (n,) [N]."""
        return self.peak * np.maximum(np.minimum(penetration / self.margin, 1.0), -1.0)

    def torques(self, penetration: np.ndarray) -> np.ndarray:
        """Minus the gradient of the energy, (n,) [N m or N]."""
        return self.stiffness * penetration

    def energy(self, penetration: np.ndarray) -> float:
        """Σ ½ k d² [J]."""
        return 0.5 * float(self.stiffness @ penetration**2)
