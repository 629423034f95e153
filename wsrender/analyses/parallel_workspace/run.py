"""The analysis ``parallel_workspace``: plan, shards, merge."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Progress, Settled, Tell
from wsrender.analyses.cost import (
    DOCUMENT_BYTES,
    WRITTEN_PER_S,
    Asks,
    Cost,
    fits,
    pictures_cost,
    refined_bytes,
    refined_seconds,
    surface_bytes,
)
from wsrender.analyses.execution import Execution
from wsrender.analyses.parallel_workspace.exact import boundary_partial, boundary_result
from wsrender.analyses.parallel_workspace.job import BY_BOUNDARY, ParallelWorkspaceJob
from wsrender.analyses.parallel_workspace.lattice import (
    common_flat,
    described,
    lattice_of,
    quantity,
    reached_share,
    settled_lattice,
)
from wsrender.analyses.parallel_workspace.refined import (
    labels_at_poses,
    occupied_cells,
    packed,
    refined_entry,
    unpacked,
)
from wsrender.analyses.parallel_workspace.result import orientation_result, positions_result
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.refined import VOLUME
from wsrender.documents.robot import Transform
from wsrender.engine import OrientationCounts, thread_count
from wsrender.engine.membership import LANES
from wsrender.engine.ranges import check_range
from wsrender.errors import InputError, ResourceError
from wsrender.indices.index_catalogue import is_dynamic, option_values, resolve
from wsrender.mechanisms.ball_region import region_of
from wsrender.mechanisms.hybrid import Variant, added, count_union, middle, variants
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.jacobians import CONDITION_NUMBERS, DETERMINANTS, check_square, pose_indices
from wsrender.mechanisms.keeping_apart import bodies_apart
from wsrender.mechanisms.mechanism import Mechanism
from wsrender.mechanisms.membership import count_lattice, fault_at, in_base_frame, orientations_labelled
from wsrender.mechanisms.orientations import OrientationSet, orientation_set, random_orientations
from wsrender.mechanisms.serial_search import SerialSearch, serial_search
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.volume_estimate import wilson
from wsrender.robot.indices import task_rows
from wsrender.volume.lattice import LatticeBlock

Arrays = dict[str, np.ndarray]

RATE_CPU_CORE, RATE_GPU = 1.6e8, 4e8  # poses per second, rounded down from benchmarks/parallel.py
INDEX_BYTES = 750  # of a voxel while its indices are computed: its pose, Jacobians and their inverses
APART_PER_S = 1e3  # poses of six legs, a platform and two things around: of one core
APART_POINTS = 4.0  # of a refined volume, those that legs reach by themselves: over the square of the tolerance
INDICES_PER_S = 8e4  # voxels whose indices are computed
POSE_BYTES, SHARE_BYTES = 75, 4.4e7  # of an orientation at a point; of the estimate of their share
BOUNDARY_BYTES = 3.3e6  # of the mesh of an exact boundary
COPIES = 5  # of what is kept of a voxel: of parts, joined and sorted, and of the result
RATE_NUMERIC_CORE = 5e4  # poses of a numeric leg per second, from benchmarks/inverse.py


@dataclass(frozen=True, kw_only=True)
class ParallelWorkspaceSettled(Settled):
    """With the lattice block as lists and numbers (see `described`); None where none is tested.

    ``occupied``: in the round of the refined volume, `packed` cells in which voxels were reached.
    """

    block: list[Any] | None
    occupied: str | None = None


class ParallelWorkspaceAnalysis(Analysis):
    """A planned ``parallel_workspace`` job; its robots are the mechanism's serial legs."""

    settles = ParallelWorkspaceSettled
    job: ParallelWorkspaceJob
    settled: ParallelWorkspaceSettled

    def prepare(self, device: str, target: str) -> ParallelWorkspaceSettled:
        """Raises InputError for a home that is not reached, indices of a mechanism that has none, or a turned delta.

        ResourceError for more poses than allowed.
        """
        job, mechanism = self.job, self.mechanism
        _check_home(mechanism)
        _check_combination(job, self.variants)
        _ = self.options
        _check_indices(mechanism, self.names, self.rows, hybrid=len(self.variants) > 1)
        by_boundary = job.method in BY_BOUNDARY
        if by_boundary:
            _check_boundary(mechanism, self.orientations)
        on_lattice = job.kind != "orientation" and not by_boundary
        block = lattice_of(job, self.variants, self.orientations, device) if on_lattice else None
        poses = self._count * (block.size if block else 1)
        if poses > job.max_poses:
            raise ResourceError("max_poses", f"is {job.max_poses:.4g}; the job has {poses:.4g} poses: larger voxels?")
        unit = None if block is None else LANES * self._count
        return ParallelWorkspaceSettled(device, target, ((0, poses),), unit, block=described(block))

    @cached_property
    def variants(self) -> list[Variant]:
        """The mechanism at every combination of values of its serial joints, one where it has none."""
        return variants(self.job.mechanism, self.robots)

    @cached_property
    def search(self) -> SerialSearch | None:
        """Over all values of the serial joints; None where the mechanism has none."""
        return serial_search(self.job.mechanism, self.robots) if len(self.variants) > 1 else None

    @cached_property
    def orientations(self) -> OrientationSet:
        """The orientations that are tested."""
        return _orientations(self.job)

    @cached_property
    def block(self) -> LatticeBlock | None:
        """The lattice; None where none is tested."""
        return settled_lattice(self.settled.block)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The indices."""
        return resolve(self.job.indices, has_inertia=True) if self.job.indices else ()

    @cached_property
    def options(self) -> dict[str, dict[str, Any]]:
        """Their options by name."""
        return option_values(self.job.index_options, self.names)

    @cached_property
    def rows(self) -> tuple[int, ...]:
        """Rows of the Jacobian of the indices."""
        return task_rows(self.job.task or ("linear" if self.mechanism.translational else "full"))

    @cached_property
    def unmeasured(self) -> str:
        """Why what is reached has neither a volume nor an area or a length; empty where it has."""
        return common_flat(self.variants, self.orientations)[1]

    @property
    def cost(self) -> Cost:
        """Poses, labels of the voxels, files and seconds."""
        poses, threads = float(sum(count for _, count in self.shards)), thread_count()
        rate = RATE_GPU if self.target.startswith("cuda") else RATE_CPU_CORE * threads
        seconds = poses / rate + poses * len(self.mechanism.numeric) / (RATE_NUMERIC_CORE * threads)
        if self.mechanism.bodies:
            refined = APART_POINTS / self.job.refined_volume**2 if self.job.refined_volume else 0.0
            seconds += (self._reached + refined) * self.mechanism.bodies.effort / APART_PER_S
        drawn, drawing = pictures_cost("slices", "robot", "targets")
        kept = (8 + 12 * self._columns) * self._reached + surface_bytes(self._reached)
        seconds += self._reached * bool(self.names) / INDICES_PER_S + drawing + refined_seconds(self.job.refined_volume)
        files = DOCUMENT_BYTES + drawn + kept
        asks = Asks("orientations", "take fewer")
        if self.block is not None:
            asks = Asks("voxel_size_m", voxel_size_m=self.block.voxel_size_m)
        return Cost(poses, self._memory(self._reached), files, seconds + files / WRITTEN_PER_S, asks)

    def check_memory(self) -> None:
        """Refused is what does not fit; how many voxels are reached need not be known of what fits in any case."""
        if not fits(self._memory(self.block.size if self.block else 0)):
            super().check_memory()

    def _memory(self, reached: float) -> float:
        """Of so many voxels that are reached, of a boundary, or of the orientations at a point."""
        if self.job.kind == "orientation":
            return SHARE_BYTES + POSE_BYTES * self.samples
        if self.job.method in BY_BOUNDARY:
            return BOUNDARY_BYTES
        kept = (COPIES * 8 * (3 + self._columns) + INDEX_BYTES * bool(self.names)) * reached
        return float(max(kept, refined_bytes(self.job.refined_volume)))

    @cached_property
    def _reached(self) -> float:
        """How many voxels are reached, about."""
        if self.block is None:
            return 0.0
        return self.block.size * reached_share(self.block, self.variants, self.orientations, self.device)

    def about_robots(self) -> dict[str, Any]:
        """Nothing: the mechanism's legs name them."""
        return {}

    @property
    def _columns(self) -> int:
        """Values that are kept of a voxel with indices."""
        single = len(self.variants) > 1 or self.mechanism.numeric
        postures = 1 if single else len(self.mechanism.on_each_branch())
        return len(self.names) + len(CONDITION_NUMBERS) + 2 * postures if self.names else 0

    @property
    def mechanism(self) -> Mechanism:
        """The mechanism, its serial joints in the middle of their ranges."""
        return middle(self.variants).mechanism

    @property
    def _count(self) -> int:
        """Poses of a voxel."""
        return len(self.orientations.rotations) * len(self.variants)

    @property
    def center_names(self) -> tuple[str, ...]:
        """What is kept at voxels' centres beside the indices; determinants where a place has one posture."""
        single = self.has_determinants and not self.mechanism.branched
        return (*CONDITION_NUMBERS, *DETERMINANTS) if single else CONDITION_NUMBERS

    @property
    def revolute(self) -> tuple[bool, ...]:
        """Whether each joint turns, or slides, whose columns the Jacobian of the indices has."""
        return self.variants[0].revolute if len(self.variants) > 1 else self.mechanism.revolute

    @property
    def quantity(self) -> tuple[str, str]:
        """What is measured, and its unit: volume, or in a plane area, on a line length."""
        return quantity(self.block)

    @property
    def has_determinants(self) -> bool:
        """Whether a place has one posture on each combination of the legs' branches."""
        return len(self.variants) == 1 and not self.mechanism.numeric

    def counted(self, partial: PartialResult) -> np.ndarray:
        """Which of the partial's voxels belong to the workspace: all but those that miss one of all orientations."""
        if self.job.kind == "total_orientation":
            return partial["orientations"] == len(self.orientations.rotations)
        return np.ones(len(partial["cells"]), bool)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Of the shard's voxels that are reached: flat number in the block, orientations, weights, indices."""
        if self.job.kind == "orientation":
            return self._at_point(execution, tell)
        if self.job.method in BY_BOUNDARY:
            return boundary_partial(self)
        if self.block is None:
            none = np.zeros(0, np.int64)
            return self._partial(OrientationCounts(none, none, none, 0), [])
        block = self.block
        check_range(*self.shards[shard], block.size * self._count, LANES * self._count)
        first, voxels = (number // self._count for number in self.shards[shard])
        rotations, weights = self.orientations.rotations, self.orientations.whole_weights

        def count(variant: Variant, turned: np.ndarray, weights: np.ndarray, report=None) -> OrientationCounts:
            found = count_lattice(
                variant.mechanism,
                block,
                turned,
                first,
                voxels,
                weights=weights,
                by_subsystem=self.job.method == "grid_by_subsystem",
                precision=self.job.precision,
                device=self.device,
                progress=report,
                threads=execution.threads,
                chunk_size=execution.chunk_size,
            )
            return replace(found, cells=found.cells - first)

        def reporting(poses_before: int, poses: int) -> Callable[[int], None]:
            return lambda done: tell(poses_before + done * poses)

        if self.job.kind == "constant_orientation":
            each = [
                count(variant, variant.rotations(rotations), weights, reporting(number * voxels, 1))
                for number, variant in enumerate(self.variants)
            ]
            total = each[0] if len(each) == 1 else added(each)
        elif len(self.variants) == 1:
            each, (variant,) = [], self.variants
            total = count(variant, variant.rotations(rotations), weights, reporting(0, len(rotations)))
        else:
            per_orientation = reporting(0, voxels * len(self.variants))
            each, total = [], count_union(self.variants, count, rotations, weights, voxels, per_orientation)
        return self._partial(replace(total, cells=total.cells + first), [found.cells + first for found in each])

    def _partial(self, found: OrientationCounts, cells_of_variants: list[np.ndarray]) -> PartialResult:
        partial = {
            "cells": found.cells,
            "orientations": found.reached,
            "weights": found.weights,
            "asked": np.array(OrientationCounts.totals([found])),
        }
        if self.names:
            partial |= self._indices(found.cells, cells_of_variants)
        return PartialResult(partial)

    def _indices(self, cells: np.ndarray, cells_of_variants: list[np.ndarray]) -> Arrays:
        """Indices at voxels: maxima over the serial joints' values, and over the branches on which legs reach them.

        Determinants have a sign of their own on each combination of branches, a column of ``branch_…`` (V, C).
        """
        values = {name: np.full(len(cells), -np.inf) for name in (*self.names, *self.center_names)}
        each = self.mechanism.on_each_branch()
        by_branch = self.has_determinants and len(each) > 1
        signed = {name: np.full((len(cells), len(each)), np.nan) for name in DETERMINANTS} if by_branch else {}
        for variant, own in zip(self.variants, cells_of_variants, strict=False):
            at = np.searchsorted(cells, own)
            for column, (rows, found) in enumerate(self._on_branches(variant, own)):
                for name in values:
                    values[name][at[rows]] = np.maximum(values[name][at[rows]], found[name])
                for name, table in signed.items():
                    table[at[rows], column] = found[name]
        return {f"index_{name}": array for name, array in values.items()} | {
            f"branch_{name}": table for name, table in signed.items()
        }

    def _on_branches(self, variant: Variant, cells: np.ndarray) -> Iterator[tuple[np.ndarray, Arrays]]:
        """On each combination of branches, which of a variant's voxels are reached, and the indices there."""
        poses, every = self._poses(variant, cells), variant.mechanism.on_each_branch()
        for mechanism in every:
            rows = np.arange(len(cells))
            if len(every) > 1:
                feasible = inverse_kinematics(mechanism, poses).feasible
                rows = np.flatnonzero(feasible & bodies_apart(mechanism, poses))
            hybrid = variant.composed if len(self.variants) > 1 else None
            length = self.job.characteristic_length_m
            yield rows, pose_indices(mechanism, poses[rows], self.names, self.rows, length, hybrid, self.options)

    def _poses(self, variant: Variant, cells: np.ndarray) -> np.ndarray:
        """Platform poses (V, 4, 4) at the centres of voxels, base frame, at the first orientation."""
        poses = np.broadcast_to(np.eye(4), (len(cells), 4, 4)).copy()
        if len(cells):
            assert self.block is not None
            poses[:, :3, 3] = in_base_frame(variant.mechanism, self.block.centers(cells))
        poses[:, :3, :3] = variant.rotations(self.orientations.rotations[:1])[0]
        return poses

    def _at_point(self, execution: Execution, tell: Tell) -> PartialResult:
        options = {"precision": self.job.precision, "device": self.device, "threads": execution.threads}
        options["by_subsystem"] = self.job.method == "grid_by_subsystem"
        rotations = self.orientations.rotations
        labels, constrained = np.full(len(rotations), UNREACHABLE, np.int8), np.zeros(2, np.int64)
        for number, variant in enumerate(self.variants, start=1):
            position = in_base_frame(variant.mechanism, np.array(self.job.position_m))
            turned = variant.rotations(rotations)
            found, rejections = orientations_labelled(variant.mechanism, position, turned, **options)
            constrained += rejections
            labels = np.where(labels == REACHABLE, labels, np.where(found == UNREACHABLE, labels, found))
            tell(number * len(rotations))
        share = self._share_at_point(execution.threads)
        reached, undecided = labels == REACHABLE, labels == UNDECIDED
        arrays = {"reached": reached, "undecided": undecided, "share": share, "constrained": constrained}
        return PartialResult(arrays)

    def _share_at_point(self, threads: int | None) -> np.ndarray:
        """Value and 95 % interval (3,) of the share of the orientations' ranges, from random ones, not from levels."""
        assert self.job.orientations is not None and self.job.position_m is not None
        numeric, searched = self.mechanism.numeric, self.search is not None
        count = 1000 if numeric else 4000 if searched else 100_000
        rotations = random_orientations(self.job.orientations, count, self.job.seed)
        labels = labels_at_poses(self, np.tile(self.job.position_m, (count, 1)), rotations, threads)
        surely, possibly = int((labels == REACHABLE).sum()), int((labels != UNREACHABLE).sum())
        low, high = wilson(np.array(surely), np.array(count))[0], wilson(np.array(possibly), np.array(count))[1]
        return np.array([(surely + possibly) / (2 * count), low, high])

    def merge(self, a: PartialResult, b: PartialResult) -> PartialResult:
        """The voxels of both ranges, in the order of their numbers."""
        merged = {name: np.concatenate([a[name], b[name]]) for name in a.arrays}
        order = np.argsort(merged["cells"], kind="stable")
        asked = merged.pop("asked").reshape(2, -1).sum(axis=0)
        return PartialResult({"asked": asked, **{name: values[order] for name, values in merged.items()}})

    def further(self, partial: PartialResult, execution: Execution) -> Settled | None:
        """A last round, of the refined volume alone: it follows from the voxels."""
        if self.job.refined_volume is None or self.unmeasured or self.settled.occupied is not None:
            return None
        shards = (*self.settled.shards, (self.samples, 0))
        return replace(self.settled, shards=shards, occupied=packed(occupied_cells(self, partial)))

    @property
    def refinements(self) -> int:
        """The refined volume, in its round."""
        return int(self.settled.occupied is not None)

    def refinement(self, number: int, progress: Progress | None, execution: Execution) -> dict[str, Any]:
        """The entry of the refined volume."""
        assert self.settled.occupied is not None
        report = None if progress is None else lambda done, total: progress(done, total, VOLUME)
        return refined_entry(self, unpacked(self, self.settled.occupied), report, execution.threads)

    def with_refinements(self, partial: PartialResult, refinements: list[Any]) -> PartialResult:
        """With the refined volume."""
        return PartialResult(partial.arrays, {**partial.facts, "refined": refinements[0]})

    def refine(self, partial: PartialResult, progress: Progress | None, execution: Execution) -> PartialResult:
        """With the refined volume, where no round was made of it."""
        last = self.further(partial, execution)
        if last is None:
            return partial
        return self.with_refinements(partial, [self.settled_as(last).refinement(0, progress, execution)])

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """Volume data or mesh, entries, tables and the legs in a typical pose."""
        if self.job.method in BY_BOUNDARY:
            return boundary_result(self, partial)
        if self.job.kind == "orientation":
            return orientation_result(self, partial)
        return positions_result(self, partial)


def _check_home(mechanism: Mechanism) -> None:
    if mechanism.home is None:
        return
    if fault := fault_at(mechanism, mechanism.home):
        raise InputError("mechanism.home", f"must be reached, but {fault}")


def _check_boundary(mechanism: Mechanism, orientations: OrientationSet) -> None:
    try:
        region_of(mechanism, orientations.rotations[0])
    except InputError as error:
        message = f'{error.message}; use the method "grid" or "grid_by_subsystem"'
        raise InputError(error.field, message) from None


def _check_indices(mechanism: Mechanism, names: tuple[str, ...], rows: tuple[int, ...], hybrid: bool) -> None:
    if not names:
        return
    check_square(mechanism)
    if dynamic := next((name for name in names if is_dynamic(name)), None):
        raise InputError("indices", f"must be kinematic for a mechanism, whose legs have no inertia, not {dynamic!r}")
    if mechanism.translational and max(rows) > 2 and not hybrid:
        raise InputError("task", 'must be "linear" or rows from x y z: the platform of a delta does not turn')


def _orientations(job: ParallelWorkspaceJob) -> OrientationSet:
    """The orientations of the job; one, of weight 1, for a constant orientation."""
    if job.orientations is not None:
        return orientation_set(job.orientations)
    rotation = (job.orientation or Transform()).matrix()[None, :3, :3]
    return OrientationSet(("alpha", "beta", "gamma"), np.zeros((1, 3)), rotation, np.ones(1), (1, 1, 1))


def _check_combination(job: ParallelWorkspaceJob, found: list[Variant]) -> None:
    """Raise InputError for what has no sense of this mechanism."""
    if found[0].mechanism.translational and job.kind != "constant_orientation":
        message = "a delta's platform does not turn, and serial joints bring it to single orientations only"
        raise InputError("kind", f'must be "constant_orientation", not "{job.kind}": {message}')
    if len(found) > 1 and job.method in BY_BOUNDARY:
        message = "the workspace is a union over the values of the serial joints"
        raise InputError("method", f'must be "grid" or "grid_by_subsystem", not "{job.method}": {message}')
