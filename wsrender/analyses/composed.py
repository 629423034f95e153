"""Analyses that are composed of parts, such as other plans: the shards of the parts are their shards."""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from wsrender.analyses.contract import Analysis, Tell
from wsrender.analyses.execution import Execution
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.piece import Piece, end_to_end

PARTS = "parts"  # fact that holds those of every part by its number


@dataclass(frozen=True, eq=False)
class Part:
    """So many samples, divisible at multiples of ``unit`` (None: not at all), and what an `Analysis` does with them.

    ``compute`` (first sample, number, execution, tell) gives the partial result of a range.
    """

    samples: int
    unit: int | None
    compute: Callable[[int, int, Execution, Tell], Any]
    merge: Callable[[Any, Any], Any]
    unpacked: Callable[[PartialResult], Any]


def part_of(plan: Analysis) -> Part:
    """A plan as a part of another."""

    def compute(first: int, number: int, execution: Execution, tell: Tell) -> Any:
        return plan.over(first, number).compute(0, execution, tell)

    return Part(plan.samples, plan.settled.shard_unit, compute, plan.merge, plan.unpacked)


@dataclass(frozen=True, eq=False)
class PartialParts:
    """The partial results of parts, by the parts' numbers."""

    parts: Mapping[int, Any]

    def packed(self) -> PartialResult:
        """Arrays led by the part's number, facts by number."""
        packed = {number: partial.packed() for number, partial in self.parts.items()}
        arrays = {f"{k}_{name}": array for k, each in packed.items() for name, array in each.arrays.items()}
        return PartialResult(arrays, {PARTS: {str(k): each.facts for k, each in packed.items()}})


class Composed(Analysis):
    """An analysis whose samples are those of its `parts`, laid end to end."""

    @property
    @abstractmethod
    def parts(self) -> list[Part]:
        """The parts, in an order that every process has."""

    @property
    def pieces(self) -> list[Piece]:
        """The samples of the parts."""
        return end_to_end((part.samples, part.unit) for part in self.parts)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialParts:
        """Partial results of the parts that have samples in the shard."""
        found, done = {}, 0
        for number, (part, piece) in enumerate(zip(self.parts, self.pieces, strict=True)):
            first, count = piece.within(*self.shards[shard])
            if count:
                found[number] = part.compute(first, count, execution, lambda more, before=done: tell(before + more))
                done += count
        return PartialParts(found)

    def merge(self, a: PartialParts, b: PartialParts) -> PartialParts:
        """The partial results of the parts of both."""
        merged = {**a.parts, **b.parts}
        for number in a.parts.keys() & b.parts.keys():
            merged[number] = self.parts[number].merge(a.parts[number], b.parts[number])
        return PartialParts(merged)

    def unpacked(self, partial: PartialResult) -> PartialParts:
        """The partial results of the parts."""
        arrays: dict[str, dict[str, Any]] = {number: {} for number in partial.facts[PARTS]}
        for name, array in partial.arrays.items():
            number, _, own = name.partition("_")
            arrays[number][own] = array
        parts = {
            int(k): self.parts[int(k)].unpacked(PartialResult(arrays[k], facts))
            for k, facts in partial.facts[PARTS].items()
        }
        return PartialParts(parts)
