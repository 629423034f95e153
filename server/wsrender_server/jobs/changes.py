"""Who follows a job, and who tells them: threads notify, coroutines read and wait."""

import asyncio
import threading
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from typing import Any


class Changes:
    """Wakes the coroutines that follow a job, from any thread of this process.

    ``listener()`` is called at every change, in the thread that makes it.
    """

    def __init__(self):
        self.listener: Callable[[], None] = lambda: None
        self._lock = threading.Lock()
        self._watches: dict[tuple[str, asyncio.AbstractEventLoop], Watch] = {}
        self.closed = False

    def close(self) -> None:
        """Wake everyone: the server stops, and nobody shall wait any more."""
        self.closed = True
        with self._lock:
            jobs = {job for job, _ in self._watches}
        self.notify(*jobs)

    def notify(self, *jobs: str) -> None:
        """Wake everyone who follows one of these jobs."""
        with self._lock:
            watches = [watch for (job, _), watch in self._watches.items() if job in jobs]
        self.listener()
        for watch in watches:
            if not watch.loop.is_closed():
                watch.loop.call_soon_threadsafe(watch.changed)

    @contextmanager
    def watch(self, job: str) -> Iterator["Watch"]:
        """Follow a job within a coroutine; what happens from now on is not missed."""
        key = (job, asyncio.get_running_loop())
        with self._lock:
            watch = self._watches.setdefault(key, Watch(key[1]))
            watch.followers += 1
        try:
            yield watch
        finally:
            with self._lock:
                watch.followers -= 1
                if not watch.followers:
                    del self._watches[key]


class Watch:
    """A job as the coroutines of one event loop follow it: what one of them has read, all of them know."""

    def __init__(self, loop: asyncio.AbstractEventLoop):
        self.loop = loop
        self.followers = 0
        self._news = asyncio.Event()
        self._read: dict[Hashable, asyncio.Task[Any]] = {}

    def changed(self) -> None:
        """What was read is old; wake everyone."""
        self._read.clear()
        self._news.set()
        self._news = asyncio.Event()

    async def read(self, key: Hashable, function: Callable[[], Any]) -> tuple[Any, asyncio.Event]:
        """What ``function()`` returns, called in a thread, and what is set when that is old.

        Equal keys share one call until the job changes.
        """
        news = self._news
        task = self._read.get(key)
        if task is None:
            task = self._read[key] = asyncio.create_task(asyncio.to_thread(function))
            task.add_done_callback(lambda done: self._forget_fault(key, done))
        return await asyncio.shield(task), news

    async def wait(self, news: asyncio.Event, timeout_s: float) -> bool:
        """Wait until what was read with ``news`` is old; at the timeout it is taken to be, and False returned."""
        try:
            async with asyncio.timeout(timeout_s):
                await news.wait()
        except TimeoutError:
            self._read.clear()
            return False
        return True

    def _forget_fault(self, key: Hashable, task: asyncio.Task[Any]) -> None:
        """A database that did not answer is asked again by whoever reads next."""
        if (task.cancelled() or task.exception()) and self._read.get(key) is task:
            del self._read[key]
