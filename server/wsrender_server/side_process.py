"""A child process for heavy work on behalf of requests: plans, with what a job would take, conversions, pictures.

It keeps native code that reads strangers' models, and long holds of Python's lock, away from the process that answers.
"""

import asyncio
import json
import multiprocessing
import os
import threading
from collections import Counter
from collections.abc import Callable, Iterable
from concurrent.futures import TimeoutError as FutureTimeoutError
from functools import partial
from multiprocessing.sharedctypes import RawArray
from pathlib import Path
from typing import Any
from weakref import WeakValueDictionary

from pebble import ProcessExpired, ProcessFuture, ProcessPool

from wsrender.errors import WsrenderError
from wsrender.robots.uploaded import MODELS_VARIABLE
from wsrender_server.jobs.child_process import how_it_ended, resident_bytes, settle_in
from wsrender_server.problems import HttpProblem, problem_of_error, refusal

MOST_WAITING = 32  # of an owner, for a side process
MOST_WAITING_OF_OWNER = 16  # for plans
LOOK_S = 0.1
TASKS_PER_CHILD = 200  # what Python and native libraries do not give back goes with the child
PATIENCE_S = 50.0  # the first plan of a kind of robot compiles kernels; many proxies give up after 60
TIMEOUT_S = 180.0
MOST_KEPT = 64

Estimated = dict[str, float | None]


class SideProcess:
    """Runs module-level functions one after another in a child that is started when first needed; owners take turns.

    A function that crashes, is too slow, or takes more than ``max_memory_bytes`` costs its own request only. It finds
    uploaded models in the folder ``models``. Close it with ``close``.
    """

    def __init__(self, max_memory_bytes: int, models: Path):
        self._max_memory_bytes = max_memory_bytes
        self._models = models
        self._pid = RawArray("q", 1)
        self._pool: ProcessPool | None = None
        self._lock = threading.Lock()
        self._waiting: Counter[str] = Counter()
        self._turns: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()

    async def run(self, function: Callable[..., Any], *arguments: Any, owner: str = "", timeout_s: float = 60.0) -> Any:
        """What ``function(*arguments)`` returns; arguments and value are pickled.

        Raises HttpProblem 409 for the function's own errors (the request kept to its schema) and for one that costs too
        much, 429 where many of the owner's wait: however many these are, others are answered after one of them.
        """
        if self._waiting[owner] >= MOST_WAITING:
            raise HttpProblem(429, "too many of your requests of this kind are waiting", "busy", retryable=True)
        self._waiting[owner] += 1
        try:
            async with self._turns.setdefault(owner, asyncio.Lock()):
                return await self._result(function, arguments, timeout_s)
        finally:
            self._waiting -= Counter([owner])

    async def _result(self, function: Callable[..., Any], arguments: tuple[Any, ...], timeout_s: float) -> Any:
        try:
            future = self._open_pool().schedule(_guarded, args=(function, arguments), timeout=timeout_s)
            value, problem = await self._watched(future)
        except FutureTimeoutError as error:
            raise HttpProblem(409, f"took longer than {timeout_s:g} s", "too_slow") from error
        except ProcessExpired as error:
            how = how_it_ended(error.exitcode)
            raise HttpProblem(409, f"the process that worked on this request crashed ({how})", "crashed") from error
        if problem is not None:
            raise refusal(problem, 409 if problem["status"] == 422 else problem["status"])
        return value

    async def _watched(self, future: ProcessFuture) -> Any:
        """The result of a future; what runs for it is killed if this ends before."""
        answer = asyncio.wrap_future(future)
        try:
            while not answer.done():
                await asyncio.wait({answer}, timeout=LOOK_S)
                if future.running() and resident_bytes(self._pid[0] or None) > self._max_memory_bytes:
                    allowed = f"{self._max_memory_bytes / 2**30:.3g} GiB"
                    raise HttpProblem(409, f"took more memory than the {allowed} allowed", "out_of_memory")
            return answer.result()
        finally:
            answer.cancel()

    def close(self) -> None:
        """Stop the child."""
        with self._lock:
            if self._pool is not None:
                self._pool.stop()
                self._pool.join()
                self._pool = None

    def _open_pool(self) -> ProcessPool:
        with self._lock:
            if self._pool is None or not self._pool.active:
                context = multiprocessing.get_context("spawn")
                self._pool = ProcessPool(
                    max_workers=1,
                    max_tasks=TASKS_PER_CHILD,
                    initializer=_start,
                    initargs=(self._pid, self._models),
                    context=context,
                )
            return self._pool


