"""Units of the indices of an evaluation, from its chain's joints."""

import numpy as np

from wsrender.engine.evaluation import Evaluation
from wsrender.indices.dimensions import task_matrix
from wsrender.indices.index_catalogue import is_dynamic, unit
from wsrender.robots.chain import Chain
from wsrender.robots.host_chain import HostChain
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


def nonzero_entries(chain: Chain) -> np.ndarray:
    """Entries of J in base axes that have a value in some posture, (6, n) bool: a slide turns nothing."""
    ranges = np.where(
        np.isfinite([chain.lower_limits, chain.upper_limits]), [chain.lower_limits, chain.upper_limits], 0
    )
    shares = np.random.default_rng(0).random((POSTURES, chain.n))
    q = np.where(ranges[0] < ranges[1], ranges[0] + shares * (ranges[1] - ranges[0]), shares)
    if isinstance(chain, HostChain):
        entries = np.abs(chain.base_jacobian(q)).max(axis=0)
    else:
        entries = np.abs([_base_jacobian(chain, each) for each in q]).max(axis=0)
    linear, angular = entries[:3], entries[3:]
    return np.concatenate([linear > FLAT * max(linear.max(), chain.reach), angular > FLAT * angular.max()])


def _base_jacobian(chain: Chain, q: np.ndarray) -> np.ndarray:
    """J (6, n) at a configuration (n,), in base axes."""
    T, axes = np.eye(4), []
    moved = chain.joint_scale * q[chain.joint_source] + chain.joint_offset
    for T_joint, turns, by in zip(chain.T_joint, chain.joint_is_revolute, moved, strict=True):
        T = T @ T_joint
        axes.append((T[:3, 3], T[:3, 2]))
        T = T @ _motion(turns, by)
    tip = (T @ chain.T_tip @ chain.T_tip_tool)[:3, 3]
    J = np.zeros((6, chain.n))
    for i, (origin, axis) in enumerate(axes):
        turns = chain.joint_is_revolute[i]
        column = [*np.cross(axis, tip - origin), *axis] if turns else [*axis, 0, 0, 0]
        J[:, chain.joint_source[i]] += chain.joint_scale[i] * np.array(column)
    return J


def _motion(turns: bool, by: float) -> np.ndarray:
    """A turn about z by an angle, or a slide along it (4, 4)."""
    T = np.eye(4)
    if turns:
        T[:2, :2] = [[np.cos(by), -np.sin(by)], [np.sin(by), np.cos(by)]]
    else:
        T[2, 3] = by
    return T
