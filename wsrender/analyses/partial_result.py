"""Partial results: what a shard gives, and what travels between processes."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

REFINEMENTS = "refinements"  # fact of a shard that is one
FIRST = "first_sample"  # array of rows, of the shard that each is of


@dataclass(frozen=True, eq=False)
class PartialResult:
    """Arrays by name, and beside them facts: plain JSON values, which are the same whether they have travelled or not.

    A partial result of another type has a method ``packed``, and its analysis one ``unpacked``. Raises TypeError for
    facts that are none.
    """

    arrays: Mapping[str, np.ndarray]
    facts: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "facts", plain(dict(self.facts)))

    def __getitem__(self, name: str) -> np.ndarray:
        """An array by its name."""
        return self.arrays[name]

    def packed(self) -> Self:
        """Itself: it can be kept as it is."""
        return self


def rows_of_shard(first: int, arrays: Mapping[str, np.ndarray]) -> PartialResult:
    """Rows (N, …) of a shard that begins with the sample ``first``, as `joined_rows` joins them."""
    number = len(next(iter(arrays.values())))
    return PartialResult({**arrays, FIRST: np.full(number, first, np.int64)})


def joined_rows(a: PartialResult, b: PartialResult) -> PartialResult:
    """The rows of both, those of earlier samples first."""
    order = np.argsort(np.concatenate([a[FIRST], b[FIRST]]), kind="stable")
    return PartialResult({name: np.concatenate([a[name], b[name]])[order] for name in a.arrays})


@dataclass(frozen=True, eq=False)
class Refinements:
    """Refinements by number, as plain JSON values, and the merged partial result of samples beside them, if any is.

    They are packed alone: what is merged stays in its process.
    """

    entries: Mapping[int, Any]
    samples: Any = None

    @classmethod
    def beside(cls, partial: Any) -> Self:
        """A partial result with the refinements it may hold."""
        return partial if isinstance(partial, cls) else cls({}, partial)

    def packed(self) -> PartialResult:
        """As facts."""
        return PartialResult({}, {REFINEMENTS: {str(number): entry for number, entry in self.entries.items()}})

    @staticmethod
    def are(partial: PartialResult) -> bool:
        """Whether that is what was packed."""
        return not partial.arrays and set(partial.facts) == {REFINEMENTS}

    @classmethod
    def of(cls, partial: PartialResult) -> Self:
        """What was packed."""
        return cls({int(number): entry for number, entry in partial.facts[REFINEMENTS].items()})


def plain(value: Any) -> Any:
    """As JSON values; raises TypeError for what is none."""
    return json.loads(json.dumps(value))
