"""The analysis ``capability``: reachability index per voxel, dexterous workspace."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.capability.job import CapabilityJob
from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import (
    DOCUMENT_BYTES,
    WRITTEN_PER_S,
    Asks,
    Cost,
    pictures_cost,
    surface_bytes,
)
from wsrender.analyses.cost import SEARCHED_BYTES as SEARCH_BYTES
from wsrender.analyses.estimate import RATE_CPU_CORE
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import no_headline
from wsrender.analyses.partial_result import PartialResult, joined_rows, rows_of_shard
from wsrender.documents.sampling import Sobol
from wsrender.engine import sampled_positions
from wsrender.notices import Notice
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.admission import Admission
from wsrender.reach.capability import (
    AXES,
    BATCH,
    SAMPLES_PER_CELL,
    SEARCHED_BYTES,
    approaching,
    candidates,
    capability,
    fibonacci_directions,
    searched_block,
)
from wsrender.reach.inverse_solver import solved_bytes
from wsrender.reach.posture_counts import closed_form_for_counts, posture_counts, turned_frames
from wsrender.reach.targets import check_tolerance, evidence_of
from wsrender.robot.constraints import constraints_of_job
from wsrender.robots.kinematics import Kinematics
from wsrender.volume.lattice import default_voxel_size, expected_voxels
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

RATE = 8e4  # pairs of voxel and direction per second of one core
TABLE_BYTES, VOXEL_BYTES = 40, 12  # of a voxel in the table beside the bits of its directions, and in the volume
BITS_BYTES, DIRECTION_BYTES = 4, 32  # of eight directions of a voxel, and of a direction in its own table
FILLED = 0.5  # of the voxels searched, the block of those that are reached
POSITIONS_PER_S = 2e6  # of one CPU core
DIVISIONS = 20  # of the size of a workspace: every voxel has many directions
FIRST_SAMPLES = 1 << 16
CONSTRAINED_RATE = 2e3  # pairs under constraints, where many are blocked
COUNTED_PER_S, CONSTRAINED_COUNTS = 4e5, 20  # poses whose postures are counted on one core; how much slower if tested
COUNT_BYTES = 4  # of a pose, the number of its postures
PAIR_BYTES = 2.25  # of a voxel and a direction: its label, whether it is reached, as byte and bit, twice
CANDIDATE_BYTES = 100  # of a voxel that is decided: its cell, centre and copies, of those that are reached too
ASKED_BYTES = 200  # of a pair while it is decided: point, direction, and the configuration that is nearest, twice


@dataclass(frozen=True, kw_only=True)
class CapabilitySettled(Settled):
    """With the edge of a voxel [m]."""

    voxel_size_m: float


class CapabilityAnalysis(Analysis):
    """A planned ``capability`` job: its samples are the pairs of a voxel and a direction, about.

    How many there are is known once the voxels are: a shard has its share of them.
    """

    effort = RATE_CPU_CORE / RATE
    settles = CapabilitySettled
    job: CapabilityJob
    settled: CapabilitySettled

    def prepare(self, device: str, target: str) -> CapabilitySettled:
        """Raises InputError for a tolerance below what is computed, ResourceError for too many voxels."""
        job, chain = self.job, self.robot.chain
        check_tolerance(chain, job.position_tolerance_m, job.precision)
        _ = self.constraints
        if job.rolls:
            closed_form_for_counts(chain)
        positions = _positions(chain)
        size = job.voxel_size_m or default_voxel_size(positions, divisions=DIVISIONS)
        voxels = expected_voxels(positions, size)
        pairs = round(voxels * job.directions)
        return CapabilitySettled(device, target, ((0, pairs),), job.directions, voxel_size_m=size)

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        """What configurations must satisfy; raises InputError."""
        return constraints_of_job(self.job, self.robot)

    @property
    def cost(self) -> Cost:
        """Of the pairs their labels, and of every voxel searched what is known of it."""
        pairs = float(self.samples)
        voxels = pairs / self.job.directions
        searched = searched_block(self.robot.chain, self.settled.voxel_size_m).size
        drawn, seconds = pictures_cost("slices", "arm_in_surface")
        table = (TABLE_BYTES + BITS_BYTES * np.ceil(self.job.directions / 8)) * voxels
        table += DIRECTION_BYTES * self.job.directions
        files = DOCUMENT_BYTES + drawn + table + VOXEL_BYTES * FILLED * searched + surface_bytes(voxels)
        solved = solved_bytes(pairs, "axis", self.robot.chain, self.job.precision) + ASKED_BYTES * min(pairs, BATCH)
        memory = max(solved + PAIR_BYTES * pairs + CANDIDATE_BYTES * voxels, SEARCHED_BYTES * searched)
        seconds += SAMPLES_PER_CELL * searched / POSITIONS_PER_S + (voxels + pairs) / RATE + files / WRITTEN_PER_S
        if job_rolls := self.job.rolls:
            seconds += pairs * job_rolls / COUNTED_PER_S * (CONSTRAINED_COUNTS if self.constraints else 1)
            memory += COUNT_BYTES * pairs * job_rolls
        if self.constraints:
            memory, seconds = memory + SEARCH_BYTES + self.program_bytes, seconds + pairs / CONSTRAINED_RATE
        return Cost(pairs, memory, files, seconds, Asks("voxel_size_m", voxel_size_m=self.settled.voxel_size_m))

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Cells (V, 3), from which directions they are reached (V, bytes, a bit each), undecided directions (V,)."""
        job, chain, size = self.job, self.robot.chain, self.settled.voxel_size_m
        first, count = self.shards[shard]
        cells = candidates(chain, size, job.seed, self.device, execution.threads)
        share = slice(len(cells) * first // self.samples, len(cells) * (first + count) // self.samples)
        found = capability(
            chain,
            size,
            fibonacci_directions(job.directions),
            cells=cells[share],
            approach_axis=job.approach_axis,
            position_m=job.position_tolerance_m,
            angle_rad=job.angle_tolerance_rad,
            seed=job.seed,
            precision=job.precision,
            device=self.device,
            threads=execution.threads,
            progress=tell,
            constraints=self.constraints,
        )
        rows = {"cells": found.cells, "bits": np.packbits(found.reached, axis=1), "undecided": found.undecided}
        if found.blocked is not None:
            rows["blocked"] = found.blocked
        if job.rolls:
            admission = Admission(chain, self.constraints, self.device, execution.threads) if self.constraints else None
            rotations = turned_frames(fibonacci_directions(job.directions), job.rolls) @ np.transpose(
                AXES[job.approach_axis]
            )
            points, options = (found.cells + 0.5) * size, {"device": self.device, "threads": execution.threads}
            counts = posture_counts(chain, points, rotations, admission, **options)
            rows |= {"postures": counts.sum(axis=1), "most": counts.max(axis=1, initial=0)}
        return rows_of_shard(first, rows)

    def merge(self, a: PartialResult, b: PartialResult) -> PartialResult:
        """The voxels of both, in the order of their places."""
        return joined_rows(a, b)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """Volume data, the table ``capability`` of reached voxels, the table ``directions``, and the document."""
        job, cells, edge = self.job, partial["cells"], self.settled.voxel_size_m
        reached = np.unpackbits(partial["bits"], axis=1, count=job.directions).astype(bool)
        index = reached.mean(axis=1)
        entry = {
            "method": "inverse kinematics at the centres of voxels",
            "directions": job.directions,
            "approach_axis": job.approach_axis,
            "evidence": evidence_of(approaching(self.robot.chain, job.approach_axis), "axis"),
            "voxels": len(cells),
            "mean_index": float(index.mean()) if len(cells) else 0.0,
            "maximum_index": float(index.max(initial=0.0)),
            "undecided_pairs": int(partial["undecided"].sum()),
            "reachable_volume_m3": len(cells) * edge**3,
            "dexterous_threshold": job.dexterous_threshold,
            "dexterous_volume_m3": int((index >= job.dexterous_threshold).sum()) * edge**3,
        }
        columns = {
            "position": (cells + 0.5) * edge,
            "reachability_index": index,
            "undecided": partial["undecided"],
            "direction_bits": partial["bits"],
        }
        if self.constraints:
            names, blocked = [each.name for each in self.constraints], partial["blocked"]
            entry["blocked_pairs"] = dict(zip(names, blocked.sum(axis=0).tolist(), strict=True))
            columns |= {f"blocked_{name}": column for name, column in zip(names, blocked.T, strict=True)}
        if job.rolls:
            poses = job.directions * job.rolls
            mean = partial["postures"] / poses
            entry["postures"] = {
                "poses_of_a_voxel": poses,
                "mean": float(mean.mean()) if len(cells) else 0.0,
                "most": int(partial["most"].max(initial=0)),
            }
            columns |= {"postures_mean": mean, "postures_most": partial["most"]}
        directions = {"direction": fibonacci_directions(job.directions), "voxels": reached.sum(axis=0)}
        chain = self.robot.chain
        return Draft(
            {"voxel_size_m": edge, "capability": entry},
            no_headline(
                f"whole voxels are counted, {entry['reachable_volume_m3']:.4g} m³ that are reached, of them "
                f"{entry['dexterous_volume_m3']:.4g} m³ from {100 * job.dexterous_threshold:.4g} % of the directions"
            ),
            _notices(entry),
            volume=self._volume(partial, reached),
            tables={"capability": Table(columns, {"position": "m"}), "directions": Table(directions)},
            skeleton=self.robot.skeleton((chain.lower_limits + chain.upper_limits) / 2),
        )

    def _volume(self, partial: PartialResult, reached: np.ndarray) -> VolumeData | None:
        """``count``: directions reached; "fraction" of "approach_directions": the index; None: nothing is reached.

        Where they are counted, "mean" and "maximum" of "postures" over the poses of a voxel.
        """
        cells, rolls = partial["cells"], self.job.rolls
        if not len(cells):
            return None
        statistics = {"fraction": {"approach_directions": reached.mean(axis=1).astype(np.float32)}}
        units = {"approach_directions": "1"}
        if rolls:
            mean = (partial["postures"] / (self.job.directions * rolls)).astype(np.float32)
            statistics |= {"mean": {"postures": mean}, "maximum": {"postures": partial["most"].astype(np.float32)}}
            units["postures"] = "1"
        first, voxels = Voxels.at_places(cells, reached.sum(axis=1), statistics)
        return VolumeData.of_voxels(self.settled.voxel_size_m, first, voxels, units)


def _notices(entry: dict[str, Any]) -> Iterator[Notice]:
    """That no direction of the set is reached anywhere, as of an arm whose tip keeps its direction."""
    if entry["voxels"] and not entry["maximum_index"]:
        yield Notice(
            "no_direction_reached",
            f"the tip's {entry['approach_axis']} axis reaches none of the {entry['directions']} directions anywhere",
            "give a larger angle tolerance or more directions, or look at the axis that the arm can turn",
            "angle_tolerance_rad",
        )


def _positions(chain: Kinematics) -> np.ndarray:
    """Positions (N, 3) of the first samples of a Sobol set [m]."""
    return sampled_positions(tip_pipeline(chain, Sobol(FIRST_SAMPLES)))
