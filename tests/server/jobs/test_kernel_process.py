"""The process of a worker in which kernels run, without its worker."""

import threading
import time
from types import SimpleNamespace

import pytest
from wsrender_server.jobs import steps
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.kernel_process import KernelProcess
from wsrender_server.jobs.task import Step, Task, Verdict
from wsrender_server.settings import Settings

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
