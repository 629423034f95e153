"""How many postures of a two-joint arm reach a point: regions of one number, bounded by lines and arcs."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from wsrender.errors import NumericalError
from wsrender.geometry.planar.arrangement import arrange, told_apart
from wsrender.geometry.planar.curves import Curves
from wsrender.geometry.planar.distances import approaches, point_distances
from wsrender.geometry.planar.loops import closes, loops_of
from wsrender.geometry.planar.planar_set import PlanarSet
from wsrender.geometry.planar.sides import Classes, side_classes


@dataclass(frozen=True)
class NumberRegions:
    """Where a number of points (K, 2) is ``number``: area, and how many separate regions."""

    number: int
    area_m2: float
    regions: int


def regions_by_number(curves: Curves, numbers: Classes, size: float) -> list[NumberRegions]:
    """Regions by a number of points that changes on curves only; the least number above 0 first.

    ``numbers`` as for `side_classes`. Raises NumericalError where curves are too close to be told apart.
    """
    return told_apart(partial(_regions, curves, numbers), size)


def _regions(curves: Curves, numbers: Classes, size: float) -> list[NumberRegions]:
    found = arrange(curves, size)
    counts = side_classes(found, numbers, size)
    out = []
    for number in sorted(set(counts.ravel().tolist()) - {0}):
        rows = np.flatnonzero((counts[:, 0] == number) != (counts[:, 1] == number))
        sign, ends = np.where(counts[rows, 0] == number, 1.0, -1.0), found.ends[rows]
        if not closes(ends, sign, len(found.vertices)):
            raise NumericalError(f"the regions of {number} do not close: curves nearly coincide")
        loops = loops_of(PlanarSet(2, found.pieces[rows], sign, found.vertices, ends))
        area = sum(loop.signed_area for loop in loops)
        out.append(NumberRegions(number, float(area), sum(not loop.hole for loop in loops)))
    return out


def solution_regions(reached: PlanarSet, size: float) -> list[NumberRegions]:
    """Regions by number of inverse solutions, whole turns left aside, of a set that two joints sweep.

    The number changes only where a candidate of the sweep lies: at a limit of the first joint, along the path of an
    end of the second joint's curve, and along singular positions, the paths of its stationary points.
    """
    assert reached.candidates is not None
    curves = reached.candidates.curves
    return regions_by_number(curves, lambda points, margin: ways(reached, points, margin).sum(axis=1), size)


def inverse_solutions(reached: PlanarSet, points: np.ndarray) -> np.ndarray:
    """Number of inverse solutions at points (K, 2), (K,); on a curve where it changes, that of either side."""
    return ways(reached, points, candidate_distances(reached, points)).sum(axis=1)


def candidate_distances(reached: PlanarSet, points: np.ndarray) -> np.ndarray:
    """Distance of points (K, 2) to the candidates of a set, (K,) [m]."""
    assert reached.candidates is not None
    return point_distances(points, reached.candidates.curves).min(axis=1)


def ways(reached: PlanarSet, points: np.ndarray, margin: np.ndarray) -> np.ndarray:
    """Whether the orbits of points (K, 2) cross the curve of the second joint, each of two ways, (K, 2).

    The ways are the two postures of an elbow: each goes on where a point moves, and they meet in singular positions.
    The points keep ``margin`` (K,) [m] from the candidates, so the orbits from the ends of the curve and from touching
    it, and their own ends from the curve.
    """
    joint, inner = reached.joint, reached.inner
    assert joint is not None and inner is not None
    orbits = joint.orbits(points)
    met = np.stack([distance[:, 0] < margin / 4 for distance in approaches(orbits, inner.curves)], axis=1)
    if not orbits.arc[0] and not inner.curves.arc[0]:
        met[:, 1] = False  # two lines cross once
    return met
