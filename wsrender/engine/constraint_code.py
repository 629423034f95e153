"""Device functions of constraints and their numbers."""

from collections.abc import Sequence
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np
import warp as wp
from wsrender_kernels.factories import factory

from wsrender.engine.index_code import function_of_source, source_of
from wsrender.indices.expression import trace
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.robots.chain import Chain


def packed_constraints(constraints: Sequence[Constraint], chain: Chain, origin: np.ndarray) -> np.ndarray:
    """The numbers of all constraints, one after the other, (D,) float64."""
    return np.concatenate([np.zeros(0), *(each.pack(chain, origin) for each in constraints)])


def device_constraints(constraints: Sequence[Constraint], chain: Chain, real: Any) -> dict[str, Any]:
    """Fields ``constraints`` and ``limits`` of a sweep's shape."""
    sizes = [len(each.pack(chain, np.zeros(3))) for each in constraints]
    total, functions = sum(sizes), []
    for each, offset in zip(constraints, np.cumsum([0, *sizes]).tolist(), strict=False):
        if isinstance(each.device, str):
            module = import_module(f"wsrender_kernels.constraints.{each.device}")
            functions.append(getattr(module, each.device)(real, chain.n, total, offset))
        else:
            names, called = [name for name, _ in each.options], partial(_called, each.device, chain.n)
            margin = trace(called, chain.n + 12 + len(names), names)
            functions.append(_expression(source_of([margin]), real, chain.n, len(names), total, offset))
    return {"constraints": tuple(functions), "limits": total}


def _called(function: Any, n: int, inputs: tuple[Any, ...], options: Sequence[str]) -> Any:
    """A constraint's function of the inputs q (n), position (3), axes (9) and options."""
    axes = [inputs[n + 3 + 3 * k : n + 6 + 3 * k] for k in range(3)]
    return function(inputs[:n], inputs[n : n + 3], axes, **dict(zip(options, inputs[n + 12 :], strict=True)))


@factory
def _expression(body: str, real: Any, n: int, options: int, size: int, offset: int) -> Any:
    """Device function as in ``wsrender_kernels.constraints``, of the body of an expression."""
    limits_type, vec_n = wp.types.vector(size, real), wp.types.vector(n, real)
    vec3, mat33 = wp.types.vector(3, real), wp.types.matrix((3, 3), real)
    length = n + 12 + options
    inputs_type, margin = wp.types.vector(length, real), function_of_source(body, 1, length, real)
    ZERO, POSITION, AXES, OPTIONS = real(0.0), n, n + 3, n + 12

    @wp.func
    def violated(limits: limits_type, q: vec_n, tip: vec3, axes: mat33):
        inputs = inputs_type()
        for i in range(n):
            inputs[i] = q[i]
        for r in range(3):
            inputs[POSITION + r] = tip[r] + limits[offset + r]
            for k in range(3):
                inputs[AXES + 3 * k + r] = axes[r, k]
        for k in range(options):
            inputs[OPTIONS + k] = limits[offset + 3 + k]
        found = margin(inputs, inputs)
        return wp.where(found[0] >= ZERO, 0, 1)

    return violated
