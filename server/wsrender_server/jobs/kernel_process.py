"""The process of a worker in which kernels run: persistent, watched, and killed where it must end; a spare waits."""

import multiprocessing
import os
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import CancelledError, TimeoutError, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from multiprocessing.sharedctypes import RawArray
from typing import Any

from pebble import ProcessExpired, ProcessPool

from wsrender.errors import DocumentError, InputError, WsrenderError
from wsrender_server.jobs import steps
from wsrender_server.jobs.child_process import how_it_ended, kill, resident_bytes
from wsrender_server.jobs.files import is_full
from wsrender_server.jobs.task import Outcome, Step, Task, TaskLimits, Verdict, error
from wsrender_server.settings import Settings

LOOK_S = 0.05
REPORT_S = 0.4
SPARE_AFTER_S = 2.0  # what takes less costs little to do again, and most servers of tests never do more
REMEMBERED_TOKENS = 1000
KILLED = -9  # exit code of a process that was killed
LOST_AT_START = (ProcessExpired, BrokenProcessPool, CancelledError, RuntimeError)


class _Child:
    """A spawned process that dies with the task it is killed in; ``ready`` is what it does first."""

    def __init__(self, settings: Settings, threads: int, first: Callable[[], Any]):
        self.gauges = RawArray("q", 3)
        self.pool = ProcessPool(
            max_workers=1,
            initializer=steps.start,
            initargs=(settings, threads, self.gauges),
            context=multiprocessing.get_context("spawn"),
        )
        self.ready = self.pool.schedule(first)

    @property
    def pid(self) -> int | None:
        """The process, None where it has not started."""
        return self.gauges[0] or None

    def close(self) -> None:
        """End it; a process killed in the middle may have left its pipes locked."""
        kill(self.pid)
        self.pool.stop()
        self.pool.join()


class _Guard:
    """What a task may take of a process, and whether it has taken more."""

    def __init__(self, task: Task, child: _Child):
        assert task.limits is not None
        self._child, self._limits, self._plans = child, task.limits, task.step == Step.PLAN
        self._began = time.monotonic()
        self._memory = task.limits.memory_bytes
        if self._plans:  # beside what the process holds of earlier tasks
            held = resident_bytes(child.pid)
            self._memory = min(self._memory, held + task.limits.planning_memory_bytes)

    def found(self) -> dict[str, Any] | None:
        """The error of a task that has taken too much; None while it has not."""
        if resident_bytes(self._child.pid) > self._memory:
            if self._memory < self._limits.memory_bytes:
                allowed = f"{self._limits.planning_memory_bytes / 2**30:.3g} GiB allowed for it; simplify the robot"
                return error("out_of_memory", f"planning the job took more memory than the {allowed}")
            allowed = f"{self._limits.memory_bytes / 2**30:.3g} GiB allowed; choose larger voxels or keep no map"
            return error("out_of_memory", f"the job took more memory than the {allowed}")
        if self._plans and time.monotonic() - self._began > self._limits.planning_s:
            allowed = f"{self._limits.planning_s:g} s allowed for it; simplify the robot"
            return error("too_slow", f"planning the job took longer than the {allowed}")
        return None


