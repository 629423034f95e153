"""What a user should know of the designs of a ``design_optimization`` that came to nothing."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.design.evaluations import feasible
from wsrender.errors import NotConvergedError, NumericalError, ResourceError
from wsrender.notices import Notice

if TYPE_CHECKING:
    from wsrender.analyses.design_optimization.run import DesignOptimizationAnalysis

# A design that is refused has no value by its nature; one whose run failed might have had one.
FAILURES = {error.code for error in (NotConvergedError, NumericalError, ResourceError)}


def fault_entries(faults: Sequence[dict[str, Any]], names: Sequence[str]) -> list[dict[str, Any]]:
    """Why designs have no value: kind of error, its first reason, the parameters there, and the number of designs.

    ``faults``: entries of `DesignFault`, the first one first; those of one kind and field are counted together.
    """
    found: dict[tuple[str, str], dict[str, Any]] = {}
    for fault in faults:
        code, field = fault["kind"]
        parameters = dict(zip(names, fault["design"], strict=True))
        entry = {"code": code, "reason": fault["reason"], "designs": 0, "parameters": parameters}
        found.setdefault((code, field), entry)["designs"] += 1
    return list(found.values())


def design_notices(
    plan: "DesignOptimizationAnalysis", designs: np.ndarray, values: np.ndarray, faults: Sequence[dict[str, Any]]
) -> Iterator[Notice]:
    """Designs whose runs failed; a best design that is none, since all (E, n) with values (E, k) were empty."""
    failed = [fault for fault in faults if fault["code"] in FAILURES]
    if failed:
        count = sum(fault["designs"] for fault in failed)
        yield Notice(
            "designs_failed",
            f"{count} of {len(designs)} designs ended in an error and count as infeasible, the first with: "
            f"{failed[0]['reason']}",
            "run that design alone (its parameters stand in search.faults), or leave it out by bounds or constraints",
            "parameters",
        )
    allowed = values[plan.space.allows(designs)]
    if not feasible(allowed, plan.weights).any():
        asked = ", ".join(o.name for o in plan.job.objectives if o.goal == "maximize") or "the objectives"
        yield Notice(
            "no_feasible_design",
            f"none of {len(designs)} designs has a workspace: {asked} is 0 or has no value in all, and the best is no "
            "better than the others",
            "widen the bounds, or move them to a design whose own analysis is not empty",
            "parameters",
        )
