"""Machines of two kinds in one cluster: each computes jobs of its own, and what one has begun the other begins anew."""

import itertools
import sys
import time

import pytest
from sqlalchemy import select
from wsrender_server.jobs import dispatcher
from wsrender_server.jobs.service import JobService
from wsrender_server.jobs.tables import Computation, Job
from wsrender_server.settings import Settings

from tests.server.conftest import free_port
from tests.server.jobs.documents import canonical
from tests.server.jobs.server_process import WORK, ServerProcess
from tests.server.jobs.test_distributed import Cluster, certificates
from tests.server.jobs.waiting import in_state, wait_until

OTHER = "import wsrender.engine.devices\nwsrender.engine.devices._vector_extension = lambda: 'other'\n" + WORK
SHARD = 1 << 17
LONG = {"robot": "ur5e", "sampling": {"method": "sobol", "count": 400 * SHARD}, "voxel_size_m": 0.1, "device": "cpu"}


@pytest.fixture
def settings(tmp_path):
    return Settings(
        data_dir=tmp_path / "data",
        scheduler=f"tls://127.0.0.1:{free_port()}",
        shard_samples=SHARD,
        threads_per_worker=1,
        **certificates(tmp_path),
    )


@pytest.fixture
def service(settings, tmp_path, monkeypatch):
    """A service with a scheduler, and no workers yet."""
    monkeypatch.setattr(dispatcher, "WORKERS_S", 2.0 - settings.worker_start_s)
    monkeypatch.setattr(sys.modules[Cluster.__module__], "WORK", "")
    cluster = Cluster(settings, tmp_path)
    with JobService(settings) as service:
        yield service
    cluster.stop()


def target_of(service, job):
    query = select(Computation.target).join(Job, Job.computation_id == Computation.id).where(Job.id == job)
    with service.store.transactions.read() as session:
        return session.scalar(query)


def elsewhere(service, job, number):
    """The target of a new job (none of another ``number`` is the same), where it is not that of ``job``."""
    sampling = {"method": "grid", "per_joint": 3 + number}
    new = service.store.submit("ann", canonical(sampling=sampling)).job.id
    target = wait_until(lambda: target_of(service, new), what="a target")
    service.store.cancel("ann", new)
    return target if target != target_of(service, job) else None


def test_targets_come_and_go(service, settings, tmp_path):
    workers = []
    try:
        first = service.store.submit("ann", canonical(**LONG)).job.id
        time.sleep(1)
        assert service.store.get("ann", first).state == "queued"
        workers.append(ServerProcess(settings, tmp_path, OTHER))
        in_state(service.store, first, "running")
        wait_until(lambda: target_of(service, first), what="a target")
        assert target_of(service, first).endswith("+other")

        workers.append(ServerProcess(settings, tmp_path, WORK))
        wait_until(lambda: len(service.dispatcher.engine.alive) == 2, what="workers of two kinds")
        # Either of them may plan a job, and so be its target; the one that is idle does sooner or later.
        numbers = itertools.count()
        target = wait_until(lambda: elsewhere(service, first, next(numbers)), what="a job on the other kind")

        workers[0].kill_all()
        wait_until(lambda: target_of(service, first) == target, what="the target that is left")
        assert service.store.get("ann", first).state == "running"
    finally:
        for worker in workers:
            worker.kill_all()


def test_a_job_for_a_gpu_waits_for_one_and_says_so(service, settings, tmp_path):
    worker = ServerProcess(settings, tmp_path, WORK)
    try:
        wait_until(lambda: service.dispatcher.alive, what="a worker")
        if "cuda" in service.dispatcher.engine.targets():
            pytest.skip("there is a GPU")
        job = service.store.submit("ann", canonical(**{**LONG, "device": "cuda"})).job
        assert job.device == "cuda" and service.waits_for(job.device) == "waiting for a worker with a CUDA GPU"
        other = service.store.submit("ann", canonical(sampling={"method": "sobol", "count": 64}, device="cpu")).job.id
        in_state(service.store, other, "succeeded")
        assert service.store.get("ann", job.id).state == "queued"
        assert service.store.cancel("ann", job.id).state == "canceled"
    finally:
        worker.kill_all()
