"""Indices at given configurations."""

from dataclasses import dataclass

import numpy as np

from wsrender.engine.devices import devices_of
from wsrender.engine.evaluation import Evaluation
from wsrender.engine.sweep_plan import SweepPlan, from_origin, sweep
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.sampling import given_sampling


@dataclass(frozen=True, eq=False)
class Evaluated:
    """Tip positions (N, 3) [m], index values (K, N), tip orientations (N, 4).

    ``rejected`` (N,) int8: the number, from 1, of the first constraint that rejects a configuration, or 0; of no
    constraints None.
    """

    position: np.ndarray
    values: np.ndarray
    quat_wxyz: np.ndarray | None
    rejected: np.ndarray | None = None


def evaluate_at(
    evaluation: Evaluation,
    q: np.ndarray,
    precision: str = "float64",
    device: str = "cpu",
    *,
    with_orientation: bool = False,
    threads: int | None = None,
    constraints: tuple[Constraint, ...] = (),
) -> Evaluated:
    """The evaluation at configurations ``q`` (N, n) [rad or m], in order."""
    K = len(evaluation.indices)
    plan = SweepPlan(
        evaluation,
        given_sampling(evaluation.chain, q),
        block=None,
        statistics=frozenset(),
        scales=np.zeros(K),
        bounds=np.full(K, np.inf),
        precision=precision,
        keep_rows=True,
        keep_orientation=with_orientation,
        constraints=constraints,
    )
    partial = sweep(plan, 0, len(q), devices_of(device), threads=threads)
    rows = np.concatenate([partial.rows[first] for first in sorted(partial.rows)] or [_none(plan)], axis=1)
    quat = np.ascontiguousarray(rows[3 + K : 7 + K].T) if with_orientation else None
    rejected = rows[-1].astype(np.int8) if constraints else None
    return Evaluated(from_origin(plan, rows), rows[3 : 3 + K], quat, rejected)


def _none(plan: SweepPlan) -> np.ndarray:
    return np.zeros((plan.shape.n_rows, 0), plan.precision)
