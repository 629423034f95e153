"""The result of a ``parallel_workspace`` job."""

import json
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.engine import OrientationCounts
from wsrender.global_indices import voxel_volumes, workspace_mean
from wsrender.indices.catalogue import unit
from wsrender.parallel.hybrid import Variant, count_union, from_middle, middle, reached_by_any
from wsrender.parallel.inverse_kinematics import inverse_kinematics
from wsrender.parallel.local_indices import DETERMINANTS
from wsrender.parallel.mechanism import Mechanism
from wsrender.parallel.membership import count_at, fault_at, in_base_frame, in_world
from wsrender.parallel.singularities import TYPES, sign_changes
from wsrender.reachability import Event, estimate_volumes
from wsrender.result import Result
from wsrender.run.provenance import job_entry, provenance, robot_entry
from wsrender.sampling import subsample
from wsrender.spec.options import TASK_ROWS
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.neighbours import inner_and_outer
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    from wsrender.run.parallel import Arrays, ParallelPlan

PICTURE_SAMPLES = 30_000
EVENTS = {"constant_orientation": "reached", "total_orientation": "all orientations", "dexterous": "dexterous"}


def positions_result(plan: "ParallelPlan", partial: "Arrays", seconds: dict[str, float]) -> Result:
    """Of the kinds whose positions vary."""
    started = time.perf_counter()
    job, found = plan.job, _counted(plan, partial)
    volume = _volume(plan, partial, found)
    document = mechanism_document(plan) | {
        "sampling": {
            "method": job.method,
            "samples": sum(count for _, count in plan.shards),
            "legs_evaluated": int(partial["asked"][0]),
            **_undecided(plan, int(partial["asked"][1])),
        },
        "voxel_size_m": plan.block.voxel_size_m if plan.block else job.voxel_size_m,
        "volume_m3": _volumes(plan, partial, volume),
        "indices": _index_entries(plan, volume) if volume else {},
        "bounds_m": _bounds(volume),
    }
    if volume is None:
        document["empty"] = _reason(plan)
    tables = {}
    if volume and plan.names:
        document["conditioning"] = _conditioning_entry(volume)
    if volume and plan.names and DETERMINANTS[0] in plan.center_names:
        changes = sign_changes(volume)
        document["singularities"] = _singularity_entry(volume, changes)
        tables["singularities"] = _singularity_table(changes)
    document["timing_s"] = {**seconds, "finish": time.perf_counter() - started}
    skeleton = None if volume is None else skeleton_at(plan, _middle(volume))
    return Result(document, volume=volume, sample=_sample(volume), skeleton=skeleton, tables=tables)


def orientation_result(plan: "ParallelPlan", partial: "Arrays", seconds: dict[str, float]) -> Result:
    """Of the orientations at a point."""
    orientations, job, is_reached = plan.orientations, plan.job, partial["reached"]
    share = float(orientations.weights[is_reached].sum())
    columns = {name: orientations.angles[:, k] for k, name in enumerate(orientations.names)}
    table = Table(
        {**columns, "quat_wxyz": orientations.quat_wxyz, "reached": is_reached},
        dict.fromkeys(orientations.names, "rad"),
    )
    document = mechanism_document(plan) | {
        "sampling": {
            "method": "grid",
            "samples": len(is_reached) * len(plan.variants),
            "levels": list(orientations.levels),
            **_undecided(plan, int(partial["undecided"].sum())),
        },
        "orientation_workspace": {
            "position_m": list(job.position_m or ()),
            "orientations": len(is_reached),
            "reached": int(is_reached.sum()),
            "share": share,
            "measure": "invariant measure of rotations over the ranges given",
        },
        "timing_s": seconds,
    }
    if not is_reached.any():
        document["empty"] = _reason(plan)
    skeleton = None
    if is_reached.any():  # the one that is turned least
        turns = np.trace(orientations.rotations, axis1=1, axis2=2)
        shown = int(np.where(is_reached, turns, -np.inf).argmax())
        skeleton = skeleton_at(plan, np.array(job.position_m), shown)
    return Result(document, tables={"orientations": table}, skeleton=skeleton)


def mechanism_document(plan: "ParallelPlan") -> dict[str, Any]:
    """What the documents of all kinds and methods begin with."""
    return {
        "analysis": "parallel_workspace",
        "job": job_entry(plan.job, *(leg.robot for leg in plan.mechanism.numeric)),
        "mechanism": mechanism_entry(plan.mechanism),
        "kind": plan.job.kind,
        "orientations": len(plan.orientations.rotations),
        "serial_configurations": len(plan.variants),
        "provenance": provenance(plan.job.precision, plan.target, seed=plan.job.seed),
    }


