"""The one process of a worker in which kernels run: persistent, watched, and killed where it must end."""

import errno
import multiprocessing
import os
import signal
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import CancelledError, TimeoutError
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.sharedctypes import RawArray
from typing import Any

from pebble import ProcessExpired, ProcessPool

from wsrender.errors import DocumentError, InputError, WsrenderError
from wsrender_server.jobs import steps
from wsrender_server.jobs.child_process import kill, resident_bytes
from wsrender_server.jobs.files import FULL
from wsrender_server.jobs.task import Outcome, Task, Verdict, error
from wsrender_server.settings import Settings

LOOK_S = 0.05
REPORT_S = 0.4
REMEMBERED_TOKENS = 1000
KILLED = -9  # exit code of a process that was killed


class KernelProcess:
    """Runs one task at a time in a spawned process.

    A native crash, too much memory or a kill ends that process and its task only; the next task gets a new one.
    """

    def __init__(self, settings: Settings):
        self._limit = settings.max_memory_bytes
        self._gauges = RawArray("q", 3)
        threads = settings.threads_per_worker or max(1, _cores() // max(1, settings.workers))
        self._start = (settings, threads, self._gauges)
        self._pool: ProcessPool | None = None
        self.closed = False
        self._lock = threading.Lock()
        self._token: str | None = None
        self._stopped: OrderedDict[str, None] = OrderedDict()

    @property
    def pid(self) -> int | None:
        """The process, None where it has not started."""
        return self._gauges[0] or None

    @property
    def busy(self) -> bool:
        """Whether a task runs."""
        return self._token is not None

    def describe(self) -> dict[str, str]:
        """Start the process; the target of each kind of device (see `steps.describe`)."""
        return self._ready().schedule(steps.describe).result()

    def run(self, task: Task, report: Callable[[int, int], None]) -> Outcome:
        """Run a task to its end; ``report`` gets the gauges (see `steps.start`) a few times a second. Never raises."""
        with self._lock:
            if task.token in self._stopped:
                return Outcome(Verdict.STOPPED)
            self._token = task.token
        try:
            future = self._ready().schedule(steps.run, args=[task])
            return self._watched(task, future, report)
        except (BrokenProcessPool, RuntimeError) as fault:
            self._discard()
            return Outcome(Verdict.LOST, error=error("worker_lost", f"the kernel process did not start: {fault}"))
        finally:
            self._token = None

    def stop(self, token: str) -> None:
        """Kill the process if it works on an attempt; none of the attempt's tasks will start here any more."""
        with self._lock:
            self._stopped[token] = None
            while len(self._stopped) > REMEMBERED_TOKENS:
                self._stopped.popitem(last=False)
            if self._token == token:
                kill(self.pid)

    def close(self) -> None:
        """End the process for good; a task that runs in it is lost."""
        self.closed = True
        kill(self.pid)
        self._discard()

    def _ready(self) -> ProcessPool:
        if self.closed:
            raise RuntimeError("the worker ends")
        if self._pool is None or not self._pool.active:
            self._discard()
            self._pool = ProcessPool(
                max_workers=1,
                initializer=steps.start,
                initargs=self._start,
                context=multiprocessing.get_context("spawn"),
            )
        return self._pool

    def _watched(self, task: Task, future: Any, report: Callable[[int, int], None]) -> Outcome:
        reported = time.monotonic()
        too_much = False
        while True:
            try:
                return Outcome(Verdict.DONE, future.result(timeout=LOOK_S))
            except TimeoutError:
                if self.closed:  # a pool that was stopped leaves its futures as they were
                    return Outcome(Verdict.LOST, error=error("worker_lost", "the worker ended", retryable=True))
                if task.token in self._stopped:
                    kill(self.pid)  # again: the process may have been starting when the stop came
                    if self.pid is None:
                        future.cancel()
                if resident_bytes(self.pid) > self._limit:
                    too_much = True
                    kill(self.pid)
                if time.monotonic() - reported > REPORT_S:
                    reported = time.monotonic()
                    report(self._gauges[1], self._gauges[2])
            except (ProcessExpired, BrokenProcessPool, CancelledError) as fault:
                self._discard()
                return self._death(task, getattr(fault, "exitcode", None), too_much)
            except BaseException as fault:
                return outcome_of_exception(fault)

    def _death(self, task: Task, exit_code: int | None, too_much: bool) -> Outcome:
        if task.token in self._stopped:
            return Outcome(Verdict.STOPPED)
        if too_much:
            allowed = f"{self._limit / 2**30:.3g} GiB"
            message = f"the job took more memory than the {allowed} allowed; choose larger voxels or keep no map"
            return Outcome(Verdict.FAILED, error=error("out_of_memory", message))
        if exit_code is None or exit_code == KILLED:
            # Killed from outside: by an administrator, or by a system short of memory.
            return Outcome(Verdict.LOST, error=error("worker_lost", "the kernel process was killed", retryable=True))
        name = signal.Signals(-exit_code).name if exit_code < 0 else f"exit code {exit_code}"
        message = f"the kernel process crashed ({name}); other jobs are not affected"
        return Outcome(Verdict.FAILED, error=error("kernel_crash", message))

    def _discard(self) -> None:
        """Forget the pool: a process killed in the middle may have left its pipes locked."""
        pool, self._pool = self._pool, None
        self._gauges[0] = 0
        if pool is not None:
            pool.stop()
            pool.join()


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)


def outcome_of_exception(fault: BaseException) -> Outcome:
    """An exception of a step as an outcome."""
    if isinstance(fault, steps.DamagedPartialError):
        return Outcome(Verdict.LOST, error=error("partial_damaged", str(fault), retryable=True))
    if isinstance(fault, DocumentError):
        problems = [{"field": field, "message": message} for field, message in fault.problems]
        return Outcome(Verdict.FAILED, error=error(fault.code, str(fault), field=fault.field, problems=problems))
    if isinstance(fault, InputError):
        return Outcome(Verdict.FAILED, error=error(fault.code, fault.message, field=fault.field))
    if isinstance(fault, WsrenderError):
        return Outcome(Verdict.FAILED, error=error(fault.code, str(fault)))
    if isinstance(fault, MemoryError):
        return Outcome(Verdict.FAILED, error=error("out_of_memory", "the job needs more memory than there is"))
    if isinstance(fault, OSError) and (fault.errno in FULL or os.strerror(errno.ENOSPC) in str(fault)):
        message = "the server's disk is full; nothing computed so far is lost, retry the job later"
        return Outcome(Verdict.FAILED, error=error("disk_full", message, retryable=True))
    # What went wrong belongs into the server's log, not into an answer.
    message = f"internal error ({type(fault).__name__}); the server's log says more"
    return Outcome(Verdict.FAILED, value=repr(fault), error=error("internal_error", message))
