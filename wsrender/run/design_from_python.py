"""Design optimisation from Python."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from wsrender.errors import InputError
from wsrender.results.result import Result
from wsrender.run.from_python import execute_here, plain
from wsrender.run.steps import Progress


def design_optimization(
    design: Mapping[str, Any],
    parameters: Sequence[Mapping[str, Any]],
    objectives: Sequence[Mapping[str, Any]],
    *,
    resume: Result | None = None,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """Find parameters at which the result of another analysis is best.

    ``design`` is the document of that analysis, ``parameters`` say which of its numbers vary: {"name": …, "pointers":
    ["/mechanism/platform_m"], "bounds": [low, high]}. ``objectives``: {"value": "exact_volume" |
    "exact_inscribed_sphere" | "exact_inscribed_cube" | "inscribed_sphere" | "inscribed_cube" | "/volume_m3/occupied" …,
    "goal": "maximize" | "minimize", "weight": …}. ``fields`` are the other fields of the job document
    ``design_optimization``: constraints, search, evaluations. ``resume`` is an earlier result, whose designs are not
    evaluated again. ``threads`` and ``chunk_size`` are those of `analyze`, for the runs of the designs.

    Raises DocumentError, InputError, NotConvergedError, and MissingExtraError for a Pareto search without pymoo.
    """
    document = {
        "analysis": "design_optimization",
        "design": design,
        "parameters": list(parameters),
        "objectives": list(objectives),
        **plain(fields),
    }
    if resume is not None:
        if "evaluations" in fields:
            raise InputError("evaluations", "must not be given together with resume: one of the two")
        document["evaluations"] = _rows(resume)
    return execute_here(document, None, progress, threads, chunk_size)


def _rows(earlier: Result) -> list[list[float | None]]:
    if "evaluations" not in earlier.tables:
        raise InputError("resume", "must be a result of design_optimization: it has no table of evaluations")
    rows = np.stack(list(earlier.tables["evaluations"].columns.values()), axis=1)
    return [[value if np.isfinite(value) else None for value in row] for row in rows.tolist()]
