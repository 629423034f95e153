"""Values of the designs of a ``design_optimization``: exact ones, or from runs of the job that is optimised."""

from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.design.exact_inscribed import largest_ball, largest_cube
from wsrender.design.exact_volume import volume_gradient, volumes_of
from wsrender.design.inscribed import inscribed_cube_edge, inscribed_sphere_radius
from wsrender.errors import InputError
from wsrender.parallel.ball_region import BallRegion
from wsrender.result import Result
from wsrender.spec.design import CUBE, EXACT, EXACT_CUBE, EXACT_SPHERE, EXACT_VOLUME, SPHERE, Objective
from wsrender.spec.json_pointer import found_at

if TYPE_CHECKING:
    from wsrender.run.design import DesignPlan


class Evaluator:
    """Values of designs: exact ones many at a time, others by running the inner job of each.

    ``fault`` is the first error of a design that is none, ``count`` the number of designs evaluated.
    """

    def __init__(self, plan: "DesignPlan", execution: dict[str, Any]):
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
        """Derivatives (n,) of the score of an exact volume."""
        space = self.plan.space
        inside = np.clip(design, space.lower, space.upper)

        def regions_at(designs: np.ndarray) -> list[BallRegion]:
            return [self.plan.placed_region(each)[0] for each in designs]

        return self.plan.weights.sum() * volume_gradient(regions_at, inside, space.lower, space.upper)

    def _exact(self, designs: np.ndarray) -> np.ndarray:
        placed, rows = [], []
        for row, design in enumerate(designs):
            try:
                placed.append(self.plan.placed_region(design))
                rows.append(row)
            except InputError as error:
                self.fault = self.fault or error.within("design")
        values = np.full((len(designs), len(self.plan.job.objectives)), np.nan)
        if rows:
            values[rows] = np.column_stack([exact_values(o.value, placed) for o in self.plan.job.objectives])
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


def exact_values(value: str, placed: list[tuple[BallRegion, np.ndarray]]) -> np.ndarray:
    """An exact value (N,) of regions with their ``T_world_base``: volume [m³], radius or edge [m]; 0 of empty ones."""
    if value == EXACT_VOLUME:
        return volumes_of([region for region, _ in placed])
    largest, factor = {EXACT_SPHERE: (largest_ball, 1.0), EXACT_CUBE: (largest_cube, 2.0)}[value]
    found = (largest(region, T_world_base) for region, T_world_base in placed)
    return np.array([0.0 if each is None else factor * each.size for each in found])
