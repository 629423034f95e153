"""Many jobs at once."""

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from threading import Event
from typing import Self

from wsrender.client.job import Job
from wsrender.client.records import JobDocument
from wsrender.client.remote_result import RemoteResult
from wsrender.errors import InputError, WaitTimeoutError
from wsrender.keywords import keywords

MOST_AT_ONCE = 64
LOOK_S = 2.0  # a batch that is left lets go of its jobs so soon


@keywords
class Batch:
    """Jobs that are submitted and waited for ``at_once`` at a time; a context manager, made by `Client.batch`.

    Leaving the block waits for all of them, then raises an ExceptionGroup of `errors` if there are any. Left by an
    exception, such as Ctrl-C, it submits no more; jobs that run go on at the server, or are stopped with ``cancel``.
    """

    def __init__(self, submit: Callable[..., Job], at_once: int, cancel: bool):
        check_at_once(at_once)
        self._submit, self._cancel = submit, cancel
        self._threads = ThreadPoolExecutor(at_once, "wsrender-batch")
        self._left = Event()
        self._futures: list[Future[RemoteResult]] = []

    def submit(
        self,
        job: JobDocument,
        *,
        labels: Mapping[str, str] | None = None,
        priority: int = 0,
        timeout_s: float | None = None,
        idempotency_key: str | None = None,
    ) -> Future[RemoteResult]:
        """As `Client.submit`, but at once: the future's ``result()`` waits for the result or raises what went wrong."""
        asked = {"labels": labels, "priority": priority, "timeout_s": timeout_s, "idempotency_key": idempotency_key}
        future = self._threads.submit(self._run, len(self._futures), job, asked)
        self._futures.append(future)
        return future

    def __repr__(self) -> str:
        ended = sum(each.done() for each in self._futures)
        return f"<Batch: {ended} of {len(self._futures)} jobs have ended>"

    @property
    def errors(self) -> dict[int, BaseException]:
        """What went wrong with jobs that have ended, by their place in the batch, from 0."""
        ended = {k: each for k, each in enumerate(self._futures) if each.done() and not each.cancelled()}
        return {k: error for k, each in ended.items() if (error := each.exception())}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        try:
            if kind is None:
                wait(self._futures)
        finally:  # where they have not all ended, the block or this wait was interrupted
            self._left.set()
            self._threads.shutdown(cancel_futures=True)
        if kind is None:
            failures(self.errors, len(self._futures))

    def _run(self, place: int, document: JobDocument, asked: dict[str, object]) -> RemoteResult:
        with place_noted(place) as noted:
            job = self._submit(document, **asked)
            noted.append(job.id)
            while not job.finished:
                try:
                    job.wait(timeout=LOOK_S)
                except WaitTimeoutError:
                    if self._left.is_set():
                        if self._cancel:
                            job.cancel()
                        raise
            return job.result()


def check_at_once(at_once: int) -> None:
    """Raise InputError for a number of jobs that is not allowed."""
    if isinstance(at_once, bool) or not isinstance(at_once, int) or not 1 <= at_once <= MOST_AT_ONCE:
        raise InputError("at_once", f"must be an integer from 1 to {MOST_AT_ONCE}, not {at_once!r}")


def failures(errors: Mapping[int, BaseException], jobs: int) -> None:
    """Raise all errors of so many jobs together, if there are any."""
    failed = [error for error in errors.values() if isinstance(error, Exception)]
    if failed:
        raise ExceptionGroup(f"{len(failed)} of {jobs} jobs", failed)


@contextmanager
def place_noted(place: int) -> Iterator[list[str]]:
    """Errors of the block say of which job of the batch they are; its id is added to the list once it is known."""
    where = [f"job {place} of the batch"]
    try:
        yield where
    except Exception as error:
        error.add_note(", ".join(where))
        raise
