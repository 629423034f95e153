"""The analysis ``parallel_workspace``: plan, shards, merge."""

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from wsrender.engine import LegTest, count_orientations, thread_count
from wsrender.engine.membership import LANES
from wsrender.errors import InputError, ResourceError
from wsrender.indices.catalogue import is_dynamic, resolve
from wsrender.parallel.hybrid import Variant, middle, reachable_box_of, reached_by_any, variants
from wsrender.parallel.inverse_kinematics import SAME_ORIENTATION, fault_text, inverse_kinematics
from wsrender.parallel.jacobians import check_square
from wsrender.parallel.local_indices import pose_indices
from wsrender.parallel.mechanism import Mechanism
from wsrender.parallel.membership import (
    Box,
    in_base_frame,
    leg_test,
    orientations_reached,
)
from wsrender.parallel.orientations import OrientationSet, orientation_set
from wsrender.result import Result
from wsrender.robot.indices import task_rows
from wsrender.run.parallel_exact import boundary_partial, boundary_result, region_of
from wsrender.run.parallel_result import orientation_result, positions_result, refined_entry
from wsrender.run.settled_device import settled_device
from wsrender.spec.parallel_workspace import BY_BOUNDARY, ParallelWorkspaceJob
from wsrender.spec.robot import Transform
from wsrender.volume.lattice import LatticeBlock, block_around, round_to_digits

Arrays = dict[str, np.ndarray]

RATE_CPU_CORE, RATE_GPU = 8e7, 4e8  # poses per second, rounded down from benchmarks/parallel.py
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

    def test(self, variant: Variant) -> LegTest:
        """What the kernels ask."""
        return leg_test(variant.mechanism, self.job.precision)

    def run_shard(self, shard: int, progress: Callable[[int], None] | None, **execution: Any) -> Arrays:
        """Of the shard's voxels that are reached: flat number in the block, orientations, weights, indices."""
        if self.job.kind == "orientation":
            return self._at_point(progress, **execution)
        if self.job.method in BY_BOUNDARY:
            return boundary_partial(self)
        if self.block is None:
            none = np.zeros(0, np.int64)
            return self._partial(none, none, none, 0)
        first, voxels = (number // self._count for number in self.shards[shard])
        found = []
        for number, variant in enumerate(self.variants):

            def report(done: int, before: int = number * voxels) -> None:
                if progress:
                    progress((before + done) * len(self.orientations.rotations))

            counts = count_orientations(
                self.test(variant),
                self.block,
                variant.rotations(self.orientations.rotations),
                first,
                voxels,
                weights=self.orientations.whole_weights,
                by_subsystem=self.job.method == "grid_by_subsystem",
                device=self.device,
                progress=report,
                **execution,
            )
            found.append(counts)
        cells, place = np.unique(np.concatenate([counts.cells for counts in found]), return_inverse=True)
        reached, weights = np.zeros((2, len(cells)), np.int64)
        np.add.at(reached, place, np.concatenate([counts.reached for counts in found]))
        np.add.at(weights, place, np.concatenate([counts.weights for counts in found]))
        return self._partial(cells, reached, weights, sum(counts.asked for counts in found))

    def _partial(self, cells: np.ndarray, orientations: np.ndarray, weights: np.ndarray, asked: int) -> Arrays:
        partial = {"cells": cells, "orientations": orientations, "weights": weights, "asked": np.array([asked])}
        if self.names:
            values = pose_indices(
                self.mechanism, self._poses(cells), self.names, self.rows, self.job.characteristic_length_m
            )
            partial |= {f"index_{name}": array for name, array in values.items()}
        return partial

    def _poses(self, cells: np.ndarray) -> np.ndarray:
        """Platform poses (V, 4, 4) at the centres of voxels, base frame, at the first orientation."""
        poses = np.broadcast_to(np.eye(4), (len(cells), 4, 4)).copy()
        if len(cells):
            assert self.block is not None
            at = np.stack(np.unravel_index(cells, self.block.shape), axis=1)
            world = (at + self.block.first_voxel + 0.5) * self.block.voxel_size_m
            poses[:, :3, 3] = in_base_frame(self.mechanism, world)
        poses[:, :3, :3] = self.orientations.rotations[0]
        return poses

    def _at_point(self, progress: Callable[[int], None] | None, **execution: Any) -> Arrays:
        execution.pop("chunk_size", None)
        position = in_base_frame(self.mechanism, np.array(self.job.position_m))
        test, rotations = self.test(self.variants[0]), self.orientations.rotations
        found = orientations_reached(test, position, rotations, device=self.device, **execution)
        if progress:
            progress(self._count)
        return {"reached": found}

    def merge(self, a: Arrays, b: Arrays) -> Arrays:
        """The voxels of both ranges, in the order of their numbers."""
        merged = {name: np.concatenate([a[name], b[name]]) for name in a}
        order = np.argsort(merged["cells"], kind="stable")
        asked = merged.pop("asked").sum(keepdims=True)
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
            return orientation_result(self, partial["reached"], seconds)
        return positions_result(self, partial, seconds)


def plan_parallel(job: ParallelWorkspaceJob, resolved: dict[str, Any] | None = None) -> ParallelPlan:
    """Resolve the job, or take what `ParallelPlan.resolved` of an earlier plan of it says.

    Raises InputError for a home that is not reached, indices of a mechanism that has none, or a turned delta;
    ResourceError for more poses than allowed.
    """
    found = variants(job.mechanism)
    mechanism = middle(found).mechanism
    _check_home(mechanism)
    _check_serial_joints(job, found)
    orientations = _orientations(job)
    names = resolve(job.indices, has_inertia=True) if job.indices else ()
    rows = task_rows(job.task or ("linear" if mechanism.translational else "full"))
    _check_indices(mechanism, names, rows)
    device, target = settled_device(job.device, resolved)
    if job.method in BY_BOUNDARY:
        region_of(mechanism, orientations.rotations[0])
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
    estimate = {"samples": poses, "bytes": 8 * poses / len(orientations.rotations), "seconds": poses / rate}
    return ParallelPlan(job, found, orientations, block, rows, names, device, target, shards, estimate)


def _check_home(mechanism: Mechanism) -> None:
    if mechanism.home is None:
        return
    legs = inverse_kinematics(mechanism, mechanism.home[None])
    if not legs.feasible[0]:
        raise InputError("mechanism.home", f"must be reached, but {fault_text(mechanism, legs, 0)}")


def _check_indices(mechanism: Mechanism, names: tuple[str, ...], rows: tuple[int, ...]) -> None:
    if not names:
        return
    check_square(mechanism)
    if dynamic := next((name for name in names if is_dynamic(name)), None):
        raise InputError("indices", f"must be kinematic for a mechanism, whose legs have no inertia, not {dynamic!r}")
    if mechanism.translational and max(rows) > 2:
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


def _check_serial_joints(job: ParallelWorkspaceJob, found: list[Variant]) -> None:
    """Raise InputError for what is not offered of hybrid mechanisms."""
    if len(found) == 1:
        return
    if job.kind != "constant_orientation":
        raise InputError("kind", f'must be "constant_orientation" of a mechanism with serial joints, not "{job.kind}"')
    if job.method in BY_BOUNDARY:
        raise InputError("method", f'must be "grid" or "grid_by_subsystem" with serial joints, not "{job.method}"')
    if job.indices:
        raise InputError("indices", "must be [] of a mechanism with serial joints: it reaches a pose in many ways")


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
