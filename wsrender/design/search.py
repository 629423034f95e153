"""Searches of designs by well-kept libraries: differential evolution and SLSQP of SciPy, NSGA-II of pymoo."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from scipy import optimize
from scipy.stats import qmc

from wsrender.design.evaluations import Evaluations
from wsrender.errors import MissingExtraError

TOUCH = 1e-9  # of a constraint's sum, relative: rounding of a design on it
WORST = 1e300  # cost of a design without value or that a constraint forbids, which is not evaluated
LAST_CHANGE = 1e-12  # of SLSQP's change of the score, relative to the score, at which it ends


@dataclass(frozen=True, eq=False)
class Space:
    """Bounds (n,) of designs and linear constraints: ``least`` ≤ ``matrix`` (c, n) · design ≤ ``most`` (c,)."""

    lower: np.ndarray
    upper: np.ndarray
    matrix: np.ndarray
    least: np.ndarray
    most: np.ndarray

    def allows(self, designs: np.ndarray) -> np.ndarray:
        """Whether designs (N, n) satisfy the constraints, to rounding, (N,)."""
        sums = designs @ self.matrix.T
        slack = TOUCH * (1 + np.abs(sums))
        return np.all((sums >= self.least - slack) & (sums <= self.most + slack), axis=1)

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """Bounds of each parameter."""
        return list(zip(self.lower.tolist(), self.upper.tolist(), strict=True))

    def scipy_constraints(self) -> list[optimize.LinearConstraint]:
        """The constraints as SciPy takes them."""
        sides: Any = (self.least, self.most)  # annotated as numbers in SciPy
        return [optimize.LinearConstraint(self.matrix, *sides)] if len(self.matrix) else []


def grid(space: Space, counts: tuple[int, ...]) -> np.ndarray:
    """Designs (N, n) of equal steps, both bounds among them, that the constraints allow."""
    bounds = zip(space.lower, space.upper, counts, strict=True)
    levels = [
        np.linspace(low, high, count) if count > 1 else np.array([(low + high) / 2]) for low, high, count in bounds
    ]
    designs = np.array(list(product(*levels)))
    return designs[space.allows(designs)]


class NothingFeasibleError(Exception):
    """No design of a search's first population is feasible: it has no direction to go."""


def feasible_population(
    space: Space, evaluations: Evaluations, *, count: int, rounds: int, seed: int
) -> tuple[np.ndarray | None, int]:
    """The first of so many ``rounds`` of designs (count, n) with a feasible one, and its number; None where none has.

    The designs fill the space evenly (Halton 1960).
    """
    sequence = qmc.Halton(len(space.lower), rng=np.random.default_rng(seed))
    for number in range(1, rounds + 1):
        designs = qmc.scale(sequence.random(count), space.lower, space.upper)
        allowed = designs[space.allows(designs)]
        if len(allowed) and evaluations.feasible(allowed).any():
            return designs, number
    return None, rounds


def evolve(
    space: Space, evaluations: Evaluations, *, population: int, generations: int, tolerance: float, seed: int
) -> str:
    """Differential evolution (Storn and Price 1997) of the score, from a feasible design on; says why it ended."""
    count, evaluated = max(5, population * len(space.lower)), False

    def energies(designs: np.ndarray) -> np.ndarray:
        nonlocal evaluated
        if not evaluated and not evaluations.feasible(designs.T).any():
            raise NothingFeasibleError
        evaluated = True
        return -evaluations.scores(designs.T)

    def run(first: Any, most: int) -> str:
        found = optimize.differential_evolution(
            energies,
            space.bounds,
            popsize=population,
            init=first,
            maxiter=most,
            tol=tolerance,
            rng=np.random.default_rng(seed),
            constraints=space.scipy_constraints(),
            polish=False,
            vectorized=True,
            updating="deferred",
        )
        return f"differential evolution: {found.message}".rstrip(".")

    try:
        return run("latinhypercube", generations)
    except NothingFeasibleError:
        first, rounds = feasible_population(space, evaluations, count=count, rounds=generations, seed=seed)
    if first is None:
        return f"no feasible design among {len(evaluations)}"
    evaluated = True
    return f"{_looked(rounds)}; {run(first, generations - rounds)}"


