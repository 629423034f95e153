"""The analysis ``design_optimization``: parameters of another job, searched for the best values of its result."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.design.evaluation_file import EvaluationFile
from wsrender.design.evaluations import Evaluations, scores
from wsrender.design.exact_volume import volume_gradient, volumes_of
from wsrender.design.inscribed import inscribed_cube_edge, inscribed_sphere_radius
from wsrender.design.search import Space, evolve, front, grid, pareto, refine
from wsrender.errors import InputError, NotConvergedError
from wsrender.parallel.ball_region import BallRegion
from wsrender.parallel.ball_surfaces import surface_table
from wsrender.parallel.exact import ExactWorkspace
from wsrender.parallel.mechanism import mechanism_of
from wsrender.result import Result
from wsrender.robot import Robot
from wsrender.run.parallel_exact import region_of
from wsrender.run.provenance import job_entry, provenance, robot_entry
from wsrender.run.settled_device import settled_device
from wsrender.spec import parse_job
from wsrender.spec.design import (
    CUBE,
    EXACT_VOLUME,
    SPHERE,
    DesignOptimizationJob,
    DifferentialEvolution,
    EvaluationsInFile,
    GridSweep,
    Objective,
    ParetoSearch,
)
from wsrender.spec.json_pointer import changed, found_at
from wsrender.spec.robot import Transform
from wsrender.volume.table import Table

if TYPE_CHECKING:
    import trimesh

Arrays = dict[str, np.ndarray]

BATCH, SLOW_BATCH = 256, 1  # designs between two reports of progress
AT_BOUND = 1e-6  # of a parameter's range
EXACT_PER_S, OTHERS_PER_S = 1e3, 1.0  # designs, rounded down


@dataclass(eq=False)
class DesignPlan:
    """A resolved ``design_optimization`` job: one shard of all its evaluations."""

    job: DesignOptimizationJob
    robots: tuple[Robot, ...]
    device: str
    target: str

    @property
    def shards(self) -> list[tuple[int, int]]:
        """One shard; as many samples as the search evaluates designs at most."""
        return [(0, self.job.most_evaluations)]

    @property
    def estimate(self) -> dict[str, float]:
        """Designs, their bytes, and seconds; of designs that are not exact a guess."""
        designs = float(self.job.most_evaluations)
        columns = len(self.job.parameters) + len(self.job.objectives)
        return {
            "samples": designs,
            "bytes": 24.0 * columns * designs,
            "seconds": designs / (EXACT_PER_S if self.is_exact else OTHERS_PER_S),
        }

    @property
    def is_exact(self) -> bool:
        """Whether all objectives are exact, and no job need run for them."""
        return all(objective.value == EXACT_VOLUME for objective in self.job.objectives)

    @property
    def space(self) -> Space:
        """Bounds and constraints of the designs."""
        names, constraints = [p.name for p in self.job.parameters], self.job.constraints
        matrix = [[constraint.coefficients.get(name, 0.0) for name in names] for constraint in constraints]
        lower, upper = np.array([parameter.bounds for parameter in self.job.parameters]).T
        least = [-np.inf if constraint.lower is None else constraint.lower for constraint in constraints]
        most = [np.inf if constraint.upper is None else constraint.upper for constraint in constraints]
        return Space(lower, upper, np.array(matrix).reshape(-1, len(names)), np.array(least), np.array(most))

    @property
    def weights(self) -> np.ndarray:
        """Weights (k,) of the values in the score; negative where small values are good."""
        return np.array([o.weight if o.goal == "maximize" else -o.weight for o in self.job.objectives])

    @property
    def resumes(self) -> bool:
        """A search that was stopped takes the designs that it has evaluated from its checkpoint."""
        return True

    def resolved(self) -> dict[str, Any]:
        """What is settled once: the device that "auto" means, target, shards."""
        return {"device": self.device, "target": self.target, "shards": [list(shard) for shard in self.shards]}

    def run_shard(self, shard: int, progress: Callable[[int], None] | None, **execution: Any) -> Arrays:
        """All designs (E, n) in the order of the search, their values (E, k), and what the search says."""
        given, width = self.job.evaluations, len(self._columns)
        own = EvaluationFile(given.path, self._columns) if isinstance(given, EvaluationsInFile) else None
        known = own.rows() if own else np.array(given, np.float64).reshape(-1, width)
        kept = EvaluationFile(execution["checkpoint"], self._columns) if "checkpoint" in execution else None
        before = _with_values(kept.rows()) if kept else np.empty((0, width))
        evaluator = _Evaluator(self, {name: execution[name] for name in ("threads",) if name in execution})
        evaluator.count = len(before)

        def keep(designs: np.ndarray, values: np.ndarray) -> None:
            for file in (own, kept):
                if file:
                    file.append(designs, values)

        count = len(self.job.parameters)
        evaluations = Evaluations(
            evaluator,
            self.weights,
            known=[(tuple(row[:count]), tuple(row[count:])) for row in np.concatenate([known, before]).tolist()],
            report=progress,
            keep=keep,
            batch=BATCH if self.is_exact else SLOW_BATCH,
        )
        ended = self._search(evaluations, evaluator)
        designs, values = evaluations.rows()
        if not np.isfinite(values).any() and evaluator.fault is not None:
            raise evaluator.fault
        about = {"ended": ended, "evaluated": evaluator.count, "fault": str(evaluator.fault or "")}
        return {"designs": designs, "values": values, "about": np.array(json.dumps(about))}

    def merge(self, a: Any, b: Any) -> Any:
        """There is one shard: nothing to merge."""
        raise ValueError("design_optimization has one shard")

    def finish(self, partial: Arrays, seconds: dict[str, float]) -> Result:
        """The best design, all designs, how the search went, and the best design's mesh where it is exact."""
        designs, values, about = partial["designs"], partial["values"], json.loads(str(partial["about"]))
        score = scores(values, self.weights)
        entries = self._best_entries(designs, values, score)
        document = {
            "analysis": "design_optimization",
            "job": job_entry(self.job, *self.robots),
            "parameters": [p.model_dump(mode="json") for p in self.job.parameters],
            "objectives": [
                {"name": o.name, "goal": o.goal, "weight": o.weight, "unit": o.unit} for o in self.job.objectives
            ],
            **self._subject(),
            "search": {
                "method": self.job.search.method,
                "ended": about["ended"],
                "designs": len(designs),
                "evaluated": about["evaluated"],
                "without_value": int((~np.isfinite(score)).sum()),
                "first_fault": about["fault"] or None,
            },
            **entries,
            "provenance": provenance("float64", self.target),
            "timing_s": seconds,
        }
        meshes, tables = self._exact_best(entries["best"])
        return Result(document, tables={**self._tables(designs, values, score), **tables}, meshes=meshes)

    def regions_at(self, designs: np.ndarray) -> list[BallRegion]:
        """The ball regions of designs (N, n) of a mechanism."""
        jobs = [self.job_of(design) for design in designs]
        return [
            region_of(mechanism_of(job.mechanism), (job.orientation or Transform()).matrix()[:3, :3]) for job in jobs
        ]

    def job_of(self, design: np.ndarray) -> Any:
        """The inner job at a design (n,); raises DocumentError where it is none."""
        return parse_job(self.document_of(design))

    def document_of(self, design: np.ndarray) -> Any:
        """The document of the inner job at a design (n,), canonical but for the changes."""
        values = zip(self.job.parameters, map(float, design), strict=True)
        document = self.job.design.model_dump(mode="json")
        return changed(document, {pointer: value for p, value in values for pointer in p.pointers})

    @property
    def _columns(self) -> list[str]:
        return [*(parameter.name for parameter in self.job.parameters), *(o.name for o in self.job.objectives)]

    def _subject(self) -> dict[str, Any]:
        """The robots or the mechanism whose parameters vary, as they are in the document."""
        if self.robots:
            return {"robots": [{"name": robot.name, "robot": robot_entry(robot)} for robot in self.robots]}
        mechanism = getattr(self.job.design, "mechanism", None)
        return {"mechanism": {"name": mechanism_of(mechanism).name}} if mechanism else {}

    def _search(self, evaluations: Evaluations, evaluator: "_Evaluator") -> str:
        space, search = self.space, self.job.search
        if isinstance(search, GridSweep):
            designs = grid(space, search.counts(len(self.job.parameters)))
            if not len(designs):
                raise InputError("constraints", "leave out every design of the sweep")
            evaluations.values(designs)
            return "every combination"
        if isinstance(search, ParetoSearch):
            return pareto(
                space, evaluations, population=search.population, generations=search.generations, seed=search.seed
            )
        assert isinstance(search, DifferentialEvolution)
        ended = evolve(
            space,
            evaluations,
            population=search.population,
            generations=search.generations,
            tolerance=search.tolerance,
            seed=search.seed,
        )
        if not len(evaluations):
            raise NotConvergedError("no design that the constraints allow was found", [])
        if search.refine and self.is_exact:
            designs, values = evaluations.rows()
            start = designs[scores(values, self.weights).argmax()]
            ended += f"; {refine(space, evaluations, start, evaluator.gradient)}"
        return ended

    def _best_entries(self, designs: np.ndarray, values: np.ndarray, score: np.ndarray) -> dict[str, Any]:
        """The design of the best score, and for a Pareto search all that none beats."""
        allowed = np.where(self.space.allows(designs), score, -np.inf)
        best = int(allowed.argmax())
        entries: dict[str, Any] = {
            "best": None if allowed[best] == -np.inf else self._entry(designs[best], values[best])
        }
        if isinstance(self.job.search, ParetoSearch):
            kept = np.flatnonzero(self.space.allows(designs))
            on_front = kept[front(values[kept], self.weights)]
            entries["pareto"] = [self._entry(designs[k], values[k]) for k in on_front]
        return entries

    def _entry(self, design: np.ndarray, values: np.ndarray) -> dict[str, Any]:
        space, names = self.space, [parameter.name for parameter in self.job.parameters]
        slack = AT_BOUND * (space.upper - space.lower)
        at_lower, at_upper = design <= space.lower + slack, design >= space.upper - slack
        return {
            "parameters": dict(zip(names, design.tolist(), strict=True)),
            "values": {o.name: v for o, v in zip(self.job.objectives, values.tolist(), strict=True)},
            "at_bounds": [name for name, at in zip(names, at_lower | at_upper, strict=True) if at],
            "design": self.document_of(design),
        }

    def _tables(self, designs: np.ndarray, values: np.ndarray, score: np.ndarray) -> dict[str, Table]:
        """``evaluations`` in order, ``convergence`` of the best, and ``sweep`` or ``pareto``."""
        objectives, names = self.job.objectives, [parameter.name for parameter in self.job.parameters]
        units = {o.name: o.unit for o in objectives if o.unit}
        columns = dict(zip(names, designs.T, strict=True)) | {
            o.name: v for o, v in zip(objectives, values.T, strict=True)
        }
        tables = {"evaluations": Table(columns, units)}
        if isinstance(self.job.search, GridSweep):
            tables["sweep"] = Table(columns, units)
            return tables
        if isinstance(self.job.search, ParetoSearch):
            kept = np.flatnonzero(self.space.allows(designs))
            on_front = kept[front(values[kept], self.weights)]
            tables["pareto"] = Table({name: column[on_front] for name, column in columns.items()}, units)
            return tables
        tables["convergence"] = self._convergence(designs, score, units)
        return tables

    def _convergence(self, designs: np.ndarray, score: np.ndarray, units: dict[str, str]) -> Table:
        """The best so far, after each evaluation that improved it and the last; of one objective the value itself."""
        best = np.maximum.accumulate(np.where(self.space.allows(designs), score, -np.inf))
        improved = best > np.concatenate([[-np.inf], best[:-1]])
        improved[-1] = True
        rows = np.flatnonzero(improved & np.isfinite(best))
        if len(self.job.objectives) == 1:
            shown = {self.job.objectives[0].name: best[rows] / self.weights[0]}
        else:
            shown = {"score": best[rows]}
        return Table({"evaluation": rows + 1, **shown}, {name: units[name] for name in shown if name in units})

    def _exact_best(self, best: dict[str, Any] | None) -> "tuple[dict[str, trimesh.Trimesh], dict[str, Table]]":
        """The exact workspace of the best design, in the world, and the table of its surfaces."""
        if best is None or not self.is_exact:
            return {}, {}
        design = np.array(list(best["parameters"].values()))
        (region,) = self.regions_at(design[None])
        exact = ExactWorkspace.of(region)
        if not len(exact.mesh.faces):
            return {}, {}
        T_world_base = mechanism_of(self.job_of(design).mechanism).T_world_base
        mesh = exact.mesh.apply_transform(T_world_base)
        mesh.metadata["frame"] = "world"
        return {"best": mesh}, {"surfaces": surface_table(region, exact.measures.area[0], T_world_base)}


