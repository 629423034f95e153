"""Device functions of constraints and their numbers."""

from collections.abc import Sequence
from importlib import import_module
from typing import Any

import numpy as np
import warp as wp
from wsrender_kernels.constraints import OfChain as Marked
from wsrender_kernels.constraints.expression import expression

from wsrender.engine.evaluation import REAL, drive, packed_bodies
from wsrender.engine.index_code import function_of_source, source_of
from wsrender.pipeline.constraints.collision import labelling
from wsrender.pipeline.constraints.constraint import Constraint, Expressed, OfChain
from wsrender.robots.kinematics import Kinematics


def packed_constraints(
    constraints: Sequence[Constraint], chain: Kinematics, origin: np.ndarray, precision: str
) -> np.ndarray:
    """The numbers of all constraints, one after the other, (D,) float64."""
    return np.concatenate([np.zeros(0), *(_numbers(each, chain, origin, precision) for each in constraints)])


def device_constraints(
    constraints: Sequence[Constraint], chain: Kinematics, origin: np.ndarray, precision: str
) -> dict[str, Any]:
    """Fields ``constraints`` and ``limits`` of a sweep's shape."""
    sizes = [len(_numbers(each, chain, origin, precision)) for each in constraints]
    total, functions, real = sum(sizes), [], REAL[precision]
    labels = {each.name: number for number, each in enumerate(labelling(constraints), 1)}
    for each, offset in zip(constraints, np.cumsum([0, *sizes]).tolist(), strict=False):
        if each.name in labels:
            functions.append(labels[each.name])
        elif isinstance(each.device, Expressed):
            # Positions in the world have more digits than single precision where the base is far away.
            own, options = wp.float64 if origin.any() else real, len(each.device.options)
            margin = function_of_source(source_of([each.device.traced(chain.n)]), 1, chain.n + 12 + options, own)
            functions.append(expression(margin, real, own, chain.n, options, total, offset))
        elif isinstance(each.device, OfChain):
            asked = each.device
            arguments = (real, chain.n, *drive(asked.chain), *asked.choices, total, offset)
            functions.append(Marked(_factory(asked.module)(*arguments)))
        else:
            functions.append(_factory(each.device)(real, chain.n, total, offset))
    return {"constraints": tuple(functions), "limits": total}


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
    rounded = numbers.astype(np.float32).astype(np.float64)
    return np.concatenate([rounded, numbers - rounded])
