"""Pieces of a job's samples, each divisible in its own way, laid end to end."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import accumulate


@dataclass(frozen=True)
class Piece:
    """Samples first … first + number - 1 of a job; they may be divided at multiples of ``unit``, None: not at all.

    Multiples are counted from ``first``.
    """

    first: int
    number: int
    unit: int | None = None

    def divided(self, size: float) -> Iterator[tuple[int, int]]:
        """(first sample, number) of shards of about ``size`` samples."""
        size = self.number if self.unit is None else int(-(-size // self.unit)) * self.unit
        for start in range(0, self.number, size or 1):
            yield self.first + start, min(size, self.number - start)

    def within(self, first: int, number: int) -> tuple[int, int]:
        """(first, number), counted from the piece's own first, of what samples of the job are among its own."""
        start, end = max(first, self.first), min(first + number, self.first + self.number)
        return start - self.first, max(end - start, 0)


def end_to_end(numbers: Iterable[tuple[int, int | None]]) -> list[Piece]:
    """Pieces of so many samples and their units, one after the other."""
    numbers = list(numbers)
    ends = accumulate(number for number, _ in numbers)
    return [Piece(end - number, number, unit) for end, (number, unit) in zip(ends, numbers, strict=True)]