def mechanism_entry(mechanism: Mechanism) -> dict[str, Any]:
    """Name, placement and legs of a mechanism, for the result document."""
    units = ["m" if kind in ("UPS", "PUS") else "rad" for kind in mechanism.kinds]
    rows = zip(
        mechanism.numbers, mechanism.kinds, mechanism.lower.tolist(), mechanism.upper.tolist(), units, strict=True
    )
    legs: dict[int, dict[str, Any]] = {
        number: {"type": kind, "lower": low, "upper": high, "unit": unit} for number, kind, low, high, unit in rows
    }
    for leg in mechanism.numeric:
        legs[leg.number] = {
            "type": "serial",
            "robot": robot_entry(leg.robot),
            "holds": "pose" if leg.holds_pose else "position",
            "actuated": np.array(leg.chain.joint_names)[leg.actuated].tolist(),
        }
    return {
        "name": mechanism.name,
        "T_world_base": mechanism.T_world_base.tolist(),
        "degrees_of_freedom": mechanism.degrees_of_freedom,
        "legs": [legs[number] for number in sorted(legs)],
    }


def _counted(plan: "ParallelPlan", partial: "Arrays") -> np.ndarray:
    """Which of the partial's voxels belong to the workspace: all but those that miss one of all orientations."""
    if plan.job.kind == "total_orientation":
        return partial["orientations"] == len(plan.orientations.rotations)
    return np.ones(len(partial["cells"]), bool)


def _shares(plan: "ParallelPlan", partial: "Arrays") -> np.ndarray:
    """The share of the orientations reached per voxel, by their measure; exactly 1 where all are."""
    return partial["weights"] / plan.orientations.whole_weights.sum(dtype=np.int64)


def _volume(plan: "ParallelPlan", partial: "Arrays", found: np.ndarray) -> VolumeData | None:
    """``count``: poses reached (orientations, or serial configurations); None where nothing is reached."""
    if plan.block is None or not found.any():
        return None
    at = np.stack(np.unravel_index(partial["cells"][found], plan.block.shape))
    low = at.min(axis=1)
    shape = tuple(at.max(axis=1) - low + 1)
    place = tuple(at - low[:, None])

    def dense(values: np.ndarray, empty, dtype) -> np.ndarray:
        block = np.full(shape, empty, dtype)
        block[place] = values[found]
        return block

    statistics: dict[str, dict[str, np.ndarray]] = {}
    units: dict[str, str] = {}
    if plan.names:
        values = {n: dense(partial[f"index_{n}"], np.nan, np.float64) for n in (*plan.names, *plan.center_names)}
        statistics["maximum"] = {name: values[name] for name in plan.names}
        statistics["center"] = {name: values[name] for name in plan.center_names}
        units = {n: unit(n, plan.rows, "standard") for n in plan.names} | dict.fromkeys(plan.center_names, "1")
        cranks = sum(kind not in ("UPS", "PUS") for kind in plan.mechanism.kinds)
        if DETERMINANTS[1] in units and cranks:
            units[DETERMINANTS[1]] = f"m^{cranks}"  # a row of A has no unit, one of B that of its joint
    if plan.job.kind == "dexterous":
        statistics["fraction"] = {"orientations": dense(_shares(plan, partial), np.nan, np.float64)}
        units["orientations"] = "1"
    x, y, z = (int(f + o) for f, o in zip(plan.block.first_voxel, low, strict=True))
    count = dense(partial["orientations"], 0, np.int64)
    return VolumeData(plan.block.voxel_size_m, (x, y, z), count, statistics, units)


def _volumes(plan: "ParallelPlan", partial: "Arrays", volume: VolumeData | None) -> dict[str, Any]:
    """Volumes [m³] by voxels, and the refined one if asked."""
    refined = json.loads(str(partial["refined"])) if "refined" in partial else None
    if volume is None:
        return {"occupied": 0.0, "inner": 0.0, "outer": 0.0, "refined": refined}
    found, voxel = voxel_volumes(volume), volume.voxel_size_m**3
    entry: dict[str, Any] = {"occupied": found.occupied, "inner": found.inner, "outer": found.outer}
    if plan.job.kind == "dexterous":
        shares = _shares(plan, partial)
        entry["dexterous"] = float((shares >= plan.job.dexterous_threshold).sum() * voxel)
        entry["all_orientations"] = float((partial["orientations"] == len(plan.orientations.rotations)).sum() * voxel)
    return entry | {"refined": refined}


