"""Progress of a run on standard error: a bar on a terminal, plain lines elsewhere."""

import sys
import time
from types import TracebackType
from typing import Self, TextIO

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

QUIET_S = 1.0  # shorter work shows nothing
LINE_EVERY_S = 5.0  # off a terminal


class RunProgress:
    """Called as ``progress(done, total, message)``; shows samples, rate and time left.

    Use it as a context manager. Work that ends within a second shows nothing.
    """

    def __init__(self, stream: TextIO | None = None):
        self._console = Console(file=stream or sys.stderr)
        self._started = self._last_line = time.monotonic()
        self._bar: Progress | None = None
        self._task: TaskID | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def __call__(self, done: int, total: int, message: str) -> None:
        """Report that ``done`` of ``total`` samples are finished."""
        elapsed = time.monotonic() - self._started
        if elapsed < QUIET_S:
            return
        if self._console.is_terminal:
            self._show_bar(done, total, f"{message}  {_rate(done, elapsed)}")
        elif time.monotonic() - self._last_line >= LINE_EVERY_S or self._last_line == self._started:
            self._last_line = time.monotonic()
            self._console.print(_line(done, total, message, elapsed), soft_wrap=True, highlight=False)

    def _show_bar(self, done: int, total: int, description: str) -> None:
        if self._bar is None or self._task is None:
            columns = (
                TextColumn("{task.percentage:3.0f} %"),
                BarColumn(),
                TextColumn("{task.description}"),
                TimeRemainingColumn(),
            )
            self._bar = Progress(*columns, console=self._console, transient=True)
            self._task = self._bar.add_task(description, total=total)
            self._bar.start()
        self._bar.update(self._task, completed=done, total=total, description=description)


def _rate(done: int, elapsed: float) -> str:
    return f"{done:.3g} samples, {done / elapsed:.3g}/s"


def _line(done: int, total: int, message: str, elapsed: float) -> str:
    left = (total - done) * elapsed / done if done else float("nan")
    return f"{message}: {100 * done / total:.0f} % of {total:.3g}, {_rate(done, elapsed)}, {left:.0f} s left"
