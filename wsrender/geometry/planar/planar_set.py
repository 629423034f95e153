"""A set of points of a plane, by its boundary of lines and arcs."""

from dataclasses import dataclass, field

import numpy as np

from wsrender.geometry.planar.candidates import Candidates
from wsrender.geometry.planar.curves import Curves
from wsrender.geometry.planar.distances import orbit_distances
from wsrender.geometry.planar.motion import PlanarJoint
from wsrender.geometry.planar.winding import winding_numbers


@dataclass(frozen=True)
class Span:
    """A part of a piece's parameter range and the candidates (rows) that made it."""

    low: float
    high: float
    made_by: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class PlanarSet:
    """What the part of a chain from a joint to the tip reaches: a point, a curve or a region.

    ``curves`` (P,) are the boundary of a region, a curve itself, or none. ``sign`` (P,) is 1 where the region lies on
    the left of increasing parameter, −1 where on the right. ``vertices`` (V, 2) [m] are the boundary's corners, the
    ends of a curve, or the point; ``ends`` (P, 2) are rows of them, −1 where a circle has none. ``spans`` (P lists)
    say how the curves came about: from the set ``inner`` that ``joint`` moves.
    """

    dimension: int
    curves: Curves
    sign: np.ndarray
    vertices: np.ndarray
    ends: np.ndarray
    spans: list[list[Span]] = field(default_factory=list)
    candidates: Candidates | None = None
    joint: PlanarJoint | None = None
    inner: "PlanarSet | None" = None

    @classmethod
    def of_point(cls, point: np.ndarray, **made: "PlanarJoint | PlanarSet | None") -> "PlanarSet":
        """A single point (2,) [m]."""
        return cls(0, Curves.none(), np.empty(0), point[None], np.empty((0, 2), np.int64), **made)  # type: ignore[arg-type]

    @property
    def piece_of_vertex(self) -> np.ndarray:
        """A piece that ends at each vertex, (V,); −1 of the point."""
        out = np.full(len(self.vertices), -1)
        for k, ends in enumerate(self.ends):
            out[ends[ends >= 0]] = k
        return out

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether points (K, 2) that lie on no boundary piece lie in the region, (K,)."""
        if self.dimension < 2:
            return np.zeros(len(points), bool)
        return winding_numbers(points, self.curves, self.sign) > 0.5

    def met_by(self, joint: PlanarJoint, points: np.ndarray, margin: np.ndarray) -> np.ndarray:
        """Whether ``joint`` moves some point of the set to each of ``points`` (K, 2): their orbits meet the set.

        The points keep ``margin`` (K,) [m] from the boundary of the moved set: their orbits, moved rigidly, keep it
        from this set too if they miss it.
        """
        orbits = joint.orbits(points)
        met = self.contains(orbits.start)
        rest = np.flatnonzero(~met)
        if len(rest):
            met[rest] = orbit_distances(orbits[rest], self.curves) < margin[rest] / 2
        return met
