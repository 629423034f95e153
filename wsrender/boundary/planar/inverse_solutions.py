"""How many postures of a two-joint arm reach a point: regions of one number, bounded by lines and arcs."""

from dataclasses import dataclass

import numpy as np

from wsrender.boundary.planar.arrangement import arrange
from wsrender.boundary.planar.distances import approaches
from wsrender.boundary.planar.exact_boundary import ExactBoundary
from wsrender.boundary.planar.loops import loops_of
from wsrender.boundary.planar.planar_set import PlanarSet
from wsrender.boundary.planar.sides import side_classes


@dataclass(frozen=True)
class SolutionRegions:
    """Where ``solutions`` postures, whole turns left aside, reach a point: area, and number of separate regions."""

    solutions: int
    area_m2: float
    regions: int


def solution_regions(boundary: ExactBoundary) -> list[SolutionRegions] | None:
    """Regions by number of inverse solutions, the fewest first; None unless two joints move the tip over an area.

    The number changes only where a candidate of the sweep lies: at a limit of the first joint, along the path of an
    end of the second joint's curve, and along singular positions, the paths of its stationary points.
    """
    reached = boundary.reached
    if len(boundary.chain.joints) != 2 or boundary.dimension != 2 or reached.candidates is None:
        return None
    size = boundary.chain.size
    found = arrange(reached.candidates.curves, size)
    counts = side_classes(found, lambda points, margin: _solutions(reached, points, margin), size)
    out = []
    for number in sorted(set(counts.ravel().tolist()) - {0}):
        rows = np.flatnonzero((counts[:, 0] == number) != (counts[:, 1] == number))
        sign = np.where(counts[rows, 0] == number, 1.0, -1.0)
        region = PlanarSet(2, found.pieces[rows], sign, found.vertices, found.ends[rows])
        loops = loops_of(region)
        area = sum(loop.signed_area for loop in loops)
        out.append(SolutionRegions(number, float(area), sum(not loop.hole for loop in loops)))
    return out


def _solutions(reached: PlanarSet, points: np.ndarray, margin: np.ndarray) -> np.ndarray:
    """How often the orbits of points (K, 2) cross the curve of the second joint, (K,).

    The points keep ``margin`` (K,) [m] from the candidates, so the orbits from the ends of the curve and from touching
    it, and their own ends from the curve.
    """
    joint, inner = reached.joint, reached.inner
    assert joint is not None and inner is not None
    orbits = joint.orbits(points)
    ways = approaches(orbits, inner.curves)
    if not orbits.arc[0] and not inner.curves.arc[0]:
        ways = ways[:1]  # two lines cross once
    return sum((distance[:, 0] < margin / 4).astype(np.int64) for distance in ways)  # type: ignore[return-value]
