"""The partial result of a ``workspace`` job."""

from dataclasses import dataclass
from typing import Any

from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.refined import RefinedRobot
from wsrender.engine import Partial
from wsrender.pipeline.pipeline import Pipeline

SWEEP = (
    *("extremes", "totals", "cells", "count", "records", "sums"),
    *("rejected", "earliest", "blocked_cells", "blocked", "cut"),
)
ROWS = "rows_"


@dataclass(frozen=True, eq=False)
class WorkspacePartial:
    """What a sweep has found, and for a converging job the whole sequence of global values."""

    sweep: Partial
    pipeline: Pipeline
    convergence: list[dict[str, Any]] | None = None
    refined: RefinedRobot | None = None

    def packed(self) -> PartialResult:
        """Arrays of the sweep and, as facts, the rest; labels of voxels are found after the last merge, and stay."""
        rows = {f"{ROWS}{first}": block for first, block in self.sweep.rows.items()}
        arrays = {name: getattr(self.sweep, name) for name in SWEEP}
        facts = {"samples": self.sweep.samples, "convergence": self.convergence}
        if (index := self.sweep.best_index) is not None:
            arrays, facts = arrays | {"best": self.sweep.best}, facts | {"best_index": index}
        return PartialResult(arrays | rows, facts)


def sweep_of(partial: PartialResult) -> Partial:
    """The sweep's part of what was packed."""
    rows = {int(name.removeprefix(ROWS)): array for name, array in partial.arrays.items() if name.startswith(ROWS)}
    kept = (*SWEEP, "best") if (index := partial.facts.get("best_index")) is not None else SWEEP
    return Partial(partial.facts["samples"], **{name: partial[name] for name in kept}, rows=rows, best_index=index)
