"""Many jobs at once, for asyncio."""

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from typing import Self

from wsrender.client.async_job import AsyncJob
from wsrender.client.batch import check_at_once, failures, place_noted
from wsrender.client.records import JobDocument
from wsrender.client.remote_result import RemoteResult
from wsrender.errors import WsrenderError
from wsrender.keywords import keywords


@keywords
class AsyncBatch:
    """As `Batch`, for asyncio; made by `AsyncClient.batch`. What a cancellation does is what is said of Ctrl-C."""

    def __init__(self, submit: Callable[..., Awaitable[AsyncJob]], at_once: int, cancel: bool):
        check_at_once(at_once)
        self._submit, self._cancel = submit, cancel
        self._free = asyncio.Semaphore(at_once)
        self._tasks: list[asyncio.Task[RemoteResult]] = []

    def submit(
        self,
        job: JobDocument,
        *,
        labels: Mapping[str, str] | None = None,
        priority: int = 0,
        timeout_s: float | None = None,
        idempotency_key: str | None = None,
    ) -> asyncio.Task[RemoteResult]:
        """As `Batch.submit`: a task, whose result is the job's."""
        asked = {"labels": labels, "priority": priority, "timeout_s": timeout_s, "idempotency_key": idempotency_key}
        task = asyncio.create_task(self._run(len(self._tasks), job, asked))
        self._tasks.append(task)
        return task

    def __repr__(self) -> str:
        ended = sum(each.done() for each in self._tasks)
        return f"<AsyncBatch: {ended} of {len(self._tasks)} jobs have ended>"

    @property
    def errors(self) -> dict[int, BaseException]:
        """As `Batch.errors`."""
        ended = {k: each for k, each in enumerate(self._tasks) if each.done() and not each.cancelled()}
        return {k: error for k, each in ended.items() if (error := each.exception())}

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, kind: type[BaseException] | None, *_: object) -> None:
        try:
            if kind is None and self._tasks:
                await asyncio.wait(self._tasks)
        finally:  # where they have not all ended, the block or this wait was interrupted
            for task in self._tasks:
                task.cancel()
            await asyncio.gather(*self._tasks, return_exceptions=True)
        if kind is None:
            failures(self.errors, len(self._tasks))

    async def _run(self, place: int, document: JobDocument, asked: dict[str, object]) -> RemoteResult:
        with place_noted(place) as noted:
            async with self._free:
                job = await self._submitted(document, asked)
                noted.append(job.id)
                await job.wait(on_interrupt="cancel" if self._cancel else "detach")
                return await job.result()

    async def _submitted(self, document: JobDocument, asked: dict[str, object]) -> AsyncJob:
        """The job; one that is on its way when the task is canceled is not left behind."""
        submission = asyncio.ensure_future(self._submit(document, **asked))
        try:
            return await asyncio.shield(submission)
        except asyncio.CancelledError:
            with suppress(WsrenderError):
                job = await submission
                if self._cancel:
                    await job.cancel()
            raise
