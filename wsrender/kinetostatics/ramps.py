"""Ramps of force before limits: those of joints, and surfaces that push (workspace, obstacles) by signed distance."""

import math
from typing import Protocol

import numpy as np

from wsrender.documents.kinetostatics import JointLimitForce, ObstacleForce
from wsrender.errors import InputError
from wsrender.robot.surroundings import shapes_around
from wsrender.robots.chain import Chain
from wsrender.world.distances import FAR, NearestShape


class JointLimitRamp:
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


class SignedDistance(Protocol):
    """A distance [m], positive where one may be, and its gradient (3,), at a position (3,) in the world."""

    def at(self, position: np.ndarray) -> tuple[float, np.ndarray]:
        """(distance, gradient)."""
        ...


class SurfaceRamp:
    """A force along the gradient of a signed distance s, over a margin Δ before the surface.

    Normalised: F_max clip((Δ − s)/Δ, 0, 1) along the unit gradient; potential: U = ½ k max(Δ − s, 0)².
    """

    def __init__(self, distance: SignedDistance, margin: float, stiffness: float | None, peak: float):
        self.distance, self.margin, self.peak = distance, margin, peak
        self.stiffness = stiffness or peak / margin

    def share(self, distance: float) -> float:
        """Part of the full strength, 0 … 1."""
        return min(max((self.margin - distance) / self.margin, 0.0), 1.0)

    def normalised(self, distance: float, gradient: np.ndarray) -> np.ndarray:
        """The force (3,) [N] of the form "normalised"; none where the gradient vanishes."""
        size = math.sqrt(gradient.dot(gradient))
        return gradient * (self.peak * self.share(distance) / size) if size > 1e-9 else np.zeros(3)

    def potential(self, distance: float, gradient: np.ndarray) -> np.ndarray:
        """The force (3,) [N] of the form "potential"."""
        return gradient * (self.stiffness * max(self.margin - distance, 0.0))

    def energy(self, distance: float) -> float:
        """½ k max(Δ − s, 0)² [J]."""
        return 0.5 * self.stiffness * max(self.margin - distance, 0.0) ** 2


class ObstacleDistance:
    """Signed distance of the tip's ball to the nearest obstacle.

    A point is moved, and the radius of its ball subtracted: directions are then well defined where the ball touches.
    Raises InputError for a mesh that encloses no volume.
    """

    def __init__(self, choice: ObstacleForce):
        self._radius = choice.tip_radius_m
        try:
            self._nearest = NearestShape([each.shape for each in shapes_around(choice.items)])
        except InputError as error:
            raise error.within("obstacles") from None

    def at(self, position: np.ndarray) -> tuple[float, np.ndarray]:
        """(distance [m] of the ball at ``position`` (3,), its gradient (3,)); negative where they overlap."""
        distance, gradient = self._nearest.at(position)
        return (distance if distance >= FAR else distance - self._radius), gradient
