"""Distance of a ball around the end effector to obstacles."""

import numpy as np

from wsrender.documents.kinetostatics import ObstacleForce
from wsrender.errors import InputError
from wsrender.world.distances import FAR, NearestShape


class ObstacleDistance:
    """Signed distance of the tip's ball to the nearest obstacle; meshes count as their convex hulls.

    A point is moved, and the radius of its ball subtracted: directions are then well defined where the ball touches.
    Raises InputError for a mesh that encloses no volume.
    """

    def __init__(self, choice: ObstacleForce):
        self._radius = choice.tip_radius_m
        try:
            self._nearest = NearestShape(choice.items)
        except InputError as error:
            raise error.within("obstacles") from None

    def at(self, position: np.ndarray) -> tuple[float, np.ndarray]:
        """(distance [m] of the ball at ``position`` (3,), its gradient (3,)); negative where they overlap."""
        distance, gradient = self._nearest.at(position)
        return (distance if distance >= FAR else distance - self._radius), gradient
