"""An existing cluster: PostgreSQL, a Dask scheduler with mutual TLS and two workers, each a process of its own."""

import subprocess
import sys
import time

import pytest
from distributed import Security
from sqlalchemy import text
from wsrender_server.jobs.database import open_database
from wsrender_server.jobs.service import JobService
from wsrender_server.jobs.tables import Row
from wsrender_server.migrations import upgrade
from wsrender_server.settings import Settings

from tests.server.conftest import free_port, wait_for_port
from tests.server.jobs.documents import canonical
from tests.server.jobs.server_process import WORK, ServerProcess
from tests.server.jobs.waiting import PATIENCE_S, comparable, ended, local_document, partial_times, wait_until

SHARD = 1 << 17
JOB = {"robot": "ur5e", "sampling": {"method": "sobol", "count": 24 * SHARD}, "voxel_size_m": 0.1, "device": "cpu"}


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    return local_document(canonical(**JOB), tmp_path_factory.mktemp("local"))


@pytest.fixture
def settings(tmp_path, postgres_url):
    engine = open_database(postgres_url)
    Row.metadata.drop_all(engine)
    with engine.begin() as connection:
        connection.execute(text("DROP TABLE IF EXISTS alembic_version"))
    upgrade(engine)
    engine.dispose()
    return Settings(
        data_dir=tmp_path / "data",
        database=postgres_url,
        scheduler=f"tls://127.0.0.1:{free_port()}",
        shard_samples=SHARD,
        threads_per_worker=1,
        **certificates(tmp_path),
    )


@pytest.fixture
def cluster(settings, tmp_path):
    cluster = Cluster(settings, tmp_path)
    yield cluster
    cluster.stop()


class Cluster:
    """A scheduler and two workers."""

    def __init__(self, settings, folder):
        self.settings, self.folder = settings, folder
        self.start_scheduler()
        self.workers = [ServerProcess(settings, folder, WORK) for _ in range(2)]

    def start_scheduler(self):
        port = int(self.settings.scheduler.rpartition(":")[2])
        command = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", f"tls://127.0.0.1:{port}"]
        command += ["--dashboard-address", "127.0.0.1:0"]
        for option in ("ca_file", "cert", "key"):
            name = option if option == "ca_file" else f"{option}_file"
            command += [f"--tls-{option.replace('_', '-')}", getattr(self.settings, f"tls_{name}")]
        with (self.folder / "scheduler.log").open("ab") as log:
            self.scheduler = subprocess.Popen(command, stdout=log, stderr=log)
        wait_for_port(port, self.scheduler, PATIENCE_S)

    def stop(self):
        for worker in self.workers:
            worker.kill_all()
        self.scheduler.kill()
        self.scheduler.wait()


def certificates(folder):
    """A certificate authority and a certificate that it signed, as files."""
    temporary = Security.temporary()
    names = {"tls_ca_file": "tls_ca_file", "tls_cert_file": "tls_worker_cert", "tls_key_file": "tls_worker_key"}
    for setting, name in names.items():
        (folder / setting).write_text(getattr(temporary, name))
    return {setting: folder / setting for setting in names}


def test_two_workers_give_the_bits_of_a_local_run(cluster, settings, expected):
    with JobService(settings) as service:
        assert len(wait_until(lambda: len(found := service.workers()) == 2 and found, what="two workers")) == 2
        job = service.store.submit("ann", canonical(**JOB)).job.id
        assert ended(service.store, job).state == "succeeded"
        assert comparable(service.store.result_document("ann", job)) == expected


@pytest.mark.parametrize("victim", ["scheduler", "worker", "everything"])
def test_lost_processes_cost_only_what_they_had_in_hand(cluster, settings, opened, expected, victim, tmp_path):
    server = ServerProcess(settings, tmp_path)
    try:
        store = opened(settings)
        job = store.submit("ann", canonical(**JOB)).job.id
        kept = wait_until(lambda: len(times := partial_times(settings.data_dir)) >= 3 and times, what="partial results")
        if victim == "worker":
            cluster.workers[0].kill_all()
        else:
            cluster.scheduler.kill()
            cluster.scheduler.wait()
            if victim == "everything":
                server.kill_all()
                for worker in cluster.workers:
                    worker.kill_all()
                    worker.start()
                server.start()
            cluster.start_scheduler()
        again = set()
        while store.get("ann", job).state in ("queued", "running"):
            now = partial_times(settings.data_dir)
            again |= {name for name in kept if name in now and now[name] != kept[name]}
            time.sleep(0.02)
        assert ended(store, job).state == "succeeded"
        assert again == set()
        assert comparable(store.result_document("ann", job)) == expected
    finally:
        server.kill_all()


def test_a_scheduler_without_tls_is_refused(tmp_path):
    with pytest.raises(ValueError, match="tls://"):
        Settings(data_dir=tmp_path, scheduler="tcp://127.0.0.1:8786")
    with pytest.raises(ValueError, match="tls_ca_file"):
        Settings(data_dir=tmp_path, scheduler="tls://127.0.0.1:8786")
