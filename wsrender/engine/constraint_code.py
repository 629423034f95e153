"""Device functions of constraints and their numbers."""

from collections.abc import Sequence
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np
from wsrender_kernels.constraints.expression import expression

from wsrender.engine.index_code import function_of_source, source_of
from wsrender.indices.expression import trace
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.robots.kinematics import Kinematics


def packed_constraints(constraints: Sequence[Constraint], chain: Kinematics, origin: np.ndarray) -> np.ndarray:
    """The numbers of all constraints, one after the other, (D,) float64."""
    return np.concatenate([np.zeros(0), *(each.pack(chain, origin) for each in constraints)])


def device_constraints(constraints: Sequence[Constraint], chain: Kinematics, real: Any) -> dict[str, Any]:
    """Fields ``constraints`` and ``limits`` of a sweep's shape."""
    sizes = [len(each.pack(chain, np.zeros(3))) for each in constraints]
    total, functions = sum(sizes), []
    for each, offset in zip(constraints, np.cumsum([0, *sizes]).tolist(), strict=False):
        if isinstance(each.device, str):
            module = import_module(f"wsrender_kernels.constraints.{each.device}")
            functions.append(getattr(module, each.device)(real, chain.n, total, offset))
        else:
            called, length = each.device.function, chain.n + 12 + len(each.device.options)
            body = source_of([trace(partial(_called, called, chain.n), length, each.device.options)])
            margin = function_of_source(body, 1, length, real)
            functions.append(expression(margin, real, chain.n, len(each.device.options), total, offset))
    return {"constraints": tuple(functions), "limits": total}


def _called(function: Any, n: int, inputs: tuple[Any, ...], options: Sequence[str]) -> Any:
    """A constraint's function of the inputs q (n), position (3), axes (9) and options."""
    axes = [inputs[n + 3 + 3 * k : n + 6 + 3 * k] for k in range(3)]
    return function(inputs[:n], inputs[n : n + 3], axes, **dict(zip(options, inputs[n + 12 :], strict=True)))
