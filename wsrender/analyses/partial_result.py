"""Partial results: what a shard gives, and what travels between processes."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np


@dataclass(frozen=True, eq=False)
class PartialResult:
    """Arrays by name, and beside them facts: plain JSON values, which are the same whether they have travelled or not.

    A partial result of another type has a method ``packed``, and its analysis one ``unpacked``. Raises TypeError for
    facts that are none.
    """

    arrays: Mapping[str, np.ndarray]
    facts: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "facts", json.loads(json.dumps(dict(self.facts))))

    def __getitem__(self, name: str) -> np.ndarray:
        """An array by its name."""
        return self.arrays[name]

    def packed(self) -> Self:
        """Itself: it can be kept as it is."""
        return self
