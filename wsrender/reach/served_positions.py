"""Sampled positions of a chain under constraints: which an admitted configuration serves, and what blocks the others.

For the positions of rejected samples inverse kinematics looks for another posture.
"""

from dataclasses import dataclass, replace

import numpy as np

from wsrender.engine import evaluate_samples
from wsrender.pipeline.pipeline import Pipeline
from wsrender.reach.admissible_search import BLOCKED, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.evidence import REACHABLE
from wsrender.reach.inverse_solver import InverseSolver


@dataclass(frozen=True, eq=False)
class ServedPositions:
    """Positions (N, 3) [m] in the world that are decided, and ``reasons`` (N,) int8: 0 served, k blocked by the k-th.

    ``rejected`` (C,): samples by the constraint that rejects them; ``undecided``: positions that are left out.
    """

    position: np.ndarray
    reasons: np.ndarray
    rejected: np.ndarray
    undecided: int


def served_positions(pipeline: Pipeline, device: str = "cpu", threads: int | None = None) -> ServedPositions:
    """The positions of a pipeline's samples under its constraints."""
    found = evaluate_samples(replace(pipeline, kept_rows=frozenset()), device, threads=threads)
    assert found.rejected is not None
    position, reasons = found.position.astype(np.float64), found.rejected.copy()
    chain, constraints = pipeline.evaluation.chain, pipeline.constraints
    counts = np.bincount(reasons, minlength=len(constraints) + 1)[1:]
    at, decided = np.flatnonzero(reasons), np.ones(len(reasons), bool)
    if len(at):
        solver = InverseSolver(chain, seed=pipeline.sampling.seed, device=device, threads=threads)
        search = AdmissibleSearch(solver, Admission(chain, constraints, device, threads)).decide(position[at])
        reasons[at] = search.reason
        decided[at] = (search.label == REACHABLE) | (search.label == BLOCKED)
    return ServedPositions(position[decided], reasons[decided], counts, int((~decided).sum()))
