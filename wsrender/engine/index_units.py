"""Units of the indices of an evaluation, from its chain's joints."""

import numpy as np

from wsrender.indices.index_catalogue import is_dynamic, unit
from wsrender.indices.units import task_matrix
from wsrender.pipeline.evaluation import Evaluation
from wsrender.robots.kinematics import Kinematics
from wsrender.tolerances import FLAT

POSTURES = 4  # at which an entry of J that is not 0 throughout shows


def units_of(evaluation: Evaluation) -> dict[str, str]:
    """Unit of every index, by name: ``m^3``, ``1``, or ``mixed (m, 1)`` where joints that turn and that slide mix."""
    chain, convention = evaluation.chain, evaluation.convention
    nonzero = nonzero_entries(chain)
    matrices = {
        dynamic: task_matrix(
            evaluation.rows,
            chain.revolute.tolist(),
            dynamic=dynamic,
            convention=convention,
            torque_scaling=evaluation.torque_scaling,
            nonzero=nonzero,
        )
        for dynamic in (False, True)
    }
    return {name: unit(name, matrices[is_dynamic(name)], convention) for name in evaluation.indices}


def nonzero_entries(chain: Kinematics) -> np.ndarray:
    """Entries of J in base axes that have a value in some posture, (6, n) bool: a slide turns nothing."""
    ranges = np.where(
        np.isfinite([chain.lower_limits, chain.upper_limits]), [chain.lower_limits, chain.upper_limits], 0
    )
    shares = np.random.default_rng(0).random((POSTURES, chain.n))
    q = np.where(ranges[0] < ranges[1], ranges[0] + shares * (ranges[1] - ranges[0]), shares)
    entries = np.abs(chain.placed(np.eye(4)).jacobians(q)).max(axis=0)
    linear, angular = entries[:3], entries[3:]
    return np.concatenate([linear > FLAT * max(linear.max(), chain.reach), angular > FLAT * angular.max()])
