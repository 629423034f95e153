"""A worker of an existing cluster keeps trying to join it, and what Dask is told of workers."""

import asyncio
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace

import distributed
import psutil
import pytest
import yaml
from dask import config
from wsrender_server.jobs import worker
from wsrender_server.jobs.service import JobService
from wsrender_server.settings import Settings

from tests.server.jobs.documents import canonical
from tests.server.jobs.waiting import ended, wait_until


@pytest.fixture
def settings(tmp_path):
    files = {f"tls_{name}_file": tmp_path / name for name in ("ca", "cert", "key")}
    return Settings(data_dir=tmp_path, scheduler="tls://127.0.0.1:1", **files)


@pytest.mark.parametrize("fault", [OSError("refused"), TimeoutError("slow"), RuntimeError("Nanny failed to start.")])
def test_what_keeps_a_worker_from_joining_is_said_and_tried_again(settings, monkeypatch, caplog, fault):
    stop, attempts = threading.Event(), []

    class Nanny:
        status, process = distributed.Status.init, None

        def __init__(self, scheduler, **options):
            attempts.append(scheduler)

        async def __aenter__(self):
            if len(attempts) < 3:
                raise fault
            return self

        async def __aexit__(self, *_):
            pass

        async def finished(self):
            pass

    monkeypatch.setattr(worker, "Nanny", Nanny)
    monkeypatch.setattr(worker, "security", lambda settings: None)
    monkeypatch.setattr(worker, "RECONNECT_S", 0.01)
    worker.serve_scheduler(settings, stop.set, stop)
    assert attempts == ["tls://127.0.0.1:1"] * 3
    said = [record.getMessage() for record in caplog.records if record.name == worker.log.name]
    assert [str(fault) in text for text in said] == [True, True]


def test_a_worker_that_is_stopped_while_it_starts_tries_nothing_again(settings, monkeypatch, caplog):
    stop = threading.Event()

    class Nanny:
        status, process = distributed.Status.init, None

        def __init__(self, scheduler, **options):
            assert not stop.is_set()

        async def __aenter__(self):
            stop.set()
            await asyncio.sleep(0.5)
            raise RuntimeError("Nanny failed to start.")

        async def __aexit__(self, *_):
            pass

    monkeypatch.setattr(worker, "Nanny", Nanny)
    monkeypatch.setattr(worker, "security", lambda settings: None)
    worker.serve_scheduler(settings, stop=stop)
    assert stop.is_set() and not [record for record in caplog.records if record.name == worker.log.name]


def test_a_worker_that_ends_while_it_starts_takes_what_it_has_started_along():
    """Kernels that were just being imported lived on for as long as that takes."""
    script = "import subprocess, sys; subprocess.Popen(['sleep', '600']); print('started', flush=True); input()"
    with subprocess.Popen([sys.executable, "-c", script], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as parent:
        assert parent.stdout.readline() == b"started\n"
        (child,) = psutil.Process(parent.pid).children()

        async def kill():
            parent.kill()

        process = SimpleNamespace(pid=parent.pid, kill=kill)
        starting = SimpleNamespace(status=distributed.Status.starting, process=SimpleNamespace(process=process))
        try:
            asyncio.run(worker._end(starting))
            assert psutil.wait_procs([child], timeout=10)[1] == []
        finally:
            with suppress(psutil.NoSuchProcess):
                child.kill()


LOST_WORKER = "distributed.deploy.lost-worker-timeout"  # after which an embedded cluster gives up a worker's place


def test_dask_has_the_settings_that_workers_are_given():
    """An unknown name would be taken without a word; every process of a worker reads them from this one."""
    defaults = yaml.safe_load(Path(distributed.__file__).with_name("distributed.yaml").read_text())
    assert config.get(LOST_WORKER, config=defaults) == "15s"
    for name, value in worker.DASK.items():
        assert config.get(name, config=defaults) != value == config.get(name)


def test_the_wait_for_a_worker_is_a_setting_and_what_jobs_wait_for_is_said(tmp_path):
    """A worker needs seconds: one that may take half of one is begun again, and again, while the job waits."""
    settings = Settings(data_dir=tmp_path, worker_start_s=0.5)
    with JobService(settings) as service:
        job = service.store.submit("ann", canonical(sampling={"method": "sobol", "count": 64}, device="cpu")).job.id
        time.sleep(4)
        assert not service.worker_ready and service.waits_for("cpu") == "waiting for the workers to start"
        assert service.store.get("ann", job).state == "queued"
    with JobService(settings.model_copy(update={"worker_start_s": 120.0})) as service:
        assert ended(service.store, job).state == "succeeded"
        assert service.waits_for("cpu") == "waiting for a free worker"
        assert config.get(LOST_WORKER) == "120.0s"
        for address in wait_until(service.dispatcher.engine.kernel_pids, what="the worker's answer"):
            service.dispatcher.engine._client.retire_workers([address])
        wait_until(lambda: service.waits_for("cpu") != "waiting for a free worker", what="the retirement")
        assert service.waits_for("cpu") == "waiting for a worker to start"
