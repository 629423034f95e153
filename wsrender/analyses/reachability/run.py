"""The analysis ``reachability``: labels, configurations and residuals of given targets."""

from functools import cached_property

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import (
    DECIDED_PER_S,
    DOCUMENT_BYTES,
    LISTED_BYTES,
    LISTED_MEMORY,
    SEARCHED_BYTES,
    SEARCHED_PER_S,
    WRITTEN_PER_S,
    Asks,
    Cost,
    pictures_cost,
)
from wsrender.analyses.estimate import RATE_CPU_CORE
from wsrender.analyses.execution import Execution
from wsrender.analyses.partial_result import PartialResult, joined_rows, rows_of_shard
from wsrender.analyses.reachability.job import ReachabilityJob
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.reach.inverse_solver import solved_bytes
from wsrender.reach.targets import check_tolerance, evidence_of, reachable
from wsrender.robot.constraints import constraints_of_job
from wsrender.volume.table import Table

POSES_PER_S = 1.2e4  # of one core, where many are unreachable
TABLE_BYTES = 60  # of a target in the table beside its configuration
LABEL_BYTES = 220  # of a target: its label and reason as text, residuals, and copies
LABELS = ("reachable", "blocked", "unreachable", "undecided")
DRAWN = 3  # configurations in the picture of the robot


class ReachabilityAnalysis(Analysis):
    """A planned ``reachability`` job: its samples are the targets."""

    effort = RATE_CPU_CORE / POSES_PER_S
    job: ReachabilityJob

    def prepare(self, device: str, target: str) -> Settled:
        """Raises InputError for a tolerance below what is computed."""
        check_tolerance(self.robot.chain, self.job.position_tolerance_m, self.job.precision)
        _ = self.constraints
        return Settled(device, target, ((0, len(self.job.points_m)),), shard_unit=1)

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        """What configurations must satisfy; raises InputError."""
        return constraints_of_job(self.job, self.robot)

    @property
    def cost(self) -> Cost:
        """Targets, what is known of each, and the table."""
        count, n, listed = len(self.job.points_m), self.robot.chain.n, 3 if self.job.quats_wxyz is None else 7
        drawn, seconds = pictures_cost("targets", "robot")
        files = DOCUMENT_BYTES + drawn + (TABLE_BYTES + 8 * (n + listed - 3) + LISTED_BYTES * listed) * count
        kind = "position" if self.job.quats_wxyz is None else "pose"
        solved = solved_bytes(count, kind, self.robot.chain, self.job.precision) + 16 * n * count
        memory = (8 + LISTED_MEMORY) * listed * count + max(solved, (LABEL_BYTES + 16 * n) * count)
        seconds += count / (DECIDED_PER_S if listed == 3 else POSES_PER_S) + files / WRITTEN_PER_S
        if self.constraints:
            memory, seconds = memory + SEARCHED_BYTES, seconds + count / SEARCHED_PER_S
        return Cost(count, memory, files, seconds, Asks("points_m", "take fewer"))

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """The shard's targets decided: arrays of `Reachability` by name."""
        job, (first, count) = self.job, self.shards[shard]
        own = slice(first, first + count)
        found = reachable(
            self.robot,
            job.points_m[own],
            None if job.quats_wxyz is None else job.quats_wxyz[own],
            position_tolerance_m=job.position_tolerance_m,
            angle_tolerance_rad=job.angle_tolerance_rad,
            characteristic_length_m=job.characteristic_length_m,
            seed=job.seed,
            precision=job.precision,
            device=self.device,
            threads=execution.threads,
            progress=tell,
            constraints=self.constraints,
        )
        return rows_of_shard(first, {name: rows for name, rows in vars(found).items() if rows is not None})

    def merge(self, a: PartialResult, b: PartialResult) -> PartialResult:
        """The targets of both, in the order asked."""
        return joined_rows(a, b)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """The table ``targets``, one row per target in the order asked, and how many have which label."""
        labels, reasons = partial["labels"], partial["reasons"]
        names = LABELS if self.constraints else tuple(name for name in LABELS if name != "blocked")
        reached = labels == "reachable"
        counts = {
            "count": len(labels),
            **{name: int((labels == name).sum()) for name in names},
            "reasons": {str(name): int((reasons == name).sum()) for name in np.unique(reasons) if name},
            "proven": int(partial["proven"].sum()),
            "evidence": evidence_of(self.robot.chain, self.job.quats_wxyz is not None),
            "largest_residual_of_reachable_m": float(partial["residual_m"][reached].max(initial=0.0)),
            "largest_residual_of_reachable_rad": float(partial["residual_rad"][reached].max(initial=0.0)),
        }
        q = partial["configurations"][reached][:DRAWN]
        skeleton = self.robot.skeleton(q) if len(q) else None
        return Draft({"targets": counts}, tables={"targets": self._table(partial)}, skeleton=skeleton)

    def _table(self, partial: PartialResult) -> Table:
        columns = {"position": np.array(self.job.points_m)}
        if self.job.quats_wxyz is not None:
            columns["quat_wxyz"] = np.array(self.job.quats_wxyz)
        columns |= {
            "label": partial["labels"],
            "reason": partial["reasons"],
            "proven": partial["proven"],
            "residual_m": partial["residual_m"],
            "residual_rad": partial["residual_rad"],
        }
        if self.constraints:
            rejected = partial["rejected"].T
            columns |= {f"rejected_{each.name}": row for each, row in zip(self.constraints, rejected, strict=True)}
        chain = self.robot.chain
        for name, values in zip(chain.joint_names, partial["configurations"].T, strict=True):
            columns[f"q_{name}"] = values
        units = {"position": "m", "residual_m": "m", "residual_rad": "rad"}
        kinds = zip(chain.joint_names, chain.revolute, strict=True)
        units |= {f"q_{name}": "rad" if revolute else "m" for name, revolute in kinds}
        return Table(columns, units)
