"""A CSV file to which every design is added as soon as it is evaluated, so that a search that was stopped goes on."""

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from wsrender.errors import InputError


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
