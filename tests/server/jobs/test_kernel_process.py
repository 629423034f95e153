"""The process of a worker in which kernels run, without its worker."""

import os
import sys
import threading
import time
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace

import psutil
import pytest
from wsrender_server.jobs import kernel_process, steps
from wsrender_server.jobs.documents import CanonicalDocument
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.kernel_process import KernelProcess
from wsrender_server.jobs.task import Outcome, Step, Task, TaskLimits, Verdict
from wsrender_server.settings import Settings

from tests.server.jobs.documents import canonical
from tests.server.jobs.waiting import wait_until
from wsrender import run

THREADS = 3
TASK = Task(Step.SHARD, "computation", "computation-1", {})


def sleep_long(task):
    time.sleep(600)


def test_a_process_that_is_closed_gives_up_its_task(tmp_path, monkeypatch):
    monkeypatch.setattr(steps, "run", sleep_long)
    process, outcomes = KernelProcess(Settings(data_dir=tmp_path)), []
    started = threading.Event()

    def run():
        outcomes.append(process.run(TASK, lambda done, total: started.set()))

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    wait_until(started.is_set, what="the task")
    process.close()
    thread.join(30)
    assert not thread.is_alive()
    assert outcomes[0].verdict == Verdict.LOST
    assert process.run(TASK, print).verdict == Verdict.LOST  # and starts none any more
    assert process.pid is None


def test_the_steps_run_on_the_threads_of_the_process(tmp_path, monkeypatch):
    asked = {}

    def kept(step):
        def called(*args, threads=None, **_):
            asked[step] = threads
            raise InterruptedError

        return called

    files = DataFolder(tmp_path)
    monkeypatch.setattr(steps, "_state", {"files": files, "threads": THREADS, "gauges": [0, 0, 0]})
    monkeypatch.setattr(steps, "_planned", lambda task: SimpleNamespace(shards=[(0, 1)], further=lambda *_: None))
    monkeypatch.setattr(steps, "_load", lambda *args: None)
    for name in ("run_shard", "finish"):
        monkeypatch.setattr(run, name, kept(name))
    for step in (Step.SHARD, Step.FINISH):
        with pytest.raises(InterruptedError):
            steps.run(Task(step, "c0ffee", "c0ffee-1", {}, seconds={}))
    assert asked == {"run_shard": THREADS, "finish": THREADS}


def last_long(task):
    """Compute until it is killed, where its computation says so; else say who has computed."""
    while task.computation == "long":
        time.sleep(0.05)
    return os.getpid()


TOLD = "WSRENDER_TEST_TOLD"  # a file's path


def begin_when_told():
    while not Path(os.environ[TOLD]).exists():
        time.sleep(0.05)


@contextmanager
def running(process, computation):
    """A task that runs in a thread; yields its list of outcomes, filled when the block is left."""
    outcomes, started = [], threading.Event()
    task = Task(Step.SHARD, computation, f"{computation}-1", {})
    thread = threading.Thread(
        target=lambda: outcomes.append(process.run(task, lambda done, total: started.set())), daemon=True
    )
    thread.start()
    wait_until(started.is_set, what="the task")
    yield outcomes
    process.stop(task.token)
    thread.join(30)
    assert not thread.is_alive()


@pytest.fixture
def spared(tmp_path, monkeypatch):
    """A kernel process with a spare from the start, whose tasks are `last_long`."""
    for name, value in {"run": last_long, "warm": os.getpid, "describe": os.getpid}.items():
        monkeypatch.setattr(steps, name, value)
    monkeypatch.setattr(kernel_process, "SPARE_AFTER_S", 0.0)
    process = KernelProcess(Settings(data_dir=tmp_path))
    yield process
    process.close()


def test_the_spare_computes_next_after_a_task_was_stopped(spared):
    spared.describe()
    first = spared.pid
    with running(spared, "long") as outcomes:
        spare = wait_until(lambda: spared._spare, what="a spare")
        second = spare.ready.result(60)
    assert outcomes == [Outcome(Verdict.STOPPED)]
    assert spared.run(TASK, print) == Outcome(Verdict.DONE, second)
    assert second == spared.pid != first and not psutil.pid_exists(first)


def test_without_a_spare_another_process_computes(spared):
    spared._settings = spared._settings.model_copy(update={"warm_spare": False})
    with running(spared, "long"):
        first = spared.pid
        assert spared._spare is None
    assert spared.run(TASK, print) == Outcome(Verdict.DONE, spared.pid) and spared.pid != first


def test_a_spare_that_was_killed_is_not_taken(spared):
    with running(spared, "long"):
        killed = wait_until(lambda: spared._spare, what="a spare").ready.result(60)
        psutil.Process(killed).kill()
        wait_until(lambda: not psutil.pid_exists(killed), what="its end")
        spared._settings = spared._settings.model_copy(update={"warm_spare": False})
    wait_until(lambda: not spared._child.pool.active, what="the notice of its end")
    assert spared.run(TASK, print).verdict == Verdict.DONE and spared.pid != killed


@pytest.fixture
def told(tmp_path, monkeypatch):
    """The file that `begin_when_told` waits for."""
    monkeypatch.setenv(TOLD, str(tmp_path / "told"))
    return tmp_path / "told"


