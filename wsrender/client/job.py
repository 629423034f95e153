"""One job on a server."""

import json
import time
from collections.abc import Iterator
from contextlib import nullcontext
from typing import Any, Self
from urllib.parse import quote

import httpx2

from wsrender.client.connection import Connection, error_of_problem
from wsrender.client.remote_result import RemoteFiles, RemoteResult
from wsrender.errors import JobFailedError, WaitTimeoutError
from wsrender.keywords import keywords
from wsrender.progress import RunProgress
from wsrender.results.export.result_format import current_document
from wsrender.results.result import Result

FINISHED = ("succeeded", "failed", "canceled", "timed_out", "expired")
LONG_POLL_S = 20.0  # proxies allow it
REPORTED_S = 5.0  # between two reports of progress at the latest
SHORTEST_POLL_S = 0.2
RECONNECT_S = 600.0  # a server's restart, a laptop's sleep


@keywords
class Job:
    """A job as the server last described it; ``refresh`` and ``wait`` ask again.

    ``record`` is the server's description: id, analysis, state, created_at, started_at, finished_at, labels,
    priority, attempt, progress, error.
    """

    def __init__(self, connection: Connection, record: dict[str, Any]):
        self._connection = connection
        self.record = record
        self._path = f"/v1/jobs/{quote(self.id, safe='')}"

    @property
    def id(self) -> str:
        """The server's name of the job."""
        return self.record["id"]

    @property
    def state(self) -> str:
        """One of queued, running, canceling, succeeded, failed, canceled, timed_out, expired."""
        return self.record["state"]

    @property
    def finished(self) -> bool:
        """Whether the state is final."""
        return self.state in FINISHED

    @property
    def progress(self) -> dict[str, Any]:
        """Keys fraction, samples_done, samples_total, rate_per_s, eta_s, message."""
        return self.record.get("progress") or {}

    @property
    def error(self) -> dict[str, Any] | None:
        """The problem document of a job that failed."""
        return self.record.get("error")

    def refresh(self) -> Self:
        """Ask the server for the job's state."""
        self.record = self._connection.request("GET", self._path).json()
        return self

    def wait(self, progress: bool = False, timeout: float | None = None) -> Self:
        """Wait until the job has finished, whatever its final state; a restart of the server does not matter.

        ``progress`` shows a bar on standard error. Raises WaitTimeoutError after ``timeout`` seconds,
        ServerConnectionError where the server stays away for ten minutes.
        """
        end = float("inf") if timeout is None else time.monotonic() + timeout
        try:
            with RunProgress() if progress else nullcontext() as bar:
                self._wait_until(end, timeout, bar)
        except KeyboardInterrupt as error:
            error.add_note(f"the job goes on at the server; Client.job({self.id!r}) finds it")
            raise
        return self

    def _wait_until(self, end: float, timeout: float | None, bar: RunProgress | None) -> None:
        self._report(bar)
        while not self.finished:
            left = end - time.monotonic()
            if left <= 0:
                raise WaitTimeoutError(f"job {self.id} is still {self.state} after {timeout:g} s")
            self._poll(min(REPORTED_S if bar else LONG_POLL_S, left), min(RECONNECT_S, left), bar)
            self._report(bar)

    def result(self) -> Result:
        """The result, the same object as of a local run; waits for the job, downloads files when they are used.

        Raises what a local run would have raised, JobFailedError where the job was canceled, timed out or crashed.
        """
        self.wait()
        if self.state != "succeeded":
            raise error_of_problem(self._problem(), JobFailedError)
        document = current_document(self._connection.request("GET", f"{self._path}/result").json())
        return RemoteResult(document, RemoteFiles(self._connection, self.id, document))

    def cancel(self) -> Self:
        """Stop the job; its state becomes canceling, then canceled."""
        self.record = self._connection.request("POST", f"{self._path}:cancel", resend=False).json()
        return self

    def retry(self) -> Self:
        """Queue a job again that failed, was canceled, timed out or has expired."""
        self.record = self._connection.request("POST", f"{self._path}:retry", resend=False).json()
        return self

    def delete(self) -> None:
        """Remove the job and its files from the server."""
        self._connection.request("DELETE", self._path, resend=False)

    def events(self, after: str = "") -> Iterator[dict[str, Any]]:
        """Everything that happened to the job, then what happens, until it has finished.

        Each event has id, type and data. ``after`` is the id of the last event already seen. Lost connections go
        on with the event after the last one.
        """
        pauses = self._connection.pauses(RECONNECT_S)
        while True:
            finished = self.refresh().finished  # asked first: then the stream lacks nothing
            try:
                for event in self._stream(after):
                    pauses.again()
                    after = event["id"] or after
                    yield event
            except httpx2.TransportError as error:
                pauses.after(error)
                continue
            if finished:
                return
            time.sleep(SHORTEST_POLL_S)  # a stream ends with its job, but also with the server

    def _stream(self, after: str) -> Iterator[dict[str, Any]]:
        headers = {"Accept": "text/event-stream"} | ({"Last-Event-ID": after} if after else {})
        with self._connection.stream(f"{self._path}/events", headers=headers) as response:
            self._connection.checked(response)
            for event in httpx2.EventSource(response):
                yield {"id": event.id, "type": event.event, "data": json.loads(event.data)}

    def _poll(self, wait_s: float, patience_s: float, bar: RunProgress | None) -> None:
        asked = time.monotonic()
        params: dict[str, Any] = {"wait": f"{wait_s:.3f}"}
        if bar:  # else no news is worth an answer but the end
            params["after"] = self.record.get("last_event") or 0
        self.record = self._connection.request(
            "GET",
            self._path,
            params=params,
            timeout=wait_s + self._connection.timeout_s,
            patience_s=patience_s,
            on_loss=lambda reason: bar(0, 1, f"server lost ({reason}), trying again") if bar else None,
        ).json()
        if not self.finished:  # even where the server answers at once
            time.sleep(max(0.0, min(wait_s, SHORTEST_POLL_S) - (time.monotonic() - asked)))

    def _report(self, bar: RunProgress | None) -> None:
        if bar:
            done, total = self.progress.get("samples_done") or 0, self.progress.get("samples_total") or 1
            message = self.progress.get("message") if self.state == "running" else None
            bar(int(done), int(total), message or self.state)

    def _problem(self) -> dict[str, Any]:
        return self.error or {"code": self.state, "detail": f"job {self.id} was {self.state.replace('_', ' ')}"}

    def __repr__(self) -> str:
        return f"Job({self.id!r}, {self.state})"

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
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
