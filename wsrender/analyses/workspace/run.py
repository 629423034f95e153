"""The analysis ``workspace``: what is settled, swept, merged and refined."""

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Progress, Settled, Tell
from wsrender.analyses.cost import (
    DECIDED_PER_S,
    DOCUMENT_BYTES,
    SEARCHED_BYTES,
    SEARCHED_PER_S,
    WRITTEN_PER_S,
    Cost,
    check_memory,
    fits,
    pictures_cost,
    refined_bytes,
    refined_seconds,
    surface_bytes,
)
from wsrender.analyses.estimate import held, kept_bytes, sweep_cost
from wsrender.analyses.execution import Execution
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.refined import RefinedRobot, divided, labelled, refined
from wsrender.analyses.workspace.job import WorkspaceJob
from wsrender.analyses.workspace.partial import WorkspacePartial, sweep_of
from wsrender.analyses.workspace.result import PICTURE_SAMPLES, workspace_draft
from wsrender.documents.options import STATISTICS, IsoSurface
from wsrender.documents.sampling import Converge, Grid
from wsrender.engine import Partial, SweepPlan, devices_of, fitted, merge, sweep
from wsrender.engine.first_pass import FirstPass
from wsrender.engine.voxel_data import admission_data, volume_data
from wsrender.errors import InputError, NotConvergedError
from wsrender.global_indices import joint_means, workspace_mean
from wsrender.indices.index_catalogue import default_statistics, resolve
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import SamplingPlan, plan_sampling
from wsrender.reach.inverse_solver import solved_bytes
from wsrender.robot import Robot
from wsrender.robot.constraints import constraints_of_job, samples_entry
from wsrender.robot.indices import evaluation_of_job
from wsrender.robot.rejections import check_admitted
from wsrender.volume.lattice import LatticeBlock, expected_voxels, voxel_of
from wsrender.volume.volume_data import VolumeData

ROWS_HELD = 3.5  # copies of the pictures' samples where some are rejected
LABEL_BYTES, LABELLED_BYTES = 24, 250  # of a voxel of the cropped block: what is near; of one that is decided


@dataclass(frozen=True, kw_only=True)
class WorkspaceSettled(Settled):
    """With the block of voxels, bounds (K,) of the indices for their sums, and how samples are evaluated."""

    voxel_size_m: float
    first_voxel: tuple[int, int, int]
    shape: tuple[int, int, int]
    bounds: tuple[float, ...]
    sampling_path: str


