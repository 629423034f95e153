"""Partial results ↔ what can be kept in files and in partial results of others."""

import json
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis
from wsrender.analyses.partial_result import PartialResult
from wsrender.documents.sampling import Converge
from wsrender.engine import Partial
from wsrender.run.workspace import WorkspacePartial, WorkspacePlan

Arrays = dict[str, np.ndarray]

SWEEP = ("extremes", "totals", "cells", "count", "records", "sums", "rejected")
ROWS = "rows_"


def packed(partial: Any) -> PartialResult:
    """Arrays and facts of a partial result."""
    return PartialResult(partial_to_arrays(partial)) if not hasattr(partial, "packed") else partial.packed()


def unpacked(parts: PartialResult, plan: Any) -> Any:
    """The partial result of a plan's shard."""
    return plan.unpacked(parts) if isinstance(plan, Analysis) else partial_of_arrays(dict(parts.arrays), plan)


def partial_to_arrays(partial: Any) -> Arrays:
    """The arrays of a partial result."""
    match partial:
        case WorkspacePartial():
            return _workspace_arrays(partial)
        case _:
            return partial


def partial_of_arrays(arrays: Arrays, plan: Any) -> Any:
    """The partial result of a plan's shard; KeyError, TypeError or ValueError where the arrays are not of one."""
    match plan:
        case WorkspacePlan():
            return _workspace_partial(arrays, plan)
        case _:
            return arrays


def _workspace_arrays(partial: WorkspacePartial) -> Arrays:
    sweep = partial.sweep
    about = {"samples": sweep.samples, "convergence": partial.convergence}
    rows = {f"{ROWS}{first}": block for first, block in sweep.rows.items()}
    return {"about": np.array(json.dumps(about)), **{name: getattr(sweep, name) for name in SWEEP}, **rows}


def _workspace_partial(arrays: Arrays, plan: WorkspacePlan) -> WorkspacePartial:
    about = json.loads(str(arrays["about"]))
    rows = {int(name.removeprefix(ROWS)): array for name, array in arrays.items() if name.startswith(ROWS)}
    sweep = Partial(about["samples"], **{name: arrays[name] for name in SWEEP}, rows=rows)
    sequence, sampling = about["convergence"], plan.job.sampling
    if sequence is None or not isinstance(sampling, Converge):
        return WorkspacePartial(sweep, plan.sweep)
    return WorkspacePartial(sweep, plan.with_grid(sequence[-1]["per_joint"], sampling), sequence)
