"""One job on a server, for asyncio."""

import asyncio
import json
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Self

import httpx2

from wsrender.client import operations
from wsrender.client.connection import AsyncConnection
from wsrender.client.job_facts import JobFacts, OnInterrupt, Watched, check_interrupt, interrupt_note
from wsrender.client.records import JobEvent, JobRecord
from wsrender.client.remote_files import RemoteFiles, result_document
from wsrender.client.remote_result import RemoteResult
from wsrender.errors import WsrenderError
from wsrender.keywords import keywords


@keywords
class AsyncJob(JobFacts):
    """As `Job`, its methods awaited."""

    def __init__(self, connection: AsyncConnection, record: JobRecord):
        self._connection = connection
        self.record = record

    async def refresh(self) -> Self:
        """As `Job.refresh`."""
        self.record = await self._connection.run(operations.looked_at(self._connection.server, self.id))
        return self

    async def wait(
        self, progress: bool = False, timeout: float | None = None, *, on_interrupt: OnInterrupt = "detach"
    ) -> Self:
        """As `Job.wait`; what is said of Ctrl-C holds for every cancellation of the task that waits."""
        check_interrupt(on_interrupt)
        server = self._connection.server
        try:
            with Watched(progress) as shown:
                self.record = await self._connection.run(
                    operations.ended(server, self.record, timeout, shown.report, shown.on_loss)
                )
        except (KeyboardInterrupt, asyncio.CancelledError) as interrupt:
            interrupt.add_note(await self._interrupted(on_interrupt))
            raise
        return self

    async def _interrupted(self, on_interrupt: OnInterrupt) -> str:
        try:
            canceled = on_interrupt == "cancel" and await self.cancel()
        except WsrenderError as error:
            return interrupt_note(self.id, error)
        return interrupt_note(self.id, bool(canceled))

    async def result(self) -> RemoteResult:
        """As `Job.result`. Files that are downloaded when they are used hold up the loop: `download` does not."""
        if error := (await self.wait())._failure():
            raise error
        document = await self._connection.run(result_document(self._connection.server, self.id))
        return RemoteResult(document, RemoteFiles(self._connection.waiting(), self.id, document))

    async def download(self, folder: str | Path, *, progress: bool = False) -> RemoteResult:
        """As `Job.download`."""
        result = await self.result()
        with Watched(progress) as shown:
            await self._connection.run(result.files.saved(folder, result.document, shown.on_bytes(result.files.bytes)))
        return result

    async def cancel(self) -> Self:
        """As `Job.cancel`."""
        return await self._changed("cancel")

    async def retry(self) -> Self:
        """As `Job.retry`."""
        return await self._changed("retry")

    async def _changed(self, verb: str) -> Self:
        self.record = await self._connection.run(operations.changed(self._connection.server, self.id, verb))
        return self

    async def delete(self) -> None:
        """As `Job.delete`."""
        await self._connection.run(operations.deleted(self._connection.server, self.id))

    async def events(self, after: str = "") -> AsyncIterator[JobEvent]:
        """As `Job.events`."""
        server = self._connection.server
        pauses = server.pauses(operations.RECONNECT_S)
        while True:
            finished = (await self.refresh()).finished  # asked first: then the stream lacks nothing
            try:
                async with self._connection.stream(operations.events_of(self.id, after)) as response:
                    await self._connection.run(operations.stream_checked(server, response))
                    async for event in httpx2.EventSource(response):
                        pauses.again()
                        after = event.id or after
                        yield {"id": event.id, "type": event.event, "data": json.loads(event.data)}
            except httpx2.TransportError as error:
                await asyncio.sleep(pauses.after(error).seconds)
                continue
            if finished:
                return
            await asyncio.sleep(operations.SHORTEST_POLL_S)  # a stream ends with its job, but also with the server
