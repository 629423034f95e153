"""Surfaces that push: workspace boundary and obstacles, by their signed distance."""

import math
from typing import Protocol

import numpy as np


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
