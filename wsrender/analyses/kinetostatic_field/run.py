"""The analysis ``kinetostatic_field``: forces of limits and conditioning over the workspace."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import DOCUMENT_BYTES, WRITTEN_PER_S, Asks, Cost, pictures_cost, surface_bytes
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import no_headline
from wsrender.analyses.kinetostatic_field.job import KinetostaticFieldJob
from wsrender.analyses.partial_result import PartialResult
from wsrender.documents.sampling import Sobol
from wsrender.engine import configurations, sampled_positions
from wsrender.kinetostatics.characteristic_length import CharacteristicLength
from wsrender.kinetostatics.force_fields import ForceField, posture_tables
from wsrender.kinetostatics.passivity import LoopWork, largest_loop_work, stiffness_bound, stiffnesses
from wsrender.notices import Notice
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.reach.admission import Admission
from wsrender.robot.constraints import constraints_of_job, samples_entry
from wsrender.robot.rejections import check_admitted, rejected_rows
from wsrender.robots.kinematics import Kinematics
from wsrender.robots.reachable_box import reachable_box
from wsrender.volume.lattice import LatticeBlock, block_around, default_voxel_size
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

SAMPLE_BYTES = 24 + 8 * 9 + 96  # of a configuration: its voxel, six components with three numbers, voxels sorted
ARROW_BYTES, LARGEST_FIELD_BYTES = 4e3, 4e5  # of a voxel in the picture of the field, and of the picture
OCCUPIED = 0.13  # of the block that holds every reach, the voxels that do
FILLED = 0.3  # of the block that holds every reach, the block of the voxels reached
RATE, LOOPS_S = 2.5e4, 0.4  # configurations per second of one core; seconds of the closed paths
DIVISIONS = 25  # of the size of a workspace: a mean needs several configurations
FIRST_SAMPLES, DRAWN = 1 << 14, 3
MOST_SAMPLES = 100_000_000
SHOWN = (0.3, 0.9)  # nearness to a limit of the posture in the picture, the first such sample
CHUNK = 1 << 12
ON_FACE = 1e-9  # of a voxel below its face counts as on it: a planar arm would be torn in two by rounding
SCALARS = ("force", "inverse_condition_number", "limit_nearness")
UNITS = {"force": "N", "torque": "N m", "inverse_condition_number": "1", "limit_nearness": "1"}

# What result documents say of the work on closed paths.
CONSERVATIVE = {
    "normalised": "no: unit directions are no gradient, and closed paths do net work, at most peak force × length",
    "potential": "where the force is below the device's peak, no singular posture is near and the joints of a "
    "redundant arm come back without self-motions; elsewhere closed paths do net work, at most loop_work_bound_j on "
    "those tried",
}


@dataclass(frozen=True, kw_only=True)
class KinetostaticFieldSettled(Settled):
    """With the edge of a voxel [m]."""

    voxel_size_m: float


class KinetostaticFieldAnalysis(Analysis):
    """A planned ``kinetostatic_field`` job: one shard of all configurations."""

    settles = KinetostaticFieldSettled
    job: KinetostaticFieldJob
    settled: KinetostaticFieldSettled

    def prepare(self, device: str, target: str) -> KinetostaticFieldSettled:
        """Raises InputError for a robot without a model, and a posture or obstacle that cannot be; ResourceError."""
        job, chain = self.job, self.robot.chain
        checked = job.field.model_copy(update={"boundary": None})  # whose samples are slow
        force_field = ForceField(self.robot, checked)
        count = plan_sampling(chain, job.sampling, MOST_SAMPLES).count
        size = job.voxel_size_m or _voxel_size(force_field, count)
        _ = self.constraints, _block(chain, size)  # raises where there are too many voxels to be numbered
        return KinetostaticFieldSettled(device, target, ((0, count),), voxel_size_m=size)

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        """What configurations must satisfy; raises InputError."""
        return constraints_of_job(self.job, self.robot)

    @property
    def cost(self) -> Cost:
        """Configurations with what is known of each, and the volume of forces."""
        count, block = self.shards[0][1], _block(self.robot.chain, self.settled.voxel_size_m)
        voxels = min(OCCUPIED * block.size, count)
        field = min(ARROW_BYTES * voxels, LARGEST_FIELD_BYTES)
        kept = field + _voxel_bytes(self.job) * FILLED * block.size + surface_bytes(voxels)
        drawn, seconds = pictures_cost("slices", "surface", "posture", "field")
        files = DOCUMENT_BYTES + drawn + kept
        seconds += count / RATE + LOOPS_S + files / WRITTEN_PER_S
        rows, volume = SAMPLE_BYTES * count, _voxel_bytes(self.job) * FILLED * block.size
        asks = Asks("voxel_size_m", voxel_size_m=self.settled.voxel_size_m)
        if rows > volume:
            asks = Asks("sampling", "take fewer samples")
        return Cost(count, rows + volume + self.program_bytes, files, seconds, asks)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Of every voxel: cell (V, 3), number of configurations (V,), sums (V, 6 + scalars), greatest force (V,).

        ``stiffness`` (P,) [N/m] at random postures; ``loop`` (5,): most work of closed paths [J], length [m], how many,
        bound of the work [J], share of paths on which the force is clipped. Under constraints of those configurations
        that they admit, and ``rejected`` (N,) int8 of all. Raises InputError where they admit none.
        """
        force_field = ForceField(self.robot, self.job.field, self.device, threads=execution.threads)
        pipeline = tip_pipeline(self.robot.chain, self.job.sampling, MOST_SAMPLES)
        drawn = pipeline.sampling.count
        cells, rows = np.empty((drawn, 3), np.int64), np.empty((drawn, 6 + len(SCALARS)))
        admission = Admission(self.robot.chain, self.constraints, self.device, execution.threads)
        rejected, shown = np.zeros(drawn, np.int8), None
        for first in range(0, drawn, CHUNK):
            numbers = np.arange(first, min(first + CHUNK, drawn))
            chunk = configurations(pipeline, numbers)
            if self.constraints:
                rejected[numbers] = admission.rejected(chunk)
            for k, q in zip(numbers, chunk, strict=True):
                if rejected[k]:
                    continue
                state = force_field.evaluate(q)
                cells[k] = np.floor(state.posture.position / self.settled.voxel_size_m + ON_FACE)
                size = np.sqrt(state.force @ state.force)
                if shown is None and SHOWN[0] < state.nearness < SHOWN[1]:
                    shown = q
                rows[k] = *state.force, *state.torque, size, state.inverse_condition, state.nearness
            tell(int(numbers[-1]) + 1)
        if self.constraints:
            counts = np.bincount(rejected, minlength=len(self.constraints) + 1)[1:]
            check_admitted(samples_entry(self.constraints, drawn, counts), self.constraints)
            cells, rows = cells[rejected == 0], rows[rejected == 0]
        found, voxel, count = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
        sums = np.stack([np.bincount(voxel.ravel(), column, len(found)) for column in rows.T], axis=1)
        greatest = np.zeros(len(found))
        np.maximum.at(greatest, voxel.ravel(), rows[:, 6])
        loop = largest_loop_work(force_field)
        shown = configurations(pipeline, np.flatnonzero(rejected == 0)[:1])[0] if shown is None else shown
        arrays = {"shown": shown, "cells": found, "count": count, "sums": sums, "greatest": greatest}
        arrays |= {"rejected": rejected} if self.constraints else {}
        about = np.array([loop.work_j, loop.length_m, loop.paths, loop.bound_j, loop.clipped])
        return PartialResult(arrays | {"stiffness": stiffnesses(force_field), "loop": about})

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """Volume data with the vector "force" (and "torque") per voxel, and the document."""
        job, count = self.job, partial["count"]
        means = partial["sums"] / count[:, None]
        # Without what is slow to build: the picture's force is that of limits and conditioning.
        plain = job.field.model_copy(update={"boundary": None, "obstacles": None})
        plain_field = ForceField(self.robot, plain, self.device)
        loop = LoopWork(*partial["loop"].tolist())
        about = {
            "sampling": {"method": job.sampling.method, "samples": self.samples},
            **self._rejections(partial),
            "voxel_size_m": self.settled.voxel_size_m,
            "kinetostatic_field": {
                "form": job.field.form,
                "characteristic_length": _length_entry(plain_field.length),
                "voxels": len(count),
                "share_of_voxels_with_force": float((partial["greatest"] > 0).mean()),
                "largest_force_n": float(partial["greatest"].max()),
                "mean_force_n": float(partial["sums"][:, 6].sum() / count.sum()),
                "passivity": self._passivity(partial["stiffness"], loop),
            },
        }
        chain = self.robot.chain
        spread = np.linspace(0.25, 0.75, DRAWN)[:, None]
        skeleton = self.robot.skeleton(chain.lower_limits + spread * (chain.upper_limits - chain.lower_limits))
        volume = self._volume(partial["cells"], count, means, partial)
        tables = posture_tables(plain_field, partial["shown"])
        return Draft(
            about,
            no_headline("a field of forces measures no workspace"),
            _notices(job.field.form, loop),
            volume=volume,
            skeleton=skeleton,
            tables=tables,
        )

    def _rejections(self, partial: PartialResult) -> dict[str, Any]:
        """What constraints reject; nothing without them."""
        if not self.constraints:
            return {}
        pipeline = tip_pipeline(self.robot.chain, self.job.sampling, MOST_SAMPLES)
        return rejected_rows(self.constraints, partial["rejected"], lambda numbers: configurations(pipeline, numbers))

    def _passivity(self, stiffness: np.ndarray, loop: LoopWork) -> dict[str, Any]:
        """Stiffness beside what the device renders, and the work of closed paths beside what would dissipate it."""
        bound = stiffness_bound(self.job.field.haptic_device)
        return {
            "stiffness_bound_n_per_m": bound,
            "largest_stiffness_n_per_m": float(stiffness.max()),
            "share_of_postures_within_bound": float((stiffness < bound).mean()),
            "largest_loop_work_j": loop.work_j,
            "loop_work_bound_j": loop.bound_j,
            "share_of_loops_clipped": loop.clipped,
            "conservative": CONSERVATIVE[self.job.field.form],
            "loop_length_m": loop.length_m,
            "loops": int(loop.paths),
            "damping_that_dissipates_it_n_s_per_m": loop.damping_n_s_per_m,
            "at_speed_m_per_s": loop.speed_m_per_s,
        }

    def _volume(self, cells: np.ndarray, count: np.ndarray, means: np.ndarray, partial: PartialResult) -> VolumeData:
        means = means.astype(np.float32)
        statistics = {
            "maximum": {"force": partial["greatest"].astype(np.float32)},
            "mean": dict(zip(SCALARS, means[:, 6:].T, strict=True)),
        }
        vectors = {"force": means[:, :3]}
        if self.job.field.haptic_device.kind == "wrench":
            vectors["torque"] = means[:, 3:6]
        units = {name: unit for name, unit in UNITS.items() if name in vectors or name in SCALARS}
        first, voxels = Voxels.at_places(cells, count, statistics, vectors)
        return VolumeData.of_voxels(self.settled.voxel_size_m, first, voxels, units)