class KernelProcess:
    """Runs one task at a time in a spawned process.

    A native crash, too much memory or a kill ends that process and its task only; the next task gets another, which
    waits warm once a task has taken long.
    """

    def __init__(self, settings: Settings):
        self._settings = settings
        self._limits = TaskLimits.of(settings)
        self._threads = settings.threads_per_worker or max(1, _cores() // max(1, settings.workers))
        self._child: _Child | None = None
        self._spare: _Child | None = None
        self.closed = False
        self._lock = threading.Lock()
        self._token: str | None = None
        self._computes = False
        self._stopped: OrderedDict[str, None] = OrderedDict()

    @property
    def pid(self) -> int | None:
        """The process, None where it has not started."""
        return self._child and self._child.pid

    @property
    def busy(self) -> bool:
        """Whether a task runs."""
        return self._token is not None

    def describe(self) -> dict[str, str]:
        """Start the process; the target of each kind of device (see `steps.describe`)."""
        return self._current().pool.schedule(steps.describe).result()

    def run(self, task: Task, report: Callable[[int, int], None]) -> Outcome:
        """Run a task to its end; ``report`` gets the gauges (see `steps.start`) a few times a second. Never raises."""
        with self._lock:
            if task.token in self._stopped:
                return Outcome(Verdict.STOPPED)
            self._token = task.token
        try:
            task = replace(task, limits=self._limits.within(task.limits))
            child = self._started(task)
            return Outcome(Verdict.STOPPED) if child is None else self._watched(child, task, report)
        except LOST_AT_START as fault:
            self._discard()
            message = f"the kernel process did not start: {fault}"
            return Outcome(Verdict.LOST, error=error("worker_lost", message, retryable=True))
        finally:
            self._token, self._computes = None, False

    def stop(self, token: str) -> None:
        """Kill the process if it works on an attempt; none of the attempt's tasks will start here any more.

        A process that is only starting goes on: the next task needs it.
        """
        with self._lock:
            self._stopped[token] = None
            while len(self._stopped) > REMEMBERED_TOKENS:
                self._stopped.popitem(last=False)
            if self._token == token and self._computes:
                kill(self.pid)

    def close(self) -> None:
        """End the process for good; a task that runs in it is lost."""
        with self._lock:
            self.closed = True
        self._discard()
        self._discard()  # the spare

    def _current(self) -> _Child:
        """The process, or the spare where there is none that lives, or a new one."""
        if self.closed:
            raise RuntimeError("the worker ends")
        while self._child is not None and not self._child.pool.active:
            self._discard()
        if self._child is None:
            self._child = _Child(self._settings, self._threads, steps.describe)
        return self._child

    def _start_spare(self) -> None:
        with self._lock:
            if not self.closed:
                self._spare = _Child(self._settings, self._threads, steps.warm)

    def _started(self, task: Task) -> _Child | None:
        """The process once it is ready; None where the task was stopped before."""
        child, ends = self._current(), time.monotonic() + self._settings.worker_start_s
        while not child.ready.done():
            wait([child.ready], timeout=LOOK_S)
            if task.token in self._stopped:
                return None
            if self.closed:  # a pool that was stopped leaves its futures as they were
                raise RuntimeError("the worker ended")
            if time.monotonic() > ends:
                raise RuntimeError(f"it took longer than {self._settings.worker_start_s:g} s")
        child.ready.result()
        return child

    def _watched(self, child: _Child, task: Task, report: Callable[[int, int], None]) -> Outcome:
        future = child.pool.schedule(steps.run, args=[task])
        began = reported = time.monotonic()
        guard, too_much = _Guard(task, child), None
        self._computes = True
        while True:
            try:
                return Outcome(Verdict.DONE, future.result(timeout=LOOK_S))
            except TimeoutError:
                now = time.monotonic()
                if self.closed:
                    return Outcome(Verdict.LOST, error=error("worker_lost", "the worker ended", retryable=True))
                if task.token in self._stopped:
                    kill(child.pid)  # again: the task may have been about to start when the stop came
                too_much = too_much or guard.found()
                if too_much is not None:
                    kill(child.pid)
                if now - reported > REPORT_S:
                    reported = now
                    report(child.gauges[1], child.gauges[2])
                if self._spare is None and self._settings.warm_spare and now - began > SPARE_AFTER_S:
                    self._start_spare()
            except (ProcessExpired, BrokenProcessPool, CancelledError) as fault:
                self._discard()
                return self._death(task, getattr(fault, "exitcode", None), too_much)
            except BaseException as fault:
                return outcome_of_exception(fault)

    def _death(self, task: Task, exit_code: int | None, too_much: dict[str, Any] | None) -> Outcome:
        if task.token in self._stopped:
            return Outcome(Verdict.STOPPED)
        if too_much is not None:
            return Outcome(Verdict.FAILED, error=too_much)
        if exit_code is None or exit_code == KILLED:
            # Killed from outside: by an administrator, or by a system short of memory.
            return Outcome(Verdict.LOST, error=error("worker_lost", "the kernel process was killed", retryable=True))
        message = f"the kernel process crashed ({how_it_ended(exit_code)}); other jobs are not affected"
        return Outcome(Verdict.FAILED, error=error("kernel_crash", message))

    def _discard(self) -> None:
        """End the process; the spare, if there is one, takes its place."""
        child, self._child, self._spare = self._child, self._spare, None
        if child is not None:
            child.close()


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
    if isinstance(fault, OSError) and is_full(fault):
        message = "the server's disk is full; nothing computed so far is lost, retry the job later"
        return Outcome(Verdict.FAILED, error=error("disk_full", message, retryable=True))
    # What went wrong belongs into the server's log, not into an answer.
    message = f"internal error ({type(fault).__name__}); the server's log says more"
    return Outcome(Verdict.FAILED, value=repr(fault), error=error("internal_error", message))
