"""Who waits for a change of a job, and who tells them: threads notify, coroutines wait."""

import asyncio
import threading
from collections.abc import Callable


class Changes:
    """Wakes the coroutines that wait for a job, from any thread of this process."""

    def __init__(self):
        self._lock = threading.Lock()
        self._waiting: dict[str, set[tuple[asyncio.AbstractEventLoop, asyncio.Event]]] = {}

    def notify(self, *jobs: str) -> None:
        """Wake everyone who waits for one of these jobs."""
        with self._lock:
            woken = [waiter for job in jobs for waiter in self._waiting.get(job, ())]
        for loop, event in woken:
            if not loop.is_closed():
                loop.call_soon_threadsafe(event.set)

    async def wait(self, job: str, changed: Callable[[], bool], timeout_s: float) -> bool:
        """Wait until ``changed()``, asked in a thread after each notification, holds; False at the timeout."""
        loop = asyncio.get_running_loop()
        waiter = (loop, asyncio.Event())
        ends = loop.time() + timeout_s
        with self._lock:
            self._waiting.setdefault(job, set()).add(waiter)
        try:
            while not await asyncio.to_thread(changed):
                try:
                    await asyncio.wait_for(waiter[1].wait(), ends - loop.time())
                except TimeoutError:
                    return False
                waiter[1].clear()
            return True
        finally:
            self._forget(job, waiter)

    def _forget(self, job: str, waiter: tuple[asyncio.AbstractEventLoop, asyncio.Event]) -> None:
        with self._lock:
            waiters = self._waiting[job]
            waiters.discard(waiter)
            if not waiters:
                del self._waiting[job]
