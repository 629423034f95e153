"""The analysis ``parallel_workspace``: plan, shards, merge."""

import json
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from wsrender.engine import OrientationCounts, thread_count
from wsrender.engine.membership import LANES
from wsrender.errors import InputError, ResourceError
from wsrender.indices.catalogue import is_dynamic, resolve
from wsrender.parallel.hybrid import Variant, added, count_union, middle, reachable_box_of, reached_by_any, variants
from wsrender.parallel.inverse_kinematics import SAME_ORIENTATION
from wsrender.parallel.jacobians import check_square
from wsrender.parallel.local_indices import CONDITION_NUMBERS, DETERMINANTS, pose_indices
from wsrender.parallel.mechanism import Mechanism
from wsrender.parallel.membership import Box, count_lattice, fault_at, in_base_frame, orientations_labelled
from wsrender.parallel.orientations import OrientationSet, orientation_set
from wsrender.reachability.inverse_solver import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.result import Result
from wsrender.robot import Robot
from wsrender.robot.indices import task_rows
from wsrender.run.parallel_exact import boundary_partial, boundary_result, region_of
from wsrender.run.parallel_result import orientation_result, positions_result, refined_entry
from wsrender.run.settled_device import settled_device
from wsrender.spec.parallel_workspace import BY_BOUNDARY, ParallelWorkspaceJob
from wsrender.spec.robot import Transform
from wsrender.volume.lattice import LatticeBlock, block_around, round_to_digits

Arrays = dict[str, np.ndarray]

RATE_CPU_CORE, RATE_GPU = 8e7, 4e8  # poses per second, rounded down from benchmarks/parallel.py
RATE_NUMERIC_CORE = 5e4  # poses of a numeric leg per second, from benchmarks/inverse.py
FIRST_POINTS, FEWEST_POINTS = 1 << 16, 1 << 10  # of the estimate that the default voxel size is made of
LEAST_SHARE = 1e-3  # of the box: where hardly anything is reached


