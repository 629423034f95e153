"""Values of the designs of a ``design_optimization``: exact ones, or from runs of the job that is optimised."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.analyses.design_optimization.job import (
    CUBE,
    EXACT,
    EXACT_CUBE,
    EXACT_SPHERE,
    EXACT_VOLUME,
    SPHERE,
    Objective,
)
from wsrender.analyses.execution import Execution
from wsrender.analyses.jobs import parse_job
from wsrender.design.exact_volume import volume_gradient, volumes_of
from wsrender.design.inscribed import inscribed_cube_edge, inscribed_sphere_radius, largest_ball, largest_cube
from wsrender.documents.json_pointer import found_at
from wsrender.errors import InputError, NotConvergedError, NumericalError, ResourceError, WsrenderError
from wsrender.mechanisms.ball_region import BallRegion
from wsrender.results.result import Result

if TYPE_CHECKING:
    from wsrender.analyses.design_optimization.run import DesignOptimizationAnalysis


FAULTS = (InputError, NotConvergedError, NumericalError, MemoryError)  # of a design: it has no value then
REFINED = {"refined", "headline", "free", "blocked", "undecided"}  # in pointers to what is read of refined volumes
FEW_SAMPLES, FEW_LEVELS = 256, 3  # of a run that shows what a result holds


@dataclass
class DesignFault:
    """Why a design has no value."""

    error: WsrenderError
    design: list[float]

    def entry(self) -> dict[str, Any]:
        """As plain JSON values."""
        error = self.error
        return {"kind": [error.code, getattr(error, "field", "")], "reason": str(error), "design": self.design}


class Evaluator:
    """Values of designs: exact ones many at a time, others by running the inner job of each.

    ``looks_first``: whether a small run shows that the objectives are there before the first design runs; else another
    process sees to it.
    A design whose job ends in an error has no value. ``faults`` are these errors, the first one first; ``count`` is the
    number of designs evaluated.
    """

    def __init__(self, plan: "DesignOptimizationAnalysis", execution: Execution, *, looks_first: bool = True):
        self.plan, self.execution = plan, execution
        self.faults: list[DesignFault] = []
        self.count = 0
        self._pointers_hold = plan.is_exact or not looks_first

    def __call__(self, designs: np.ndarray) -> np.ndarray:
        """Values (N, k) of designs (N, n), NaN where a design has none.

        Raises InputError for an objective that is no number of the result, before the first design runs where it can.
        """
        if not self._pointers_hold:
            self._check_pointers()
        self.count += len(designs)
        if self.plan.is_exact:
            return self._exact(designs)
        return np.array([self._by_running(design) for design in designs])

    @property
    def fault(self) -> WsrenderError | None:
        """The first error of a design."""
        return self.faults[0].error if self.faults else None

    def gradient(self, design: np.ndarray) -> np.ndarray:
        """Derivatives (n,) of the score of an exact volume."""
        space = self.plan.space
        inside = np.clip(design, space.lower, space.upper)

        def regions_at(designs: np.ndarray) -> list[BallRegion]:
            return [self.plan.placed_region(each)[0] for each in designs]

        return self.plan.weights.sum() * volume_gradient(regions_at, inside, space.lower, space.upper)

    def _check_pointers(self) -> None:
        """Look the objectives up in the result of a small run in the middle of the bounds, where there is one."""
        space = self.plan.space
        middle = (space.lower + space.upper) / 2
        try:
            document = self._inner_job(middle).model_dump(mode="json")
            if (small := with_few_samples(document)) == document:
                return  # a design takes no longer
            result = self._run(parse_job(small))
        except FAULTS:
            return  # the first design that has a result will tell
        for objective in self.plan.job.objectives:
            if objective.value not in EXACT:
                self._value(objective, result, middle)
        self._pointers_hold = "empty" not in result.document

    def _run(self, job: Any) -> Result:
        return self.execution.run_inside(job)

    def _exact(self, designs: np.ndarray) -> np.ndarray:
        placed, rows = [], []
        for row, design in enumerate(designs):
            try:
                placed.append(self.plan.placed_region(design))
                rows.append(row)
            except FAULTS as error:
                self._keep(error, design)
        values = np.full((len(designs), len(self.plan.job.objectives)), np.nan)
        try:
            if rows:
                values[rows] = self._exact_rows(placed)
        except FAULTS:
            for row, one in zip(rows, placed, strict=True):
                try:
                    values[row] = self._exact_rows([one])[0]
                except FAULTS as error:
                    self._keep(error, designs[row])
        return values

    def _exact_rows(self, placed: list[tuple[BallRegion, np.ndarray]]) -> np.ndarray:
        values = np.column_stack([exact_values(o.value, placed) for o in self.plan.job.objectives])
        if np.isnan(values).any():
            raise NumericalError("a design's workspace is too thin for an exact volume")
        return values

    def _by_running(self, design: np.ndarray) -> list[float]:
        result = None
        try:
            result = self._run(self._inner_job(design))
            values = [self._value(objective, result, design) for objective in self.plan.job.objectives]
        except FAULTS as error:
            if result is not None and not self._pointers_hold:
                raise
            self._keep(error, design)
            return [np.nan] * len(self.plan.job.objectives)
        self._pointers_hold = self._pointers_hold or "empty" not in result.document
        return values

    def _keep(self, error: Exception, design: np.ndarray) -> None:
        """Keep a design's error."""
        if isinstance(error, MemoryError):
            error = ResourceError("design", f"needs more memory than there is ({str(error) or 'MemoryError'})")
        elif isinstance(error, InputError) and error.field != "objectives":
            error = error.within("design")
        assert isinstance(error, WsrenderError)
        self.faults.append(DesignFault(error, design.tolist()))

    def _inner_job(self, design: np.ndarray) -> Any:
        """The job of a design; volumes are refined only where an objective reads them."""
        job = self.plan.job_of(design)
        read = any(REFINED.intersection(objective.value.split("/")) for objective in self.plan.job.objectives)
        if read or getattr(job, "refined_volume", None) is None:
            return job
        return job.model_copy(update={"refined_volume": None})

    def _value(self, objective: Objective, result: Result, design: np.ndarray) -> float:
        """The value of an objective; NaN where the result has null there, or nothing because it is empty."""
        if objective.value in EXACT:
            return float(exact_values(objective.value, [self.plan.placed_region(design)])[0])
        if objective.value in (SPHERE, CUBE):
            if result.volume is None and "empty" not in result.document:
                raise InputError("objectives", f'"{objective.value}" needs voxels, and the design gives none')
            return (inscribed_sphere_radius if objective.value == SPHERE else inscribed_cube_edge)(result.volume)
        try:
            found = found_at(result.document, objective.value)
        except ValueError as error:
            if "empty" in result.document:
                return np.nan
            raise InputError("objectives", f"{objective.value} {error}") from None
        if isinstance(found, bool) or not isinstance(found, int | float | None):
            raise InputError("objectives", f"{objective.value} is no number in the result document")
        return np.nan if found is None else float(found)


