"""The analysis ``boundary_patches``: the boundary of a spatial arm in patches, with edges, corners and a mesh."""

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.boundary_patches.job import BoundaryPatchesJob
from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import DOCUMENT_BYTES, WRITTEN_PER_S, Asks, Cost, pictures_cost
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import headline
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.refined import measure_entry, volume_entry
from wsrender.geometry.spatial.critical_sets import CriticalSet
from wsrender.geometry.spatial.edges import Corner, Edge
from wsrender.geometry.spatial.patches import Patch
from wsrender.geometry.spatial.spatial_arm import SpatialArm
from wsrender.geometry.spatial.spatial_boundary import (
    JOINTS,
    TOLERANCE,
    CriticalBoundary,
    SpatialBoundary,
    coloured,
    fitted_boundary,
    solid_arm,
    spatial_boundary,
)
from wsrender.geometry.spatial.surfaces import Primitive
from wsrender.notices import Notice
from wsrender.pipeline.sampling import held_chain
from wsrender.reach.measure_refinement import refined_measure
from wsrender.reach.moving_joints import moving_joints
from wsrender.reach.reached_points import ReachedPoints
from wsrender.robot import model_chain
from wsrender.robots.chain import Chain
from wsrender.volume.table import Table

POINTS_PER_S = 1e5  # inverse kinematics on one CPU core
POINTS_PER_CELL = 40.0  # of the surface: bisections of the edges that it crosses
INTEGRATED = 1e5  # points of the volume's integral, or of its estimate, about
VOLUME_TOLERANCE = 0.005  # of the volume that is estimated beside a fitted boundary
ENCLOSED_ERROR = 1e-3  # of the volume: the patches of arms without thin parts were off by 1e-9 … 7e-4
BYTES_PER_CORNER, BYTES_PER_CELL = 40.0, 4.2e3  # of the lattice; of the surface, with its triangles

MESH_BYTES = 100.0  # of a cell of the surface in ply and glb