def test_a_task_that_is_stopped_while_a_process_starts_costs_no_process(spared, told, monkeypatch):
    monkeypatch.setattr(steps, "describe", begin_when_told)
    task = Task(Step.SHARD, "c0ffee", "c0ffee-1", {})
    outcomes = []
    thread = threading.Thread(target=lambda: outcomes.append(spared.run(task, print)), daemon=True)
    thread.start()
    first = wait_until(lambda: spared.pid, what="the process")
    spared.stop(task.token)
    thread.join(60)
    assert outcomes == [Outcome(Verdict.STOPPED)] and not spared._child.ready.done()
    told.touch()
    assert spared.run(TASK, print) == Outcome(Verdict.DONE, first)


@pytest.mark.parametrize(("first", "wait_s", "why"), [(begin_when_told, 0.5, "longer than 0.5 s"), (os.abort, 60, "")])
def test_a_process_that_does_not_start_is_worth_another_try(spared, told, monkeypatch, first, wait_s, why):
    monkeypatch.setattr(steps, "describe", first)
    spared._settings = spared._settings.model_copy(update={"worker_start_s": wait_s})
    outcome = spared.run(TASK, print)
    assert outcome.verdict == Verdict.LOST and outcome.error["retryable"] and outcome.error["code"] == "worker_lost"
    assert f"did not start: {why}" in outcome.error["message"].replace("it took ", "")
    monkeypatch.setattr(steps, "describe", os.getpid)
    spared._settings = spared._settings.model_copy(update={"worker_start_s": 60.0})
    assert spared.run(TASK, print).verdict == Verdict.DONE


def test_a_spare_is_warm(tmp_path):
    """It has loaded what a job needs, and left no files."""
    process = KernelProcess(Settings(data_dir=tmp_path, threads_per_worker=1))
    try:
        pool = process._current().pool
        pool.schedule(steps.warm).result(300)
        assert pool.schedule(loaded, args=[["wsrender.run", "mujoco", "warp", "h5py"]]).result(60) == [True] * 4
        assert list((tmp_path / "scratch").iterdir()) == []
    finally:
        process.close()


def loaded(names):
    return [name in sys.modules for name in names]


ENOUGH = TaskLimits(2**33, 2**33, 600.0, 10**11)
HELD = 3 * 2**28  # bytes


def hold_or_sleep(task):
    """What the computation is called: hold memory, or only take time."""
    held = b"x" * (HELD if task.computation == "hold" else 0)
    time.sleep(600 if task.computation in ("hold", "sleep") else 1.5)
    return len(held)


@pytest.mark.parametrize(
    ("step", "computation", "of_task", "of_worker", "code", "allowed"),
    [
        (Step.SHARD, "hold", {"memory_bytes": 2**29}, {}, "out_of_memory", "0.5 GiB"),
        (Step.SHARD, "hold", {}, {"max_memory_bytes": 2**29}, "out_of_memory", "0.5 GiB"),
        (Step.SHARD, "hold", {"memory_bytes": 2**29}, {"max_memory_bytes": 2**30}, "out_of_memory", "0.5 GiB"),
        (Step.SHARD, "hold", None, {"max_memory_bytes": 2**29}, "out_of_memory", "0.5 GiB"),
        (Step.PLAN, "hold", {"planning_memory_bytes": 2**28}, {}, "out_of_memory", "0.25 GiB allowed for it"),
        (Step.PLAN, "hold", {}, {"max_planning_memory_bytes": 2**28}, "out_of_memory", "0.25 GiB allowed for it"),
        (Step.PLAN, "sleep", {"planning_s": 0.5}, {}, "too_slow", "0.5 s allowed for it"),
        (Step.PLAN, "sleep", {}, {"max_planning_s": 0.5}, "too_slow", "0.5 s allowed for it"),
        (Step.SHARD, "short", {"planning_s": 0.5, "planning_memory_bytes": 1}, {}, None, ""),
    ],
)
def test_a_task_is_held_to_the_smaller_of_its_own_limits_and_the_workers(
    monkeypatch, held_to, step, computation, of_task, of_worker, code, allowed
):
    monkeypatch.setattr(steps, "run", hold_or_sleep)
    limits = None if of_task is None else replace(ENOUGH, **of_task)
    outcome = held_to(of_worker).run(Task(step, computation, "t-1", {}, limits=limits), print)
    assert (outcome.error or {}).get("code") == code
    assert allowed in (outcome.error or {"message": ""})["message"]


@pytest.fixture(scope="module")
def held_to():
    """A kernel process, held to other settings of its worker."""
    large = {"max_planning_memory_bytes": 2**33, "warm_spare": False}
    with TemporaryDirectory() as folder:
        process = KernelProcess(Settings(data_dir=Path(folder), **large))

        def with_settings(settings):
            process._limits = TaskLimits.of(Settings(data_dir=Path(folder), **large | settings))
            return process

        yield with_settings
        process.close()


@pytest.mark.parametrize(("of_task", "of_worker"), [(1000, 10**11), (10**11, 1000), (None, 1000)])
def test_a_worker_plans_no_more_samples_than_the_smaller_limit_allows(tmp_path, of_task, of_worker):
    process = KernelProcess(Settings(data_dir=tmp_path, threads_per_worker=1, max_samples=of_worker, warm_spare=False))
    limits = None if of_task is None else replace(ENOUGH, samples=of_task)
    document = CanonicalDocument.of(canonical(sampling={"method": "sobol", "count": 4096}, device="cpu"))
    try:
        outcome = process.run(Task(Step.PLAN, "c0ffee", "c0ffee-1", document, limits=limits), lambda *_: None)
    finally:
        process.close()
    assert outcome.error is not None
    assert outcome.error["code"] == "resource_limit" and "this server allows 1000" in outcome.error["message"]