def refined_entry(plan: "ParallelPlan", partial: "Arrays", progress: Callable[[int, int], None]) -> dict[str, Any]:
    """The volume with its 95 % interval from uniform points that inverse kinematics decides.

    The strata are the inner voxels, the border and the rest of the lattice block. ``progress``: points decided, and
    about how many there will be.
    """
    job, tolerance = plan.job, plan.job.refined_volume
    volume = _volume(plan, partial, _counted(plan, partial))
    assert tolerance is not None
    if plan.block is None:
        return {"value": 0.0, "ci95": [0.0, 0.0], "tolerance": tolerance, "met": True, "points": 0}
    classes = np.zeros(plan.block.shape, np.int8)
    if volume is not None:
        inner, outer = inner_and_outer(volume.occupied)
        around = tuple(
            slice(f - o - 1, f - o + n + 1)
            for f, o, n in zip(volume.first_voxel, plan.block.first_voxel, volume.shape, strict=True)
        )
        padded = np.pad(classes, 1)
        padded[tuple(slice(s.start + 1, s.stop + 1) for s in around)] = inner.astype(np.int8) + outer
        classes = padded[1:-1, 1:-1, 1:-1]
    strata = [np.argwhere(classes == code) + plan.block.first_voxel for code in np.unique(classes)]
    rotations, weights = plan.orientations.rotations, plan.orientations.whole_weights
    least = int(np.ceil(job.dexterous_threshold * weights.sum(dtype=np.int64))) if job.kind == "dexterous" else 0

    def membership(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        unknown = np.full((len(points), 1), np.inf)  # how far points outside are: cells are judged by labels alone
        if job.kind == "constant_orientation":
            hits = reached_by_any(plan.variants, points, rotations, device=plan.device)
            return hits.astype(np.int8)[:, None], unknown

        def count(variant: Variant, turned: np.ndarray, weights: np.ndarray) -> OrientationCounts:
            there = in_base_frame(variant.mechanism, points)
            return count_at(variant.mechanism, there, turned, weights=weights, device=plan.device)

        found = count_union(plan.variants, count, rotations, weights, len(points))
        inside = np.zeros((len(points), 1), np.int8)
        inside[found.cells, 0] = found.weights >= least if least else found.reached == len(rotations)
        return inside, unknown

    events = {EVENTS[job.kind]: Event(1, 1)}
    found = estimate_volumes(
        membership, strata, plan.block.voxel_size_m, events, tolerance, seed=job.seed, progress=progress
    )
    (estimate,) = found.volumes.values()
    return {
        "value": estimate.value,
        "ci95": [estimate.low, estimate.high],
        "tolerance": tolerance,
        "met": estimate.met,
        "of": EVENTS[job.kind],
        "points": found.points,
    }


def _index_entries(plan: "ParallelPlan", volume: VolumeData) -> dict[str, Any]:
    return {
        name: {
            "maximum": float(np.nanmax(volume.statistics["maximum"][name])),
            "minimum": float(np.nanmin(volume.statistics["maximum"][name])),
            "workspace_mean": workspace_mean(volume, name),
            "unit": volume.units[name],
            "task": [TASK_ROWS[r] for r in plan.rows],
        }
        for name in plan.names
    }


def _conditioning_entry(volume: VolumeData) -> dict[str, Any]:
    """The least condition number (null: infinite everywhere) and the mean of 1/κ over the voxels, of A, B and J."""
    entry = {}
    for matrix in "ABJ":
        inverse = volume.statistics["center"][f"inverse_condition_number_{matrix}"][volume.occupied]
        largest = float(inverse.max())
        entry[matrix] = {
            "least_condition_number": 1 / largest if largest > 0 else None,
            "mean_inverse": float(inverse.mean()),
        }
    return entry


def _bounds(volume: VolumeData | None) -> dict[str, list[float]]:
    """Outer faces of the occupied voxels [m]."""
    if volume is None:
        return {}
    lower = volume.origin_m
    return {"lower": lower.tolist(), "upper": (lower + np.array(volume.shape) * volume.voxel_size_m).tolist()}


def _singularity_entry(volume: VolumeData, changes: dict[int, np.ndarray]) -> dict[str, Any]:
    """How often the determinants change sign; a determinant that is 0 everywhere says so."""
    entry: dict[str, Any] = {}
    for kind, name in TYPES.items():
        values = volume.statistics["center"][name][volume.occupied]
        entry[f"type_{kind}"] = {
            "determinant": name,
            "sign_changes": len(changes[kind]),
            "positive_voxels": int((values > 0).sum()),
            "negative_voxels": int((values < 0).sum()),
            "everywhere": bool((values == 0).all()),
        }
    return entry


def _singularity_table(changes: dict[int, np.ndarray]) -> Table:
    kinds = np.repeat(np.array(list(changes), np.int64), [len(points) for points in changes.values()])
    return Table({"position": np.concatenate(list(changes.values())), "type": kinds}, {"position": "m"})


def _reason(plan: "ParallelPlan") -> str:
    """Why nothing is reached."""
    if plan.block is None and plan.job.kind != "orientation":
        return "no position is within the reach of all legs and the region of the platform"
    if plan.job.kind == "orientation":
        position = np.array(plan.job.position_m)
    else:
        assert plan.block is not None
        position = (np.array(plan.block.first_voxel) + np.array(plan.block.shape) / 2) * plan.block.voxel_size_m
    variant = middle(plan.variants)
    fault = fault_at(variant.mechanism, _pose(plan, variant, position))
    where = f"at {np.round(position, 6).tolist()} m" + (", serial joints half way," if len(plan.variants) > 1 else "")
    return f"no pose tested is reached; {where} {fault}"


def _pose(plan: "ParallelPlan", variant: Variant, position_world: np.ndarray, orientation: int = 0) -> np.ndarray:
    """The platform there at one of the orientations, frame of the variant's base, (4, 4)."""
    pose = np.eye(4)
    pose[:3, :3] = variant.rotations(plan.orientations.rotations[[orientation]])[0]
    pose[:3, 3] = in_base_frame(variant.mechanism, position_world)
    return pose


def _middle(volume: VolumeData) -> np.ndarray:
    """The centre of the reached voxel that is nearest to their mean [m]."""
    cells = np.argwhere(volume.count == volume.count.max())
    nearest = cells[((cells - cells.mean(axis=0)) ** 2).sum(axis=1).argmin()]
    return (nearest + volume.first_voxel + 0.5) * volume.voxel_size_m


def skeleton_at(plan: "ParallelPlan", position_world: np.ndarray, orientation: int = 0) -> np.ndarray | None:
    """Every leg from its base over its joints to the middle of the platform, (L, K, 3) [m]; None if not reached.

    At the mechanism's home, if it has one, else at the position, world, in one of the orientations; serial joints as
    near to the middle of their ranges as they can be.
    """
    for variant in from_middle(plan.variants):
        mechanism = variant.mechanism
        pose = _pose(plan, variant, position_world, orientation) if mechanism.home is None else mechanism.home
        if not fault_at(mechanism, pose):
            return in_world(mechanism, _legs_at(mechanism, pose))
    return None


def _legs_at(mechanism: Mechanism, pose: np.ndarray) -> np.ndarray:
    """The legs at a reached pose (4, 4), base frame, (L, K, 3) [m]; shorter ones stay at the platform's middle."""
    legs = inverse_kinematics(mechanism, pose[None])
    lines = [np.stack(line) for line in zip(mechanism.base, legs.elbows[0], legs.joints[0], strict=True)]
    lines += [leg.skeleton(pose) for leg in mechanism.numeric]
    longest = max(len(line) for line in lines) + 1
    return np.stack([np.vstack([line, np.tile(pose[:3, 3], (longest - len(line), 1))]) for line in lines])


def _undecided(plan: "ParallelPlan", poses: int) -> dict[str, int]:
    """Poses that count as not reached, for the numerical solution neither found nor excluded one."""
    return {"undecided": poses} if plan.mechanism.numeric else {}


def _sample(volume: VolumeData | None) -> DistributionMap | None:
    """A fixed subsample of the voxels' centres with their values."""
    if volume is None:
        return None
    cells = np.argwhere(volume.occupied)
    cells = cells[subsample(len(cells), PICTURE_SAMPLES)]
    at = tuple(cells.T)
    kept = volume.statistics.get("maximum") or volume.statistics.get("fraction") or {}
    positions = (cells + volume.first_voxel + 0.5) * volume.voxel_size_m
    return DistributionMap(positions, {name: values[at] for name, values in kept.items()}, dict(volume.units))
