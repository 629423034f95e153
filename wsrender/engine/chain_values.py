"""Device functions of indices of the whole chain, and their numbers."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np

from wsrender.engine.constraint_code import expression_numbers, expression_value
from wsrender.engine.evaluation import REAL, drive, packed_bodies
from wsrender.pipeline.chain_index import ChainIndex
from wsrender.pipeline.constraints.expression import ExpressionIndex
from wsrender.pipeline.pipeline import Pipeline


def packed_values(pipeline: Pipeline) -> np.ndarray:
    """The numbers of all indices of the chain, one after the other, (V,) float64."""
    asked = pipeline.evaluation.of_chain.values()
    return np.concatenate([np.zeros(0), *(_numbers(each, pipeline) for each in asked)])


def device_values(pipeline: Pipeline, before: int) -> dict[str, Any]:
    """Fields ``chain_values`` and ``cuts`` of a sweep's shape; so many numbers stand ``before`` theirs."""
    asked, real = pipeline.evaluation.of_chain, REAL[pipeline.precision]
    sizes = [len(_numbers(each, pipeline)) for each in asked.values()]
    offsets, total = np.cumsum([before, *sizes]).tolist(), before + sum(sizes)
    functions = [
        (pipeline.evaluation.indices.index(name), _function(each, pipeline.origin, real, total, offset))
        for (name, each), offset in zip(asked.items(), offsets, strict=False)
    ]
    places = pipeline.evaluation.indices.index
    return {"chain_values": tuple(functions), "cuts": tuple(map(places, pipeline.evaluation.cuts))}


def _function(
    index: ChainIndex | ExpressionIndex, origin: np.ndarray, real: Any, total: int, offset: int
) -> Callable[..., Any]:
    if isinstance(index, ExpressionIndex):
        return expression_value(index, origin, real, total, offset)
    factory = getattr(import_module(f"wsrender_kernels.chain_indices.{index.module}"), index.module)
    return factory(real, index.chain.n, *drive(index.chain), *index.choices, total, offset)


def _numbers(index: ChainIndex | ExpressionIndex, pipeline: Pipeline) -> np.ndarray:
    if isinstance(index, ExpressionIndex):
        return expression_numbers(index, pipeline.origin, pipeline.precision)
    return np.concatenate([np.array(index.numbers, np.float64), *map(packed_bodies, index.laden)])
