"""The analysis ``collaborative_volume``: the body-elemental algorithm over seeds, and the true volume beside it."""

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.analyses.collaborative_volume.job import CollaborativeVolumeJob
from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import DOCUMENT_BYTES, Asks, Cost, pictures_cost, refined_bytes, refined_seconds
from wsrender.analyses.estimate import RATE_CPU_CORE
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import headline_of, no_headline
from wsrender.analyses.partial_result import PartialResult, joined_rows, rows_of_shard
from wsrender.analyses.refined import Progress, divided, refined_together, volume_entry
from wsrender.analyses.several_robots import arms_apart_of
from wsrender.documents.sampling import Random
from wsrender.engine import evaluate_samples, sampled_positions
from wsrender.multi import body_elements
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline, tip_pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.reach import Inside
from wsrender.robot import Robot
from wsrender.robot.constraints import constraints_of_job, samples_entry
from wsrender.robot.rejections import check_admitted
from wsrender.robots.array_files import Rows, listed_points, listed_provenance
from wsrender.volume.measure import UNITS
from wsrender.volume.table import Table

if TYPE_CHECKING:
    from wsrender.robot.arms_collision import ArmsApart

SIDES = ("left", "right")
POINT_BYTES = 165.0  # of two arms: positions, places in the box, cells
POSITIONS_PER_S = 2e6  # of one CPU core
BIASED = 'the body-elemental volume is biased; "refined_volume" gives the true one of two robots'


