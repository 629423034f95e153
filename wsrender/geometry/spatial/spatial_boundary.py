"""The boundary of the positions that a spatial arm reaches: patches, edges, corners, a mesh, and the volume.

Where more than three joints move the end point the critical sets are not solved: `fitted_boundary` finds crossings by
inverse kinematics, and fits surfaces to them. Where the boundary crosses an edge of the lattice is bisected to 1e-6 of
the arm's size; a point just outside has its nearest reached point on the boundary, and the direction to it is the
normal.
"""

from dataclasses import dataclass
from math import ceil, log2
from typing import Protocol

import numpy as np
import trimesh

from wsrender.errors import ModelError
from wsrender.geometry.spatial.cells import CellLattice, LatticeCrossings, Membership, Report
from wsrender.geometry.spatial.critical_sets import NONE, CriticalSet, CrossedSurfaces, critical_sets, crossed_surfaces
from wsrender.geometry.spatial.edges import Corner, Edge, edges_and_corners
from wsrender.geometry.spatial.grown_patches import grown_patches
from wsrender.geometry.spatial.inverse import ThreeJointInverse
from wsrender.geometry.spatial.measures import PatchMeasures, joint_volume, measures
from wsrender.geometry.spatial.patch_mesh import PatchMesh, patch_mesh
from wsrender.geometry.spatial.patches import Patch, boundary_patches
from wsrender.geometry.spatial.spatial_arm import SpatialArm, spatial_arm
from wsrender.geometry.spatial.thin_parts import thin_parts
from wsrender.robots.chain import Chain

JOINTS = 3  # of the arms whose critical sets are solved
# Of patches, in their order and then again: Tableau's ten, told apart by most people with a colour vision deficiency.
COLORS = ("4e79a7", "f28e2b", "59a14f", "e15759", "76b7b2", "edc948", "b07aa1", "ff9da7", "9c755f", "bab0ac")
_SAMPLES = 24  # of each joint, for the box that the lattice fills
_DIFFERS = 3e-4  # of the volume: where patches enclose so much more or less, parts thinner than cells are looked for
_MISSED = 5e-5  # of the volume: what may be left in such parts
_FEWEST, _CELLS_PER_PLANE = 4, 4  # planes of cells more, at most: these, or one for so many cells across
_FLAT = 1e-9  # volume that the Jacobian spans, relative to that of its columns: rounding
BISECTED = 1e-6  # of the arm's size: what bisection leaves
TOLERANCE = 2e-6  # of the arm's size: the error of nearly all crossings, within which they are on a primitive
_OUTSIDE = 1e-4  # of the arm's size: how far outside the points are that give normals
_UNDECIDED = 1e-5  # of the arm's size: where no try is sure a crossing may be that much too far inside


@dataclass(frozen=True, eq=False)
class SpatialBoundary:
    """Patches, largest first, with their areas and the volume they enclose; edges; corners; the mesh.

    ``measures``: of the patches at the resolution of the cells, which are ``width`` [m] wide.
    """

    arm: SpatialArm
    patches: list[Patch]
    measures: PatchMeasures
    edges: list[Edge]
    corners: list[Corner]
    mesh: PatchMesh
    width: float


@dataclass(frozen=True, eq=False)
class CriticalBoundary(SpatialBoundary):
    """By critical sets; ``volume`` [m³] and ``volume_error`` by integration over the joints, whatever the cells."""

    volume: float
    volume_error: float


def solid_arm(chain: Chain) -> SpatialArm:
    """The arm of a chain, whose joints must move its end point through a volume. Raises ModelError."""
    arm = spatial_arm(chain)
    if arm.n < JOINTS:
        names = ", ".join(arm.names) or "none"
        raise ModelError(
            "robot", f"{arm.n} joints move the end point ({names}): it fills no volume; {JOINTS} or more must"
        )
    J = arm.motion(_samples(arm, 9))[1]
    sigma = np.linalg.svd(J, compute_uv=False)
    if sigma[:, 2].max() <= _FLAT * sigma[:, 0].max():
        raise ModelError(
            "robot",
            f"the joints {', '.join(arm.names)} move the end point on a surface or curve only: it fills no volume "
            '(arms in a plane: "planar_boundary")',
        )
    return arm


def spatial_boundary(arm: SpatialArm, cells: int, report: Report) -> CriticalBoundary:
    """Find the boundary of an arm of three joints, with so many ``cells`` along its longest edge.

    Where it encloses another volume than there is, planes of cells more go through the parts and gaps that passed
    between those of the lattice; of both boundaries that which encloses the better volume is taken.
    """
    inverse, sets = ThreeJointInverse(arm), critical_sets(arm)
    volume = joint_volume(inverse, report)
    lattice = lattice_around(arm, inverse.reaches, cells, report)
    found = _on_lattice(lattice, inverse, sets, volume, report)
    if _off(found) <= _DIFFERS:
        return found
    thin = thin_parts(sets, inverse, lattice, report)
    planes = thin.planes(lattice.width, _MISSED * found.volume, max(_FEWEST, cells // _CELLS_PER_PLANE))
    if not any(map(len, planes)):
        return found
    divided = lattice.divided(planes, inverse.reaches, report)
    return min(found, _on_lattice(divided, inverse, sets, volume, report), key=_off)


def _on_lattice(
    lattice: CellLattice,
    inverse: ThreeJointInverse,
    sets: list[CriticalSet],
    volume: tuple[float, float],
    report: Report,
) -> CriticalBoundary:
    crossings = lattice.crossings(inverse.reaches, report)
    loops = lattice.loops(crossings)
    crossed = crossed_surfaces(sets, inverse, crossings, lattice.width)
    patches, patch_of = boundary_patches(sets, crossed, loops, inverse.arm.size)
    mesh = patch_mesh(loops, crossed, patches, patch_of, lattice.width)
    measured = measures(mesh.curved, patches)
    edges, corners = edges_and_corners(mesh)
    return CriticalBoundary(inverse.arm, patches, measured, edges, corners, mesh, lattice.width, *volume)


def _off(found: CriticalBoundary) -> float:
    """How far what the patches enclose is from the volume, relative to that."""
    return abs(found.measures.volume - found.volume) / found.volume


def coloured(vertices: np.ndarray, faces: np.ndarray, patch: np.ndarray) -> trimesh.Trimesh:
    """The mesh of triangles (T, 3) with the number ``surface`` and the colour of their patches (T,)."""
    rgba = np.array([[*bytes.fromhex(color), 255] for color in COLORS], np.uint8)[patch % len(COLORS)]
    mesh = trimesh.Trimesh(vertices, faces, face_colors=rgba, process=False)
    mesh.face_attributes["surface"] = patch.astype(np.int32)
    mesh.metadata = {"frame": "world", "unit": "m", "up": "z"}
    return mesh


def lattice_around(arm: SpatialArm, reaches: Membership, cells: int, report: Report) -> CellLattice:
    """Cells around everything that is reached: around samples, and more until none at the border is reached."""
    points = arm.position(_samples(arm, _SAMPLES))
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.01 * float((high - low).max())
    while True:
        lattice = CellLattice.around(low - margin, high + margin, cells, reaches, report)
        if lattice.closed:
            return lattice
        margin *= 3


def _samples(arm: SpatialArm, count: int) -> np.ndarray:
    """Displacements (about count³, n), both ends of each joint included."""
    count = max(2, round(count ** (JOINTS / arm.n)))
    axes = [np.linspace(low, high, count) for low, high in zip(arm.low, arm.high, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, arm.n)


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