class BoundaryPatchesAnalysis(Analysis):
    """A planned ``boundary_patches`` job: one shard of about as many points as will be tested."""

    job: BoundaryPatchesJob

    def prepare(self, device: str, target: str) -> Settled:
        """Raises ModelError where the joints do not move the end effector through a volume.

        InputError for a robot without a model, unknown joints to lock or values beyond their limits; ResourceError.
        """
        _ = self.arm
        return Settled(device, target, ((0, self._points),))

    @cached_property
    def chain(self) -> Chain:
        """Of the joints that move the end point."""
        return moving_joints(held_chain(model_chain(self.robot), self.job.locked))[0]

    @cached_property
    def arm(self) -> SpatialArm:
        """Its geometry."""
        return solid_arm(self.chain)

    @property
    def _points(self) -> int:
        cells = self.job.cells
        return int(cells**3 + POINTS_PER_CELL * 6 * cells**2 + INTEGRATED)

    @property
    def cost(self) -> Cost:
        """Points to be tested, bytes of lattice and mesh, seconds."""
        points, cells = float(self._points), self.job.cells
        held = BYTES_PER_CORNER * cells**3 + BYTES_PER_CELL * 6 * cells**2
        drawn, seconds = pictures_cost("patches")
        files = DOCUMENT_BYTES + drawn + MESH_BYTES * 6 * cells**2
        seconds += points / POINTS_PER_S + files / WRITTEN_PER_S
        return Cost(points, held, files, seconds, Asks("cells", "take fewer"))

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Patches, edges and corners, and the mesh."""
        tested = 0

        def report(points: int) -> None:
            nonlocal tested
            tested += points
            tell(min(tested, self._points))

        found, about = self._found(report, execution.threads)
        edges = [np.full(len(edge.points), k) for k, edge in enumerate(found.edges)]
        arrays = {
            "vertices": found.mesh.vertices,
            "faces": found.mesh.faces,
            "patch": found.mesh.patch,
            "edge": np.concatenate([*edges, np.empty(0, int)]).astype(np.int64),
            "edge_points": np.concatenate([*(edge.points for edge in found.edges), np.empty((0, 3))]),
        }
        return PartialResult(arrays, _about(found) | about)

    def _found(self, report: Callable[[int], None], threads: int | None) -> tuple[SpatialBoundary, dict[str, Any]]:
        """The boundary by critical sets, of arms of more joints by fits, and what the document says of either."""
        if self.arm.n == JOINTS:
            exact = spatial_boundary(self.arm, self.job.cells, report)
            return exact, _integrated(exact)
        reached = ReachedPoints(self.chain, self.device, threads)
        fitted = fitted_boundary(self.arm, reached, self.job.cells, report)
        decided = 0

        def volume_progress(done: int, _: int) -> None:
            nonlocal decided
            report(max(done - decided, 0))
            decided = max(done, decided)

        measure = refined_measure(
            self.chain, VOLUME_TOLERANCE, device=self.device, threads=threads, progress=volume_progress
        )
        refined = volume_entry(measure_entry(measure, VOLUME_TOLERANCE))
        volumes = {"enclosed": fitted.measures.volume, "refined": refined}
        return fitted, {
            "volume_m3": volumes,
            "fit_tolerance_m": TOLERANCE * self.arm.size,
            "undecided": reached.undecided,
        }

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """Tables ``patches``, ``edges``, ``corners`` and ``edge_points``; the mesh ``patches``, a colour each."""
        about = dict(partial.facts)
        meshes = {}
        if len(partial["faces"]):  # none where all that is reached is thinner than a cell
            mesh = meshes["patches"] = coloured(partial["vertices"], partial["faces"], partial["patch"])
            about["mesh"] = {
                "mesh": "patches",
                "triangles": len(mesh.faces),
                "volume_m3": float(mesh.volume),
                "watertight": bool(mesh.is_watertight),
            }
        tables = {
            "patches": _patch_table(about["patches"]),
            "edges": _edge_table(about["edges"]),
            "corners": _corner_table(about["corners"]),
            "edge_points": Table({"edge": partial["edge"], "position": partial["edge_points"]}, {"position": "m"}),
        }
        tables = {name: table for name, table in tables.items() if len(table)}
        return Draft(about, _headline(about), _notices(about), meshes=meshes, tables=tables)


def _about(found: SpatialBoundary) -> dict[str, Any]:
    return {
        "joints": list(found.arm.names),
        "cell_width_m": found.width,
        "patches": [
            _patch_entry(patch, float(area)) for patch, area in zip(found.patches, found.measures.areas, strict=True)
        ],
        "edges": [_edge_entry(edge) for edge in found.edges],
        "corners": [_corner_entry(corner) for corner in found.corners],
    }


def _integrated(found: CriticalBoundary) -> dict[str, Any]:
    return {
        "volume_m3": {"integrated": found.volume, "enclosed": found.measures.volume},
        "integration_error_m3": found.volume_error,
    }


def _headline(about: dict[str, Any]) -> dict[str, Any]:
    """The volume by integration and what that may be off, or the refined one; whatever the cells."""
    volumes = about["volume_m3"]
    if "integrated" not in volumes:
        return headline("volume", volumes["refined"]["value"], volumes["refined"]["ci95"])
    value, error = volumes["integrated"], about["integration_error_m3"]
    return headline("volume", value, (value - error, value + error))


def _notices(about: dict[str, Any]) -> Iterator[Notice]:
    """That the patches enclose another volume than there is."""
    enclosed, known = about["volume_m3"]["enclosed"], _headline(about)
    low, high = known["ci95"]
    off = max(low - enclosed, enclosed - high, 0.0) / known["value"]
    if off > ENCLOSED_ERROR:
        yield Notice(
            "enclosed_differs",
            f"the patches enclose {enclosed:.5g} m³, {100 * (enclosed / known['value'] - 1):+.1f} % beside the volume "
            f"of {known['value']:.5g} m³: they miss parts and gaps that are thinner than a cell, "
            f"{about['cell_width_m']:.3g} m, such as where a joint turns a little beyond a singular posture",
            "take the headline for the volume; more cells bring the patches nearer to it",
            "cells",
        )


def _patch_entry(patch: Patch, area: float) -> dict[str, Any]:
    """Kind and numbers of a patch; of a free form, of the primitive that is nearest to it, and how far it is off."""
    fit = patch.fit
    entry: dict[str, Any] = {"kind": patch.kind, "method": patch.method}
    if fit is not None and patch.exact:
        entry |= _primitive_entry(fit.primitive)
    entry |= {
        "generated_by": [_generator_entry(each) for each in patch.sets],
        "area_m2": area,
        "residual_m": None if fit is None else fit.residual,
        "points_fitted": len(patch.rows),
    }
    if fit is not None and not patch.exact:
        entry["nearest"] = {"kind": fit.primitive.kind, **_primitive_entry(fit.primitive)}
    return entry


def _generator_entry(each: CriticalSet) -> dict[str, Any]:
    free = [each.arm.names[i] for i in each.free]
    return {"limits": [stop.text for stop in each.stops], "free": free, "singular": each.singular}


def _primitive_entry(primitive: Primitive) -> dict[str, Any]:
    names = {"plane": ("point_m", "normal"), "cone": ("apex_m", "axis"), "cylinder": ("point_m", "axis")}
    point, axis = names.get(primitive.kind, ("center_m", "axis"))
    numbers = {
        "radius_m": primitive.radius,
        "tube_radius_m": primitive.tube_radius,
        "half_angle_rad": primitive.half_angle,
    }
    entry: dict[str, Any] = {point: primitive.point.tolist()}
    if primitive.axis is not None:
        entry[axis] = primitive.axis.tolist()
    return entry | {name: value for name, value in numbers.items() if value}


def _edge_entry(edge: Edge) -> dict[str, Any]:
    entry: dict[str, Any] = {
        "kind": edge.kind,
        "patches": list(edge.patches),
        "corners": list(edge.corners),
        "length_m": edge.length,
        "angle_between_normals_rad": list(edge.angle),
        "residual_m": edge.residual,
    }
    if edge.center is not None and edge.axis is not None:
        entry |= {"center_m": edge.center.tolist(), "axis": edge.axis.tolist(), "radius_m": edge.radius}
    return entry


def _corner_entry(corner: Corner) -> dict[str, Any]:
    return {"position_m": corner.point.tolist(), "patches": list(corner.patches)}


def _patch_table(patches: list[dict[str, Any]]) -> Table:
    """A row per patch, in the order of the document; NaN where a kind has no such number."""
    points = [patch.get("center_m") or patch.get("point_m") or patch.get("apex_m") or [np.nan] * 3 for patch in patches]
    axes = [patch.get("axis") or patch.get("normal") or [np.nan] * 3 for patch in patches]
    numbers = ("radius_m", "tube_radius_m", "half_angle_rad", "area_m2", "residual_m")
    columns = {
        "patch": np.arange(len(patches)),
        "kind": _texts(patch["kind"] for patch in patches),
        "generated_by": _texts(generator_text(patch) for patch in patches),
        "method": _texts(patch["method"] for patch in patches),
        "point": np.array(points, float).reshape(-1, 3),
        "axis": np.array(axes, float).reshape(-1, 3),
        **{name: _numbers(patch.get(name) for patch in patches) for name in numbers},
    }
    units = {"point": "m", "radius_m": "m", "tube_radius_m": "m", "half_angle_rad": "rad"}
    return Table(columns, units | {"area_m2": "m^2", "residual_m": "m"})


def generator_text(patch: dict[str, Any]) -> str:
    """What generates a patch, in a few words: ``joint2 upper`` or ``singular``."""
    return " or ".join(
        ", ".join([*each["limits"], *(["singular"] if each["singular"] else [])]) for each in patch["generated_by"]
    )


def _edge_table(edges: list[dict[str, Any]]) -> Table:
    columns = {
        "edge": np.arange(len(edges)),
        "kind": _texts(edge["kind"] for edge in edges),
        "patches": np.array([edge["patches"] for edge in edges], int).reshape(-1, 2),
        "length_m": _numbers(edge["length_m"] for edge in edges),
        "radius_m": _numbers(edge.get("radius_m") for edge in edges),
        "angle_rad": np.array([edge["angle_between_normals_rad"] for edge in edges], float).reshape(-1, 2),
        "residual_m": _numbers(edge["residual_m"] for edge in edges),
    }
    return Table(columns, {"length_m": "m", "radius_m": "m", "angle_rad": "rad", "residual_m": "m"})


def _corner_table(corners: list[dict[str, Any]]) -> Table:
    return Table(
        {
            "position": np.array([corner["position_m"] for corner in corners], float).reshape(-1, 3),
            "patches": _texts(" ".join(map(str, corner["patches"])) for corner in corners),
        },
        {"position": "m"},
    )


def _texts(values: Any) -> np.ndarray:
    return np.array(list(values), dtype=str)


def _numbers(values: Any) -> np.ndarray:
    return np.array([np.nan if value is None else value for value in values], float)