@dataclass(eq=False)
class ParallelPlan:
    """A resolved ``parallel_workspace`` job; ``block`` is None where no lattice is tested.

    ``variants``: the mechanism at every combination of values of its serial joints, one where it has none.
    """

    job: ParallelWorkspaceJob
    variants: list[Variant]
    orientations: OrientationSet
    block: LatticeBlock | None
    rows: tuple[int, ...]
    names: tuple[str, ...]
    device: str
    target: str
    shards: list[tuple[int, int]]
    estimate: dict[str, float] = field(default_factory=dict)

    def resolved(self) -> dict[str, Any]:
        """What is settled once: the device that "auto" means, target, lattice block, shards."""
        block = self.block
        return {
            "device": self.device,
            "target": self.target,
            "block": None if block is None else [block.voxel_size_m, list(block.first_voxel), list(block.shape)],
            "shards": [list(shard) for shard in self.shards],
            "shard_unit": None if block is None else LANES * self._count,
        }

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
        single = len(self.variants) == 1 and not self.mechanism.numeric
        return (*CONDITION_NUMBERS, *DETERMINANTS) if single else CONDITION_NUMBERS

    def run_shard(self, shard: int, progress: Callable[[int], None] | None, **execution: Any) -> Arrays:
        """Of the shard's voxels that are reached: flat number in the block, orientations, weights, indices."""
        if self.job.kind == "orientation":
            return self._at_point(progress, **execution)
        if self.job.method in BY_BOUNDARY:
            return boundary_partial(self)
        if self.block is None:
            none = np.zeros(0, np.int64)
            return self._partial(OrientationCounts(none, none, none, 0), [])
        block, (first, voxels) = self.block, (number // self._count for number in self.shards[shard])
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
                **execution,
            )
            return replace(found, cells=found.cells - first)

        def reporting(poses_before: int, poses: int) -> Callable[[int], None]:
            return lambda done: progress(poses_before + done * poses) if progress else None

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

    def _partial(self, found: OrientationCounts, cells_of_variants: list[np.ndarray]) -> Arrays:
        partial = {
            "cells": found.cells,
            "orientations": found.reached,
            "weights": found.weights,
            "asked": np.array([found.asked, found.undecided]),
        }
        if self.names:
            values = {name: np.full(len(found.cells), -np.inf) for name in (*self.names, *self.center_names)}
            for variant, cells in zip(self.variants, cells_of_variants, strict=False):
                at = np.searchsorted(found.cells, cells)
                for name, of_variant in self._indices(variant, cells).items():
                    values[name][at] = np.maximum(values[name][at], of_variant)
            partial |= {f"index_{name}": array for name, array in values.items()}
        return partial

    def _indices(self, variant: Variant, cells: np.ndarray) -> Arrays:
        """Indices at voxels that a variant reaches; those of hybrids are maxima over their serial joints."""
        hybrid = len(self.variants) > 1
        return pose_indices(
            variant.mechanism,
            self._poses(variant, cells),
            self.names,
            self.rows,
            self.job.characteristic_length_m,
            variant.composed if hybrid else None,
        )

    def _poses(self, variant: Variant, cells: np.ndarray) -> np.ndarray:
        """Platform poses (V, 4, 4) at the centres of voxels, base frame, at the first orientation."""
        poses = np.broadcast_to(np.eye(4), (len(cells), 4, 4)).copy()
        if len(cells):
            assert self.block is not None
            poses[:, :3, 3] = in_base_frame(variant.mechanism, self.block.centers(cells))
        poses[:, :3, :3] = variant.rotations(self.orientations.rotations[:1])[0]
        return poses

    def _at_point(self, progress: Callable[[int], None] | None, **execution: Any) -> Arrays:
        execution.pop("chunk_size", None)
        options = {"precision": self.job.precision, "device": self.device, **execution}
        options["by_subsystem"] = self.job.method == "grid_by_subsystem"
        rotations = self.orientations.rotations
        labels = np.full(len(rotations), UNREACHABLE, np.int8)
        for number, variant in enumerate(self.variants, start=1):
            position = in_base_frame(variant.mechanism, np.array(self.job.position_m))
            found = orientations_labelled(variant.mechanism, position, variant.rotations(rotations), **options)
            labels = np.where(labels == REACHABLE, labels, np.where(found == UNREACHABLE, labels, found))
            if progress:
                progress(number * len(rotations))
        return {"reached": labels == REACHABLE, "undecided": labels == UNDECIDED}

    def merge(self, a: Arrays, b: Arrays) -> Arrays:
        """The voxels of both ranges, in the order of their numbers."""
        merged = {name: np.concatenate([a[name], b[name]]) for name in a}
        order = np.argsort(merged["cells"], kind="stable")
        asked = merged.pop("asked").reshape(2, -1).sum(axis=0)
        return {"asked": asked, **{name: values[order] for name, values in merged.items()}}

    def refine(self, partial: Arrays, progress: Callable[[int, int, str], None] | None) -> Arrays:
        """The merged partial result, with the refined volume if asked."""
        if self.job.refined_volume is None:
            return partial

        def report(done: int, total: int) -> None:
            if progress:
                progress(done, max(total, done), "refining the volume")

        return {**partial, "refined": np.array(json.dumps(refined_entry(self, partial, report)))}

    def finish(self, partial: Arrays, seconds: dict[str, float]) -> Result:
        """Volume data or mesh, document, tables and the legs in a typical pose."""
        if self.job.method in BY_BOUNDARY:
            return boundary_result(self, partial, seconds)
        if self.job.kind == "orientation":
            return orientation_result(self, partial, seconds)
        return positions_result(self, partial, seconds)


