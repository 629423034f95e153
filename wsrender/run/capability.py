"""The analysis ``capability``: reachability index per voxel, dexterous workspace."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.analyses.capability.job import CapabilityJob
from wsrender.analyses.cost import DOCUMENT_BYTES, NOTHING, Cost, Costed, pictures_cost, surface_bytes
from wsrender.analyses.execution import Execution
from wsrender.analyses.provenance import job_entry, provenance, robot_entry
from wsrender.analyses.settled_device import settled_device
from wsrender.documents.sampling import Sobol
from wsrender.engine import sampled_positions
from wsrender.reachability.capability import (
    SAMPLES_PER_CELL,
    SEARCHED_BYTES,
    capability,
    fibonacci_directions,
    searched_block,
)
from wsrender.reachability.targets import check_tolerance
from wsrender.results.result import Result
from wsrender.robot import Robot
from wsrender.robots.chain import Chain
from wsrender.sampling import plan_sampling
from wsrender.volume.lattice import check_voxels, default_voxel_size, expected_voxels
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

RATE = 2e4  # pairs of voxel and direction per second of one core, rounded down from benchmarks/inverse.py
TABLE_BYTES, VOXEL_BYTES = 58, 12  # of a voxel in the table, and in the volume
FILLED = 0.5  # of the voxels searched, the block of those that are reached
POSITIONS_PER_S = 2e6  # of one CPU core
DIVISIONS = 20  # of the size of a workspace: every voxel has many directions
FIRST_SAMPLES = 1 << 16
PAIR_BYTES = 2.25  # of a voxel and a direction: its label, whether it is reached, as byte and bit, twice


@dataclass(eq=False)
class CapabilityPlan(Costed):
    """A resolved ``capability`` job: one shard."""

    job: CapabilityJob
    robot: Robot
    voxel_size_m: float
    device: str
    target: str
    shards: list[tuple[int, int]]
    cost: Cost = NOTHING

    def resolved(self) -> dict[str, Any]:
        """What is settled once: the device that "auto" means, target, voxel size, shards."""
        return {
            "device": self.device,
            "target": self.target,
            "voxel_size_m": self.voxel_size_m,
            "shards": [list(shard) for shard in self.shards],
        }

    def run_shard(
        self, shard: int, progress: Callable[[int], None] | None, execution: Execution
    ) -> dict[str, np.ndarray]:
        """Cells (V, 3), from which directions they are reached (V, bytes, a bit each), undecided directions (V,)."""
        job = self.job
        found = capability(
            self.robot.chain,
            self.voxel_size_m,
            fibonacci_directions(job.directions),
            approach_axis=job.approach_axis,
            position_m=job.position_tolerance_m,
            angle_rad=job.angle_tolerance_rad,
            seed=job.seed,
            precision=job.precision,
            device=self.device,
            threads=execution.threads,
            progress=progress,
        )
        return {"cells": found.cells, "bits": np.packbits(found.reached, axis=1), "undecided": found.undecided}

    def merge(self, a: dict[str, np.ndarray], b: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        """There is one shard: nothing to merge."""
        raise ValueError("capability has one shard")

    def finish(self, partial: dict[str, np.ndarray], seconds: dict[str, float], execution: Execution) -> Result:
        """Volume data, the table ``capability`` of reached voxels, the table ``directions``, and the document."""
        job, cells = self.job, partial["cells"]
        reached = np.unpackbits(partial["bits"], axis=1, count=job.directions).astype(bool)
        index = reached.mean(axis=1)
        voxel = self.voxel_size_m**3
        document = {
            "analysis": "capability",
            "job": job_entry(job, self.robot),
            "robot": robot_entry(self.robot),
            "voxel_size_m": self.voxel_size_m,
            "capability": {
                "method": "inverse kinematics at the centres of voxels",
                "directions": job.directions,
                "approach_axis": job.approach_axis,
                "voxels": len(cells),
                "mean_index": float(index.mean()) if len(cells) else 0.0,
                "maximum_index": float(index.max(initial=0.0)),
                "undecided_pairs": int(partial["undecided"].sum()),
                "reachable_volume_m3": len(cells) * voxel,
                "dexterous_threshold": job.dexterous_threshold,
                "dexterous_volume_m3": int((index >= job.dexterous_threshold).sum()) * voxel,
            },
            "provenance": provenance(job, self.target),
            "timing_s": seconds,
        }
        tables = {
            "capability": Table(
                {
                    "position": (cells + 0.5) * self.voxel_size_m,
                    "reachability_index": index,
                    "undecided": partial["undecided"],
                    "direction_bits": partial["bits"],
                },
                {"position": "m"},
            ),
            "directions": Table(
                {"direction": fibonacci_directions(job.directions), "voxels": reached.sum(axis=0)},
            ),
        }
        chain = self.robot.chain
        skeleton = self.robot.skeleton((chain.lower_limits + chain.upper_limits) / 2)
        return Result(document, volume=self._volume(cells, reached), tables=tables, skeleton=skeleton)

    def _volume(self, cells: np.ndarray, reached: np.ndarray) -> VolumeData | None:
        """``count``: directions reached; "fraction" of "approach_directions": the index; None: nothing is reached."""
        if not len(cells):
            return None
        statistics = {"fraction": {"approach_directions": reached.mean(axis=1).astype(np.float32)}}
        first, voxels = Voxels.at_places(cells, reached.sum(axis=1), statistics)
        return VolumeData.of_voxels(self.voxel_size_m, first, voxels, {"approach_directions": "1"})


def plan_capability(job: CapabilityJob, robot: Robot, resolved: dict[str, Any] | None = None) -> CapabilityPlan:
    """Resolve the job, or take what `CapabilityPlan.resolved` of an earlier plan of it says.

    Raises InputError for a tolerance below what is computed.
    """
    chain = robot.chain
    check_tolerance(chain, job.position_tolerance_m, job.precision)
    device, target = settled_device(job.device, resolved)
    if resolved is None:
        positions = _positions(chain)
        size = job.voxel_size_m or default_voxel_size(positions, divisions=DIVISIONS)
        block = searched_block(chain, size)
        voxels = expected_voxels(positions, size)
        check_voxels(block, PAIR_BYTES * job.directions, share=voxels / block.size)
        shards = [(0, round(voxels * job.directions))]
    else:
        size, shards = resolved["voxel_size_m"], [(first, count) for first, count in resolved["shards"]]
    pairs = float(shards[0][1])
    return CapabilityPlan(job, robot, size, device, target, shards, _cost(job, chain, size, pairs))


def _cost(job: CapabilityJob, chain: Chain, size: float, pairs: float) -> Cost:
    """Of so many pairs of a voxel and a direction: their labels, and of every voxel searched, what is known of it."""
    voxels, searched = pairs / job.directions, searched_block(chain, size).size
    drawn, seconds = pictures_cost("slices", "arm")
    kept = TABLE_BYTES * voxels + VOXEL_BYTES * FILLED * searched + surface_bytes(voxels)
    memory = PAIR_BYTES * pairs + SEARCHED_BYTES * searched
    found = SAMPLES_PER_CELL * searched / POSITIONS_PER_S
    return Cost(pairs, memory, DOCUMENT_BYTES + drawn + kept, pairs / RATE + found + seconds)


def _positions(chain: Chain) -> np.ndarray:
    """Positions (N, 3) of the first samples of a Sobol set [m]."""
    plan = plan_sampling(chain, Sobol(FIRST_SAMPLES))
    return sampled_positions(chain, plan)
