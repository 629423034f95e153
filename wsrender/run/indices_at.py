"""The analysis ``indices_at``: local indices at given configurations."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from wsrender.analyses.cost import DOCUMENT_BYTES, NOTHING, Cost, pictures_cost
from wsrender.analyses.execution import Execution
from wsrender.analyses.indices_at.job import IndicesAtJob
from wsrender.analyses.provenance import index_choices, job_entry, provenance, robot_entry
from wsrender.analyses.settled_device import settled_device
from wsrender.engine import Evaluated, Evaluation, evaluate_at, units_of
from wsrender.errors import InputError
from wsrender.notices import entries
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.results.result import Result
from wsrender.robot import Robot
from wsrender.robot.constraints import constraints_for, samples_entry
from wsrender.robot.indices import evaluation_of_job
from wsrender.robot.model_robot import configuration_rows
from wsrender.run.one_shard import OneShard
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table

ROWS_PER_S = 1e6  # of one CPU core, with their files


@dataclass(eq=False)
class IndicesAtPlan(OneShard):
    """A resolved ``indices_at`` job: one shard."""

    job: IndicesAtJob
    robot: Robot
    evaluation: Evaluation
    constraints: tuple[Constraint, ...]
    q: np.ndarray
    device: str
    target: str
    shards: list[tuple[int, int]] = field(default_factory=list)
    cost: Cost = NOTHING

    def run_shard(self, shard: int, progress: Callable[[int], None] | None, execution: Execution) -> Evaluated:
        """Positions and values of all rows."""
        rows = evaluate_at(
            self.evaluation,
            self.q,
            self.job.precision,
            self.device,
            with_orientation=self.evaluation.host_chain is None,
            threads=execution.threads,
            constraints=self.constraints,
        )
        if progress:
            progress(len(self.q))
        return rows

    def finish(self, partial: Evaluated, seconds: dict[str, float], execution: Execution) -> Result:
        """The map, one row per configuration in the order asked, and the extremes of each index.

        With constraints the table ``admission`` says of every row why it is rejected, "" where it is not; values of
        rejected ones are NaN, and count in no extreme.
        """
        names = self.evaluation.indices
        admitted, about, tables = self._admission(partial.rejected)
        units = units_of(self.evaluation)
        values = dict(zip(names, np.where(admitted, partial.values, np.nan), strict=True))
        document = {
            "analysis": "indices_at",
            "job": job_entry(self.job, self.robot),
            "robot": robot_entry(self.robot),
            "sampling": {"method": "given", "samples": len(self.q)},
            **about,
            "indices": {
                name: {
                    "maximum": float(v[admitted].max()) if admitted.any() else None,
                    "minimum": float(v[admitted].min()) if admitted.any() else None,
                    "unit": units[name],
                }
                for name, v in values.items()
            },
            "choices": index_choices(self.job, self.evaluation),
            "warnings": entries(self.evaluation.notices),
            "provenance": provenance(self.job, self.target),
            "timing_s": seconds,
        }
        rows = DistributionMap(partial.position, values, units, self.q, self.robot.joint_names, partial.quat_wxyz)
        return Result(document, map=rows, sample=rows.only(admitted) if tables else None, tables=tables)

    def _admission(self, rejected: np.ndarray | None) -> tuple[np.ndarray, dict[str, Any], dict[str, Table]]:
        """Which rows are admitted (N,) bool, what the document says of it, and the table of reasons."""
        if rejected is None:
            return np.ones(len(self.q), bool), {}, {}
        reasons = np.array(["", *(each.name for each in self.constraints)])
        counts = np.bincount(rejected, minlength=len(reasons))[1:]
        about = samples_entry(self.constraints, len(self.q), counts)
        return rejected == 0, about, {"admission": Table({"reason": reasons[rejected]})}


def plan_indices_at(job: IndicesAtJob, robot: Robot, resolved: dict[str, Any] | None = None) -> IndicesAtPlan:
    """Resolve the job, or take what `IndicesAtPlan.resolved` of an earlier plan of it says.

    Raises InputError for configurations that are missing or of the wrong length.
    """
    n = robot.chain.n
    if not job.configurations:
        raise InputError("configurations", f"must be given: rows of {n} joint values, {', '.join(robot.joint_names)}")
    q = configuration_rows(np.array(job.configurations, np.float64), n, "configurations")
    evaluation = evaluation_of_job(job, robot)
    width = 4 if job.precision == "float32" else 8
    held = float(len(q) * (3 + 6 + len(evaluation.indices)) * width)
    drawn, seconds = pictures_cost("histogram", "robot")
    files = DOCUMENT_BYTES + drawn + q.nbytes + held
    cost = Cost(len(q), q.nbytes + held, files, len(q) / ROWS_PER_S + seconds)
    constraints, device = constraints_for(robot, job.constraints), settled_device(job.device, resolved)
    return IndicesAtPlan(job, robot, evaluation, constraints, q, *device, [(0, len(q))], cost)
