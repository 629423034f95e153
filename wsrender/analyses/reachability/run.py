"""The analysis ``reachability``: labels, configurations and residuals of given targets."""

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import DOCUMENT_BYTES, Cost, pictures_cost
from wsrender.analyses.estimate import RATE_CPU_CORE
from wsrender.analyses.execution import Execution
from wsrender.analyses.partial_result import PartialResult, joined_rows, rows_of_shard
from wsrender.analyses.reachability.job import ReachabilityJob
from wsrender.reach.targets import check_tolerance, reachable
from wsrender.volume.table import Table

RATE = 2e4  # targets per second, rounded down from benchmarks/inverse.py: many unreachable poses on one core
TABLE_BYTES, LISTED_BYTES = 120, 60  # of a target in the table, and in the job that the document keeps
DRAWN = 3  # configurations in the picture of the robot


class ReachabilityAnalysis(Analysis):
    """A planned ``reachability`` job: its samples are the targets."""

    effort = RATE_CPU_CORE / RATE
    job: ReachabilityJob

    def prepare(self, device: str, target: str) -> Settled:
        """Raises InputError for a tolerance below what is computed."""
        check_tolerance(self.robot.chain, self.job.position_tolerance_m, self.job.precision)
        return Settled(device, target, ((0, len(self.job.points_m)),), shard_unit=1)

    @property
    def cost(self) -> Cost:
        """Targets, what is known of each, and the table."""
        count = len(self.job.points_m)
        held = float(count * (self.robot.chain.n + 8) * 8)
        drawn, seconds = pictures_cost("targets")
        listed = (TABLE_BYTES + LISTED_BYTES) * count
        return Cost(count, held, DOCUMENT_BYTES + drawn + listed, count / RATE + seconds)

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
        )
        return rows_of_shard(first, vars(found))

    def merge(self, a: PartialResult, b: PartialResult) -> PartialResult:
        """The targets of both, in the order asked."""
        return joined_rows(a, b)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """The table ``targets``, one row per target in the order asked, and how many have which label."""
        labels, reasons = partial["labels"], partial["reasons"]
        reached = labels == "reachable"
        counts = {
            "count": len(labels),
            **{name: int((labels == name).sum()) for name in ("reachable", "unreachable", "undecided")},
            "reasons": {str(name): int((reasons == name).sum()) for name in np.unique(reasons) if name},
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
