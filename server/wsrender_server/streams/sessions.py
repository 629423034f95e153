"""Sessions of live streams, as the process that answers sees them, and how fast their messages come."""

import asyncio
import contextlib
import multiprocessing
import socket
import time
from collections import deque
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from multiprocessing.process import BaseProcess
from pathlib import Path

from starlette.concurrency import run_in_threadpool

from wsrender_server.problems import HttpProblem
from wsrender_server.settings import Settings
from wsrender_server.streams.scheduling import calm_down, hurry

MOST_UNREAD = 1 << 16  # bytes that the loop does not take before it counts as hung
END_S = 2.0  # for a loop to end by itself
FORCE = b'{"type":"force"'


class MessageRate:
    """Counts the messages of every second [s], of which ``most`` are allowed."""

    def __init__(self, most: int):
        self._most = most
        self._second = self._count = 0

    def exceeded(self, now: float) -> bool:
        """Take in a message at a time [s]; whether it is one too many."""
        if int(now) != self._second:
            self._second, self._count = int(now), 0
        self._count += 1
        return self._count > self._most


class Session(asyncio.Protocol):
    """The link to one loop: lines to it, and what it answers, of which only the newest force counts."""

    def __init__(self, process: BaseProcess):
        self.process = process
        self._transport: asyncio.Transport | None = None
        self._rest = b""
        self._others: deque[bytes] = deque()
        self._force: bytes | None = None
        self._news = asyncio.Event()
        self.ended = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """The link is open (asyncio)."""
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport

    def data_received(self, data: bytes) -> None:
        """Lines have come (asyncio)."""
        *lines, self._rest = (self._rest + data).split(b"\n")
        for line in lines:
            if line.startswith(FORCE):
                self._force = line
            else:
                self._others.append(line)
        self._news.set()

    def connection_lost(self, exc: Exception | None) -> None:
        """The loop is gone (asyncio)."""
        self.ended = True
        self._news.set()

    def send(self, message: bytes) -> bool:
        """Pass a client's message on, with its time of arrival; False where the loop does not take them."""
        assert self._transport is not None
        if self.ended or self._transport.get_write_buffer_size() > MOST_UNREAD:
            return False
        self._transport.write(b"%d %b\n" % (time.perf_counter_ns(), message.replace(b"\n", b" ")))
        return True

    async def received(self) -> list[bytes]:
        """What has come since the last call: messages in their order, then the newest force; none at the end."""
        while not (self._others or self._force) and not self.ended:
            self._news.clear()
            await self._news.wait()
        lines = list(self._others) + ([self._force] if self._force else [])
        self._others.clear()
        self._force = None
        return lines

    def close(self) -> None:
        """Close the link: the loop ends."""
        if self._transport is not None:
            self._transport.close()


class Streams:
    """The sessions of a server, as many as its settings allow."""

    def __init__(self, settings: Settings, models: Path):
        self._settings, self._models = settings, models
        self._owners: list[str] = []
        self._processes: set[BaseProcess] = set()

    @asynccontextmanager
    async def session(self, owner: str, document: str) -> AsyncIterator[Session]:
        """A session of a `StreamOpen` document with a loop of its own. Raises HttpProblem 429 where there are many."""
        self._check_room(owner)
        self._owners.append(owner)
        hurry()  # for as long as there are messages to be passed on
        try:
            process, link = await run_in_threadpool(self._started, document)
            loop = asyncio.get_running_loop()
            _, session = await loop.create_connection(lambda: Session(process), sock=link)
            try:
                yield session
            finally:
                session.close()
                await run_in_threadpool(self._ended, process)
        finally:
            self._owners.remove(owner)
            if not self._owners:
                calm_down()

    def close(self) -> None:
        """End all loops."""
        for process in list(self._processes):
            self._ended(process, 0.0)

    def _check_room(self, owner: str) -> None:
        settings = self._settings
        if self._owners.count(owner) >= settings.max_streams_per_owner:
            detail = f"you have {self._owners.count(owner)} live streams; more are not allowed"
            raise HttpProblem(429, detail, "too_many_streams", retryable=True)
        if len(self._owners) >= settings.max_streams:
            raise HttpProblem(
                429, f"the server has {len(self._owners)} live streams; no more", "too_many_streams", True
            )

    def _started(self, document: str) -> tuple[BaseProcess, socket.socket]:
        here, there = socket.socketpair()
        context = multiprocessing.get_context("spawn")
        process = context.Process(target=_run_loop, args=(there, document, self._models), daemon=True)
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


def _run_loop(link: socket.socket, document: str, models: Path) -> None:
    """What a process does; what it needs is imported there, not by the server."""
    from wsrender_server.streams.loop_process import run_loop

    run_loop(link, document, models)
