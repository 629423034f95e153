"""Interactive sessions of pages, as the process that answers sees them: as many as the settings allow, each watched."""

import asyncio
import contextlib
import multiprocessing
import socket
import struct
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

from starlette.concurrency import run_in_threadpool

from wsrender_server.jobs.child_process import resident_bytes
from wsrender_server.problems import HttpProblem
from wsrender_server.settings import Settings

MOST_UNREAD = 1 << 16  # bytes of questions that a process does not take in before it counts as hung
LOOK_S = 0.5  # at the memory of a process
END_S = 1.0  # for a process to end by itself


class ViewSession:
    """The link to the process of a session."""

    def __init__(self, process: BaseProcess, reader: asyncio.StreamReader, writer: asyncio.StreamWriter):
        self.process = process
        self.too_large = False
        self._reader, self._writer = reader, writer

    def send(self, question: bytes) -> bool:
        """Pass a question on; False where the process does not take them."""
        if self._writer.transport.get_write_buffer_size() > MOST_UNREAD:
            return False
        self._writer.write(struct.pack("<I", len(question)) + question)
        return True

    async def received(self) -> bytes | None:
        """The next message; None at the end."""
        try:
            (length,) = struct.unpack("<I", await self._reader.readexactly(4))
            return await self._reader.readexactly(length)
        except (asyncio.IncompleteReadError, ConnectionError):
            return None

    def close(self) -> None:
        """Close the link: the process ends."""
        self._writer.close()

    async def watch(self, most_bytes: int) -> None:
        """Kill the process where it takes too much memory."""
        while True:
            await asyncio.sleep(LOOK_S)
            if resident_bytes(self.process.pid) > most_bytes:
                self.too_large = True
                self.process.kill()
                return


class ViewSessions:
    """The interactive sessions of a server."""

    def __init__(self, settings: Settings, models: Path):
        self._settings, self._models = settings, models
        self._owners: list[str] = []
        self._processes: set[BaseProcess] = set()

    @asynccontextmanager
    async def session(self, owner: str, subject: Mapping[str, Any]) -> AsyncIterator[ViewSession]:
        """A session about a ``subject`` (see `view_process`). Raises HttpProblem 429 where there are many."""
        self._check_room(owner)
        self._owners.append(owner)
        try:
            process, link = await run_in_threadpool(self._started, subject)
            session = ViewSession(process, *await asyncio.open_connection(sock=link))
            watching = asyncio.create_task(session.watch(self._settings.max_view_session_memory_bytes))
            try:
                yield session
            finally:
                watching.cancel()
                session.close()
                await run_in_threadpool(self._ended, process)
        finally:
            self._owners.remove(owner)

    def close(self) -> None:
        """End all sessions."""
        for process in list(self._processes):
            self._ended(process, 0.0)

    def _check_room(self, owner: str) -> None:
        settings, own = self._settings, self._owners.count(owner)
        if own >= settings.max_view_sessions_per_owner:
            detail = f"you have {own} interactive sessions; more are not allowed"
            raise HttpProblem(429, detail, "too_many_sessions", retryable=True)
        if len(self._owners) >= settings.max_view_sessions:
            detail = f"the server has {len(self._owners)} interactive sessions; no more"
            raise HttpProblem(429, detail, "too_many_sessions", retryable=True)

    def _started(self, subject: Mapping[str, Any]) -> tuple[BaseProcess, socket.socket]:
        here, there = socket.socketpair()
        context = multiprocessing.get_context("spawn")
        arguments = (there, subject, self._models, self._settings.threads_per_worker)
        process = context.Process(target=_run_session, args=arguments, daemon=True)
        try:
            process.start()
        finally:
            there.close()
        self._processes.add(process)
        here.setblocking(False)
        return process, here

    def _ended(self, process: BaseProcess, patience_s: float = END_S) -> None:
        process.join(patience_s)
        if process.is_alive():
            process.kill()
            process.join()
        self._processes.discard(process)
        with contextlib.suppress(ValueError):  # closed before
            process.close()


def _run_session(link: socket.socket, subject: Mapping[str, Any], models: Path, threads: int | None) -> None:
    """What a process does; what it needs is imported there, not by the server."""
    from wsrender_server.streams.view_process import run_session

    run_session(link, subject, models, threads)
