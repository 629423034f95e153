"""The analysis ``indices_at``: local indices at given configurations."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from wsrender.engine import Evaluated, Evaluation, evaluate_at, units_of
from wsrender.errors import InputError
from wsrender.notices import entries
from wsrender.result import Result
from wsrender.robot import Robot
from wsrender.robot.indices import evaluation_of_job
from wsrender.robot.model_robot import configuration_rows
from wsrender.run.cost import DOCUMENT_BYTES, NOTHING, Cost, pictures_cost
from wsrender.run.execution import Execution
from wsrender.run.one_shard import OneShard
from wsrender.run.provenance import index_choices, job_entry, provenance, robot_entry
from wsrender.run.settled_device import settled_device
from wsrender.spec import IndicesAtJob
from wsrender.volume.distribution_map import DistributionMap

ROWS_PER_S = 1e6  # of one CPU core, with their files


@dataclass(eq=False)
class IndicesAtPlan(OneShard):
    """A resolved ``indices_at`` job: one shard."""

    job: IndicesAtJob
    robot: Robot
    evaluation: Evaluation
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
        )
        if progress:
            progress(len(self.q))
        return rows

    def finish(self, partial: Evaluated, seconds: dict[str, float], execution: Execution) -> Result:
        """The map, one row per configuration in the order asked, and the extremes of each index."""
        names = self.evaluation.indices
        units = units_of(self.evaluation)
        values = dict(zip(names, partial.values, strict=True))
        document = {
            "analysis": "indices_at",
            "job": job_entry(self.job, self.robot),
            "robot": robot_entry(self.robot),
            "sampling": {"method": "given", "samples": len(self.q)},
            "indices": {
                name: {
                    "maximum": float(v.max()),
                    "minimum": float(v.min()),
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
        return Result(document, map=rows)


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
    return IndicesAtPlan(job, robot, evaluation, q, *settled_device(job.device, resolved), [(0, len(q))], cost)
