"""Progress of a run: a bar on a terminal or in a notebook, plain lines on standard error elsewhere."""

import sys
import time
from threading import Timer
from types import TracebackType
from typing import Self, TextIO

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from wsrender.notebook import display, in_notebook

QUIET_S = 1.0  # shorter work shows nothing
LINE_EVERY_S = 5.0  # off a terminal
DRAWN_EVERY_S = 0.1  # in a notebook


class RunProgress:
    """Called as ``progress(done, total, message)``; shows the part done, samples, rate and time left.

    Use it as a context manager. Work that ends within a second shows nothing, except in a notebook.
    """

    def __init__(self, stream: TextIO | None = None):
        self._shown = _BelowCell() if stream is None and in_notebook() else _shown_on(stream or sys.stderr)
        self._phase: tuple[int, str] | None = None
        self._phase_start = (0.0, 0)  # time [s], done

    def __enter__(self) -> Self:
        self._shown.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._shown.stop(completed=kind is None)

    def __call__(self, done: int, total: int, message: str) -> None:
        """Report that ``done`` of ``total`` samples are finished; ``message`` names what is going on."""
        now = time.monotonic()
        if self._phase != (total, message):  # planning and compiling must not count in the rate
            self._phase, self._phase_start = (total, message), (now, done)
        since, done_before = self._phase_start
        rate = (done - done_before) / (now - since) if done > done_before and now > since else None
        self._shown.show(done, total, message, rate)


def _shown_on(stream: TextIO) -> "_Bar | _Lines":
    console = Console(file=stream, highlight=False, soft_wrap=True)
    return _Bar(console) if console.is_terminal else _Lines(console)


class _Bar:
    """A bar that appears after a second, moving even while no report comes."""

    def __init__(self, console: Console):
        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.percentage:3.0f} %"),
            TextColumn("{task.fields[samples]}"),
            TimeRemainingColumn(),
        )
        self._bar = Progress(*columns, console=console, transient=True)
        self._task = self._bar.add_task("starting", total=None, samples="")
        self._timer = Timer(QUIET_S, self._bar.start)
        self._timer.daemon = True

    def start(self) -> None:
        self._timer.start()

    def stop(self, completed: bool) -> None:
        self._timer.cancel()
        self._timer.join()
        self._bar.stop()

    def show(self, done: int, total: int, message: str, rate: float | None) -> None:
        size = total if done else None  # None: a moving bar
        samples = _samples(done, rate)
        self._bar.update(self._task, completed=done, total=size, description=escape(message), samples=samples)


class _BelowCell(_Bar):
    """The same bar as rich draws it in a notebook; it stays there, full where the work has ended.

    It is displayed by itself, not live: no widgets are needed, and a notebook that is read later still shows it.
    """

    def __init__(self):
        super().__init__(Console(force_jupyter=True))
        self._next = 0.0

    def start(self) -> None:
        self._handle = display(self._bar)

    def stop(self, completed: bool) -> None:
        if completed:
            total = self._bar.tasks[self._task].total or 1
            self._bar.update(self._task, completed=total, total=total)
        self._handle.update(self._bar)

    def show(self, done: int, total: int, message: str, rate: float | None) -> None:
        super().show(done, total, message, rate)
        if time.monotonic() >= self._next:
            self._next = time.monotonic() + DRAWN_EVERY_S
            self._handle.update(self._bar)


class _Lines:
    """A line every few seconds."""

    def __init__(self, console: Console):
        self._console = console
        self._next = 0.0

    def start(self) -> None:
        self._next = time.monotonic() + QUIET_S

    def stop(self, completed: bool) -> None:
        pass

    def show(self, done: int, total: int, message: str, rate: float | None) -> None:
        if rate is None or time.monotonic() < self._next:
            return
        self._next = time.monotonic() + LINE_EVERY_S
        left = f"{(total - done) / rate:.0f} s left"
        self._console.print(f"{message}: {100 * done / total:.0f} %, {_samples(done, rate)}, {left}")


def _samples(done: int, rate: float | None) -> str:
    if done == 0:
        return ""
    return f"{done:.3g}, {rate:.3g}/s" if rate else f"{done:.3g}"
