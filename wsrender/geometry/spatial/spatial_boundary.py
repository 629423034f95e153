"""The boundary of the positions that a spatial arm reaches: patches, edges, corners, a mesh, and the volume."""

from dataclasses import dataclass

import numpy as np
import trimesh

from wsrender.errors import ModelError
from wsrender.geometry.spatial.cells import CellLattice, Membership, Report
from wsrender.geometry.spatial.critical_sets import CriticalSet, critical_sets
from wsrender.geometry.spatial.crossed_surfaces import crossed_surfaces
from wsrender.geometry.spatial.edges import Corner, Edge, edges_and_corners
from wsrender.geometry.spatial.inverse import ThreeJointInverse
from wsrender.geometry.spatial.joint_volume import joint_volume
from wsrender.geometry.spatial.measures import PatchMeasures, measures
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