def plan_parallel(job: ParallelWorkspaceJob, *robots: Robot, resolved: dict[str, Any] | None = None) -> ParallelPlan:
    """Resolve the job, or take what `ParallelPlan.resolved` of an earlier plan of it says.

    ``robots``: the mechanism's serial legs.

    Raises InputError for a home that is not reached, indices of a mechanism that has none, or a turned delta;
    ResourceError for more poses than allowed.
    """
    found = variants(job.mechanism, robots)
    mechanism = middle(found).mechanism
    _check_home(mechanism)
    _check_combination(job, found)
    orientations = _orientations(job)
    names = resolve(job.indices, has_inertia=True) if job.indices else ()
    rows = task_rows(job.task or ("linear" if mechanism.translational else "full"))
    _check_indices(mechanism, names, rows, hybrid=len(found) > 1)
    device, target = settled_device(job.device, resolved)
    if job.method in BY_BOUNDARY:
        _check_boundary(mechanism, orientations)
    if resolved is None:
        on_lattice = job.kind != "orientation" and job.method not in BY_BOUNDARY
        block = _block(job, found, orientations, device) if on_lattice else None
        poses = len(found) * len(orientations.rotations) * (block.size if block else 1)
        if poses > job.max_poses:
            raise ResourceError("max_poses", f"is {job.max_poses:.4g}; the job has {poses:.4g} poses: larger voxels?")
        shards = [(0, poses)]
    else:
        block = _settled(resolved["block"])
        shards = [(first, count) for first, count in resolved["shards"]]
    poses = float(sum(count for _, count in shards))
    rate = RATE_GPU if target.startswith("cuda") else RATE_CPU_CORE * thread_count()
    seconds = poses / rate + poses * len(mechanism.numeric) / (RATE_NUMERIC_CORE * thread_count())
    estimate = {"samples": poses, "bytes": 8 * poses / len(orientations.rotations), "seconds": seconds}
    return ParallelPlan(job, found, orientations, block, rows, names, device, target, shards, estimate)


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


def _settled(block: list[Any] | None) -> LatticeBlock | None:
    if block is None:
        return None
    size, first, shape = block
    return LatticeBlock(size, tuple(first), tuple(shape))


def _check_combination(job: ParallelWorkspaceJob, found: list[Variant]) -> None:
    """Raise InputError for what has no sense of this mechanism."""
    if found[0].mechanism.translational and job.kind != "constant_orientation":
        message = "a delta's platform does not turn, and serial joints bring it to single orientations only"
        raise InputError("kind", f'must be "constant_orientation", not "{job.kind}": {message}')
    if len(found) > 1 and job.method in BY_BOUNDARY:
        message = "the workspace is a union over the values of the serial joints"
        raise InputError("method", f'must be "grid" or "grid_by_subsystem", not "{job.method}": {message}')


def _block(
    job: ParallelWorkspaceJob, found: list[Variant], orientations: OrientationSet, device: str
) -> LatticeBlock | None:
    """The lattice around all that the legs can reach; None where that is nothing."""
    level = np.allclose(orientations.rotations, np.eye(3), rtol=0, atol=SAME_ORIENTATION)
    if found[0].mechanism.translational and not level:
        raise InputError("orientation", "must be null: the parallelograms of a delta do not let its platform turn")
    box = reachable_box_of(found, orientations.rotations)
    if box is None:
        return None
    return block_around(box.lower, box.upper, job.voxel_size_m or _voxel_size(found, orientations, box, device))


def _voxel_size(found: list[Variant], orientations: OrientationSet, box: Box, device: str) -> float:
    """A hundredth of the cube root of the volume reached at any orientation, estimated, to two significant digits."""
    from scipy.stats.qmc import Sobol

    points = max(FIRST_POINTS // len(orientations.rotations), FEWEST_POINTS)
    unit = Sobol(3, scramble=False).random_base2(int(points).bit_length() - 1)
    inside = reached_by_any(found, box.lower + unit * (box.upper - box.lower), orientations.rotations, device=device)
    return round_to_digits(float(np.cbrt(box.volume * max(inside.mean(), LEAST_SHARE))) / 100.0, 2)
