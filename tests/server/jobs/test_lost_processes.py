"""kill -9 in mid-job: whatever is lost is done again, what was done is not, and no bit changes."""

import json
import time

import psutil
import pytest
from wsrender_server.jobs.service import JobService
from wsrender_server.settings import Settings

from tests.server.jobs.documents import canonical
from tests.server.jobs.server_process import ServerProcess
from tests.server.jobs.waiting import comparable, ended, local_document, partial_times, wait_until
from wsrender.analyses.jobs import canonical_json, parse_job

SHARD, SHARDS = 1 << 17, 24
JOB = {
    "robot": "ur5e",
    "sampling": {"method": "sobol", "count": SHARD * SHARDS},
    "voxel_size_m": 0.1,
    "voxel_statistics": ["count", "maximum", "minimum", "mean"],
    "device": "cpu",
}

STUDY = {
    "analysis": "base_placement",
    "robot": "ur5e",
    "points_m": [[0.1 + 0.05 * k, 0.1, 0.3] for k in range(8)],
    "quats_wxyz": [[0, 1, 0, 0]] * 8,
    "over": {"x_m": [-1, 1, 0.05], "y_m": [-1, 1, 0.05]},
    "index": "manipulability",
    "refine": False,
    "device": "cpu",
}


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """The document of a local run."""
    return local_document(canonical(**JOB), tmp_path_factory.mktemp("local"))


@pytest.fixture
def settings(tmp_path):
    return Settings(data_dir=tmp_path / "data", shard_samples=SHARD)


@pytest.fixture
def server(settings, tmp_path):
    server = ServerProcess(settings, tmp_path)
    yield server
    server.stop()


def kernels(server):
    """The kernel process below the worker."""
    return [child for child in server.children() if child.ppid() != server.process.pid and is_python(child)]


def workers(server):
    """The Dask workers below the server."""
    parents = {child.ppid() for child in kernels(server)}
    return [child for child in server.children() if child.pid in parents]


def is_python(process):
    try:
        return "spawn_main" in " ".join(process.cmdline())
    except psutil.NoSuchProcess:
        return False


@pytest.mark.parametrize("victim", ["worker", "server", "everything"])
def test_the_job_finishes_with_the_same_bits(server, settings, opened, expected, victim):
    again, found = interrupted(server, settings, opened(settings), canonical(**JOB), victim)
    assert again == set() and found == expected


def test_an_interrupted_study_of_placements_resumes(settings, opened, tmp_path):
    """Finished shards are not computed again, and its tables, bits of labels among them, have the same hashes."""
    document = json.loads(canonical_json(parse_job(STUDY)))
    settings = settings.model_copy(update={"shard_samples": 1 << 14})
    server = ServerProcess(settings, tmp_path)
    try:
        again, found = interrupted(server, settings, opened(settings), document, "everything")
    finally:
        server.stop()
    assert again == set() and found == local_document(document, tmp_path / "local")
    assert "placements.parquet" in {each["name"] for each in found["artifacts"]}


def interrupted(server, settings, store, document, victim):
    """Names of shards that were computed again after a process was killed, and the result's document."""
    job = store.submit("ann", document).job.id
    kept = wait_until(lambda: len(times := partial_times(settings.data_dir)) >= 3 and times, what="partial results")
    orphans = kernels(server)
    if victim == "worker":
        workers(server)[0].kill()
    else:
        server.kill() if victim == "server" else server.kill_all()
        wait_until(lambda: not any(alive(process) for process in orphans), 60, "the end of orphans")
        assert store.get("ann", job).state == "running"
        server.start()
    again = set()
    while store.get("ann", job).state in ("queued", "running"):
        now = partial_times(settings.data_dir)
        again |= {name for name in kept if name in now and now[name] != kept[name]}
        time.sleep(0.02)
    record = ended(store, job)
    assert record.state == "succeeded", record.error
    return again, comparable(store.result_document("ann", job))


@pytest.mark.parametrize("workers", [2, 4])
def test_the_number_of_workers_changes_no_bit(settings, expected, workers):
    with JobService(settings.model_copy(update={"workers": workers, "threads_per_worker": 1})) as service:
        job = service.store.submit("ann", canonical(**JOB)).job.id
        assert ended(service.store, job).state == "succeeded"
        assert comparable(service.store.result_document("ann", job)) == expected


def test_a_stopped_server_leaves_nothing_and_goes_on(server, settings, opened, expected):
    store = opened(settings)
    job = store.submit("ann", canonical(**JOB)).job.id
    wait_until(lambda: partial_times(settings.data_dir), what="a partial result")
    children = server.children()
    server.process.terminate()
    assert server.process.wait(60) == 0
    wait_until(lambda: not any(alive(child) for child in children), 60, "the end of the children")
    server.start()
    assert ended(store, job).state == "succeeded"
    assert comparable(store.result_document("ann", job)) == expected


def alive(process):
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False
