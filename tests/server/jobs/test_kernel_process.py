"""The process of a worker in which kernels run, without its worker."""

import threading
import time

from wsrender_server.jobs import steps
from wsrender_server.jobs.kernel_process import KernelProcess
from wsrender_server.jobs.task import Step, Task, Verdict
from wsrender_server.settings import Settings

from tests.server.jobs.waiting import wait_until

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
