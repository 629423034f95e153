"""What a job is by its record, whoever asks for it."""

from collections.abc import Callable
from types import TracebackType
from typing import Literal, Self

from wsrender.client.problems import error_of_problem
from wsrender.client.records import FINISHED, JobProgress, JobRecord, JobState, Problem
from wsrender.client.requests import OnLoss
from wsrender.errors import InputError, JobFailedError, WsrenderError
from wsrender.progress import RunProgress

OnInterrupt = Literal["detach", "cancel"]
INTERRUPTS = ("detach", "cancel")


class JobFacts:
    """A job as the server last described it in ``record``."""

    record: JobRecord

    @property
    def id(self) -> str:
        """The server's name of the job."""
        return self.record["id"]

    @property
    def state(self) -> JobState:
        """One of queued, running, canceling, succeeded, failed, canceled, timed_out, expired."""
        return self.record["state"]

    @property
    def finished(self) -> bool:
        """Whether the state is final."""
        return self.state in FINISHED

    @property
    def progress(self) -> JobProgress:
        """Keys fraction, samples_done, samples_total, rate_per_s, eta_s, message."""
        return self.record.get("progress") or {}

    @property
    def error(self) -> Problem | None:
        """The problem document of a job that failed."""
        return self.record.get("error")

    def _failure(self) -> WsrenderError | None:
        """What a local run would have raised, or JobFailedError; None of a job that succeeded or goes on."""
        if self.state == "succeeded" or not self.finished:
            return None
        unsaid = {"code": self.state, "detail": f"job {self.id} was {self.state.replace('_', ' ')}"}
        return error_of_problem(dict(self.error) if self.error else unsaid, JobFailedError)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.id!r}, {self.state})"

    def _repr_mimebundle_(self, include: object = None, exclude: object = None) -> dict[str, object]:
        from wsrender.results.cards import Card

        record, running = self.record, not self.finished
        told = {name.removesuffix("_at"): record.get(name) for name in ("created_at", "started_at", "finished_at")}
        told |= {"labels": ", ".join(f"{key}={value}" for key, value in (record.get("labels") or {}).items())}
        told |= {"now": self.progress.get("message") if running else None}
        card = Card(
            f"Job {self.id} · {record.get('analysis')}",
            [self.state.replace("_", " ")],
            [str(self.error.get("detail") or self.error.get("title"))] if self.error else [],
            {name: str(value) for name, value in told.items() if value},
            share=float(self.progress.get("fraction") or 0) if running else None,
        )
        return card.bundle(repr(self))


class Watched:
    """A bar that shows a job, or nothing; a context manager with what `operations.ended` and downloads report to."""

    def __init__(self, progress: bool):
        self._bar = RunProgress() if progress else None

    def __enter__(self) -> Self:
        if self._bar:
            self._bar.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar:
            self._bar.__exit__(kind, error, trace)

    @property
    def report(self) -> Callable[[JobRecord], None] | None:
        """What is told the job, whenever it is known anew; None where nobody looks."""
        return self._show if self._bar else None

    @property
    def on_loss(self) -> OnLoss | None:
        """What is told why the server is away."""
        return self._show_loss if self._bar else None

    def on_bytes(self, total: int) -> Callable[[int], None] | None:
        """What is told how much of so many bytes has arrived."""
        bar = self._bar
        return bar and (lambda have: bar(round(have / 1e6), max(round(total / 1e6), 1), "downloading, MB"))

    def _show(self, record: JobRecord) -> None:
        progress = record.get("progress") or {}
        done, total = progress.get("samples_done") or 0, progress.get("samples_total") or 1
        message = progress.get("message") if record["state"] == "running" else None
        if self._bar:
            self._bar(int(done), int(total), message or record["state"])

    def _show_loss(self, reason: str) -> None:
        if self._bar:
            self._bar(0, 1, f"server lost ({reason}), trying again")


def check_interrupt(on_interrupt: str) -> None:
    """Raise InputError for what is no choice."""
    if on_interrupt not in INTERRUPTS:
        raise InputError("on_interrupt", f"must be {' or '.join(INTERRUPTS)}, not {on_interrupt!r}")


def interrupt_note(job_id: str, canceled: bool | WsrenderError) -> str:
    """What is said where a wait is interrupted: whether the job goes on, was canceled, or why it could not be."""
    if isinstance(canceled, WsrenderError):
        return f"job {job_id} could not be canceled: {canceled}"
    return (
        f"job {job_id} was canceled" if canceled else f"the job goes on at the server; Client.job({job_id!r}) finds it"
    )
