"""The result of a ``workspace`` job from its merged partial result."""

import time
from typing import Any

import numpy as np

from wsrender.engine import Partial, SweepPlan, configurations, evaluate_at
from wsrender.engine.voxel_data import volume_data
from wsrender.global_indices import (
    global_isotropy,
    joint_means,
    structural_length_index,
    voxel_volumes,
    workspace_mean,
)
from wsrender.indices.catalogue import unit
from wsrender.reachability.voxel_labels import counts
from wsrender.result import Result
from wsrender.robot import Robot
from wsrender.run.provenance import index_choices, job_entry, provenance, robot_entry
from wsrender.run.refined import Refined, volume_entry
from wsrender.sampling import subsample
from wsrender.spec import WorkspaceJob
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.volume_data import VolumeData

PICTURE_SAMPLES = 100_000


def workspace_result(
    job: WorkspaceJob,
    robot: Robot,
    plan: SweepPlan,
    partial: Partial,
    convergence: list[dict[str, float]] | None,
    refined: Refined | None,
    target: str,
    seconds: dict[str, float],
) -> Result:
    """Map, picture sample, volume data, skeleton, surface and result document."""
    from wsrender.boundary.surfaces import surfaces

    started = time.perf_counter()
    evaluation = plan.evaluation
    units = {name: unit(name, evaluation.rows, evaluation.convention) for name in evaluation.indices}
    volume = volume_data(plan, partial, units)
    volumes = voxel_volumes(volume)
    sample = _picture_sample(plan, robot, units)
    measure = refined.measure if refined else None
    labels = refined.voxels if refined else None
    known = volume_entry(measure)["value"] if measure else volumes.occupied
    meshes, surface_entries = surfaces(job.surfaces, volume, sample.position)
    document: dict[str, Any] = {
        "analysis": "workspace",
        "job": job_entry(job, robot),
        "robot": robot_entry(robot),
        "sampling": _sampling_entry(job, plan, partial),
        "indices": _index_entries(plan, partial, volume, units),
        "choices": index_choices(job, evaluation.rows),
        "voxel_size_m": plan.block.voxel_size_m if plan.block else None,
        "volume_m3": {
            "occupied": volumes.occupied,
            "inner": volumes.inner,
            "outer": volumes.outer,
            "refined": volume_entry(measure) if measure else None,
        },
        "voxel_labels": counts(labels) if labels else None,
        "surfaces": surface_entries,
        "bounds_m": {
            "lower": [float(v) for v in partial.minimum[:3]],
            "upper": [float(v) for v in partial.maximum[:3]],
        },
        "global": {
            "global_isotropy": global_isotropy(partial),
            "structural_length_index": None if evaluation.host_chain else structural_length_index(robot.chain, known),
            "structural_length_volume": "refined" if measure else "occupied",
        },
        "convergence": convergence,
        "provenance": provenance(job.precision, target, sampling_path=plan.sampling_path, seed=plan.sampling.seed),
    }
    result = Result(
        document,
        map=_kept_map(plan, partial, robot, units) if plan.keep_rows else None,
        sample=sample,
        volume=volume,
        skeleton=robot.skeleton(_middle(plan)),
        meshes=meshes,
        volumes={"reachability": labels} if labels else {},
    )
    document["timing_s"] = {**seconds, "finish": time.perf_counter() - started}
    return result


def _sampling_entry(job: WorkspaceJob, plan: SweepPlan, partial: Partial) -> dict[str, Any]:
    sampling = plan.sampling
    entry: dict[str, Any] = {"method": job.sampling.method, "samples": partial.samples, "seed": sampling.seed}
    if sampling.method == "grid":
        entry["per_joint"] = [int(level) for level in sampling.levels]
    entry["locked"] = dict(job.sampling.locked)
    return entry


def _index_entries(plan: SweepPlan, partial: Partial, volume: VolumeData, units: dict[str, str]) -> dict[str, Any]:
    high, low, means = partial.maximum, partial.minimum, joint_means(plan, partial)
    return {
        name: {
            "maximum": float(high[3 + k]),
            "minimum": float(low[3 + k]),
            "joint_mean": float(means[k]),
            "workspace_mean": workspace_mean(volume, name),
            "unit": units[name],
        }
        for k, name in enumerate(plan.evaluation.indices)
    }


def _kept_map(plan: SweepPlan, partial: Partial, robot: Robot, units: dict[str, str]) -> DistributionMap:
    K, n = len(plan.evaluation.indices), robot.chain.n
    rows = np.concatenate([partial.rows[first] for first in sorted(partial.rows)], axis=1)
    after = 3 + K
    q = rows[after : after + n].T if plan.keep_configuration else None
    after += n * plan.keep_configuration
    quat = rows[after : after + 4].T if plan.keep_orientation else None
    return DistributionMap(
        rows[:3].T,
        dict(zip(plan.evaluation.indices, rows[3 : 3 + K], strict=True)),
        units,
        q,
        robot.joint_names,
        quat,
    )


def _picture_sample(plan: SweepPlan, robot: Robot, units: dict[str, str]) -> DistributionMap:
    """A fixed subsample of the samples, evaluated anew in float64 on the CPU."""
    q = configurations(plan.sampling, subsample(plan.sampling.count, PICTURE_SAMPLES))
    evaluated = evaluate_at(plan.evaluation, q)
    values = dict(zip(plan.evaluation.indices, evaluated.values, strict=True))
    return DistributionMap(evaluated.position, values, units, q, robot.joint_names)


def _middle(plan: SweepPlan) -> np.ndarray:
    """Mid-range of every joint, and a quarter to either side."""
    lower, upper = plan.sampling.lower, plan.sampling.upper
    return np.stack([lower + share * (upper - lower) for share in (0.25, 0.5, 0.75)])
