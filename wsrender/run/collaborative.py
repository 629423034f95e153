"""The analysis ``collaborative_volume``: the body-elemental algorithm over seeds, and the true volume beside it."""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.analyses.collaborative_volume.job import CollaborativeVolumeJob
from wsrender.analyses.cost import DOCUMENT_BYTES, Cost, check_memory, pictures_cost, refined_seconds
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import headline_of, no_headline
from wsrender.analyses.provenance import job_entry, provenance, robot_entry
from wsrender.analyses.refined import Progress, refined_together, volume_entry
from wsrender.analyses.sampled_positions import sampled_positions
from wsrender.analyses.settled_device import settled_device
from wsrender.documents.point_sets import PointSet
from wsrender.documents.sampling import Random
from wsrender.multi.body_elements import body_elements
from wsrender.reachability import Event
from wsrender.results.result import Result
from wsrender.robot import Robot
from wsrender.run.one_shard import OneShard
from wsrender.volume.table import Table

POINT_BYTES = 100.0  # of two arms: positions, places in the box, cells
POSITIONS_PER_S = 2e6  # of one CPU core
BIASED = 'the body-elemental volume is biased; "refined_volume" gives the true one of two robots'


@dataclass(eq=False)
class CollaborativePlan(OneShard):
    """A resolved ``collaborative_volume`` job: one shard."""

    job: CollaborativeVolumeJob
    robots: tuple[Robot, ...]
    sources: tuple[Robot | np.ndarray, Robot | np.ndarray]  # of the left and right points
    device: str
    target: str

    @property
    def shards(self) -> list[tuple[int, int]]:
        """One shard of all samples."""
        return [(0, max(self.job.samples * self.job.seeds * len(self.robots), 1))]

    @property
    def cost(self) -> Cost:
        """Samples, the points of one run with its cells, and the true volume where it is asked for."""
        samples = float(self.job.samples * self.job.seeds * len(self.robots))
        drawn, seconds = pictures_cost("refinements")
        seconds += samples / POSITIONS_PER_S + refined_seconds(self.job.refined_volume) * bool(len(self.robots) == 2)
        memory = POINT_BYTES * self.job.samples + _cell_bytes(self.job)
        return Cost(samples, memory, DOCUMENT_BYTES + drawn, seconds)

    def run_shard(
        self, shard: int, progress: Callable[[int], None] | None, execution: Execution
    ) -> dict[str, np.ndarray]:
        """V₀ … V_d of every seed."""
        job, done, rows, cells = self.job, 0, [], []
        for seed in range(job.seed, job.seed + job.seeds):
            points = []
            # The arms draw different configurations, or two equal arms would reach mirrored points.
            for side, source in enumerate(self.sources):
                if isinstance(source, Robot):
                    sampling = Random(job.samples, seed=(2 * seed + side) % 2**63)
                    source = sampled_positions(source, sampling, self.device, threads=execution.threads)
                    done += job.samples
                points.append(source)
                if progress:
                    progress(done)
            left, right = points
            found = body_elements(left, right, job.cells, job.refinements, job.neighbours)
            rows.append(found.volumes_m3)
            cells.append([np.count_nonzero(found.collaborative), np.count_nonzero(found.boundary)])
        arrays = {"volumes": np.array(rows), "cells": np.array(cells)}
        return arrays

    def refine(
        self, partial: dict[str, np.ndarray], progress: Progress | None, execution: Execution
    ) -> dict[str, np.ndarray]:
        """With the true volume, if asked."""
        if self.job.refined_volume is None:
            return partial
        chains = [robot.chain for robot in self.robots]
        events, tolerance = {"true": Event(2, 2)}, self.job.refined_volume
        true = refined_together(chains, events, tolerance, self.device, progress, execution.threads)
        return partial | {"refined": np.array(json.dumps(true))}

    def finish(self, partial: dict[str, np.ndarray], seconds: dict[str, float], execution: Execution) -> Result:
        """Means and variances over the seeds, and the bias where the true volume is known."""
        volumes, job = partial["volumes"], self.job
        mean, variance = volumes.mean(axis=0), _variance(volumes)
        measure = json.loads(str(partial["refined"]))["true"] if "refined" in partial else None
        true = None if measure is None else volume_entry(measure)
        document = {
            "analysis": "collaborative_volume",
            "job": job_entry(job, *self.robots),
            "robots": [{"name": robot.name, "robot": robot_entry(robot)} for robot in self.robots],
            "sampling": {"method": "random", "samples": job.samples * job.seeds * len(self.robots), "seed": job.seed},
            "refinements": [
                {
                    "refinement": i,
                    "mean_m3": float(mean[i]),
                    "variance_m6": None if variance is None else float(variance[i]),
                    "bias": None if true is None or not true["value"] else float(mean[i] / true["value"] - 1),
                }
                for i in range(len(mean))
            ],
            "cells": {
                "collaborative": float(partial["cells"][:, 0].mean()),
                "boundary": float(partial["cells"][:, 1].mean()),
            },
            "volume_m3": {"body_elemental": float(mean[-1]), "true": true},
            "headline": no_headline(BIASED) if measure is None else headline_of(measure),
            "provenance": provenance(job, self.target),
            "timing_s": seconds,
        }
        tables = {"refinements": _curve(mean, variance, true), "seeds": _seeds(job.seed, volumes)}
        return Result(document, tables=tables)


def plan_collaborative(
    job: CollaborativeVolumeJob, *robots: Robot, resolved: dict[str, Any] | None = None
) -> CollaborativePlan:
    """Resolve the job, or take what `CollaborativePlan.resolved` of an earlier plan of it says.

    Raises InputError for points that cannot be read.
    """
    left_to_place = list(robots)
    left, right = (
        source.array() if isinstance(source, PointSet) else left_to_place.pop(0) for source in (job.left, job.right)
    )
    check_memory(POINT_BYTES * job.samples, "samples", f"{job.samples:.4g} points of each arm", "take fewer")
    check_memory(_cell_bytes(job), "refinements", f"{job.refinements} of them", "take fewer, or fewer cells")
    return CollaborativePlan(job, robots, (left, right), *settled_device(job.device, resolved))


def _cell_bytes(job: CollaborativeVolumeJob) -> float:
    """Bytes of the finest division: the cells of each arm, and those of both."""
    return 3.0 * math.prod(job.cells) * (job.refinements + 1) ** 3


def _variance(volumes: np.ndarray) -> np.ndarray | None:
    """Unbiased variance over the seeds [m⁶]; None of one."""
    return volumes.var(axis=0, ddof=1) if len(volumes) > 1 else None


def _curve(mean: np.ndarray, variance: np.ndarray | None, true: dict[str, Any] | None) -> Table:
    """Volume by refinement, with a band of one standard deviation, and the true volume with its interval."""
    columns = {"refinement": np.arange(len(mean)), "body_elemental": mean}
    if variance is not None:
        deviation = np.sqrt(variance)
        columns |= {"body_elemental_low": mean - deviation, "body_elemental_high": mean + deviation}
    if true is not None:
        values = {"true": true["value"], "true_low": true["ci95"][0], "true_high": true["ci95"][1]}
        columns |= {name: np.full(len(mean), value) for name, value in values.items()}
    return Table(columns, dict.fromkeys(list(columns)[1:], "m^3"))


def _seeds(first: int, volumes: np.ndarray) -> Table:
    columns = {"seed": first + np.arange(len(volumes)), "volume": volumes}
    return Table(columns, {"volume": "m^3"})
