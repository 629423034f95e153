"""The surface of a patch, and where lines meet it: a primitive, a critical set, or nothing but its own points."""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy.spatial import KDTree

from wsrender.geometry.spatial.critical_sets import CriticalSet, Meeting
from wsrender.geometry.spatial.primitives import Primitive

_ITERATIONS = 20
_CONVERGED = 1e-13  # relative to the size of the coordinates
_NEAR, _SMOOTH_ITERATIONS = 12, 3
_GRAZING = 0.1  # cosine between a line and a normal


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
        """By Newton's method on the distance along each line; NaN for one that runs along the surface."""
        s, x, near = np.zeros(len(origin)), origin, _CONVERGED * np.abs(origin).max(initial=1e-300)
        with np.errstate(divide="ignore", invalid="ignore"):
            for _ in range(_ITERATIONS):
                distance, gradient = self.primitive.distance(x)
                s = s - distance / (gradient * direction).sum(axis=1)
                x = origin + s[:, None] * direction
                if not (np.abs(distance) > near).any():
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


@dataclass(frozen=True, eq=False)
class SmoothPoints:
    """A smooth surface through points (K, 3) [m] with outward normals (K, 3), about ``width`` [m] apart.

    Points x of it are where the mean of ½ (n + nᵢ) · (x − pᵢ) over the points nearby is 0, n their mean normal: exact
    where a sphere or plane is seen from all sides.
    """

    points: np.ndarray
    normals: np.ndarray
    width: float

    def meet(self, origin: np.ndarray, direction: np.ndarray, start: np.ndarray) -> Meeting:
        """Where lines meet the surface within two cells; NaN where they hardly cross it."""
        s, n = np.zeros(len(origin)), np.full((len(origin), 3), np.nan)
        if not len(origin):
            return Meeting(s, n, start)
        # k as a list gives a column per neighbour.
        neighbours = list(range(1, min(_NEAR, len(self.points)) + 1))
        near = self._tree.query(origin, k=neighbours)[1]  # type: ignore[arg-type]
        p, normals = self.points[near], self.normals[near]
        facing = (normals * direction[:, None]).sum(axis=2)
        for _ in range(_SMOOTH_ITERATIONS):
            offset = origin[:, None] + s[:, None, None] * direction[:, None] - p
            squared = (offset**2).sum(axis=2) / self.width**2
            weight = np.exp(squared.min(axis=1, keepdims=True) - squared) * np.maximum(facing, 1e-9)
            n = (weight[:, :, None] * normals).sum(axis=1)
            n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300)
            off = (offset * (normals + n[:, None])).sum(axis=2) / 2
            value = (weight * off).sum(axis=1) / weight.sum(axis=1)
            s = s - value / np.maximum((n * direction).sum(axis=1), _GRAZING)
        good = (np.abs(s) <= 2 * self.width) & ((n * direction).sum(axis=1) > _GRAZING)
        return Meeting(np.where(good, s, np.nan), np.where(good[:, None], n, np.nan), start)

    @cached_property
    def _tree(self) -> KDTree:
        return KDTree(self.points)


def surface_of(primitive: Primitive | None, critical_set: CriticalSet | None, found: Surface) -> Surface:
    """The surface of a patch, by what is known of it."""
    if primitive is not None:
        return PrimitiveSurface(primitive)
    return critical_set if critical_set is not None else found
