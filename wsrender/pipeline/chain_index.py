"""Indices that kernels compute of the whole chain."""

from dataclasses import dataclass
from typing import Any

from wsrender.robots.chain import Chain


@dataclass(frozen=True)
class ChainIndex:
    """A module of ``wsrender_kernels.chain_indices``, its choices, and its numbers.

    ``chain``: the robot's `Chain.dynamic`; the numbers go on with the bodies of the chains ``laden``, which have its
    joints. ``cut``: what larger values are told as; None: none is.
    """

    module: str
    chain: Chain
    choices: tuple[Any, ...] = ()
    numbers: tuple[float, ...] = ()
    laden: tuple[Chain, ...] = ()
    cut: float | None = None
