"""A worker that hangs keeps nobody waiting but its own job, and not for long either."""

import psutil
import pytest
from wsrender_server.jobs import engine
from wsrender_server.jobs.service import JobService
from wsrender_server.settings import Settings

from tests.server.jobs.documents import canonical
from tests.server.jobs.waiting import ended, in_state, wait_until, within

LONG = {"robot": "ur5e", "indices": ["manipulability"], "voxel_size_m": 0.1, "device": "cpu"}
LONG_COUNT = 2**33  # samples, in one shard: minutes
QUICK = {"sampling": {"method": "sobol", "count": 4096}, "device": "cpu"}


@pytest.fixture
def service(tmp_path, monkeypatch):
    monkeypatch.setattr(engine, "WORKER_TTL_S", 10)
    settings = Settings(data_dir=tmp_path, workers=2, threads_per_worker=1, shard_samples=LONG_COUNT)
    with JobService(settings) as service:
        wait_until(lambda: len(service.workers()) == 2, what="two workers")
        yield service


def kernel_pids(service, workers):
    """Of so many workers as answer; one that is slow to is asked again."""
    known = service.dispatcher.engine.kernel_pids
    return wait_until(lambda: len(found := known()) == workers and [*found.values()], what="the workers' answers")


@pytest.fixture
def hung(service):
    """A worker that hangs, and its kernel process, both workers being in the middle of a job."""
    for seed in (1, 2):
        sampling = {"method": "sobol", "count": LONG_COUNT, "seed": seed}
        service.store.submit("ann", canonical(**{**LONG, "sampling": sampling}))
    jobs, _ = service.store.list("ann")
    wait_until(lambda: all(service.store.get("ann", job.id).progress.samples_done for job in jobs), what="progress")
    kernel = psutil.Process(kernel_pids(service, 2)[0])
    worker = kernel.parent()
    worker.suspend()
    yield worker, kernel
    if worker.is_running():
        worker.resume()


def test_canceling_beside_a_worker_that_hangs(service, hung):
    worker, kernel = hung
    jobs, _ = service.store.list("ann")
    with within(6):
        wait_until(lambda: len(service.workers()) == 1, what="the answer of the other")
        for job in jobs:
            service.store.cancel("ann", job.id)
        for job in jobs:
            in_state(service.store, job.id, "canceled")
    quick = [service.store.submit("ann", canonical(**QUICK, voxel_size_m=size)).job for size in (0.05, 0.06)]
    assert {ended(service.store, job.id).state for job in quick} == {"succeeded"}  # though one was sent to it
    wait_until(lambda: not kernel.is_running() or kernel.status() == psutil.STATUS_ZOMBIE, what="its kernels' end")
    wait_until(lambda: len(service.workers()) == 2, what="another worker in its place")
    assert not worker.is_running()


def test_a_server_whose_workers_all_hang_is_not_ready(service, hung, monkeypatch):
    monkeypatch.setattr(engine, "QUIET_S", 2.0)
    others = [psutil.Process(pid).parent() for pid in kernel_pids(service, 1)]
    wait_until(lambda: service.worker_ready, what="a sign of life")
    for worker in others:
        worker.suspend()
    try:
        wait_until(lambda: not service.worker_ready, what="the silence")
    finally:
        for worker in others:
            worker.resume()
    wait_until(lambda: service.worker_ready, what="signs of life")
