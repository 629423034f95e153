"""The tip stands near an orientation: an axis of it near a direction, or its whole rotation near another."""

from dataclasses import dataclass

import numpy as np

from wsrender.pipeline.constraints.constraint import Structure
from wsrender.pipeline.constraints.region import Point
from wsrender.robots.kinematics import Kinematics
from wsrender.tolerances import TOLERANCES


@dataclass(frozen=True)
class Orientation:
    """Unit vectors ``axes`` in the tip's frame lie in the world as a turn of at most ``within`` [rad] puts ``toward``.

    One vector each: they enclose at most that angle. All three axes: the rotation from one frame to the other.

    With θ the angle, the squared distances of the vectors add up to 4 sin² θ/2 of one and 8 sin² θ/2 of three, which
    rounding leaves apart down to θ = 0, unlike a cosine.
    """

    axes: tuple[Point, ...]
    toward: tuple[Point, ...]
    within: float
    name: str = "orientation"
    keeps: frozenset[Structure] = frozenset()
    device: str = "orientation"

    def pack(self, chain: Kinematics, origin: np.ndarray, precision: str) -> np.ndarray:
        """The vectors in the tip's frame and in the world (3, 3) each, as columns, and the largest sum of squares.

        The angle is larger by what rounding may add: a tool may point along the axis of a narrow cone always.
        """
        return np.concatenate([_columns(self.axes), _columns(self.toward), [self._largest(precision)]])

    def _largest(self, precision: str) -> float:
        angle = self.within + TOLERANCES[precision].kinematics
        return (4.0 if len(self.axes) == 1 else 8.0) * np.sin(angle / 2) ** 2 if angle < np.pi else np.inf

    def host(self, q: np.ndarray, frames: np.ndarray) -> np.ndarray:
        """See `Constraint.host`."""
        apart = frames[:, :3, :3] @ np.transpose(self.axes) - np.transpose(self.toward)
        return ((apart**2).sum(axis=(1, 2)) > self._largest("float64")).astype(np.int8)


def _columns(vectors: tuple[Point, ...]) -> np.ndarray:
    """Up to three vectors as columns of a matrix (3, 3), row by row, (9,); columns of zeros after them."""
    matrix = np.zeros((3, 3))
    matrix[:, : len(vectors)] = np.transpose(vectors)
    return matrix.ravel()
