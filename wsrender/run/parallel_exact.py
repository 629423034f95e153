"""The result of a ``parallel_workspace`` job by the methods exact and solids."""

import json
import time
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np
import trimesh

from wsrender.boundary.surfaces import surface_entry
from wsrender.errors import InputError
from wsrender.parallel.ball_region import BallRegion, ball_region
from wsrender.parallel.exact import ExactWorkspace
from wsrender.parallel.mechanism import Mechanism
from wsrender.parallel.solids import solid_workspace
from wsrender.result import Result
from wsrender.run.parallel_result import mechanism_document, skeleton_at
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table

if TYPE_CHECKING:
    from wsrender.run.parallel import Arrays, ParallelPlan


def region_of(mechanism: Mechanism, rotation: np.ndarray) -> BallRegion:
    """The ball region of a job; InputError where other surfaces bound the workspace, naming the remedy."""
    try:
        return ball_region(mechanism, rotation)
    except InputError as error:
        message = f'{error.message}; use the method "grid" or "grid_by_subsystem"'
        raise InputError(f"mechanism.{error.field}", message) from None


def boundary_partial(plan: "ParallelPlan") -> "Arrays":
    """Mesh in the base frame, vertices of the workspace, and the numbers as JSON."""
    region = region_of(plan.mechanism, plan.orientations.rotations[0])
    if plan.job.method == "solids":
        mesh = solid_workspace(region)
        about: dict[str, Any] = {
            "volume_m3": float(mesh.volume) if len(mesh.faces) else 0.0,
            "area_m2": float(mesh.area),
        }
        corners = np.zeros((0, 3))
    else:
        found = ExactWorkspace.of(region)
        mesh, corners = found.mesh, found.vertices
        about = {"volume_m3": found.volume_m3, "area_m2": found.area_m2, "topology": asdict(found.topology)}
        T = plan.mechanism.T_world_base
        sides = found.bounds_along(T[:3, :3])  # a row is an axis of the world in the base frame
        if sides is not None:
            about["bounds_m"] = {
                name: (side + T[:3, 3]).tolist() for name, side in zip(("lower", "upper"), sides, strict=True)
            }
    return {
        "about": np.array(json.dumps(about)),
        "vertices": np.asarray(mesh.vertices, np.float64),
        "faces": np.asarray(mesh.faces, np.int64),
        "corners": corners,
    }


def boundary_result(plan: "ParallelPlan", partial: "Arrays", seconds: dict[str, float]) -> Result:
    """Volume, area, topology and mesh of the workspace."""
    started = time.perf_counter()
    about, method = json.loads(str(partial["about"])), plan.job.method
    document = mechanism_document(plan) | {
        "sampling": {"method": method},
        "volume_m3": {method: about["volume_m3"]},
        "area_m2": about["area_m2"],
    }
    tables, meshes, sample, skeleton = {}, {}, None, None
    if len(partial["faces"]):
        metadata = {"frame": "world", "unit": "m", "up": "z"}
        mesh = trimesh.Trimesh(partial["vertices"], partial["faces"], process=False, metadata=metadata)
        mesh.apply_transform(plan.mechanism.T_world_base)
        meshes["workspace"] = mesh
        lower, upper = mesh.bounds
        document["bounds_m"] = about.get("bounds_m") or {"lower": lower.tolist(), "upper": upper.tolist()}
        document["surfaces"] = {"workspace": surface_entry("workspace", mesh)}
        sample = DistributionMap(np.asarray(mesh.vertices), {})
        skeleton = skeleton_at(plan, mesh.center_mass)
    else:
        document["empty"] = "no position is reached: the spheres that bound the workspace enclose none"
    if method == "exact":
        document["topology"] = about["topology"]
        T = plan.mechanism.T_world_base
        tables["vertices"] = Table({"position": partial["corners"] @ T[:3, :3].T + T[:3, 3]}, {"position": "m"})
    document["timing_s"] = {**seconds, "finish": time.perf_counter() - started}
    return Result(document, sample=sample, meshes=meshes, tables=tables, skeleton=skeleton)
