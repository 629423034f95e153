"""The designs of an optimisation and their values: evaluated once each, in order, and kept, also in a file."""

import csv
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from wsrender.errors import InputError

Evaluate = Callable[[np.ndarray], np.ndarray]


class Evaluations:
    """Rows of parameters and values; a design that is known is not evaluated again.

    ``evaluate`` takes designs (N, n) and gives values (N, k), NaN where a design has none; it is asked for at most
    ``batch`` designs at a time. ``report`` is told how many designs there are, ``keep`` every new one with its values.
    ``weights`` (k,), negative where small values are good, make the score of a design:
    -inf where a value is missing.
    """

    def __init__(
        self,
        evaluate: Evaluate,
        weights: np.ndarray,
        known: Sequence[tuple[tuple[float, ...], tuple[float, ...]]] = (),
        report: Callable[[int], None] | None = None,
        keep: Callable[[np.ndarray, np.ndarray], None] | None = None,
        batch: int = 64,
    ):
        self.weights = weights
        self._evaluate, self._report, self._keep, self._batch = evaluate, report, keep, batch
        self._known = dict(known)
        self._asked: dict[tuple[float, ...], tuple[float, ...]] = {}  # in the order of the search

    def __len__(self) -> int:
        return len(self._asked)

    def values(self, designs: np.ndarray) -> np.ndarray:
        """Values (N, k) of designs (N, n)."""
        keys = [tuple(map(float, design)) for design in designs]
        new = [key for key in dict.fromkeys(keys) if key not in self._known]
        for first in range(0, len(new), self._batch):
            part = new[first : first + self._batch]
            found = self._evaluate(np.array(part))
            self._known |= {key: tuple(map(float, row)) for key, row in zip(part, found, strict=True)}
            if self._keep:
                self._keep(np.array(part), found)
            if self._report:
                self._report(len(self._asked) + first + len(part))
        self._asked |= {key: self._known[key] for key in keys}
        return np.array([self._known[key] for key in keys]).reshape(len(keys), len(self.weights))

    def scores(self, designs: np.ndarray) -> np.ndarray:
        """Scores (N,) of designs (N, n)."""
        return scores(self.values(designs), self.weights)

    def feasible(self, designs: np.ndarray) -> np.ndarray:
        """Whether each of designs (N, n) has all its values and is not empty, (N,); see `feasible`."""
        return feasible(self.values(designs), self.weights)

    def rows(self) -> tuple[np.ndarray, np.ndarray]:
        """All designs (E, n) that were asked for, in that order, and their values (E, k)."""
        return np.array(list(self._asked)), np.array(list(self._asked.values()))


def scores(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Weighted sums (N,) of values (N, k); -inf where one is missing."""
    return np.where(np.isfinite(values).all(axis=1), np.nan_to_num(values) @ weights, -np.inf)


def feasible(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Whether rows of values (N, k) are whole, and not 0 in all that shall be large: an empty workspace, (N,)."""
    whole, large = np.asarray(np.isfinite(values).all(axis=1)), weights > 0
    return whole & np.any(values[:, large] != 0, axis=1) if large.any() else whole


class EvaluationFile:
    """Rows of parameters and values under a header line; numbers are written so that they are read back exactly."""

    def __init__(self, path: str | Path, columns: Sequence[str]):
        """Begin the file where there is none, and cut off a line that a crash has left unfinished.

        InputError where it cannot be written.
        """
        self.path, self.columns = Path(path), list(columns)
        try:
            content = self.path.read_bytes() if self.path.exists() else b""
            if not content.endswith(b"\n"):
                self.path.write_bytes(content[: content.rfind(b"\n") + 1])
        except OSError as error:
            raise InputError("evaluations.path", f"{self.path} cannot be written: {error}") from error
        if b"\n" not in content:
            self._write([self.columns])

    def rows(self) -> np.ndarray:
        """The designs and values (N, columns) so far; InputError where the file has other columns or no numbers."""
        try:
            lines = list(csv.reader(self.path.read_text("utf-8").splitlines(keepends=True)))
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise InputError("evaluations.path", f"{self.path} cannot be read: {error}") from error
        if not lines or lines[0] != self.columns:
            found = ", ".join(lines[0]) if lines else "nothing"
            raise InputError(
                "evaluations.path", f"{self.path} must have the columns {', '.join(self.columns)}, not {found}"
            )
        try:
            return np.array(lines[1:], np.float64).reshape(-1, len(self.columns))
        except ValueError as error:
            raise InputError("evaluations.path", f"{self.path} must hold numbers: {error}") from None

    def append(self, designs: np.ndarray, values: np.ndarray) -> None:
        """Add designs (N, n) and their values (N, k)."""
        self._write([list(map(repr, row)) for row in np.hstack([designs, values]).tolist()])

    def _write(self, lines: list[list[str]]) -> None:
        try:
            with self.path.open("a", encoding="utf-8", newline="") as file:
                csv.writer(file).writerows(lines)
        except OSError as error:
            raise InputError("evaluations.path", f"{self.path} cannot be written: {error}") from error
