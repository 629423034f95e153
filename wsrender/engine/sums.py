"""Fixed-point scales of sums: powers of two that follow from bounds of the indices and the sample count alone."""

import numpy as np
from wsrender_kernels.voxels import QUANTUM_BITS

from wsrender.engine.evaluation import REAL
from wsrender.errors import InputError
from wsrender.indices.index_catalogue import find, is_dynamic
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.robots.chain import Chain

MARGIN = 1.01  # for rounding at the bound


def scales_of(pipeline: Pipeline) -> np.ndarray:
    """Powers of two (K,): a value up to its bound fits the kernel's integers, the sum of all samples 63 bits.

    0 without bounds. By exponents alone: logarithms differ from processor to processor.
    """
    if pipeline.bounds is None:
        return np.zeros(len(pipeline.evaluation.indices))
    samples = max(pipeline.sampling.count, 1)
    bits = min(QUANTUM_BITS[REAL[pipeline.precision]], 62 - (samples - 1).bit_length())
    mantissa, exponent = np.frexp(pipeline.bounds)
    return np.ldexp(1.0, bits - exponent + (mantissa == 0.5))


def has_own_bound(evaluation: Evaluation, name: str) -> bool:
    """Whether an index's own bound holds: a number does everywhere, a function of the norm where that is known."""
    bound = find(name).bound
    if find(name).given or not callable(bound):
        return bound is not None
    if find(name).of_chain:
        return True
    return evaluation.convention == "standard" and not is_dynamic(name) and not evaluation.given_kinematics


def own_bound(evaluation: Evaluation, name: str) -> float:
    """Upper bound of an index by its own entry, from the chain's reach if it is a function; NaN where it has none.

    Raises InputError where the function gives no bound.
    """
    index = find(name)
    if not has_own_bound(evaluation, name):
        return float("nan")
    if not callable(index.bound):
        return MARGIN * float(index.bound or np.nan)
    norm, options = np.float64(_largest_norm(evaluation)), evaluation.options.get(name, {})
    bound = float(index.bound(norm, len(evaluation.rows), evaluation.chain.n, **options))
    if not 0 <= bound < np.inf:
        raise InputError("indices", f"the bound of {name} is {bound:g}; its entry must give a finite one, 0 or more")
    return MARGIN * bound or 1.0


def _largest_norm(evaluation: Evaluation) -> float:
    """Upper bound of the task matrix's Frobenius norm."""
    chain = evaluation.chain.geometry
    assert chain is not None  # see `has_own_bound`
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
