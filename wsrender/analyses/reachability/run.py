"""The analysis ``reachability``: labels, configurations and residuals of given targets."""

from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import (
    DECIDED_PER_S,
    DOCUMENT_BYTES,
    LISTED_BYTES,
    LISTED_MEMORY,
    SEARCHED_BYTES,
    SEARCHED_PER_S,
    STARTS_S,
    WRITTEN_PER_S,
    Asks,
    Cost,
    pictures_cost,
)
from wsrender.analyses.criteria import margins_of, share_of, verdicts
from wsrender.analyses.estimate import RATE_CPU_CORE
from wsrender.analyses.execution import Execution
from wsrender.analyses.partial_result import PartialResult, joined_rows, rows_of_shard
from wsrender.analyses.reachability.job import ReachabilityJob
from wsrender.documents.target_lists import TargetTable, TargetVolume
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.reach.inverse_solver import closed_form_of, solved_bytes
from wsrender.reach.target_list import TargetList, covered, targets_of_job
from wsrender.reach.targets import Reachability, check_tolerance, evidence_of_targets, reachable_targets
from wsrender.robot.constraints import constraints_of_job
from wsrender.robots.closed_form import ClosedForm
from wsrender.robots.kinematics import Kinematics
from wsrender.volume.table import Table

ADMITTED_PER_S = 4e4  # poses of one core, of which all postures are asked for
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
        """Raises InputError for a tolerance below what is computed, a table that cannot be read, and no room."""
        check_tolerance(self.robot.chain, self.job.position_tolerance_m, self.job.precision)
        _ = self.constraints, self.margins
        return Settled(device, target, ((0, len(self.targets)),), shard_unit=1)

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        """What configurations must satisfy; raises InputError."""
        return constraints_of_job(self.job, self.robot)

    @cached_property
    def targets(self) -> TargetList:
        """The targets; raises InputError for a table that cannot be read."""
        chain = self.robot.chain
        return targets_of_job(self.job, lambda position: chain.center, chain.reach)

    @cached_property
    def margins(self) -> dict[int, Kinematics]:
        """The arm within the limits of each criterion, by number, that asks for a margin; raises InputError."""
        return margins_of(self.job.criteria, self.robot.chain)

    @property
    def cost(self) -> Cost:
        """Targets, what is known of each, and the table."""
        count, n, oriented = len(self.targets), self.robot.chain.n, bool(self.targets.oriented.any())
        width = 7 if oriented else 3
        listed = 0 if isinstance(self.job.targets, TargetTable | TargetVolume) else width
        drawn, seconds = pictures_cost("targets", "robot")
        files = DOCUMENT_BYTES + drawn + (TABLE_BYTES + 8 * (n + width - 3) + LISTED_BYTES * listed) * count
        kind = "pose" if oriented else "position"
        solved = solved_bytes(count, kind, self.robot.chain, self.job.precision) + 16 * n * count
        memory = (8 * width + LISTED_MEMORY * listed) * count + max(solved, (LABEL_BYTES + 16 * n) * count)
        each = count / (POSES_PER_S if oriented else DECIDED_PER_S)
        if self.constraints:
            closed = isinstance(closed_form_of(self.robot.chain, kind), ClosedForm) and kind == "pose"
            rate = ADMITTED_PER_S if closed else SEARCHED_PER_S
            memory, each = memory + SEARCHED_BYTES + self.program_bytes, each + count / rate
            seconds += STARTS_S
        seconds += each * (1 + len(self.margins)) + files / WRITTEN_PER_S
        return Cost(count, memory, files, seconds, Asks("points_m", "take fewer"))

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """The shard's targets decided: arrays of `Reachability` by name, and labels by criterion that has a margin.

        Of targets that are reached with a margin, the configuration found keeps that of the last such criterion.
        """
        first, count = self.shards[shard]
        targets = self.targets.part(slice(first, first + count))
        found = self._decided(self.robot.chain, targets, execution, tell)
        rows = {name: value for name, value in vars(found).items() if value is not None}
        labels = {}
        for k, chain in self.margins.items():
            at = np.flatnonzero(np.isin(found.labels, ("reachable", "undecided")))
            inner = self._decided(chain, targets.part(at), execution)
            labels[f"criterion_{k + 1}"] = found.labels.copy()
            labels[f"criterion_{k + 1}"][at] = inner.labels
            kept = inner.labels == "reachable"
            rows["labels"][at[kept]], rows["reasons"][at[kept]] = "reachable", ""  # whatever was undecided
            for name in ("configurations", "residual_m", "residual_rad"):
                rows[name][at[kept]] = getattr(inner, name)[kept]
        return rows_of_shard(first, rows | labels)

    def _decided(
        self, chain: Kinematics, targets: TargetList, execution: Execution, tell: Tell | None = None
    ) -> Reachability:
        job = self.job
        return reachable_targets(
            chain,
            targets,
            (job.position_tolerance_m, job.angle_tolerance_rad),
            characteristic_length_m=job.characteristic_length_m,
            seed=job.seed,
            precision=job.precision,
            device=self.device,
            threads=execution.threads,
            progress=tell,
            constraints=self.constraints,
        )

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
            "evidence": evidence_of_targets(self.robot.chain, self.targets),
            "largest_residual_of_reachable_m": float(partial["residual_m"][reached].max(initial=0.0)),
            "largest_residual_of_reachable_rad": float(partial["residual_rad"][reached].max(initial=0.0)),
        }
        if self.job.targets is not None:
            weight = self.targets.weight
            counts["share"] = {name: share_of(weight, labels == name) for name in names}
        q = partial["configurations"][reached][:DRAWN]
        skeleton = self.robot.skeleton(q) if len(q) else None
        entries = {"targets": counts, **covered(self.job.targets, reached, labels == "undecided")}
        entries |= self._verdicts(partial)
        return Draft(
            entries, provenance=self.targets.provenance, tables={"targets": self._table(partial)}, skeleton=skeleton
        )

    def _verdicts(self, partial: PartialResult) -> dict[str, Any]:
        """The entries ``criteria`` and ``verdict`` of a job with criteria."""
        labels = [
            partial[f"criterion_{k + 1}" if k in self.margins else "labels"] for k in range(len(self.job.criteria))
        ]
        return verdicts(self.job.criteria, self.targets.weight, labels)

    def _table(self, partial: PartialResult) -> Table:
        columns = self.targets.columns(self.job.targets is not None) | {
            "label": partial["labels"],
            "reason": partial["reasons"],
            "proven": partial["proven"],
            "residual_m": partial["residual_m"],
            "residual_rad": partial["residual_rad"],
        }
        if self.constraints:
            rejected = partial["rejected"].T
            columns |= {f"rejected_{each.name}": row for each, row in zip(self.constraints, rejected, strict=True)}
        columns |= {f"criterion_{k + 1}": partial[f"criterion_{k + 1}"] for k in self.margins}
        chain = self.robot.chain
        for name, values in zip(chain.joint_names, partial["configurations"].T, strict=True):
            columns[f"q_{name}"] = values
        units = {"position": "m", "residual_m": "m", "residual_rad": "rad"}
        kinds = zip(chain.joint_names, chain.revolute, strict=True)
        units |= {f"q_{name}": "rad" if revolute else "m" for name, revolute in kinds}
        return Table(columns, units)
