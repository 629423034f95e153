"""The surface of a patch, and where lines meet it: a primitive, a critical set, or nothing but its own points."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from wsrender.boundary.spatial.critical_sets import CriticalSet, Meeting
from wsrender.boundary.spatial.primitives import Primitive

_ITERATIONS = 20
_CONVERGED = 1e-13  # relative to the size of the coordinates


class Surface(Protocol):
    """Something that lines meet."""

    def meet(self, origin: np.ndarray, direction: np.ndarray, start: np.ndarray) -> Meeting:
        """Where lines meet the surface, near ``origin`` (N, 3); ``start`` (N, n): displacements at points nearby."""
        ...


@dataclass(frozen=True, eq=False)
class PrimitiveSurface:
    """A plane, sphere, cylinder, cone or torus."""

    primitive: Primitive

    def meet(self, origin: np.ndarray, direction: np.ndarray, start: np.ndarray) -> Meeting:
        """By Newton's method on the distance along each line."""
        s = np.zeros(len(origin))
        x = origin
        for _ in range(_ITERATIONS):
            distance, gradient = self.primitive.distance(x)
            slope = (gradient * direction).sum(axis=1)
            with np.errstate(divide="ignore", invalid="ignore"):
                s = s - distance / slope
            x = origin + s[:, None] * direction
            if not len(x) or np.nanmax(np.abs(distance)) <= _CONVERGED * max(np.abs(x).max(), 1e-300):
                break
        distance, gradient = self.primitive.distance(x)
        good = np.abs(distance) <= 10 * _CONVERGED * np.maximum(np.abs(x).max(axis=1), 1e-300)
        gradient = gradient * np.sign((gradient * direction).sum(axis=1))[:, None]
        return Meeting(np.where(good, s, np.nan), np.where(good[:, None], gradient, np.nan), start)


@dataclass(frozen=True, eq=False)
class FoundPoints:
    """A surface of which single points are known only: a line meets it where it starts."""

    def meet(self, origin: np.ndarray, direction: np.ndarray, start: np.ndarray) -> Meeting:
        """At distance 0; the direction is the normal."""
        return Meeting(np.zeros(len(origin)), direction, start)


def surface_of(primitive: Primitive | None, critical_set: CriticalSet | None) -> Surface:
    """The surface of a patch, by what is known of it."""
    if primitive is not None:
        return PrimitiveSurface(primitive)
    return critical_set if critical_set is not None else FoundPoints()
