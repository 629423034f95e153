"""Partial results ↔ npz files without pickles, so that a restart need not compute them again."""

import json
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from wsrender.engine import Evaluated, Partial
from wsrender.errors import InputError
from wsrender.export.atomic import new_file
from wsrender.run.indices_at import IndicesAtPlan
from wsrender.run.workspace import WorkspacePartial, WorkspacePlan
from wsrender.spec.sampling import Converge

SWEEP = ("extremes", "totals", "cells", "count", "records", "sums")
EVALUATED = ("position", "values", "largest_sigma", "smallest_sigma", "quat_wxyz")
ROWS = "rows_"


Partials = WorkspacePartial | Evaluated | dict[str, np.ndarray]
"""Partial results: of the analyses without a type of their own, plain arrays by name."""


def save_partial(partial: Partials, path: str | Path) -> None:
    """Write a partial result; the file appears complete or not at all."""
    match partial:
        case WorkspacePartial():
            arrays = _workspace_arrays(partial)
        case Evaluated():
            arrays = _evaluated_arrays(partial)
        case _:
            arrays = partial
    with new_file(path) as temporary, temporary.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)


def load_partial(path: str | Path, plan: Any) -> Partials:
    """Read what ``save_partial`` wrote of a shard of ``plan``; InputError where the file is missing or damaged."""
    path = Path(path)
    read: Callable[[Any, Any], Any] = READERS.get(type(plan), _arrays)
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
            return read(arrays, plan)
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(path.name, f"cannot be read as a partial result: {error}") from error


def _workspace_arrays(partial: WorkspacePartial) -> dict[str, np.ndarray]:
    sweep = partial.sweep
    about = {"samples": sweep.samples, "convergence": partial.convergence}
    rows = {f"{ROWS}{first}": block for first, block in sweep.rows.items()}
    return {"about": np.array(json.dumps(about)), **{name: getattr(sweep, name) for name in SWEEP}, **rows}


def _workspace(arrays: Any, plan: WorkspacePlan) -> WorkspacePartial:
    about = json.loads(str(arrays["about"]))
    rows = {int(name.removeprefix(ROWS)): arrays[name] for name in arrays.files if name.startswith(ROWS)}
    sweep = Partial(about["samples"], **{name: arrays[name] for name in SWEEP}, rows=rows)
    sequence, sampling = about["convergence"], plan.job.sampling
    if sequence is None or not isinstance(sampling, Converge):
        return WorkspacePartial(sweep, plan.sweep)
    return WorkspacePartial(sweep, plan.with_grid(sequence[-1]["per_joint"], sampling), sequence)


def _arrays(arrays: Any, plan: Any) -> dict[str, np.ndarray]:
    return {name: arrays[name] for name in arrays.files}


def _evaluated_arrays(partial: Evaluated) -> dict[str, np.ndarray]:
    return {name: value for name in EVALUATED if (value := getattr(partial, name)) is not None}


def _evaluated(arrays: Any, plan: Any) -> Evaluated:
    quat_wxyz = arrays["quat_wxyz"] if "quat_wxyz" in arrays.files else None
    return Evaluated(arrays["position"], arrays["values"], arrays["largest_sigma"], arrays["smallest_sigma"], quat_wxyz)


READERS: dict[type, Callable[[Any, Any], Any]] = {WorkspacePlan: _workspace, IndicesAtPlan: _evaluated}
