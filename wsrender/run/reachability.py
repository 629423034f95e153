"""The analysis ``reachability``: labels, configurations and residuals of given targets."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.analyses.cost import DOCUMENT_BYTES, NOTHING, Cost, pictures_cost
from wsrender.analyses.execution import Execution
from wsrender.analyses.provenance import job_entry, provenance, robot_entry
from wsrender.analyses.reachability.job import ReachabilityJob
from wsrender.analyses.settled_device import settled_device
from wsrender.reachability.targets import check_tolerance, reachable
from wsrender.results.result import Result
from wsrender.robot import Robot
from wsrender.run.one_shard import OneShard
from wsrender.volume.table import Table

RATE = 2e4  # targets per second, rounded down from benchmarks/inverse.py: many unreachable poses on one core
TABLE_BYTES, LISTED_BYTES = 120, 60  # of a target in the table, and in the job that the document keeps
DRAWN = 3  # configurations in the picture of the robot


@dataclass(eq=False)
class ReachabilityPlan(OneShard):
    """A resolved ``reachability`` job: one shard."""

    job: ReachabilityJob
    robot: Robot
    device: str
    target: str
    shards: list[tuple[int, int]]
    cost: Cost = NOTHING

    def run_shard(
        self, shard: int, progress: Callable[[int], None] | None, execution: Execution
    ) -> dict[str, np.ndarray]:
        """All targets decided: arrays of `Reachability` by name."""
        job = self.job
        found = reachable(
            self.robot,
            job.points_m,
            job.quats_wxyz,
            position_tolerance_m=job.position_tolerance_m,
            angle_tolerance_rad=job.angle_tolerance_rad,
            characteristic_length_m=job.characteristic_length_m,
            seed=job.seed,
            precision=job.precision,
            device=self.device,
            threads=execution.threads,
            progress=progress,
        )
        return vars(found)

    def finish(self, partial: dict[str, np.ndarray], seconds: dict[str, float], execution: Execution) -> Result:
        """The table ``targets``, one row per target in the order asked, and how many have which label."""
        labels, reasons = partial["labels"], partial["reasons"]
        reached = labels == "reachable"
        document = {
            "analysis": "reachability",
            "job": job_entry(self.job, self.robot),
            "robot": robot_entry(self.robot),
            "targets": {
                "count": len(labels),
                **{name: int((labels == name).sum()) for name in ("reachable", "unreachable", "undecided")},
                "reasons": {str(name): int((reasons == name).sum()) for name in np.unique(reasons) if name},
                "largest_residual_of_reachable_m": float(partial["residual_m"][reached].max(initial=0.0)),
                "largest_residual_of_reachable_rad": float(partial["residual_rad"][reached].max(initial=0.0)),
            },
            "provenance": provenance(self.job, self.target),
            "timing_s": seconds,
        }
        q = partial["configurations"][reached][:DRAWN]
        skeleton = self.robot.skeleton(q) if len(q) else None
        return Result(document, tables={"targets": self._table(partial)}, skeleton=skeleton)

    def _table(self, partial: dict[str, np.ndarray]) -> Table:
        columns = {"position": np.array(self.job.points_m)}
        if self.job.quats_wxyz is not None:
            columns["quat_wxyz"] = np.array(self.job.quats_wxyz)
        columns |= {
            "label": partial["labels"],
            "reason": partial["reasons"],
            "residual_m": partial["residual_m"],
            "residual_rad": partial["residual_rad"],
        }
        chain = self.robot.chain
        for name, values in zip(chain.joint_names, partial["configurations"].T, strict=True):
            columns[f"q_{name}"] = values
        units = {"position": "m", "residual_m": "m", "residual_rad": "rad"}
        kinds = zip(chain.joint_names, chain.revolute, strict=True)
        units |= {f"q_{name}": "rad" if revolute else "m" for name, revolute in kinds}
        return Table(columns, units)


def plan_reachability(job: ReachabilityJob, robot: Robot, resolved: dict[str, Any] | None = None) -> ReachabilityPlan:
    """Resolve the job. Raises InputError for a tolerance below what is computed."""
    chain = robot.chain
    check_tolerance(chain, job.position_tolerance_m, job.precision)
    count = len(job.points_m)
    held = float(count * (chain.n + 8) * 8)
    drawn, seconds = pictures_cost("targets")
    listed = (TABLE_BYTES + LISTED_BYTES) * count
    cost = Cost(count, held, DOCUMENT_BYTES + drawn + listed, count / RATE + seconds)
    return ReachabilityPlan(job, robot, *settled_device(job.device, resolved), [(0, count)], cost)
