"""Device functions of indices of the whole chain, and their numbers."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np

from wsrender.engine.evaluation import REAL, drive, packed_bodies
from wsrender.pipeline.chain_index import ChainIndex
from wsrender.pipeline.pipeline import Pipeline


def packed_values(pipeline: Pipeline) -> np.ndarray:
    """The numbers of all indices of the chain, one after the other, (V,) float64."""
    return np.concatenate([np.zeros(0), *map(_numbers, pipeline.evaluation.of_chain.values())])


def device_values(pipeline: Pipeline, before: int) -> dict[str, Any]:
    """Fields ``chain_values`` and ``cuts`` of a sweep's shape; so many numbers stand ``before`` theirs."""
    asked, real = pipeline.evaluation.of_chain, REAL[pipeline.precision]
    sizes = [len(_numbers(each)) for each in asked.values()]
    offsets, total = np.cumsum([before, *sizes]).tolist(), before + sum(sizes)
    functions = [
        (pipeline.evaluation.indices.index(name), _function(each, real, total, offset))
        for (name, each), offset in zip(asked.items(), offsets, strict=False)
    ]
    places = pipeline.evaluation.indices.index
    return {"chain_values": tuple(functions), "cuts": tuple(map(places, pipeline.evaluation.cuts))}


def _function(index: ChainIndex, real: Any, total: int, offset: int) -> Callable[..., Any]:
    factory = getattr(import_module(f"wsrender_kernels.chain_indices.{index.module}"), index.module)
    return factory(real, index.chain.n, *drive(index.chain), *index.choices, total, offset)


def _numbers(index: ChainIndex) -> np.ndarray:
    return np.concatenate([np.array(index.numbers, np.float64), *map(packed_bodies, index.laden)])
