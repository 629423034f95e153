"""The analysis ``parallel_workspace``: plan, shards, merge."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from wsrender.engine import LegTest, count_orientations, count_orientations_at, thread_count
from wsrender.engine.membership import LANES
from wsrender.errors import InputError, ResourceError
from wsrender.indices.catalogue import is_dynamic, resolve
from wsrender.parallel.inverse_kinematics import SAME_ORIENTATION, fault_text, inverse_kinematics
from wsrender.parallel.jacobians import check_square
from wsrender.parallel.local_indices import pose_indices
from wsrender.parallel.mechanism import Mechanism, mechanism_of
from wsrender.parallel.membership import (
    Box,
    in_base_frame,
    leg_test,
    orientations_reached,
    placed_box,
    reachable_box,
)
from wsrender.parallel.orientations import OrientationSet, orientation_set
from wsrender.result import Result
from wsrender.robot.indices import task_rows
from wsrender.run.parallel_exact import boundary_partial, boundary_result, region_of
from wsrender.run.parallel_result import orientation_result, positions_result
from wsrender.run.settled_device import settled_device
from wsrender.spec.parallel_workspace import BY_BOUNDARY, ParallelWorkspaceJob
from wsrender.spec.robot import Transform
from wsrender.volume.lattice import LatticeBlock, block_around, round_to_digits

Arrays = dict[str, np.ndarray]

RATE_CPU_CORE, RATE_GPU = 3e7, 5e9  # poses per second, rounded down from benchmarks/parallel.py
FIRST_POINTS, FEWEST_POINTS = 1 << 16, 1 << 10  # of the estimate that the default voxel size is made of
LEAST_SHARE = 1e-3  # of the box: where hardly anything is reached


@dataclass(eq=False)
class ParallelPlan:
    """A resolved ``parallel_workspace`` job; ``block`` is None where no lattice is tested."""

    job: ParallelWorkspaceJob
    mechanism: Mechanism
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
    def _count(self) -> int:
        return len(self.orientations.rotations)

    @property
    def test(self) -> LegTest:
        """What the kernels ask."""
        return leg_test(self.mechanism, self.job.precision)

    def run_shard(self, shard: int, progress: Callable[[int], None] | None, **execution: Any) -> Arrays:
        """Of the shard's voxels that are reached: flat number in the block, orientations, weights, indices."""
        if self.job.kind == "orientation":
            return self._at_point(progress, **execution)
        if self.job.method in BY_BOUNDARY:
            return boundary_partial(self)
        if self.block is None:
            return self._partial(np.zeros(0, np.int64), np.zeros(0, np.int32), np.zeros(0, np.int32), 0)
        first, poses = (number // self._count for number in self.shards[shard])
        counts = count_orientations(
            self.test,
            self.block,
            self.orientations.rotations,
            first,
            poses,
            weights=self.orientations.whole_weights,
            by_subsystem=self.job.method == "grid_by_subsystem",
            device=self.device,
            progress=progress and (lambda done: progress(done * self._count)),
            **execution,
        )
        cells = np.flatnonzero(counts.reached)
        return self._partial(cells + first, counts.reached[cells], counts.weights[cells], counts.asked)

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
        found = orientations_reached(self.test, position, self.orientations.rotations, device=self.device, **execution)
        if progress:
            progress(self._count)
        return {"reached": found}

    def merge(self, a: Arrays, b: Arrays) -> Arrays:
        """The voxels of both ranges, in the order of their numbers."""
        merged = {name: np.concatenate([a[name], b[name]]) for name in a}
        order = np.argsort(merged["cells"], kind="stable")
        asked = merged.pop("asked").sum(keepdims=True)
        return {"asked": asked, **{name: values[order] for name, values in merged.items()}}

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
    mechanism = mechanism_of(job.mechanism)
    _check_home(mechanism)
    orientations = _orientations(job)
    names = resolve(job.indices, has_inertia=True) if job.indices else ()
    rows = task_rows(job.task or ("linear" if mechanism.translational else "full"))
    _check_indices(mechanism, names, rows)
    device, target = settled_device(job.device, resolved)
    if job.method in BY_BOUNDARY:
        region_of(mechanism, orientations.rotations[0])
    if resolved is None:
        on_lattice = job.kind != "orientation" and job.method not in BY_BOUNDARY
        block = _block(job, mechanism, orientations, device) if on_lattice else None
        poses = len(orientations.rotations) * (block.size if block else 1)
        if poses > job.max_poses:
            raise ResourceError("max_poses", f"is {job.max_poses:.4g}; the job has {poses:.4g} poses: larger voxels?")
        shards = [(0, poses)]
    else:
        block = _settled(resolved["block"])
        shards = [(first, count) for first, count in resolved["shards"]]
    poses = float(sum(count for _, count in shards))
    rate = RATE_GPU if target.startswith("cuda") else RATE_CPU_CORE * thread_count()
    estimate = {"samples": poses, "bytes": 8 * poses / len(orientations.rotations), "seconds": poses / rate}
    return ParallelPlan(job, mechanism, orientations, block, rows, names, device, target, shards, estimate)


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


def _block(
    job: ParallelWorkspaceJob, mechanism: Mechanism, orientations: OrientationSet, device: str
) -> LatticeBlock | None:
    """The lattice around all that the legs can reach; None where that is nothing."""
    box = reachable_box(mechanism, orientations.rotations)
    if mechanism.translational and not np.allclose(orientations.rotations, np.eye(3), rtol=0, atol=SAME_ORIENTATION):
        raise InputError("orientation", "must be null: the parallelograms of a delta do not let its platform turn")
    if box.empty:
        return None
    if not np.isfinite([box.lower, box.upper]).all():
        raise InputError("mechanism", "must have finite reach")
    around = placed_box(mechanism, box)
    size = job.voxel_size_m or _voxel_size(mechanism, orientations, box, device)
    return block_around(around.lower, around.upper, size)


def _voxel_size(mechanism: Mechanism, orientations: OrientationSet, box: Box, device: str) -> float:
    """A hundredth of the cube root of the volume reached at any orientation, estimated, to two significant digits."""
    from scipy.stats.qmc import Sobol

    count = len(orientations.rotations)
    points = max(FIRST_POINTS // count, FEWEST_POINTS)
    unit = Sobol(3, scramble=False).random_base2(int(points).bit_length() - 1)
    positions = box.lower + unit * (box.upper - box.lower)
    counts = count_orientations_at(leg_test(mechanism), positions, orientations.rotations, device=device)
    share = max((counts.reached > 0).mean(), LEAST_SHARE)
    return round_to_digits(float(np.cbrt(box.volume * share)) / 100.0, 2)
