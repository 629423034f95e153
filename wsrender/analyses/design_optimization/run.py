"""The analysis ``design_optimization``: parameters of another job, searched for the best values of its result."""

import sys
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Progress, Settled, Tell
from wsrender.analyses.cost import DOCUMENT_BYTES, NOTHING, Asks, Cost, pictures_cost
from wsrender.analyses.design_optimization.job import (
    EXACT,
    EXACT_VOLUME,
    DesignOptimizationJob,
    DifferentialEvolution,
    EvaluationsInFile,
    GridSweep,
    ParetoSearch,
)
from wsrender.analyses.design_optimization.notices import design_notices, fault_entries
from wsrender.analyses.design_optimization.result import (
    best_entries,
    best_headline,
    exact_best,
    objective_entries,
    tables_of,
)
from wsrender.analyses.design_optimization.values import FAULTS, Evaluator
from wsrender.analyses.execution import Execution
from wsrender.analyses.jobs import parse_job
from wsrender.analyses.partial_result import FIRST, PartialResult, joined_rows, rows_of_shard
from wsrender.analyses.piece import Piece
from wsrender.analyses.registry import planned
from wsrender.design.evaluations import EvaluationFile, Evaluations, feasible, scores
from wsrender.design.search import Space, evolve, grid, pareto, refine
from wsrender.documents.json_pointer import changed
from wsrender.documents.robot import Transform
from wsrender.errors import InputError, NotConvergedError, NumericalError
from wsrender.mechanisms.ball_region import BallRegion, region_of
from wsrender.mechanisms.mechanism import mechanism_of

BATCH, SLOW_BATCH = 256, 1  # designs between two reports of progress
EXACT_PER_S, OTHERS_PER_S = 1e3, 5.0  # designs
BEST_BYTES = 2.7e5  # of the best design's mesh


@dataclass(frozen=True, kw_only=True)
class DesignSettled(Settled):
    """With the designs of all rounds of a divided search; its samples are as many as the search evaluates at most."""

    designs: tuple[tuple[float, ...], ...] = ()
    most_samples: int = 0


class PendingDesigns(Exception):  # noqa: N818 - no error: a search has come to designs without values
    """The designs (N, n) that a search asks for next."""

    def __init__(self, designs: np.ndarray):
        super().__init__()
        self.designs = tuple(map(tuple, designs.tolist()))


