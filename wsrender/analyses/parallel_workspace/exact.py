"""The result of a ``parallel_workspace`` job by the methods exact and solids."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np
import trimesh

from wsrender.analyses.contract import Draft
from wsrender.analyses.headline import headline
from wsrender.analyses.parallel_workspace.result import mechanism_entries, skeleton_at
from wsrender.analyses.partial_result import PartialResult
from wsrender.geometry.surfaces import surface_entry
from wsrender.mechanisms.ball_region import BallRegion, region_of, surface_table
from wsrender.mechanisms.exact import ExactWorkspace
from wsrender.mechanisms.solids import solid_workspace
from wsrender.notices import Notice
from wsrender.volume.table import Table

SAGITTA = 1.5e-4  # of a ball's radius: between the triangles of its mesh and the sphere, of 20,480 triangles
COARSE = 0.05  # relative error by that which is warned of

if TYPE_CHECKING:
    from wsrender.analyses.parallel_workspace.run import ParallelWorkspaceAnalysis


def boundary_partial(plan: "ParallelWorkspaceAnalysis") -> PartialResult:
    """Mesh in the base frame, vertices of the workspace, and the numbers."""
    region = region_of(plan.mechanism, plan.orientations.rotations[0])
    if plan.job.method == "solids":
        mesh = solid_workspace(region)
        about: dict[str, Any] = {
            "volume_m3": float(mesh.volume) if len(mesh.faces) else 0.0,
            "area_m2": float(mesh.area),
        }
        corners = np.zeros((0, 3))
        counted = np.bincount(mesh.face_attributes["surface"], mesh.area_faces, _surfaces(region))
    else:
        found = ExactWorkspace.of(region)
        mesh, corners, counted = found.mesh, found.vertices, found.measures.area[0]
        about = {"volume_m3": found.volume_m3, "area_m2": found.area_m2, "topology": asdict(found.topology)}
        T = plan.mechanism.T_world_base
        sides = found.bounds_along(T[:3, :3])  # a row is an axis of the world in the base frame
        if sides is not None:
            about["bounds_m"] = {
                name: (side + T[:3, 3]).tolist() for name, side in zip(("lower", "upper"), sides, strict=True)
            }
    arrays = {
        "vertices": np.asarray(mesh.vertices, np.float64),
        "faces": np.asarray(mesh.faces, np.int64),
        "surface": mesh.face_attributes["surface"],
        "areas": counted,
        "corners": corners,
    }
    return PartialResult(arrays, about)


def _headline(method: str, volume_m3: float) -> dict[str, Any]:
    """The exact volume; that of meshes has no interval."""
    if method == "exact":
        return headline("volume", volume_m3, [volume_m3, volume_m3])
    return headline("volume", volume_m3, None, "balls are meshes of triangles: there is no interval")


def _notices(region: BallRegion, about: Mapping[str, Any], method: str) -> Iterator[Notice]:
    """What meshes of balls hide: thin workspaces lie within the error of their triangles."""
    error = about["area_m2"] * SAGITTA * max(region.inside_radii, default=0.0)
    if method == "solids" and error > COARSE * about["volume_m3"]:
        yield Notice(
            "coarse_meshes",
            f"the workspace is thin: its {about['volume_m3']:.3g} m³ may be wrong by {error:.2g} m³, for the balls are "
            "meshes of triangles",
            'use the method "exact"',
            "method",
        )


def _surfaces(region: BallRegion) -> int:
    """How many surfaces may bound a region."""
    return len(region.inside_radii) + len(region.outside_radii) + len(region.sides_of_box()[1])


def boundary_result(plan: "ParallelWorkspaceAnalysis", partial: PartialResult) -> Draft:
    """Volume, area, topology and mesh of the workspace."""
    about, method = partial.facts, plan.job.method
    document = mechanism_entries(plan) | {
        "sampling": {"method": method},
        "volume_m3": {method: about["volume_m3"]},
        "area_m2": about["area_m2"],
    }
    region = region_of(plan.mechanism, plan.orientations.rotations[0])
    tables = {"surfaces": surface_table(region, partial["areas"], plan.mechanism.T_world_base)}
    meshes, skeleton = {}, None
    if len(partial["faces"]):
        metadata = {"frame": "world", "unit": "m", "up": "z"}
        mesh = trimesh.Trimesh(
            partial["vertices"],
            partial["faces"],
            face_attributes={"surface": partial["surface"]},
            process=False,
            metadata=metadata,
        )
        mesh.apply_transform(plan.mechanism.T_world_base)
        meshes["workspace"] = mesh
        lower, upper = mesh.bounds
        document["bounds_m"] = about.get("bounds_m") or {"lower": lower.tolist(), "upper": upper.tolist()}
        document["surfaces"] = {"workspace": surface_entry("workspace", mesh)}
        skeleton = skeleton_at(plan, mesh.center_mass)
    else:
        document["empty"] = "no position is reached: the spheres that bound the workspace enclose none"
    if method == "exact":
        document["topology"] = about["topology"]
        T = plan.mechanism.T_world_base
        tables["vertices"] = Table({"position": partial["corners"] @ T[:3, :3].T + T[:3, 3]}, {"position": "m"})
    return Draft(
        document,
        _headline(method, about["volume_m3"]),
        _notices(region, about, method),
        meshes=meshes,
        tables=tables,
        skeleton=skeleton,
    )
