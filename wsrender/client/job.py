"""One job on a server."""

import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Self

import httpx2

from wsrender.client import operations
from wsrender.client.connection import Connection
from wsrender.client.job_facts import JobFacts, OnInterrupt, Watched, check_interrupt, interrupt_note
from wsrender.client.records import FINISHED, JobEvent, JobRecord
from wsrender.client.remote_files import RemoteFiles, result_document
from wsrender.client.remote_result import RemoteResult
from wsrender.errors import WsrenderError
from wsrender.keywords import keywords

__all__ = ["FINISHED", "Job"]


@keywords
class Job(JobFacts):
    """A job as the server last described it; ``refresh`` and ``wait`` ask again.

    ``record`` is the server's description: id, analysis, state, created_at, started_at, finished_at, labels,
    priority, attempt, progress, error.
    """

    def __init__(self, connection: Connection, record: JobRecord):
        self._connection = connection
        self.record = record

    def refresh(self) -> Self:
        """Ask the server for the job's state."""
        self.record = self._connection.run(operations.looked_at(self._connection.server, self.id))
        return self

    def wait(
        self, progress: bool = False, timeout: float | None = None, *, on_interrupt: OnInterrupt = "detach"
    ) -> Self:
        """Wait until the job has finished, whatever its final state; a restart of the server does not matter.

        ``progress`` shows a bar on standard error. Ctrl-C ends the wait and lets the job go on (a note of the
        KeyboardInterrupt says its id), or, with ``on_interrupt="cancel"``, stops it too. Raises WaitTimeoutError after
        ``timeout`` seconds, ServerConnectionError where the server stays away for ten minutes, InputError.
        """
        check_interrupt(on_interrupt)
        server = self._connection.server
        try:
            with Watched(progress) as shown:
                self.record = self._connection.run(
                    operations.ended(server, self.record, timeout, shown.report, shown.on_loss)
                )
        except KeyboardInterrupt as interrupt:
            interrupt.add_note(self._interrupted(on_interrupt))
            raise
        return self

    def _interrupted(self, on_interrupt: OnInterrupt) -> str:
        try:
            canceled = on_interrupt == "cancel" and self.cancel()
        except WsrenderError as error:
            return interrupt_note(self.id, error)
        return interrupt_note(self.id, bool(canceled))

    def result(self) -> RemoteResult:
        """The result, the same object as of a local run; waits for the job, downloads files when they are used.

        Raises what a local run would have raised, JobFailedError where the job was canceled, timed out or crashed.
        """
        if error := self.wait()._failure():
            raise error
        document = self._connection.run(result_document(self._connection.server, self.id))
        return RemoteResult(document, RemoteFiles(self._connection, self.id, document))

    def download(self, folder: str | Path, *, progress: bool = False) -> RemoteResult:
        """The result, with every file of it saved to a folder as a local run would have written it.

        ``progress`` shows a bar on standard error. A lost connection goes on where it was; if anything fails, nothing
        changes. Raises what ``result`` does, InputError, ServerError for a file that is damaged on its way.
        """
        result = self.result()
        with Watched(progress) as shown:
            self._connection.run(result.files.saved(folder, result.document, shown.on_bytes(result.files.bytes)))
        return result

    def cancel(self) -> Self:
        """Stop the job; its state becomes canceling, then canceled."""
        return self._changed("cancel")

    def retry(self) -> Self:
        """Queue a job again that failed, was canceled, timed out or has expired."""
        return self._changed("retry")

    def _changed(self, verb: str) -> Self:
        self.record = self._connection.run(operations.changed(self._connection.server, self.id, verb))
        return self

    def delete(self) -> None:
        """Remove the job and its files from the server."""
        self._connection.run(operations.deleted(self._connection.server, self.id))

    def events(self, after: str = "") -> Iterator[JobEvent]:
        """Everything that happened to the job, then what happens, until it has finished.

        Each event has id, type and data. ``after`` is the id of the last event already seen. Lost connections go
        on with the event after the last one.
        """
        server = self._connection.server
        pauses = server.pauses(operations.RECONNECT_S)
        while True:
            finished = self.refresh().finished  # asked first: then the stream lacks nothing
            try:
                with self._connection.stream(operations.events_of(self.id, after)) as response:
                    self._connection.run(operations.stream_checked(server, response))
                    for event in httpx2.EventSource(response):
                        pauses.again()
                        after = event.id or after
                        yield {"id": event.id, "type": event.event, "data": json.loads(event.data)}
            except httpx2.TransportError as error:
                time.sleep(pauses.after(error).seconds)
                continue
            if finished:
                return
            time.sleep(operations.SHORTEST_POLL_S)  # a stream ends with its job, but also with the server