class WorkspaceAnalysis(Analysis):
    """A planned ``workspace`` job."""

    settles = WorkspaceSettled
    job: WorkspaceJob
    settled: WorkspaceSettled

    def __init__(self, job: WorkspaceJob, robot: Robot, *, resolved: Mapping[str, Any] | None = None):
        self.evaluation = evaluation_of_job(job, robot)
        if job.voxel_statistics is None:
            kept = {*default_statistics(self.evaluation.indices), *(["maximum"] if job.best_sample else [])}
            job = job.model_copy(update={"voxel_statistics": tuple(name for name in STATISTICS if name in kept)})
        super().__init__(job, robot, resolved=resolved)

    def __repr__(self) -> str:
        return f"workspace: {self.pipeline}"

    def prepare(self, device: str, target: str) -> WorkspaceSettled:
        """Raises InputError, MissingInertiaError, ResourceError."""
        job, sampling = self.job, self.first_sampling
        size = job.voxel_size_m or self.first_pass.voxel_size(None if self._iterates else sampling)
        block = self.first_pass.block(size)
        bounds = self.first_pass.bounds
        pipeline = self.pipeline = self._pipeline(block, bounds)
        self._check(pipeline)
        plan = SweepPlan(pipeline)
        fitted(block, plan.shape, devices_of(device), sampling.count)  # raises where a sweep would
        return WorkspaceSettled(
            device,
            target,
            ((0, sampling.count),),
            None if self._iterates else plan.division,
            self._iterates,
            voxel_size_m=block.voxel_size_m,
            first_voxel=block.first_voxel,
            shape=block.shape,
            bounds=bounds,
            sampling_path=plan.sampling_path,
        )

    @cached_property
    def first_sampling(self) -> SamplingPlan:
        """The samples; of a converging job those of its first grid."""
        sampling = self.job.sampling
        if isinstance(sampling, Converge):  # its own limit ends the sequence: see _converge
            return plan_sampling(self.robot.chain, Grid(sampling.start, locked=sampling.locked))
        return plan_sampling(self.robot.chain, sampling, self.job.max_samples)

    @cached_property
    def first_pass(self) -> FirstPass:
        """What is known from coarse samples."""
        return FirstPass(self.evaluation, dict(self.job.sampling.locked))

    @cached_property
    def pipeline(self) -> Pipeline:
        """Samples, constraints, values and what is kept, as they are settled."""
        settled, size = self.settled, self.settled.voxel_size_m
        about = voxel_of(self.robot.chain.foot, size)
        block = LatticeBlock(size, settled.first_voxel, settled.shape, about=about)
        collapse = settled.sampling_path == "collapsed"
        return self._pipeline(block, settled.bounds, collapse)

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        """What samples must satisfy; tables of collisions are made here."""
        return constraints_of_job(self.job, self.robot)

    def _pipeline(self, block: LatticeBlock, bounds: tuple[float, ...], collapse: bool = True) -> Pipeline:
        job = self.job
        return Pipeline(
            self.evaluation,
            self.first_sampling,
            self.constraints,
            block,
            frozenset(job.voxel_statistics or ()),
            frozenset(job.map_columns) if job.keep_map else None,
            bounds,
            job.precision,
            collapse,
            self.best,
        )

    @cached_property
    def best(self) -> str | None:
        """The index whose best samples are kept; raises InputError for none of the job's."""
        if self.job.best_sample is None:
            return None
        try:
            (name,) = resolve((self.job.best_sample,), self.robot.has_inertia)
        except InputError as error:
            raise error.at("best_sample") from None
        if name not in self.evaluation.indices:
            choices = ", ".join(self.evaluation.indices)
            raise InputError("best_sample", f"{name!r} is not among the job's indices: {choices}")
        return name

    def _check(self, pipeline: Pipeline) -> None:
        """Whether the parts of the job go together; raises InputError, ResourceError."""
        job = self.job
        if job.keep_map and "orientation" in job.map_columns and self.evaluation.given_kinematics:
            raise InputError("map_columns", "orientation is not kept for a user-defined robot")
        if isinstance(job.sampling, Converge):
            _converging_index(pipeline, job.sampling)
            if job.sampling.by == "workspace_mean" and not {"maximum", "mean"} & pipeline.statistics:
                raise InputError("sampling.by", "workspace_mean needs the voxel statistic maximum or mean")
        _check_surfaces(job, pipeline)

    def check_memory(self) -> None:
        """Refused is what does not fit; how many voxels hold a sample need not be known of what fits in any case."""
        if not fits(self.most_bytes):
            super().check_memory()

    @property
    def most_bytes(self) -> float:
        """Of memory if every sample were in a voxel of its own: found without the coarse samples."""
        block = self.pipeline.block
        every = float(min(self.pipeline.sampling.count, block.size if block else 0))
        return self._memory(sweep_cost(self.pipeline, devices_of(self.device), every), every)

    @property
    def swept_cost(self) -> Cost:
        """Of the sweep alone, with what labels its samples."""
        swept = sweep_cost(self.pipeline, devices_of(self.device), self._held)
        return replace(swept, memory_bytes=swept.memory_bytes + self.program_bytes)

    @property
    def kept_bytes(self) -> float:
        """Of the partial result's voxels and the volume made of them."""
        return 2 * kept_bytes(self.pipeline, self._held)

    def _memory(self, swept: Cost, voxels: float) -> float:
        """Of the sweep, or of what follows it, whose voxels are held beside it."""
        kept, labels = 2 * kept_bytes(self.pipeline, voxels), 0.0
        if self.job.voxel_labels:
            expected, block = self._expected
            near = min(27 * voxels, (np.cbrt(expected) + 2) ** 3)
            labels = LABELLED_BYTES * near + solved_bytes(near, "position", self.robot.chain) + LABEL_BYTES * block
            labels += SEARCHED_BYTES * bool(self.constraints)
        if self.constraints:
            kept += ROWS_HELD * self._picture_bytes + self.program_bytes
        return float(max(swept.memory_bytes, kept + self.refined_cost[0] + labels))

    @property
    def cost(self) -> Cost:
        """Of the sweep, and of the refined measure, labels, files and pictures."""
        job, swept, (voxels, block) = self.job, self.swept_cost, self._expected
        more = [*(("admission", "share") if self.constraints else ()), *(["labels"] if job.voxel_labels else [])]
        drawn, seconds = pictures_cost("slices", "scatter", "histogram", "robot", *more)
        files = swept.file_bytes + self._picture_bytes + drawn + DOCUMENT_BYTES + surface_bytes(voxels)
        files += self.volume_bytes
        if self.constraints:  # of each voxel samples drawn, admitted and rejected by each, and a share
            files += block * 8.0 * (3 + len(self.constraints))
        memory = self._memory(swept, self._held)
        seconds += swept.seconds + self.refined_cost[1]
        if job.voxel_labels:
            near = (np.cbrt(voxels) + 2) ** 3
            rate = SEARCHED_PER_S if self.constraints else DECIDED_PER_S
            files, seconds = files + 16.0 * (np.cbrt(block) + 2) ** 3, seconds + near / rate
        return Cost(swept.samples, memory, float(files), float(seconds + files / WRITTEN_PER_S), swept.asks)

    @property
    def _picture_bytes(self) -> float:
        """Bytes of the pictures' samples, as arrays."""
        columns = 3 + self.pipeline.evaluation.chain.n + len(self.pipeline.evaluation.indices)
        return 8.0 * columns * min(self.pipeline.sampling.count, PICTURE_SAMPLES)

    @property
    def refined_cost(self) -> tuple[float, float]:
        """Bytes and seconds of the refined volume."""
        tolerance, searched = self.job.refined_volume, bool(divided(self.constraints)[1])
        return refined_bytes(tolerance, searched), refined_seconds(tolerance, searched)

    @property
    def volume_bytes(self) -> float:
        """Bytes of the volume's arrays as a file: counts, and a number of each statistic and index."""
        statistics = len(self.pipeline.statistics - {"count"}) * len(self.pipeline.evaluation.indices)
        width = 4 if self.job.precision == "float32" else 8
        return self._expected[1] * (8.0 + width * statistics + 8.0 * (self.best is not None))

    @cached_property
    def _expected(self) -> tuple[float, float]:
        """Voxels that hold a sample, and those of the block around them, from the coarse samples' positions."""
        positions, size = self.first_pass.evaluated.position, self.voxel_size_m
        cells = np.floor(positions / size)
        block = float(np.prod(np.ptp(cells, axis=0) + 1))
        return expected_voxels(positions, size, self.first_pass.hull), block

    @property
    def _held(self) -> float:
        """Voxels that hold a sample, of those that would hold one of enough samples."""
        return held(self._expected[0], self.pipeline.sampling.count)

    @property
    def voxel_size_m(self) -> float:
        """Edge of a voxel [m]."""
        return self.settled.voxel_size_m

    def with_voxels(self, voxel_size_m: float) -> Self:
        """The plan with voxels of another edge [m], and what it knows of the robot; raises what `prepare` does."""
        plan = copy(self)
        vars(plan).pop("_expected", None)
        plan.job = self.job.model_copy(update={"voxel_size_m": voxel_size_m})
        plan.settled = plan.prepare(self.device, self.target)
        return plan

    @property
    def least_voxel_size_m(self) -> float:
        """Edge of a voxel [m] below which the samples leave holes."""
        return self.first_pass.least_voxel_size(None if self._iterates else self.pipeline.sampling)

    @property
    def _iterates(self) -> bool:
        return isinstance(self.job.sampling, Converge)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> WorkspacePartial:
        """Sweep the shard's samples; a converging job has one shard, its sequence of grids."""
        if isinstance(self.job.sampling, Converge):
            return self._converge(self.job.sampling, execution, tell)
        first, count = self.shards[shard]
        how: dict[str, Any] = {"threads": execution.threads, "chunk_size": execution.chunk_size}
        found = sweep(self.pipeline, first, count, devices_of(self.device), progress=tell, **how)
        return WorkspacePartial(found, self.pipeline)

    def merge(self, a: WorkspacePartial, b: WorkspacePartial) -> WorkspacePartial:
        """The partial result of both; bit for bit the same in any order."""
        return WorkspacePartial(merge(a.sweep, b.sweep), self.pipeline)

    @property
    def refinements(self) -> int:
        """The refined volume, area or length, if asked."""
        return int(self.job.refined_volume is not None)

    def refinement(self, number: int, progress: Progress | None, execution: Execution) -> dict[str, Any]:
        """The entry of the refined volume, area or length."""
        chain, seed = self.robot.chain.held(self.job.sampling.locked), self.pipeline.sampling.seed
        constraints, tolerance = self.pipeline.constraints, self.job.refined_volume
        assert tolerance is not None
        return refined(chain, tolerance, seed, self.device, progress, execution.threads, constraints)

    def with_refinements(self, partial: WorkspacePartial, refinements: list[Any]) -> WorkspacePartial:
        """With the refined volume, area or length."""
        return replace(partial, refined=RefinedRobot(refinements[0], None))

    def refine(self, partial: WorkspacePartial, progress: Progress | None, execution: Execution) -> WorkspacePartial:
        """With the labels of the voxels, if asked."""
        if not self.job.voxel_labels:
            return partial
        measure = partial.refined and partial.refined.measure
        return replace(partial, refined=RefinedRobot(measure, self._labelled(partial, progress, execution)))

    def _labelled(self, partial: WorkspacePartial, progress: Progress | None, execution: Execution) -> VolumeData:
        """The labels of the voxels."""
        pipeline = replace(partial.pipeline, statistics=frozenset())
        constraints, seed = pipeline.constraints, pipeline.sampling.seed
        drawn = admission_data(pipeline, partial.sweep) if constraints else volume_data(pipeline, partial.sweep, {})
        chain = self.robot.chain.held(self.job.sampling.locked)
        return labelled(chain, drawn, seed, self.device, progress, execution.threads, constraints)

    def result(self, partial: WorkspacePartial, execution: Execution) -> Draft:
        """Map, volume, global values and the entries of the document."""
        return workspace_draft(self.job, self.robot, partial, execution.threads)

    def unpacked(self, partial: PartialResult) -> WorkspacePartial:
        """The sweep; of a converging job with the plan of its last grid."""
        sequence, sampling = partial.facts["convergence"], self.job.sampling
        pipeline = self.pipeline
        if sequence is not None and isinstance(sampling, Converge):
            pipeline = self.with_grid(sequence[-1]["per_joint"], sampling)
        return WorkspacePartial(sweep_of(partial), pipeline, sequence)

    def _converge(self, sampling: Converge, execution: Execution, tell: Tell) -> WorkspacePartial:
        """[WSR] Algorithm 1: finer grids until an index's global value changes by at most the tolerance."""
        position = self.pipeline.evaluation.indices.index(_converging_index(self.pipeline, sampling))
        sequence: list[dict[str, float]] = []
        levels, before = sampling.start, 0
        while True:
            pipeline = self.with_grid(levels, sampling)
            count = pipeline.sampling.count
            if count > (limit := min(sampling.max_samples, self.job.max_samples)):
                values = ", ".join(f"{s['value']:.6g} ({s['per_joint']})" for s in sequence)
                raise NotConvergedError(
                    f"not converged: the next grid, {levels} per joint, has {count:.4g} samples, above "
                    f"max_samples = {limit:.4g}; {sampling.by} so far: {values or 'none'}",
                    sequence,
                )

            def report(done: int, before: int = before) -> None:
                tell(before + done)

            how: dict[str, Any] = {"threads": execution.threads, "chunk_size": execution.chunk_size}
            partial = sweep(pipeline, 0, count, devices_of(self.device), progress=report, **how)
            check_admitted(samples_entry(pipeline.constraints, count, partial.rejected), pipeline.constraints)
            value = self._global_value(pipeline, partial, position, sampling.by)
            sequence.append({"per_joint": levels, "samples": count, "value": value})
            if len(sequence) > 1 and abs(value - sequence[-2]["value"]) <= sampling.tolerance:
                return WorkspacePartial(partial, pipeline, sequence)
            levels, before = levels + sampling.step, before + count

    def with_grid(self, levels: int, sampling: Converge) -> Pipeline:
        """The pipeline of one grid; the voxel size is that of the job for all of them."""
        grid = plan_sampling(self.robot.chain, Grid(levels, locked=sampling.locked))
        pipeline = replace(self.pipeline, sampling=grid)
        if pipeline.kept_rows is not None:
            check_memory(sweep_cost(pipeline, devices_of(self.device), held(self._expected[0], grid.count)))
        return pipeline

    def _global_value(self, pipeline: Pipeline, partial: Partial, position: int, by: str) -> float:
        if by == "joint_mean":
            return float(joint_means(pipeline, partial)[position])
        value = workspace_mean(volume_data(pipeline, partial, {}), pipeline.evaluation.indices[position])
        assert value is not None
        return value


def _check_surfaces(job: WorkspaceJob, pipeline: Pipeline) -> None:
    """Whether the volume will hold what iso-surfaces are made of; raises InputError."""
    for surface in job.surfaces:
        if not isinstance(surface, IsoSurface):
            continue
        if surface.iso_surface not in pipeline.evaluation.indices:
            choices = ", ".join(pipeline.evaluation.indices)
            raise InputError("surfaces", f"{surface.iso_surface!r} is not among the job's indices: {choices}")
        if not {"maximum", "mean"} & pipeline.statistics:
            raise InputError("surfaces", "an iso-surface needs the voxel statistic maximum or mean")


def _converging_index(pipeline: Pipeline, sampling: Converge) -> str:
    (name,) = resolve((sampling.index,), pipeline.evaluation.chain.has_inertia)
    if name not in pipeline.evaluation.indices:
        raise InputError("sampling.index", f"{sampling.index!r} is not among the job's indices")
    return name
