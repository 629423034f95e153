"""The boundary of an arm whose critical sets are not solved: crossings found by inverse kinematics, and fits to them.

More than three joints move the end point. Where the boundary crosses an edge of the lattice is bisected to 1e-6 of the
arm's size; a point just outside has its nearest reached point on the boundary, and the direction to it is the normal.
"""

from math import ceil, log2
from typing import Protocol

import numpy as np

from wsrender.geometry.spatial.cells import LatticeCrossings, Report
from wsrender.geometry.spatial.crossed_surfaces import NONE, CrossedSurfaces
from wsrender.geometry.spatial.edges import edges_and_corners
from wsrender.geometry.spatial.grown_patches import grown_patches
from wsrender.geometry.spatial.measures import measures
from wsrender.geometry.spatial.patch_mesh import patch_mesh
from wsrender.geometry.spatial.spatial_arm import SpatialArm
from wsrender.geometry.spatial.spatial_boundary import SpatialBoundary, lattice_around

BISECTED = 1e-6  # of the arm's size: what bisection leaves
TOLERANCE = 2e-6  # of the arm's size: the error of nearly all crossings, within which they are on a primitive
_OUTSIDE = 1e-4  # of the arm's size: how far outside the points are that give normals
_UNDECIDED = 1e-5  # of the arm's size: where no try is sure a crossing may be that much too far inside


class Reached(Protocol):
    """What an arm reaches, decided by inverse kinematics."""

    def reaches(self, points: np.ndarray) -> np.ndarray:
        """Whether points (N, 3) [m] are reached, (N,) bool; those that are undecided count as not."""
        ...

    def nearest(self, points: np.ndarray) -> np.ndarray:
        """The reached points (N, 3) that are nearest to points (N, 3) [m]."""
        ...


def fitted_boundary(arm: SpatialArm, reached: Reached, cells: int, report: Report) -> SpatialBoundary:
    """Find the boundary with so many ``cells`` along its longest edge; ``report(points tested)``."""
    lattice = lattice_around(arm, reached.reaches, cells, report)
    bisections = ceil(log2(max(2.0, lattice.width / (BISECTED * arm.size))))
    crossings = lattice.crossings(reached.reaches, report, bisections)
    loops = lattice.loops(crossings)
    crossed = _crossed(arm, crossings, reached)
    report(len(crossings))
    patches, patch_of, crossed = grown_patches(crossed, loops, TOLERANCE * arm.size, lattice.width)
    mesh = patch_mesh(loops, crossed, patches, patch_of, lattice.width)
    edges, corners = edges_and_corners(mesh, 10 * TOLERANCE)
    return SpatialBoundary(arm, patches, measures(mesh.curved, patches), edges, corners, mesh, lattice.width)


def _crossed(arm: SpatialArm, crossings: LatticeCrossings, reached: Reached) -> CrossedSurfaces:
    """Points and normals of the crossings, from the nearest reached points to points a little outside."""
    middle, outward = (crossings.inside + crossings.outside) / 2, crossings.outward
    off, left = _OUTSIDE * arm.size, _UNDECIDED * arm.size
    foot = reached.nearest(middle + off * outward)
    away = middle + off * outward - foot
    distance = np.linalg.norm(away, axis=1)
    normal = away / np.maximum(distance, 1e-300)[:, None]
    slope = (normal * outward).sum(axis=1)
    # The boundary crosses the edge: nothing farther off is nearest. A plane of no slope has the edge in it.
    good = (distance <= off + left) & (slope > 1e-3)
    # The plane that touches there crosses the edge within the square of the way to it, nearer than bisection.
    along = ((foot - middle) * normal).sum(axis=1) / np.where(good, slope, 1.0)
    along = np.where(good & (np.abs(along) <= left), along, 0.0)
    normal = np.where(good[:, None], normal, outward)
    nowhere = np.zeros((len(crossings), arm.n))
    return CrossedSurfaces(np.full(len(crossings), NONE), middle + along[:, None] * outward, normal, nowhere)