def _looked(rounds: int) -> str:
    return f"a feasible design after {rounds} more population{'s' if rounds > 1 else ''}"


def refine(
    space: Space, evaluations: Evaluations, start: np.ndarray, gradient: Callable[[np.ndarray], np.ndarray]
) -> str:
    """Sequential quadratic programming (SLSQP, Kraft 1988) from a design along the gradient (n,) of the score."""
    scale = max(abs(float(evaluations.scores(start[None])[0])), 1e-300)
    found = optimize.minimize(
        lambda design: -float(evaluations.scores(design[None])[0]) / scale,
        start,
        jac=lambda design: -gradient(design) / scale,
        bounds=space.bounds,
        constraints=space.scipy_constraints(),
        method="SLSQP",
        options={"ftol": LAST_CHANGE, "maxiter": 100},
    )
    return f"SLSQP: {found.message}".rstrip(".")


def pareto(space: Space, evaluations: Evaluations, *, population: int, generations: int, seed: int) -> str:
    """NSGA-II (Deb et al. 2002) of the weighted values, from a feasible design on; MissingExtraError without pymoo."""
    try:
        from pymoo.algorithms.moo.nsga2 import NSGA2
        from pymoo.core.problem import Problem
        from pymoo.optimize import minimize
    except ModuleNotFoundError as error:
        raise MissingExtraError(error.name or "pymoo", "design") from None

    limits, evaluated = (np.isfinite(space.least), np.isfinite(space.most)), False

    class Designs(Problem):
        def _evaluate(self, x: np.ndarray, out: dict[str, Any], *args: Any, **kwargs: Any) -> None:
            nonlocal evaluated
            allowed = space.allows(x)
            if not evaluated and allowed.any() and not evaluations.feasible(x[allowed]).any():
                raise NothingFeasibleError
            evaluated = evaluated or bool(allowed.any())
            costs = np.full((len(x), len(evaluations.weights)), np.nan)
            costs[allowed] = evaluations.values(x[allowed]) * -evaluations.weights
            out["F"] = np.where(np.isfinite(costs), costs, WORST)
            sums = x @ space.matrix.T
            out["G"] = np.hstack([(space.least - sums)[:, limits[0]], (sums - space.most)[:, limits[1]]])

    problem = Designs(
        n_var=len(space.lower),
        n_obj=len(evaluations.weights),
        n_ieq_constr=int(limits[0].sum() + limits[1].sum()),
        xl=space.lower,
        xu=space.upper,
    )
    try:
        minimize(problem, NSGA2(pop_size=population), ("n_gen", generations), seed=seed, verbose=False)
        return f"{generations} generations"
    except NothingFeasibleError:
        rounds = generations - 1
        first, rounds = feasible_population(space, evaluations, count=population, rounds=rounds, seed=seed)
    if first is None:
        return f"no feasible design among {len(evaluations)}"
    evaluated, left = True, generations - rounds
    start: Any = first  # annotated as a sampling in pymoo
    minimize(problem, NSGA2(pop_size=population, sampling=start), ("n_gen", left), seed=seed, verbose=False)
    return f"{_looked(rounds)}; {left} generations"


def front(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Numbers of the rows of values (N, k) that no other row beats in one value and equals or beats in all."""
    gains = values * weights
    whole = np.flatnonzero(np.isfinite(gains).all(axis=1))
    found = []
    for k in whole:
        better = (gains[whole] >= gains[k]).all(axis=1) & (gains[whole] > gains[k]).any(axis=1)
        if not better.any():
            found.append(k)
    return np.array(found, int)
