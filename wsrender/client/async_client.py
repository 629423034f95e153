"""A job server, as seen from Python's asyncio."""

from collections.abc import AsyncIterator, Mapping, Sequence
from pathlib import Path
from typing import Literal, Self

import httpx2

from wsrender.client import operations
from wsrender.client.async_batch import AsyncBatch
from wsrender.client.async_job import AsyncJob
from wsrender.client.connection import AsyncConnection
from wsrender.client.documents import uploaded
from wsrender.client.kinetostatic_stream import KinetostaticStream
from wsrender.client.records import Analysis, Estimate, JobDocument, JobState, LibraryRobot, Worker
from wsrender.keywords import keywords


@keywords
class AsyncClient:
    """As `Client`, for asyncio: the same names and parameters, awaited; ``async with`` and ``async for``."""

    def __init__(
        self,
        url: str = "http://127.0.0.1:8000",
        token: str | None = None,
        *,
        timeout_s: float = 30.0,
        patience_s: float = 60.0,
        transport: httpx2.AsyncBaseTransport | None = None,
    ):
        self._token = token
        self._connection = AsyncConnection(url, token, timeout_s, patience_s, transport)
        self._server = self._connection.server

    async def close(self) -> None:
        """As `Client.close`."""
        await self._connection.close()

    def __repr__(self) -> str:
        return f"AsyncClient({self._server.url!r})"

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    async def analyses(self) -> list[Analysis]:
        """As `Client.analyses`."""
        return await self._connection.run(operations.listed(self._server, "/v1/analyses"))

    async def robots(self) -> list[LibraryRobot]:
        """As `Client.robots`."""
        return await self._connection.run(operations.listed(self._server, "/v1/robots"))

    async def workers(self) -> list[Worker]:
        """As `Client.workers`."""
        return await self._connection.run(operations.listed(self._server, "/v1/workers"))

    async def upload_model(self, model: str | Path | bytes, field: str = "robot.path") -> str:
        """As `Client.upload_model`."""
        return await self._connection.run(uploaded(self._server, model, field))

    async def submit(
        self,
        job: JobDocument,
        *,
        labels: Mapping[str, str] | None = None,
        priority: int = 0,
        timeout_s: float | None = None,
        idempotency_key: str | None = None,
    ) -> AsyncJob:
        """As `Client.submit`."""
        steps = operations.submitted(self._server, job, labels, priority, timeout_s, idempotency_key)
        return AsyncJob(self._connection, await self._connection.run(steps))

    def batch(self, *, at_once: int = 8, cancel: bool = False) -> AsyncBatch:
        """As `Client.batch`; ``async with``, and its ``submit`` gives a task."""
        return AsyncBatch(self.submit, at_once, cancel)

    async def estimate(self, job: JobDocument) -> Estimate:
        """As `Client.estimate`."""
        return await self._connection.run(operations.estimated(self._server, job))

    async def job(self, id: str) -> AsyncJob:
        """As `Client.job`."""
        return AsyncJob(self._connection, await self._connection.run(operations.looked_at(self._server, id)))

    async def jobs(
        self,
        *,
        state: JobState | None = None,
        analysis: str | None = None,
        label: tuple[str, str] | None = None,
        robot: str | None = None,
        limit: int | None = None,
    ) -> AsyncIterator[AsyncJob]:
        """As `Client.jobs`."""
        page = operations.first_page(state, analysis, label, robot, limit)
        while page is not None:
            records, page = await self._connection.run(operations.page_of_jobs(self._server, page))
            for record in records:
                yield AsyncJob(self._connection, record)

    async def kinetostatic_stream(
        self,
        robot: str | Mapping[str, object],
        *,
        field: Mapping[str, object] | None = None,
        input: Literal["configuration", "pose"] | None = None,
        base: str | None = None,
        tip: str | None = None,
        start: Sequence[float] | None = None,
        cues: Mapping[str, object] | None = None,
        stale_after_s: float | None = None,
        rise_s: float | None = None,
    ) -> KinetostaticStream:
        """As `Client.kinetostatic_stream`. A device's loop is a thread of its own, in which the stream is opened."""
        chosen = {"field": field, "input": input, "base": base, "tip": tip, "start": start, "cues": cues}
        steps = operations.stream_document(
            self._server, robot, {**chosen, "stale_after_s": stale_after_s, "rise_s": rise_s}
        )
        document = await self._connection.run(steps)
        return KinetostaticStream(self._server.url, self._token, document, self._server.timeout_s)
