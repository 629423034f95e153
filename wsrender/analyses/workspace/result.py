"""The result of a ``workspace`` job from its merged partial result."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from wsrender.analyses.contract import Draft
from wsrender.analyses.headline import headline_of
from wsrender.analyses.provenance import index_choices
from wsrender.analyses.refined import by_measure, divided
from wsrender.analyses.volume_notices import few_samples, occupied_differs, tolerance_not_met
from wsrender.analyses.workspace.job import WorkspaceJob
from wsrender.analyses.workspace.partial import WorkspacePartial
from wsrender.engine import Evaluated, Partial, SweepPlan, configurations, evaluate_samples, evaluated_of, units_of
from wsrender.engine.voxel_data import admission_data, volume_data
from wsrender.global_indices import (
    VoxelVolumes,
    global_isotropy,
    joint_means,
    plain_means,
    structural_length_index,
    voxel_volumes,
    workspace_mean,
)
from wsrender.indices.index_catalogue import find
from wsrender.notices import Notice
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import subsample
from wsrender.reach.holes import share_of_holes, share_unseen
from wsrender.reach.voxel_labels import counts
from wsrender.robot import Robot
from wsrender.robot.constraints import samples_entry
from wsrender.robot.rejections import check_admitted, colliding_pairs, first_rejected, lost_voxels, moved_means
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.measure import NOT_ASKED
from wsrender.volume.volume_data import VOXEL_LABELS, VolumeData

PICTURE_SAMPLES = 100_000


def workspace_draft(job: WorkspaceJob, robot: Robot, found: WorkspacePartial, threads: int | None) -> Draft:
    """Map, picture sample, volume data, skeleton, surface and the entries of the document."""
    from wsrender.geometry.surfaces import surfaces

    pipeline, partial, refined = found.pipeline, found.sweep, found.refined
    samples = samples_entry(pipeline.constraints, partial.samples, partial.rejected)
    check_admitted(samples, pipeline.constraints)
    evaluation = pipeline.evaluation
    units = units_of(evaluation)
    volume = volume_data(pipeline, partial, units)
    volumes = voxel_volumes(volume)
    drawn = _picture_sample(pipeline, threads)
    sample = _admitted(pipeline, drawn, robot, units)
    admission = admission_data(pipeline, partial) if pipeline.constraints else None
    rejections = {"rejections": _rejections(pipeline, partial, drawn, admission)} if admission else {}
    rows = None if pipeline.kept_rows is None else evaluated_of(pipeline, partial)
    measure = refined.measure if refined else None
    labels = refined.voxels if refined else None
    measures = by_measure(measure, measure)
    solid = measures["volume_m3"]["refined"]
    meshes, surface_entries = surfaces(job.surfaces, volume, sample.position)
    document: dict[str, Any] = {
        "sampling": _sampling_entry(job, pipeline, partial),
        **samples,
        **rejections,
        "indices": _index_entries(pipeline, partial, volume, units),
        "choices": index_choices(job, evaluation),
        "voxel_size_m": pipeline.block.voxel_size_m if pipeline.block else None,
        **measures,
        "volume_m3": {
            "occupied": volumes.occupied,
            "inner": volumes.inner,
            "outer": volumes.outer,
            **measures["volume_m3"],
        },
        "voxel_labels": counts(labels, pipeline.constraints) if labels else None,
        "surfaces": surface_entries,
        "bounds_m": {
            "lower": [float(v) for v in partial.minimum[:3] + pipeline.origin],
            "upper": [float(v) for v in partial.maximum[:3] + pipeline.origin],
        },
        "global": {
            "global_isotropy": global_isotropy(partial),
            **_structural_length(robot, measure, constrained=bool(pipeline.constraints)),
        },
        "convergence": found.convergence,
    }
    return Draft(
        document,
        headline_of(measure),
        (
            *tolerance_not_met(measure),
            *_notices(job, robot, pipeline, volume, volumes, solid, threads),
            *_index_notices(pipeline, partial),
        ),
        {
            "pipeline": str(pipeline),
            "sampling_path": SweepPlan(pipeline).sampling_path,
            "seed": pipeline.sampling.seed,
        },
        map=rows and _admitted(pipeline, rows, robot, units),
        sample=sample,
        volume=volume,
        skeleton=_shown_arms(pipeline, robot, sample),
        meshes=meshes,
        volumes={name: each for name, each in {VOXEL_LABELS: labels, "admission": admission}.items() if each},
    )


def _rejections(pipeline: Pipeline, partial: Partial, sample: Evaluated, admission: VolumeData) -> dict[str, Any]:
    """The first rejected sample by reason, the pairs that collide, and what is lost beside a loss at random.

    Pairs and means are of the ``sample``.
    """
    rejecting = np.flatnonzero(partial.rejected)
    constraints, numbers = [pipeline.constraints[k] for k in rejecting], partial.earliest[rejecting]
    rejected, count, voxel = sample.rejected, admission.voxels.count, admission.voxel_size_m**3
    assert rejected is not None and sample.q is not None
    admitted, lost = admission.voxels.statistics["samples"]["admitted"], int(partial.rejected.sum())
    return {
        "first": first_rejected(constraints, numbers, configurations(pipeline, numbers)),
        **colliding_pairs(pipeline.constraints, sample.q, rejected),
        "volume_m3": lost_voxels(count, admitted, partial.samples, lost, voxel),
        "means": {
            "counted": len(rejected),
            "indices": {
                name: moved_means(values, rejected)
                for name, values in zip(pipeline.evaluation.indices, sample.values, strict=True)
            },
        },
    }


def _structural_length(robot: Robot, measure: dict[str, Any] | None, *, constrained: bool) -> dict[str, Any]:
    """The index, of the refined volume alone; else None, with the reason."""
    index, reason = None, ""
    if (chain := robot.chain.geometry) is None:
        reason = "a robot that is defined by a Python class has no lengths of links"
    elif constrained:
        reason = "it says what the links are worth, not what constraints leave of the workspace"
    elif measure is None:
        reason = NOT_ASKED
    elif measure["value"] is None:
        reason = measure["reason"]
    elif measure["quantity"] != "volume":
        reason = f"the tip reaches no volume; what it reaches is measured by its {measure['quantity']}"
    elif not (index := structural_length_index(chain, measure["value"])):
        reason = "the volume is 0"
    return {"structural_length_index": index, "structural_length_reason": reason}


def _notices(
    job: WorkspaceJob,
    robot: Robot,
    pipeline: Pipeline,
    volume: VolumeData,
    volumes: VoxelVolumes,
    solid: dict[str, Any] | None,
    threads: int | None,
) -> Iterator[Notice]:
    """What to know of the volume: too few samples, or voxels that are far from what is reachable."""
    holes = None
    region, others = divided(pipeline.constraints)
    if solid and robot.chain.geometry and not others:  # else empty voxels may be blocked
        held = robot.chain.held(job.sampling.locked)
        holes = share_of_holes(held, volume, seed=pipeline.sampling.seed, threads=threads, region=region)
    yield from few_samples(holes, share_unseen(volume))
    yield from occupied_differs(volumes.occupied, solid["value"] if solid else None, "free" if others else "reachable")


def _index_notices(pipeline: Pipeline, partial: Partial) -> Iterator[Notice]:
    """What to know of the values of the indices."""
    yield from pipeline.evaluation.notices
    if not partial.maximum[3 : 3 + len(pipeline.evaluation.indices)].any():
        yield Notice(
            "task_without_motion",
            "all indices and global isotropy are 0: the task has a direction in which the arm cannot move",
            "choose other rows, such as x, y",
            "task",
        )


def _sampling_entry(job: WorkspaceJob, pipeline: Pipeline, partial: Partial) -> dict[str, Any]:
    sampling = pipeline.sampling
    entry: dict[str, Any] = {"method": job.sampling.method, "samples": partial.samples, "seed": sampling.seed}
    if sampling.method == "grid":
        entry["per_joint"] = [int(level) for level in sampling.levels]
    entry["locked"] = dict(job.sampling.locked)
    return entry


def _index_entries(pipeline: Pipeline, partial: Partial, volume: VolumeData, units: dict[str, str]) -> dict[str, Any]:
    high, low, means = partial.maximum, partial.minimum, joint_means(pipeline, partial)
    plain, cut = plain_means(pipeline, partial), dict(zip(pipeline.evaluation.cuts, partial.cut.tolist(), strict=True))
    return {
        name: {
            "maximum": float(high[3 + k]),
            "minimum": float(low[3 + k]),
            **({"mean": float(plain[k])} if find(name).signed or find(name).of_chain else {}),
            "joint_mean": None if find(name).signed else float(means[k]),
            "workspace_mean": None if find(name).signed else workspace_mean(volume, name),
            **({"cut_share": cut[name] / max(partial.admitted, 1)} if name in cut else {}),
            "unit": units[name],
        }
        for k, name in enumerate(pipeline.evaluation.indices)
    }


def _picture_sample(pipeline: Pipeline, threads: int | None) -> Evaluated:
    """A fixed subsample of the samples, evaluated anew in float64 on the CPU."""
    exact = replace(pipeline, precision="float64")
    q = configurations(exact, subsample(pipeline.sampling.count, PICTURE_SAMPLES))
    return replace(evaluate_samples(exact.at(q), threads=threads), q=q)


def _admitted(pipeline: Pipeline, found: Evaluated, robot: Robot, units: dict[str, str]) -> DistributionMap:
    values = dict(zip(pipeline.evaluation.indices, found.values, strict=True))
    every = DistributionMap(found.position, values, units, found.q, robot.joint_names, found.quat_wxyz)
    return every if found.rejected is None else every.only(found.rejected == 0)


def _shown_arms(pipeline: Pipeline, robot: Robot, sample: DistributionMap) -> np.ndarray | None:
    """The arm (3, L+2, 3) at mid-range of every joint, and a quarter to either side.

    Under constraints at the admitted configurations nearest to these; None where no sample is admitted.
    """
    lower, upper = pipeline.sampling.lower, pipeline.sampling.upper
    middle = np.stack([lower + share * (upper - lower) for share in (0.25, 0.5, 0.75)])
    if pipeline.constraints:
        if sample.configuration is None or not len(sample):
            return None
        span = np.where(upper > lower, upper - lower, 1.0)
        apart = (np.abs(sample.configuration - middle[:, None]) / span).sum(axis=-1)
        middle = sample.configuration[apart.argmin(axis=1)]
    return robot.skeleton(middle)