class DesignOptimizationAnalysis(Analysis):
    """A planned ``design_optimization`` job: one shard of as many designs as the search evaluates at most.

    Divided, each design that a job must run for is a shard, and each generation a round: the search, which is no work
    beside its evaluations, is done again with the values that are known until it asks for others.
    """

    settles = DesignSettled
    settled: DesignSettled
    resumes = True  # a search that was stopped takes the designs that it has evaluated from its checkpoint
    job: DesignOptimizationJob

    def prepare(self, device: str, target: str) -> DesignSettled:
        """Raises InputError for a mechanism that other surfaces than spheres bound, where an exact value is asked."""
        if exact := [objective.value for objective in self.job.objectives if objective.value in EXACT]:
            self._check_mechanism(exact[0])
        return DesignSettled(device, target, ((0, self.job.most_evaluations),))

    def _check_mechanism(self, exact: str) -> None:
        inner: Any = self.job.design
        if inner.mechanism.before or inner.mechanism.after:
            raise InputError("design.mechanism", f'must have no serial joints where "{exact}" is improved')
        try:
            region_of(mechanism_of(inner.mechanism), np.eye(3))
        except InputError as error:
            message = f'{error.message} ("{exact}" is of workspaces that only spheres bound)'
            raise InputError(f"design.{error.field}", message) from None

    @property
    def asked_device(self) -> str:
        """That of the job whose parameters vary."""
        return getattr(self.job.design, "device", "cpu")

    @property
    def cost(self) -> Cost:
        """Designs, their bytes with those of one that is run, and seconds; of designs that are not exact a guess."""
        designs = float(self.job.most_evaluations)
        columns = len(self.job.parameters) + len(self.job.objectives)
        drawn, seconds = pictures_cost("refinements", *["patches"] * self.is_exact)
        files = DOCUMENT_BYTES + drawn + BEST_BYTES * self.is_exact + 16.0 * columns * designs
        seconds += designs / (EXACT_PER_S if self.is_exact else OTHERS_PER_S)
        memory, asks = 24.0 * columns * designs, Asks("search", "take fewer designs")
        if not self.is_exact:
            inner = self._inner
            memory, asks = memory + inner.memory_bytes, replace(inner.asks, field=f"design.{inner.asks.field}")
        return Cost(designs, memory, files, seconds, asks)

    @cached_property
    def _inner(self) -> Cost:
        """Of the design as it is written; nothing is known where that cannot be planned, as others may be."""
        try:
            return planned(self.job.design, *self.robots).cost
        except FAULTS:
            return NOTHING

    @property
    def is_exact(self) -> bool:
        """Whether all objectives are exact, and no job need run for them."""
        return all(objective.value in EXACT for objective in self.job.objectives)

    @property
    def precision(self) -> str:
        """That of the jobs that are run; exact values are float64."""
        return "float64" if self.is_exact else getattr(self.job.design, "precision", "float64")

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

    def division(self, size: float, most: int) -> Settled:
        """A first round of the designs that the search begins with; one shard where they are exact or go to a file."""
        if self.is_exact or isinstance(self.job.evaluations, EvaluationsInFile):
            return self.settled
        try:
            self._searched(None, self._given())
        except PendingDesigns as asked:
            most_samples = self.job.most_evaluations
            return self._round(replace(self.settled, shards=(), most_samples=most_samples), asked.designs, most)
        return self.settled

    def further(self, partial: PartialResult, execution: Execution) -> Settled | None:
        """One more round, of the next generation."""
        if FIRST not in partial.arrays:
            return None
        try:
            self._searched(None, self._known(partial))
        except PendingDesigns as asked:
            return self._round(self.settled, asked.designs, len(asked.designs))
        return None

    def _round(self, settled: DesignSettled, designs: Any, most: int) -> DesignSettled:
        """What is settled, with shards of these designs, about as many as ``most``."""
        before, each = len(settled.designs), -(-len(designs) // most)
        shards = Piece(before, len(designs), 1).divided(each)
        return replace(settled, shards=(*settled.shards, *shards), designs=(*settled.designs, *designs))

    def _given(self) -> np.ndarray:
        """Rows (E, n + k) of the designs that the job knows."""
        return np.array(self.job.evaluations, np.float64).reshape(-1, len(self._columns))

    def _known(self, partial: PartialResult) -> np.ndarray:
        """Rows (E, n + k) of the designs of all rounds, and those that the job knows."""
        return np.concatenate([self._given(), np.hstack([partial["designs"], partial["values"]])])

    def _searched(
        self, evaluator: Evaluator | None, known: np.ndarray, batch: int = sys.maxsize, **told: Any
    ) -> tuple[Evaluations, str]:
        """The search with designs that are ``known``, rows (E, n + k), and how it ended.

        Without an evaluator it raises PendingDesigns where it needs others.
        """

        def pending(designs: np.ndarray) -> np.ndarray:
            raise PendingDesigns(designs)

        count = len(self.job.parameters)
        rows = [(tuple(row[:count]), tuple(row[count:])) for row in known.tolist()]
        evaluations = Evaluations(evaluator or pending, self.weights, known=rows, batch=batch, **told)
        return evaluations, self._search(evaluations, evaluator)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """All designs (E, n) in the order of the search, their values (E, k), and what the search says.

        Of a shard of a round its designs, their values, and why they have none.
        """
        if self.settled.designs:
            return self._evaluated(*self.shards[shard], execution, tell)
        given = self.job.evaluations
        own = EvaluationFile(given.path, self._columns) if isinstance(given, EvaluationsInFile) else None
        known = own.rows() if own else self._given()
        kept = EvaluationFile(execution.checkpoint, self._columns) if execution.checkpoint else None
        before = _with_values(kept.rows()) if kept else np.empty((0, len(self._columns)))
        evaluator = Evaluator(self, execution)
        evaluator.count = len(before)

        def keep(designs: np.ndarray, values: np.ndarray) -> None:
            for file in (own, kept):
                if file:
                    file.append(designs, values)

        batch = BATCH if self.is_exact else SLOW_BATCH
        evaluations, ended = self._searched(evaluator, np.concatenate([known, before]), batch, report=tell, keep=keep)
        faults = [fault.entry() for fault in evaluator.faults]
        return self._whole(evaluations, ended, evaluator.count, faults, execution)

    def _evaluated(self, first: int, count: int, execution: Execution, tell: Tell) -> PartialResult:
        """The designs of a shard, their values, and faults by the designs' numbers."""
        evaluator, rows, faults = Evaluator(self, execution, looks_first=first == 0), [], {}
        designs = np.array(self.settled.designs[first : first + count])
        for number, design in enumerate(designs):
            before = len(evaluator.faults)
            rows.append(evaluator(design[None])[0])
            faults |= {str(first + number): fault.entry() for fault in evaluator.faults[before:]}
            tell(number + 1)
        found = rows_of_shard(first, {"designs": designs, "values": np.array(rows)})
        return PartialResult(found.arrays, {"faults": faults})

    def merge(self, a: PartialResult, b: PartialResult) -> PartialResult:
        """The designs of both, in their order."""
        return PartialResult(joined_rows(a, b).arrays, {"faults": {**a.facts["faults"], **b.facts["faults"]}})

    def refine(self, partial: PartialResult, progress: Progress | None, execution: Execution) -> PartialResult:
        """What the search says of all rounds, as if they had been one shard."""
        if FIRST not in partial.arrays:
            return partial
        faults = [partial.facts["faults"][number] for number in sorted(partial.facts["faults"], key=int)]
        evaluations, ended = self._searched(None, self._known(partial))
        return self._whole(evaluations, ended, len(self.settled.designs), faults, execution)

    def _whole(
        self, evaluations: Evaluations, ended: str, evaluated: int, faults: list[dict[str, Any]], execution: Execution
    ) -> PartialResult:
        """The partial result of the whole search; raises the first of the faults where no design has a value."""
        designs, values = evaluations.rows()
        if faults and not np.isfinite(values).any():
            again = Evaluator(self, execution)
            again(np.array([faults[0]["design"]]))
            raise again.fault or NumericalError(faults[0]["reason"])
        names = [parameter.name for parameter in self.job.parameters]
        about = {"ended": ended, "evaluated": evaluated, "faults": fault_entries(faults, names)}
        return PartialResult({"designs": designs, "values": values}, about)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """The best design, all designs, how the search went, and the best design's mesh where it is exact."""
        designs, values, about = partial["designs"], partial["values"], partial.facts
        score = scores(values, self.weights)
        best = best_entries(self, designs, values, score)
        document = {
            "parameters": [p.model_dump(mode="json") for p in self.job.parameters],
            "objectives": objective_entries(self),
            "search": {
                "method": self.job.search.method,
                "ended": about["ended"],
                "designs": len(designs),
                "evaluated": about["evaluated"],
                "without_value": int((~np.isfinite(score)).sum()),
                "first_fault": about["faults"][0]["reason"] if about["faults"] else None,
                "faults": about["faults"],
            },
            **best,
        }
        meshes, tables = exact_best(self, best["best"])
        return Draft(
            document,
            best_headline(self, best["best"]),
            design_notices(self, designs, values, about["faults"]),
            {"precision": self.precision},
            tables={**tables_of(self, designs, values, score), **tables},
            meshes=meshes,
        )

    def placed_region(self, design: np.ndarray) -> tuple[BallRegion, np.ndarray]:
        """The ball region of a design (n,) of a mechanism, and the base's place in the world (4, 4)."""
        job = self.job_of(design)
        mechanism = mechanism_of(job.mechanism)
        region = region_of(mechanism, (job.orientation or Transform()).matrix()[:3, :3])
        return region, mechanism.T_world_base

    def job_of(self, design: np.ndarray) -> Any:
        """The inner job at a design (n,); raises DocumentError where it is none."""
        return parse_job(self.document_of(design))

    def document_of(self, design: np.ndarray) -> Any:
        """The document of the inner job at a design (n,), in the words that its pointers need."""
        values = zip(self.job.parameters, map(float, design), strict=True)
        return changed(self.job.design_document, {pointer: value for p, value in values for pointer in p.pointers})

    @property
    def _columns(self) -> list[str]:
        return [*(parameter.name for parameter in self.job.parameters), *(o.name for o in self.job.objectives)]

    def about_robots(self) -> dict[str, Any]:
        """The robots or the mechanism whose parameters vary, as they are in the document."""
        if self.robots:
            return super().about_robots()
        mechanism = getattr(self.job.design, "mechanism", None)
        return {"mechanism": {"name": mechanism_of(mechanism).name}} if mechanism else {}

    def _search(self, evaluations: Evaluations, evaluator: Evaluator | None) -> str:
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
        if evaluator and search.refine and {objective.value for objective in self.job.objectives} == {EXACT_VOLUME}:
            designs, values = evaluations.rows()
            if feasible(values, self.weights).any():
                start = designs[scores(values, self.weights).argmax()]
                ended += f"; {_refined(space, evaluations, start, evaluator)}"
        return ended


def _refined(space: Space, evaluations: Evaluations, start: np.ndarray, evaluator: Evaluator) -> str:
    """How the search along gradients ended; a design on its way that is none ends it."""
    try:
        return refine(space, evaluations, start, evaluator.gradient)
    except FAULTS as error:
        return f"SLSQP: stopped by an error ({error})"


def _with_values(rows: np.ndarray) -> np.ndarray:
    """A checkpoint's rows but those of designs without value, which are tried again, so that their fault is known."""
    return np.unique(rows[np.isfinite(rows).all(axis=1)], axis=0)
