"""Device functions of constraints and their numbers."""

from collections.abc import Sequence
from importlib import import_module
from typing import Any

import numpy as np
import warp as wp
from wsrender_kernels.chain_indices.expression import expression as value_of_chain
from wsrender_kernels.constraints import OfChain as Marked
from wsrender_kernels.constraints.expression import expression, expression_of_chain
from wsrender_kernels.kinematics import device_joint_frames

from wsrender.engine.evaluation import REAL, drive, packed_bodies
from wsrender.engine.index_code import function_of_source, source_of
from wsrender.indices.chain_expression import Expressed
from wsrender.pipeline.constraints.collision import labelling
from wsrender.pipeline.constraints.constraint import Constraint, OfChain
from wsrender.pipeline.constraints.expression import ExpressionIndex
from wsrender.pipeline.constraints.host_function import on_host
from wsrender.robots.kinematics import Kinematics


def packed_constraints(
    constraints: Sequence[Constraint], chain: Kinematics, origin: np.ndarray, precision: str
) -> np.ndarray:
    """The numbers of all constraints, one after the other, (D,) float64."""
    return np.concatenate([np.zeros(0), *(_numbers(each, chain, origin, precision) for each in constraints)])


def device_constraints(
    constraints: Sequence[Constraint], chain: Kinematics, origin: np.ndarray, precision: str, after: int = 0
) -> dict[str, Any]:
    """Fields ``constraints`` and ``limits`` of a sweep's shape; so many numbers of others stand ``after`` theirs."""
    sizes = [len(_numbers(each, chain, origin, precision)) for each in constraints]
    total, functions, real = sum(sizes) + after, [], REAL[precision]
    labels = {each.name: number for number, each in enumerate((*labelling(constraints), *on_host(constraints)), 1)}
    for each, offset in zip(constraints, np.cumsum([0, *sizes]).tolist(), strict=False):
        if each.name in labels:
            functions.append(labels[each.name])
        elif isinstance(each.device, Expressed):
            # Positions in the world have more digits than single precision where the base is far away.
            functions.append(_traced(each, chain, real, wp.float64 if origin.any() else real, total, offset))
        elif isinstance(each.device, OfChain):
            asked = each.device
            arguments = (real, chain.n, *drive(asked.chain), *asked.choices, total, offset)
            functions.append(Marked(_factory(asked.module)(*arguments)))
        else:
            functions.append(_factory(each.device)(real, chain.n, total, offset))
    return {"constraints": tuple(functions), "limits": total}


def _traced(constraint: Any, chain: Kinematics, real: Any, own: Any, total: int, offset: int) -> Any:
    """The device function of an expression, evaluated in the precision ``own``."""
    asked, n = constraint.device, chain.n
    margin, options = _compiled(constraint, n, own), len(asked.options)
    if not asked.asks:
        return expression(margin, real, own, n, options, total, offset)
    arguments = (margin, real, own, n, *drive(constraint.chain), asked.asks, options, total, offset)
    return Marked(expression_of_chain(*arguments))


def _compiled(constraint: Any, n: int, own: Any) -> Any:
    asked, whole = constraint.device, constraint.chain
    joints = len(whole.joint_source) if whole else n
    return function_of_source(source_of([asked.traced(n, joints)]), 1, asked.inputs(n, joints), own)


def expression_value(index: ExpressionIndex, origin: np.ndarray, real: Any, total: int, offset: int) -> Any:
    """The device function of an index of users; see `wsrender_kernels.chain_indices`."""
    assert index.chain is not None
    # Positions in the world have more digits than single precision where the base is far away.
    own, n, asked = wp.float64 if origin.any() else real, index.chain.n, index.device
    function = _compiled(index, n, own)
    return value_of_chain(real, n, *drive(index.chain), function, own, asked.asks, len(asked.options), total, offset)


def expression_numbers(index: ExpressionIndex, origin: np.ndarray, precision: str) -> np.ndarray:
    """The numbers of such an index (D,) float64."""
    assert index.chain is not None
    return np.concatenate([_rounded(index.pack(index.chain, origin, precision)), *_chain_numbers(index)])


def _factory(name: str) -> Any:
    return getattr(import_module(f"wsrender_kernels.constraints.{name}"), name)


def _numbers(constraint: Constraint, chain: Kinematics, origin: np.ndarray, precision: str) -> np.ndarray:
    """Those of a constraint; of an expression as single precision holds them, then what that leaves of each.

    Of the whole chain its bodies follow.
    """
    numbers = constraint.pack(chain, origin, precision)
    if isinstance(constraint.device, OfChain):
        return np.concatenate([numbers, packed_bodies(constraint.device.chain)])
    if not isinstance(constraint.device, Expressed):
        return numbers
    both = _rounded(numbers)
    return np.concatenate([both, *_chain_numbers(constraint)]) if constraint.device.asks else both


def _rounded(numbers: np.ndarray) -> np.ndarray:
    rounded = numbers.astype(np.float32).astype(np.float64)
    return np.concatenate([rounded, numbers - rounded])


def _chain_numbers(constraint: Any) -> tuple[np.ndarray, ...]:
    """What an expression of the whole chain has more."""
    chain, turned = constraint.chain, device_joint_frames(constraint.chain.T_joint)
    return *constraint.limits, np.array(constraint.gravity), turned[:, 0, :2].ravel(), packed_bodies(chain)