def _with_values(rows: np.ndarray) -> np.ndarray:
    """A checkpoint's rows but those of designs without value, which are tried again, so that their fault is known."""
    return np.unique(rows[np.isfinite(rows).all(axis=1)], axis=0)


class _Evaluator:
    """Values of designs: exact ones many at a time, others by running the inner job of each.

    ``fault`` is the first error of a design that is none, ``count`` the number of designs evaluated.
    """

    def __init__(self, plan: DesignPlan, execution: dict[str, Any]):
        self.plan, self.execution = plan, execution
        self.fault: InputError | None = None
        self.count = 0

    def __call__(self, designs: np.ndarray) -> np.ndarray:
        """Values (N, k) of designs (N, n), NaN where a design has none."""
        self.count += len(designs)
        if self.plan.is_exact:
            return self._exact(designs)
        return np.array([self._by_running(design) for design in designs])

    def gradient(self, design: np.ndarray) -> np.ndarray:
        """Derivatives (n,) of the score of exact objectives."""
        space = self.plan.space
        inside = np.clip(design, space.lower, space.upper)
        return self.plan.weights.sum() * volume_gradient(self.plan.regions_at, inside, space.lower, space.upper)

    def _exact(self, designs: np.ndarray) -> np.ndarray:
        regions, rows = [], []
        for row, design in enumerate(designs):
            try:
                regions += self.plan.regions_at(design[None])
                rows.append(row)
            except InputError as error:
                self.fault = self.fault or error.within("design")
        values = np.full((len(designs), 1), np.nan)
        if rows:
            values[rows, 0] = volumes_of(regions)
        return values

    def _by_running(self, design: np.ndarray) -> list[float]:
        from wsrender.run.steps import execute  # which knows this analysis too

        try:
            result = execute(self.plan.job_of(design), **self.execution)
        except InputError as error:
            self.fault = self.fault or error.within("design")
            return [np.nan] * len(self.plan.job.objectives)
        return [self._value(objective, result, design) for objective in self.plan.job.objectives]

    def _value(self, objective: Objective, result: Result, design: np.ndarray) -> float:
        """The value of an objective; NaN where the result has null there, or nothing because it is empty."""
        if objective.value == SPHERE:
            return inscribed_sphere_radius(result.volume)
        if objective.value == CUBE:
            return inscribed_cube_edge(result.volume)
        if objective.value == EXACT_VOLUME:
            return float(volumes_of(self.plan.regions_at(design[None]))[0])
        try:
            found = found_at(result.document, objective.value)
        except ValueError as error:
            if "empty" in result.document:
                return np.nan
            raise InputError("objectives", f"{objective.value} {error}") from None
        if isinstance(found, bool) or not isinstance(found, int | float | None):
            raise InputError("objectives", f"{objective.value} is no number in the result document")
        return np.nan if found is None else float(found)


def plan_design(job: DesignOptimizationJob, *robots: Robot, resolved: dict[str, Any] | None = None) -> DesignPlan:
    """Resolve the job, or take what `DesignPlan.resolved` of an earlier plan of it says.

    Raises InputError for a mechanism that other surfaces than spheres bound, where its exact volume is asked.
    """
    plan = DesignPlan(job, robots, *settled_device(getattr(job.design, "device", "cpu"), resolved))
    if any(objective.value == EXACT_VOLUME for objective in job.objectives):
        inner: Any = job.design
        if inner.mechanism.before or inner.mechanism.after:
            raise InputError("design.mechanism", 'must have no serial joints where "exact_volume" is improved')
        region_of(mechanism_of(inner.mechanism), np.eye(3))
    return plan
