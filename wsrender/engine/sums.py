"""Fixed-point scales of sums: powers of two that follow from bounds of the indices and the sample count alone."""

import numpy as np
from wsrender_kernels.voxels import QUANTUM_BITS

from wsrender.engine.evaluation import REAL, Evaluation
from wsrender.indices.catalogue import find, is_dynamic
from wsrender.robots.chain import Chain

MARGIN = 1.01  # for rounding at the bound


def scales_for(bounds: np.ndarray, samples: int, precision: str) -> np.ndarray:
    """Powers of two (K,): a value up to its bound fits the kernel's integers, the sum of all samples 63 bits."""
    bits = min(QUANTUM_BITS[REAL[precision]], 62 - int(max(samples, 1) - 1).bit_length())
    return 2.0 ** np.floor(bits - np.log2(bounds))


def bound_from_reach(evaluation: Evaluation, name: str) -> float:
    """Upper bound of a kinematic index of the standard convention from the chain's reach; NaN for any other.

    Each of the six is largest, for a given Frobenius norm of the Jacobian, where all m singular values are equal.
    """
    index = find(name)
    if index.user_defined or is_dynamic(name) or evaluation.convention != "standard" or evaluation.host_chain:
        return float("nan")
    m, n = len(evaluation.rows), evaluation.chain.n
    sigma = _largest_norm(evaluation) / np.sqrt(m)
    if sigma == 0:
        return 1.0
    return MARGIN * float(index.function([np.float64(sigma)] * m, m, n))


def _largest_norm(evaluation: Evaluation) -> float:
    """Upper bound of the task matrix's Frobenius norm."""
    chain = evaluation.chain
    length = evaluation.characteristic_length_m if evaluation.mixed_rows else 1.0
    columns_linear, columns_angular = np.zeros(chain.n), np.zeros(chain.n)
    lever = _levers(chain)
    for i, k in enumerate(chain.joint_source):
        scale = abs(chain.joint_scale[i])
        columns_linear[k] += scale * (lever[i] if chain.joint_is_revolute[i] else 1.0)
        columns_angular[k] += scale * bool(chain.joint_is_revolute[i])
    squares = 0.0
    if min(evaluation.rows) < 3:
        squares += float((columns_linear**2).sum()) / length**2
    if max(evaluation.rows) >= 3:
        squares += float((columns_angular**2).sum())
    return float(np.sqrt(squares))


def _levers(chain: Chain) -> np.ndarray:
    """Upper bound of the distance from each joint's origin to the end effector, (L,) [m]."""
    links = [*np.linalg.norm(chain.T_joint[1:, :3, 3], axis=1), np.linalg.norm((chain.T_tip @ chain.T_tip_tool)[:3, 3])]
    return np.cumsum((np.array(links) + chain.largest_slide)[::-1])[::-1]
