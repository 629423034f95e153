"""The result of a ``design_optimization``: best design, front, tables, and the best design's exact workspace."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.analyses.design_optimization.job import (
    CUBE,
    EXACT,
    EXACT_CUBE,
    EXACT_SPHERE,
    EXACT_VOLUME,
    SPHERE,
    GridSweep,
    ParetoSearch,
)
from wsrender.analyses.headline import headline, no_headline
from wsrender.design.inscribed import CUBE_ERROR, SPHERE_ERROR, largest_ball, largest_cube
from wsrender.design.search import front
from wsrender.mechanisms.ball_region import surface_table
from wsrender.mechanisms.exact import ExactWorkspace
from wsrender.volume.table import Table

if TYPE_CHECKING:
    import trimesh

    from wsrender.analyses.design_optimization.run import DesignOptimizationAnalysis

AT_BOUND = 1e-6  # of a parameter's range
_DH_UNITS = {"a": "m", "d": "m", "alpha": "rad", "theta": "rad"}
_ENDINGS = {"m": "m", "rad": "rad", "deg": "deg", "s": "s"}  # units by the endings of fields


def best_headline(plan: "DesignOptimizationAnalysis", best: dict[str, Any] | None) -> dict[str, Any]:
    """The exact volume of the best design, where that was improved."""
    if best is None:
        return no_headline("no design has a value")
    if EXACT_VOLUME not in best["values"]:
        return no_headline("the objectives are no exact volume; an analysis of the best design measures it")
    volume = best["values"][EXACT_VOLUME]
    return headline("volume", volume, (volume, volume))


def objective_entries(plan: "DesignOptimizationAnalysis") -> list[dict[str, Any]]:
    """Name, goal, weight and unit of every objective; of those measured in voxels how far they may be off."""
    voxel = getattr(plan.job.design, "voxel_size_m", None)
    entries = []
    for o in plan.job.objectives:
        entry = {"name": o.name, "goal": o.goal, "weight": o.weight, "unit": o.unit}
        if o.value in (SPHERE, CUBE):
            error = SPHERE_ERROR if o.value == SPHERE else CUBE_ERROR
            entry |= {"error_voxels": error, "error_m": None if voxel is None else error * voxel}
        entries.append(entry)
    return entries


def best_entries(
    plan: "DesignOptimizationAnalysis", designs: np.ndarray, values: np.ndarray, score: np.ndarray
) -> dict[str, Any]:
    """The design of the best score, and for a Pareto search all that none beats."""
    allowed = np.where(plan.space.allows(designs), score, -np.inf)
    best = int(allowed.argmax())
    entries: dict[str, Any] = {"best": None}
    if allowed[best] > -np.inf:
        entries["best"] = _entry(plan, designs[best], values[best])
        if inscribed := _inscribed_entries(plan, designs[best]):
            entries["inscribed"] = inscribed
    if isinstance(plan.job.search, ParetoSearch):
        entries["pareto"] = [_entry(plan, designs[k], values[k]) for k in _on_front(plan, designs, values)]
    return entries


def _on_front(plan: "DesignOptimizationAnalysis", designs: np.ndarray, values: np.ndarray) -> np.ndarray:
    kept = np.flatnonzero(plan.space.allows(designs))
    return kept[front(values[kept], plan.weights)]


def _entry(plan: "DesignOptimizationAnalysis", design: np.ndarray, values: np.ndarray) -> dict[str, Any]:
    space, names = plan.space, [parameter.name for parameter in plan.job.parameters]
    slack = AT_BOUND * (space.upper - space.lower)
    at_lower, at_upper = design <= space.lower + slack, design >= space.upper - slack
    return {
        "parameters": dict(zip(names, design.tolist(), strict=True)),
        "values": {o.name: v for o, v in zip(plan.job.objectives, values.tolist(), strict=True)},
        "at_bounds": [name for name, at in zip(names, at_lower | at_upper, strict=True) if at],
        "design": plan.document_of(design),
    }


def _inscribed_entries(plan: "DesignOptimizationAnalysis", design: np.ndarray) -> dict[str, Any]:
    """Where the exact inscribed ball and cube of a design lie, world frame, and what no other exceeds."""
    entries: dict[str, Any] = {}
    asked = {o.value for o in plan.job.objectives}
    for value, name, largest, factor in (
        (EXACT_SPHERE, "radius_m", largest_ball, 1.0),
        (EXACT_CUBE, "edge_m", largest_cube, 2.0),
    ):
        found = largest(*plan.placed_region(design)) if value in asked else None
        if found is not None:
            sizes = {name: factor * found.size, f"at_most_{name}": factor * found.at_most}
            entries[value.removeprefix("exact_inscribed_")] = {"center_m": found.center.tolist(), **sizes}
    return entries


def tables_of(
    plan: "DesignOptimizationAnalysis", designs: np.ndarray, values: np.ndarray, score: np.ndarray
) -> dict[str, Table]:
    """``evaluations`` in order, ``convergence`` of the best, and ``sweep`` or ``pareto``."""
    objectives, names = plan.job.objectives, [parameter.name for parameter in plan.job.parameters]
    units = {o.name: o.unit for o in objectives if o.unit}
    units |= {p.name: unit for p in plan.job.parameters if (unit := unit_of(p.pointers))}
    columns = dict(zip(names, designs.T, strict=True)) | {o.name: v for o, v in zip(objectives, values.T, strict=True)}
    tables = {"evaluations": Table(columns, units)}
    if isinstance(plan.job.search, GridSweep):
        tables["sweep"] = Table(columns, units)
    elif isinstance(plan.job.search, ParetoSearch):
        on_front = _on_front(plan, designs, values)
        tables["pareto"] = Table({name: column[on_front] for name, column in columns.items()}, units)
    else:
        tables["convergence"] = _convergence(plan, designs, score, units)
    return tables


def unit_of(pointers: Sequence[str]) -> str:
    """Unit of a parameter by the fields that it stands in, such as "m" of "/mechanism/link_m"; "": none, or several."""
    fields = [next((part for part in reversed(each.split("/")) if not part.isdigit()), "") for each in pointers]
    units = {_DH_UNITS.get(field) or _ENDINGS.get(field.rpartition("_")[2], "") for field in fields}
    return units.pop() if len(units) == 1 else ""


def _convergence(
    plan: "DesignOptimizationAnalysis", designs: np.ndarray, score: np.ndarray, units: dict[str, str]
) -> Table:
    """The best so far, after each evaluation that improved it and the last; of one objective the value itself."""
    best = np.maximum.accumulate(np.where(plan.space.allows(designs), score, -np.inf))
    improved = best > np.concatenate([[-np.inf], best[:-1]])
    improved[-1] = True
    rows = np.flatnonzero(improved & np.isfinite(best))
    if len(plan.job.objectives) == 1:
        shown = {plan.job.objectives[0].name: best[rows] / plan.weights[0]}
    else:
        shown = {"score": best[rows]}
    return Table({"evaluation": rows + 1, **shown}, {name: units[name] for name in shown if name in units})


def exact_best(
    plan: "DesignOptimizationAnalysis", best: dict[str, Any] | None
) -> "tuple[dict[str, trimesh.Trimesh], dict[str, Table]]":
    """The exact workspace of the best design, in the world, and the table of its surfaces."""
    if best is None or not any(o.value in EXACT for o in plan.job.objectives):
        return {}, {}
    region, T_world_base = plan.placed_region(np.array(list(best["parameters"].values())))
    exact = ExactWorkspace.of(region)
    if not len(exact.mesh.faces):
        return {}, {}
    mesh = exact.mesh.apply_transform(T_world_base)
    mesh.metadata["frame"] = "world"
    return {"best": mesh}, {"surfaces": surface_table(region, exact.measures.area[0], T_world_base)}