class CollaborativeVolumeAnalysis(Analysis):
    """A planned ``collaborative_volume`` job: the samples of every run."""

    effort = RATE_CPU_CORE / POSITIONS_PER_S
    job: CollaborativeVolumeJob

    def prepare(self, device: str, target: str) -> Settled:
        """Raises InputError for points that cannot be read."""
        _ = self.sources, self.constraints, self.apart
        return Settled(device, target, ((0, max(self._samples, 1)),), self._of_a_run or None)

    @cached_property
    def sources(self) -> tuple[Robot | np.ndarray, Robot | np.ndarray]:
        """Of the left and right points: a robot, or they themselves."""
        robots = iter(self.robots)
        left, right = (self.listed[side].values if side in self.listed else next(robots) for side in SIDES)
        return left, right

    @cached_property
    def listed(self) -> dict[str, Rows]:
        """The points of the sides that are points; raises InputError."""
        return listed_points({side: getattr(self.job, side) for side in SIDES})

    @cached_property
    def constraints(self) -> list[tuple[Constraint, ...]]:
        """What each robot must satisfy by itself; tables of collisions are made here."""
        return [constraints_of_job(self.job, robot) for robot in self.robots]

    @cached_property
    def apart(self) -> "dict[tuple[int, int], ArmsApart]":
        """What keeps the two apart, if asked."""
        return arms_apart_of(self.job.constraints, list(self.job.arms().values()), self.robots, SIDES)

    @property
    def _of_a_run(self) -> int:
        """Samples of the robots in one run."""
        return self.job.samples * len(self.robots)

    @property
    def _samples(self) -> int:
        """Of all runs and robots."""
        return self._of_a_run * self.job.seeds

    @property
    def cost(self) -> Cost:
        """Samples, the points of one run with its cells, and the true volume where it is asked for."""
        samples = float(self._samples)
        drawn, seconds = pictures_cost("refinements")
        searched = bool(self.apart) or any(divided(each)[1] for each in self.constraints)
        refined = refined_seconds(self.job.refined_volume, searched)
        seconds += samples / POSITIONS_PER_S + refined * bool(len(self.robots) == 2)
        points, cells = POINT_BYTES * self._points, _cell_bytes(self.job)
        memory = max(points + cells, refined_bytes(self.job.refined_volume, searched)) + self.program_bytes
        asks = Asks("samples" if points > cells else "refinements", "take fewer samples, refinements or cells")
        return Cost(samples, memory, DOCUMENT_BYTES + drawn, seconds, asks)

    @property
    def _points(self) -> int:
        """Of one arm, the larger number."""
        return max(self.job.samples if isinstance(each, Robot) else len(each) for each in self.sources)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """V₀ … V_d of every seed of the shard; of points alone of all."""
        job, done, rows, cells, rejected = self.job, 0, [], [], []
        first, count = self.shards[shard]
        runs = range(job.seeds)
        if self._of_a_run:
            runs = range(first // self._of_a_run, (first + count) // self._of_a_run)
        for seed in (job.seed + run for run in runs):
            points = []
            # The arms draw different configurations, or two equal arms would reach mirrored points.
            for side, source in enumerate(self.sources):
                if isinstance(source, Robot):
                    sampling = Random(job.samples, seed=(2 * seed + side) % 2**63)
                    source, of_each = self._positions(side, sampling, execution)
                    rejected.append(of_each)
                    done += job.samples
                points.append(source)
                tell(done)
            left, right = points
            found = body_elements(left, right, job.cells, job.refinements, job.neighbours)
            rows.append(found.volumes_m3)
            cells.append([np.count_nonzero(found.collaborative), np.count_nonzero(found.boundary)])
        found = {"volumes": np.array(rows), "cells": np.array(cells)}
        if any(self.constraints):
            found["rejected"] = np.array(rejected).reshape(len(rows), len(self.robots), -1)
        return rows_of_shard(first, found)

    def _positions(self, side: int, sampling: Random, execution: Execution) -> tuple[np.ndarray, np.ndarray]:
        """Positions (N, 3) [m] of those of a side's samples that are admitted, and how many each constraint rejects."""
        robot = self.sources[side]
        assert isinstance(robot, Robot)
        if not any(self.constraints):
            found = sampled_positions(tip_pipeline(robot.chain, sampling), self.device, threads=execution.threads)
            return found, np.zeros(0, np.int64)
        constraints = self.constraints[side]
        plan = plan_sampling(robot.chain, sampling)
        pipeline = Pipeline(Evaluation(robot.chain), plan, constraints, kept_rows=frozenset(), precision="float32")
        found = evaluate_samples(pipeline, self.device, threads=execution.threads)
        assert found.rejected is not None
        counts = np.bincount(found.rejected, minlength=len(constraints) + 1)
        check_admitted(samples_entry(constraints, sampling.count, counts[1:]), constraints)
        return found.position[found.rejected == 0].astype(np.float64), counts[1:]

    def merge(self, a: PartialResult, b: PartialResult) -> PartialResult:
        """The runs of both, in the order of their seeds."""
        return joined_rows(a, b)

    @property
    def refinements(self) -> int:
        """The true volume, if asked."""
        return int(self.job.refined_volume is not None)

    def refinement(self, number: int, progress: Progress | None, execution: Execution) -> dict[str, Any]:
        """The entry of the true volume."""
        chains, tolerance = [robot.chain for robot in self.robots], self.job.refined_volume
        assert tolerance is not None
        events = {"true": Inside(2, 2)}
        options = self.device, progress, execution.threads, self.constraints, self.apart
        return refined_together(chains, events, tolerance, *options)["true"]

    def with_refinements(self, partial: PartialResult, refinements: list[Any]) -> PartialResult:
        """With the true volume."""
        return PartialResult(partial.arrays, {"refined": refinements[0]})

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """Means and variances over the seeds, and the bias where the true volume is known."""
        volumes, job = partial["volumes"], self.job
        mean, variance = volumes.mean(axis=0), _variance(volumes)
        measure = partial.facts.get("refined")
        true = None if measure is None else volume_entry(measure)
        about: dict[str, Any] = {
            "robots": [],
            **self.about_robots(),
            **self._admission(partial),
            "sampling": {"method": "random", "samples": self._samples, "seed": job.seed},
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
        }
        if measure is not None and measure["value"] is not None and "parts" in measure:
            name = f"{measure['quantity']}_{UNITS[measure['quantity']]}"
            about[name] = about.get(name, {}) | measure["parts"]
        tables = {"refinements": _curve(mean, variance, true), "seeds": _seeds(job.seed, volumes)}
        headline = no_headline(BIASED) if measure is None else headline_of(measure)
        return Draft(about, headline, provenance=listed_provenance(self.listed), tables=tables)

    def _admission(self, partial: PartialResult) -> dict[str, Any]:
        """Of both robots under constraints: configurations of all runs drawn, admitted, and rejected by reason."""
        if not any(self.constraints):
            return {}
        drawn, rejected = self.job.samples * self.job.seeds, partial["rejected"].sum(axis=0)
        each = zip(SIDES, self.constraints, rejected, strict=True)
        return {"admission": {side: samples_entry(of_side, drawn, by)["samples"] for side, of_side, by in each}}


def _cell_bytes(job: CollaborativeVolumeJob) -> float:
    """Bytes of the finest division: the cells of each arm, and those of both."""
    return 2.1 * math.prod(job.cells) * (job.refinements + 1) ** 3


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