def _notices(form: str, loop: LoopWork) -> Iterator[Notice]:
    """That a potential is none where its force is clipped."""
    if form == "potential" and loop.clipped > 0:
        yield Notice(
            "force_clipped",
            f"on {100 * loop.clipped:.0f} % of the closed paths tried the force is clipped at the device's peak: there "
            f'the form "potential" is not conservative, and a path does up to {loop.work_j:.2g} J (bound '
            f"{loop.bound_j:.2g} J)",
            "less stiffness (joint_limits, conditioning, boundary, obstacles) or a device with a higher peak",
            "field.haptic_device.peak_force_n",
        )


def _length_entry(length: CharacteristicLength) -> dict[str, Any]:
    return {
        "length_m": length.length_m,
        "method": length.method,
        "posture": None if length.posture is None else length.posture.tolist(),
        "condition_number": length.condition_number,
    }


def _block(chain: Kinematics, size: float) -> LatticeBlock:
    """Around all that is reached."""
    return block_around(*reachable_box(chain, chain.lower_limits, chain.upper_limits), size)


def _voxel_bytes(job: KinetostaticFieldJob) -> int:
    """Bytes of a voxel in arrays: its count, scalars with the largest force, and one or two vectors."""
    vectors = 2 if job.field.haptic_device.kind == "wrench" else 1
    return 8 + 4 * (1 + len(SCALARS) + 3 * vectors)


def _voxel_size(force_field: ForceField, samples: int) -> float:
    chain = force_field.chain
    positions = sampled_positions(tip_pipeline(chain, Sobol(FIRST_SAMPLES)))
    return default_voxel_size(positions, samples, divisions=DIVISIONS)
