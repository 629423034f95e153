"""A database that is locked or full, a disk that is full: clear, retryable errors, and nothing lost."""

import errno
import sqlite3
import subprocess
import threading
from contextlib import closing

import pytest
from sqlalchemy import event
from wsrender_server.jobs.database import open_database
from wsrender_server.jobs.faults import DiskFull, StoreUnavailable
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.kernel_process import outcome_of_exception
from wsrender_server.jobs.service import JobService
from wsrender_server.jobs.store import JobStore
from wsrender_server.migrations import upgrade
from wsrender_server.settings import Settings

from tests.server.jobs.documents import canonical
from tests.server.jobs.waiting import comparable, ended, local_document, partial_times, wait_until, within
from wsrender.errors import InputError


@pytest.fixture
def settings(tmp_path):
    return Settings(data_dir=tmp_path / "data")


@pytest.fixture
def impatient(settings):
    """A store that waits 0.2 s for a lock."""
    engine = open_database(settings.database_url, lock_wait_s=0.2)
    upgrade(engine)
    yield JobStore(engine, DataFolder(settings.data_dir))
    engine.dispose()


def locked(settings):
    """A connection that holds the database's lock until it is closed."""
    connection = sqlite3.connect(settings.data_dir / "wsrender.db", isolation_level=None, check_same_thread=False)
    connection.execute("BEGIN IMMEDIATE")
    return closing(connection)


def test_a_locked_database_refuses_and_forgets_nothing(impatient, settings, document):
    before = impatient.submit("ann", document).job
    with locked(settings):
        for refused in (
            lambda: impatient.submit("ann", canonical(precision="float64")),
            lambda: impatient.cancel("ann", before.id),
            lambda: impatient.put_model("ann", b"<mujoco/>"),
        ):
            with within(1), pytest.raises(StoreUnavailable) as fault:
                refused()
            assert fault.value.retryable
        assert impatient.get("ann", before.id) == before  # reading goes on
    assert [job.id for job in impatient.list("ann")[0]] == [before.id]
    assert impatient.cancel("ann", before.id).state == "canceled"


def test_a_lock_in_mid_job_only_delays_it(impatient, settings):
    with JobService(settings, impatient) as service:
        wait_until(lambda: service.worker_ready, what="a worker")
        fields = {"sampling": {"method": "sobol", "count": 2**22}, "voxel_size_m": 0.05, "device": "cpu"}
        job = impatient.submit("ann", canonical(**fields)).job.id
        wait_until(lambda: impatient.get("ann", job).state == "running", what="the start")
        lock = locked(settings)
        threading.Timer(3, lock.thing.close).start()
        assert ended(impatient, job).state == "succeeded"


def test_a_full_database_refuses_and_forgets_nothing(settings, opened, document):
    store = opened(settings)
    before = store.submit("ann", document).job
    engine = open_database(settings.database_url)

    @event.listens_for(engine, "connect")
    def limit(connection, record):
        pages = connection.execute("PRAGMA page_count").fetchone()[0]
        connection.execute(f"PRAGMA max_page_count = {pages}")

    full = JobStore(engine, DataFolder(settings.data_dir))
    table = {"dh": {"convention": "standard", "rows": [{"joint": "revolute", "a": 1.0}] * 60}}
    with pytest.raises(StoreUnavailable, match="full"):
        full.submit("ann", canonical(robot=table))
    full.close()
    assert [job.id for job in store.list("ann")[0]] == [before.id] and len(store.unfinished()) == 1


def test_a_full_disk_refuses_models(settings, opened, monkeypatch):
    store = opened(settings)

    def full(file):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(DiskFull) as fault:
        store.put_model("ann", b"<mujoco/>")
    assert fault.value.retryable and list((settings.data_dir / "models").iterdir()) == []


@pytest.mark.parametrize(
    "fault",
    [
        OSError(errno.ENOSPC, "No space left on device"),
        OSError(errno.EDQUOT, "Disk quota exceeded"),
        OSError("Unable to synchronously create dataset (No space left on device)"),
        OSError("Not enough free space to write 64000000 bytes after offset 128"),
        OSError("65536 requested and 4096 written"),
    ],
)
def test_a_disk_that_fills_up_in_mid_job_is_worth_a_retry(fault):
    error = outcome_of_exception(fault).error
    assert error["code"] == "disk_full" and error["retryable"]


@pytest.fixture
def small_disk(tmp_path):
    """A folder on a disk of its own, of 64 MiB."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=64m,mode=0700", "tmpfs", folder]
    if subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("only root may mount a disk that can be filled")
    yield folder
    subprocess.run(["umount", "-l", folder], check=True)


def test_a_job_whose_disk_fills_up_says_so_and_a_retry_goes_on(small_disk, tmp_path):
    """Other jobs take the disk once this one has its first parts: a retry, when there is room, needs no others."""
    sampling = {"method": "sobol", "count": 2**19}
    document = canonical(sampling=sampling, voxel_size_m=0.02, keep_map=True, refined_volume=None, device="cpu")
    settings = Settings(data_dir=small_disk / "data", min_free_disk_bytes=0, shard_samples=2**16)
    others = small_disk / "others"
    with JobService(settings) as service:
        wait_until(lambda: service.worker_ready, what="a worker")
        others.write_bytes(bytes(service.store.files.free_bytes() - 12 * 2**20))
        job = service.store.submit("ann", document).job.id
        record = ended(service.store, job)
        assert record.state == "failed" and record.error["code"] == "disk_full" and record.error["retryable"]
        assert partial_times(settings.data_dir)
        others.unlink()
        service.store.retry("ann", job)
        assert ended(service.store, job).state == "succeeded"
        result = comparable(service.store.result_document("ann", job))
    assert result == local_document(document, tmp_path / "local")


def test_an_unexpected_fault_says_nothing_about_the_server():
    error = outcome_of_exception(RuntimeError("/srv/secret/path")).error
    assert error["code"] == "internal_error" and "secret" not in error["message"]


def test_a_data_folder_has_one_server(settings):
    service, second = JobService(settings), JobService(settings)
    with service, pytest.raises(InputError, match="in use"):
        second.start()
    second.store.close()


def test_a_database_of_another_version_must_be_upgraded(tmp_path):
    engine = open_database(f"sqlite:///{tmp_path / 'empty.db'}")
    with pytest.raises(InputError, match="wsrender database upgrade"):
        upgrade(engine, check_only=True)
    upgrade(engine)
    upgrade(engine, check_only=True)
    engine.dispose()


def test_a_database_that_is_not_there_is_named():
    with pytest.raises(StoreUnavailable):
        upgrade(open_database("postgresql+psycopg://nobody@127.0.0.1:1/none"), check_only=True)


@pytest.mark.parametrize("name", ["../x", "a/b", "", "x" * 65, "A", "a\x00"])
def test_the_data_folder_takes_no_paths(tmp_path, name):
    files = DataFolder(tmp_path)
    for path in (files.model, files.partials, lambda n: files.artifact("ab", n)):
        with pytest.raises(ValueError, match="no name"):
            path(name)