def _start(pid: Any, models: Path) -> None:
    settle_in()
    os.environ[MODELS_VARIABLE] = str(models)
    pid[0] = os.getpid()


def _guarded(function: Callable[..., Any], arguments: tuple[Any, ...]) -> tuple[Any, dict[str, Any] | None]:
    """(value, None) or (None, problem): exceptions of wsrender do not survive pickling."""
    try:
        return function(*arguments), None
    except WsrenderError as error:
        return None, problem_of_error(error)


class Estimates:
    """Plans documents; what takes longer than a request should goes on, and answers when it is asked for again.

    An owner has one of the ``processes`` at a time, and owners have them in turn: whatever one of them asks for, others
    are answered.
    """

    def __init__(self, processes: Iterable[SideProcess], longest_s: float):
        self._processes = tuple(processes)
        self._longest_s = longest_s
        self._idle: asyncio.LifoQueue[SideProcess] = asyncio.LifoQueue()  # one that has worked is warm
        for process in reversed(self._processes):
            self._idle.put_nowait(process)
        self._turns: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()
        self._waiting: Counter[str] = Counter()
        self._tasks: dict[tuple[str, str], asyncio.Task[Estimated]] = {}

    async def of(self, owner: str, sha256: str, document: str) -> Estimated:
        """Samples, bytes and seconds of the text of a canonical document of an owner's, with its hash.

        Raises HttpProblem 409 for whatever planning refuses, and, retryable, while planning goes on; 429 where many of
        the owner's wait.
        """
        key = owner, sha256
        task = self._tasks.get(key)
        if task is None:
            if self._waiting[owner] >= MOST_WAITING_OF_OWNER:
                raise HttpProblem(429, "too many of your jobs wait to be planned", "busy", retryable=True)
            self._waiting[owner] += 1
            task = self._tasks[key] = asyncio.create_task(self._planned(owner, document))
            task.add_done_callback(partial(self._ended, owner))
            for old in list(self._tasks)[:-MOST_KEPT]:
                del self._tasks[old]
        await asyncio.wait({task}, timeout=PATIENCE_S)
        if not task.done():
            detail = "the job is being planned, which takes longer the first time; ask again"
            raise HttpProblem(409, detail, "planning", retryable=True)
        self._tasks.pop(key, None)
        return task.result()

    async def _planned(self, owner: str, document: str) -> Estimated:
        async with self._turns.setdefault(owner, asyncio.Lock()):
            process = await self._idle.get()  # first come, first served, and of an owner one comes at a time
            try:
                return await process.run(planned, document, timeout_s=min(self._longest_s, TIMEOUT_S))
            finally:
                self._idle.put_nowait(process)

    def _ended(self, owner: str, task: asyncio.Task[Estimated]) -> None:
        self._waiting -= Counter([owner])
        if not task.cancelled():
            task.exception()  # nobody may ask again

    def close(self) -> None:
        """Stop the processes."""
        for process in self._processes:
            process.close()


def planned(document: str) -> Estimated:
    """The estimate of a plan; None for what the analysis does not estimate. Raises what planning raises."""
    from wsrender.run import plan

    found = plan(json.loads(document))  # which may be longer than what a body may have
    return {"samples": float(found.samples), "bytes": None, "seconds": None} | found.estimate