def with_few_samples(document: Any) -> Any:
    """A job document whose joint spaces are sampled as little as shows what its result holds."""
    if isinstance(document, dict):
        document = {name: with_few_samples(item) for name, item in document.items()}
        sampling = document.get("sampling")
        if isinstance(sampling, dict) and isinstance(sampling.get("count"), int):
            document["sampling"] = {**sampling, "count": min(sampling["count"], FEW_SAMPLES)}
        elif isinstance(sampling, dict) and "per_joint" in sampling:
            levels = np.minimum(sampling["per_joint"], FEW_LEVELS).tolist()
            document["sampling"] = {**sampling, "per_joint": levels}
        return document
    return [with_few_samples(item) for item in document] if isinstance(document, list) else document


def exact_values(value: str, placed: list[tuple[BallRegion, np.ndarray]]) -> np.ndarray:
    """An exact value (N,) of regions with their ``T_world_base``: volume [m³], radius or edge [m]; 0 of empty ones.

    The volume is NaN where a region is too thin for float64.
    """
    if value == EXACT_VOLUME:
        return volumes_of([region for region, _ in placed])
    largest, factor = {EXACT_SPHERE: (largest_ball, 1.0), EXACT_CUBE: (largest_cube, 2.0)}[value]
    found = (largest(region, T_world_base) for region, T_world_base in placed)
    return np.array([0.0 if each is None else factor * each.size for each in found])
