"""Where points of space appear in a picture."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Camera:
    """A parallel projection: looks along ``forward`` at ``center`` [m], ``up`` is upright in the picture.

    ``half_height`` [m] is half the height of what the picture shows.
    """

    center: np.ndarray
    forward: np.ndarray
    up: np.ndarray
    half_height: float

    def to_picture(self, points: np.ndarray) -> np.ndarray:
        """Where points (N, 3) [m] appear, (N, 2): right and up of the middle, in half heights of the picture."""
        right = np.cross(self.forward, self.up)
        return (points - self.center) @ np.stack([right, self.up], axis=1) / self.half_height

    def nearness(self, points: np.ndarray) -> np.ndarray:
        """How much nearer to the eye than the centre points (N, 3) are, (N,) [m]."""
        return -(points - self.center) @ self.forward
