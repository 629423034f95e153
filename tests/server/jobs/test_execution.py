"""Jobs on the embedded cluster: results, failures, cancel and timeout, with real processes."""

import gc
import hashlib
import os
import signal
import time

import psutil
import pytest
from distributed.spans import Span
from wsrender_server.jobs.service import JobService
from wsrender_server.settings import Settings

from tests.server.jobs.documents import canonical, design_optimization, indices_at
from tests.server.jobs.waiting import (
    PATIENCE_S,
    comparable,
    ended,
    in_state,
    local_document,
    partial_times,
    wait_until,
    within,
)

QUICK = {"sampling": {"method": "sobol", "count": 4096}, "voxel_size_m": 0.05, "device": "cpu"}
SHARDED = {**QUICK, "robot": "ur5e", "sampling": {"method": "sobol", "count": 2**20}, "voxel_size_m": 0.1}
FLOOR = {"items": [{"shape": "half_space", "point_m": [0, 0, -0.003]}]}
GUARDED = {**SHARDED, "environment": FLOOR, "constraints": {"self_collision": True}, "refined_volume": 0.03}
# Each of its shards takes many seconds: what happens to it happens in the middle of one.
LONG = {
    **SHARDED,
    "indices": "all",
    "precision": "float64",
    "sampling": {"method": "sobol", "count": 6 * 10**10, "seed": 1},
    "max_samples": 10**11,
}


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    settings = Settings(data_dir=tmp_path_factory.mktemp("data"), shard_samples=1 << 16, max_memory_bytes=2**30)
    with JobService(settings) as service:
        wait_until(lambda: service.worker_ready, what="a worker")
        yield service


@pytest.fixture(scope="module")
def store(service):
    return service.store


def kernel_pid(service):
    """That of the one kernel process, once its worker answers and it has started."""
    (pid,) = kernel_pids(service)
    return pid


def kernel_pids(service):
    """Those of all workers; one that is slow to answer is asked again."""

    def started():
        pids = [*service.dispatcher.engine.kernel_pids().values()]
        return len(pids) == service.settings.workers and all(pids) and pids

    return wait_until(started, what="the kernel processes")


def long_job(service, **options):
    """A job that would take minutes, in the middle of its samples."""
    seed = time.monotonic_ns() % 2**31  # never from the cache
    document = canonical(**{**LONG, "sampling": {**LONG["sampling"], "seed": seed}})
    job = service.store.submit("ann", document, **options).job.id
    wait_until(lambda: service.store.get("ann", job).progress.samples_done > 0, what="progress")
    return job


def quick_job(service):
    """A new quick job, run to its end."""
    seed = time.monotonic_ns() % 2**31
    document = canonical(**{**QUICK, "sampling": {"method": "sobol", "count": 4096, "seed": seed}})
    return ended(service.store, service.store.submit("ann", document).job.id)


@pytest.mark.parametrize("fields", (SHARDED, GUARDED), ids=("all", "guarded"))
def test_a_result_equals_the_local_run(store, tmp_path, fields):
    job = ended(store, store.submit("ann", canonical(**fields)).job.id)
    assert job.state == "succeeded", job.error
    document = store.result_document("ann", job.id)
    assert comparable(document) == local_document(canonical(**fields), tmp_path / "local")
    assert ("free" in document["volume_m3"]) == (fields is GUARDED)
    for artifact in store.artifacts("ann", job.id):
        content = store.artifact_path("ann", job.id, artifact.name).read_bytes()
        assert (len(content), hashlib.sha256(content).hexdigest()) == (artifact.bytes, artifact.sha256)
    assert {"result.json", "volume.vtkhdf", "plots/slices.png"} <= {a.name for a in store.artifacts("ann", job.id)}


@pytest.mark.parametrize(
    "search",
    [
        {"method": "sweep", "steps": 20},
        {"method": "differential_evolution", "population": 5, "generations": 2, "refine": False},
    ],
)
def test_a_killed_design_optimization_goes_on_where_it_was(service, store, search, tmp_path):
    """With the same result, and no design evaluated twice: each is a shard, of its generation's round."""
    inner = {"analysis": "workspace", "robot": "scara", **QUICK, "sampling": {"method": "sobol", "count": 2**16}}
    document = design_optimization(
        design={**inner, "robot": {"library": "scara", "tool": {"position_m": [0.01, 0, 0]}}},
        parameters=[{"name": "reach", "pointers": ["/robot/tool/position_m/0"], "bounds": [0.01, 0.1]}],
        objectives=[{"value": "/volume_m3/occupied"}],
        search=search,
    )
    job, folder = store.submit("ann", document).job.id, service.settings.data_dir
    kept = wait_until(lambda: len(times := partial_times(folder)) > 4 and times, what="designs")
    os.kill(kernel_pid(service), signal.SIGKILL)
    again = set()
    while store.get("ann", job).state in ("queued", "running"):
        now = partial_times(folder)
        again |= {name for name in kept if name in now and now[name] != kept[name]}
        time.sleep(0.01)
    assert ended(store, job).state == "succeeded" and not again
    assert comparable(store.result_document("ann", job)) == local_document(document, tmp_path / "local")


def test_a_kept_map_and_a_converging_job_equal_the_local_run(store, tmp_path):
    converge = {"method": "converge", "tolerance": 1e3, "start": 2, "step": 1}
    for number, fields in enumerate(
        [
            {"keep_map": True, "map_columns": ["configuration", "orientation"], "voxel_statistics": ["count", "mean"]},
            {"sampling": converge},
        ]
    ):
        document = canonical(**{**QUICK, **fields})
        job = ended(store, store.submit("ann", document).job.id)
        assert job.state == "succeeded", job.error
        local = local_document(document, tmp_path / str(number))
        assert comparable(store.result_document("ann", job.id)) == local


def test_indices_at_equals_the_local_run(store, tmp_path):
    configurations = [[0.1, 0.2, 0.05, 0.3], [0.4, 0.5, 0.02, 0.6]]
    document = indices_at(configurations=configurations, device="cpu")
    job = ended(store, store.submit("ann", document).job.id)
    assert job.state == "succeeded", job.error
    assert comparable(store.result_document("ann", job.id)) == local_document(document, tmp_path / "local")


def test_an_uploaded_model_is_named_by_its_hash(store):
    text = (
        "<mujoco><worldbody><body><joint name='a' axis='0 0 1' range='-1 1' limited='true'/>"
        "<geom size='.1'/><body pos='1 0 0'><joint name='b' axis='0 0 1' range='-1 1' limited='true'/>"
        "<geom size='.1'/><site name='tool' pos='1 0 0'/></body></body></worldbody>"
        "<compiler angle='radian'/></mujoco>"
    )
    sha256 = store.put_model("ann", text.encode())
    job = ended(
        store, store.submit("ann", canonical(**{**QUICK, "robot": {"model": sha256}, "task": ["x", "y"]})).job.id
    )
    assert job.state == "succeeded", job.error
    assert store.result_document("ann", job.id)["job"]["robot"]["model"] == sha256


@pytest.mark.parametrize(
    ("fields", "code", "field"),
    [
        ({"tip": "no such frame"}, "frame_not_found", "tip"),
        ({"indices": ["no_such_index"]}, "invalid_input", "indices"),
        ({"voxel_size_m": 1e-5}, "resource_limit", "voxel_size_m"),
        ({"device": "cuda:77"}, "invalid_input", "device"),
    ],
)
def test_a_job_that_cannot_run_fails_with_its_reason(store, fields, code, field):
    job = ended(store, store.submit("ann", canonical(**{**QUICK, **fields})).job.id)
    assert job.state == "failed"
    assert (job.error["code"], job.error["field"], job.error["retryable"]) == (code, field, False)


def test_a_native_crash_fails_only_its_own_job(service):
    job = long_job(service)
    beside = service.store.submit("bob", canonical(**QUICK)).job.id
    os.kill(kernel_pid(service), signal.SIGABRT)
    assert ended(service.store, beside, "bob").state == "succeeded"
    crashed = ended(service.store, job)
    assert crashed.state == "failed" and crashed.error["code"] == "kernel_crash"


def test_a_native_crash_leaves_the_job_beside_it_running(tmp_path):
    settings = Settings(data_dir=tmp_path, workers=2, threads_per_worker=1, shard_samples=1 << 26)
    with JobService(settings) as service:
        wait_until(lambda: len(service.dispatcher.engine.workers()) == 2, what="two workers")
        documents = [
            canonical(**{**LONG, "sampling": {"method": "sobol", "count": 2**25, "seed": s}}) for s in (21, 22)
        ]
        jobs = [service.store.submit("ann", document).job.id for document in documents]
        running = lambda: all(service.store.get("ann", job).progress.samples_done > 0 for job in jobs)  # noqa: E731
        wait_until(running, what="progress of both")
        os.kill(kernel_pids(service)[0], signal.SIGABRT)
        crashed, beside = sorted((ended(service.store, job) for job in jobs), key=lambda job: job.state)
        assert (crashed.state, crashed.error["code"]) == ("failed", "kernel_crash")
        assert beside.state == "succeeded", beside.error


def test_a_killed_kernel_process_is_no_fault_of_the_job(service, tmp_path):
    document = canonical(**{**SHARDED, "sampling": {"method": "sobol", "count": 2**20, "seed": 7}})
    submitted, pid = service.store.submit("ann", document), kernel_pid(service)
    job, mine = submitted.job.id, (service.settings.data_dir, submitted.computation)
    kept = wait_until(lambda: partial_times(*mine), what="a partial result")
    os.kill(pid, signal.SIGKILL)
    again = []
    while service.store.get("ann", job).state == "running":
        now = partial_times(*mine)
        again += [name for name in kept if name in now and now[name] != kept[name]]
        time.sleep(0.02)
    assert ended(service.store, job).state == "succeeded" and again == []
    assert comparable(service.store.result_document("ann", job)) == local_document(document, tmp_path / "local")


def test_a_process_lost_while_it_merges_costs_no_partial_result(service, tmp_path):
    document = canonical(**{**SHARDED, "sampling": {"method": "sobol", "count": 2**20, "seed": 12}})
    submitted, pid = service.store.submit("ann", document), kernel_pid(service)
    job, mine = submitted.job.id, (service.settings.data_dir, submitted.computation)
    wait_until(lambda: any((service.settings.data_dir / "scratch").iterdir()), what="the writing of the result")
    os.kill(pid, signal.SIGKILL)  # at once: it may be about to end
    kept = partial_times(*mine)
    again = []
    while service.store.get("ann", job).state == "running":
        now = partial_times(*mine)
        again += [name for name in kept if name in now and now[name] != kept[name]]
        time.sleep(0.02)
    assert len(kept) == 17 and again == []  # of 16 shards, and of the refined volume
    assert ended(service.store, job).state == "succeeded"
    assert comparable(service.store.result_document("ann", job)) == local_document(document, tmp_path / "local")
    assert list((service.settings.data_dir / "scratch").iterdir()) == []


def test_a_damaged_partial_result_is_computed_again(service, tmp_path):
    document = canonical(**{**SHARDED, "sampling": {"method": "sobol", "count": 2**20, "seed": 13}})
    job, folder = service.store.submit("ann", document).job.id, service.settings.data_dir
    for name in wait_until(lambda: partial_times(folder), what="a partial result"):
        (folder / name).write_bytes(b"")
    assert ended(service.store, job).state == "succeeded"
    assert comparable(service.store.result_document("ann", job)) == local_document(document, tmp_path / "local")


def test_too_much_memory_fails_only_its_own_job(service):
    # Some 2 GiB: more than a job may have here, and less than a machine is refused for that others use too.
    statistics = {"indices": ["manipulability"], "voxel_statistics": ["count", "maximum", "minimum"]}
    fields = {**LONG, **statistics, "voxel_size_m": 0.0075}
    job = ended(service.store, service.store.submit("ann", canonical(**fields)).job.id)
    assert job.state == "failed" and job.error["code"] == "out_of_memory", job.error
    assert "GiB" in job.error["message"]
    assert quick_job(service).state == "succeeded"


def test_cancel_frees_the_slot_within_3_s(service):
    job = long_job(service)
    pid = kernel_pid(service)
    with within(3):
        service.store.cancel("ann", job)
        in_state(service.store, job, "canceled")
        wait_until(lambda: not computes(pid), what="the end of the computation")
    assert quick_job(service).state == "succeeded"


def test_a_timeout_is_enforced_within_1_s(service):
    document = canonical(**{**LONG, "sampling": {**LONG["sampling"], "seed": 2}})
    job = service.store.submit("ann", document, timeout_s=4).job.id
    in_state(service.store, job, "running")
    pid = kernel_pid(service)
    with within(5):
        record = ended(service.store, job)
    assert record.state == "timed_out" and record.error["code"] == "timed_out"
    assert (record.finished_at - record.started_at).total_seconds() >= 4
    with within(1):
        wait_until(lambda: not computes(pid), what="the end of the computation")
    assert not service.store.unfinished() or quick_job(service).state == "succeeded"


@pytest.mark.parametrize(("end", "options"), [("canceled", {}), ("timed_out", {"timeout_s": 3})])
def test_a_job_that_iterates_ends_as_any(service, end, options):
    sampling = {"method": "converge", "tolerance": 1e-300, "start": 20, "step": 1, "max_samples": 10**12}
    document = canonical(**{**LONG, "sampling": sampling, "voxel_size_m": 0.1 + 0.01 * len(end), "max_samples": 10**12})
    job = service.store.submit("ann", document, **options).job.id
    in_state(service.store, job, "running")
    wait_until(lambda: service.store.get("ann", job).progress.message == "samples" or options, what="the samples")
    assert service.store.get("ann", job).progress.samples_total is None
    if end == "canceled":
        service.store.cancel("ann", job)
    with within(5):
        in_state(service.store, job, end)
    assert quick_job(service).state == "succeeded"


def test_a_refined_volume_says_how_far_it_is_and_ends_as_any(service):
    document = canonical(**{**QUICK, "robot": "gao_6r", "refined_volume": 0.001, "voxel_size_m": 0.02})
    job = service.store.submit("ann", document).job.id
    finishing = lambda: "decided by inverse kinematics" in service.store.get("ann", job).progress.message  # noqa: E731
    wait_until(finishing, what="the refined volume")
    assert service.store.get("ann", job).progress.fraction == 0.99
    with within(3):
        service.store.cancel("ann", job)
        in_state(service.store, job, "canceled")
    assert quick_job(service).state == "succeeded"


def test_a_canceled_job_can_be_retried_and_keeps_its_partial_results(service):
    document = canonical(**{**SHARDED, "sampling": {"method": "sobol", "count": 2**21, "seed": 8}})
    job = service.store.submit("ann", document).job.id
    wait_until(lambda: len(partial_times(service.settings.data_dir)) > 2, what="partial results")
    with within(3):
        service.store.cancel("ann", job)
        in_state(service.store, job, "canceled")
    kept = partial_times(service.settings.data_dir)
    service.store.retry("ann", job)
    again = []
    while service.store.get("ann", job).state in ("queued", "running"):
        now = partial_times(service.settings.data_dir)
        again += [name for name in kept if name in now and now[name] != kept[name]]
        time.sleep(0.02)
    assert ended(service.store, job).state == "succeeded" and again == []


def test_progress_grows_and_ends_at_one(service):
    document = canonical(**{**SHARDED, "sampling": {"method": "sobol", "count": 2**22, "seed": 9}})
    submitted, pid = service.store.submit("ann", document), kernel_pid(service)
    job, mine = submitted.job.id, (service.settings.data_dir, submitted.computation)
    wait_until(lambda: partial_times(*mine), what="a partial result")
    os.kill(pid, signal.SIGSTOP)  # on a fast machine all would be over before it is recorded
    try:
        told = lambda: (progress := service.store.get("ann", job).progress).rate_per_s and progress  # noqa: E731
        under_way = wait_until(told, what="the rate")
    finally:
        os.kill(pid, signal.SIGCONT)
    assert under_way.samples_total == 2**22 and under_way.eta_s is not None
    seen = []
    while (record := service.store.get("ann", job)).state in ("queued", "running"):
        if not seen or record.progress != seen[-1]:
            seen.append(record.progress)
        time.sleep(0.05)
    fractions = [progress.fraction for progress in [*seen, record.progress]]
    assert record.state == "succeeded" and fractions == sorted(fractions) and fractions[-1] == 1.0


def test_an_urgent_job_goes_first(service):
    running = long_job(service)
    later = service.store.submit("ann", canonical(**{**QUICK, "voxel_size_m": 0.06})).job.id
    urgent = service.store.submit("ann", canonical(**{**QUICK, "voxel_size_m": 0.07}), priority=5).job.id
    time.sleep(0.5)
    service.store.cancel("ann", running)
    assert ended(service.store, urgent).finished_at < ended(service.store, later).finished_at


def test_a_waiting_job_goes_first_with_an_urgent_twin(service):
    running = long_job(service)
    first = service.store.submit("ann", canonical(**{**QUICK, "voxel_size_m": 0.061})).job.id
    twin = canonical(**{**QUICK, "voxel_size_m": 0.071})
    waiting = service.store.submit("ann", twin).job.id
    time.sleep(0.5)
    urgent = service.store.submit("ann", twin, priority=5).job.id
    time.sleep(0.5)
    service.store.cancel("ann", running)
    ends = [ended(service.store, job).finished_at for job in (waiting, urgent, first)]
    assert ends[0] < ends[2] and ends[1] < ends[2]


def test_partial_results_and_scratch_do_not_stay(service):
    assert quick_job(service).state == "succeeded"
    computations = set(service.store.unfinished())
    assert computations == set()
    assert list((service.settings.data_dir / "scratch").iterdir()) == []


def test_the_worker_is_described(service):
    (worker,) = wait_until(service.workers, timeout=PATIENCE_S)
    assert worker.target.startswith(("cpu:", "cuda:")) and "cpu" in worker.devices and not worker.busy


def computes(pid):
    """Whether a kernel process takes processor time; one that was between two shards need not end."""
    try:
        process = psutil.Process(pid)
        before = process.cpu_times()
        time.sleep(0.2)
        return process.status() != psutil.STATUS_ZOMBIE and process.cpu_times() != before
    except psutil.NoSuchProcess:
        return False


def test_dask_keeps_nothing_of_jobs_that_have_ended(service, store):
    """What it measures of them, in the scheduler and in its workers; by default it grows with every job, for ever."""
    kept = []
    for number in range(6):
        job = store.submit("ann", indices_at(configurations=[[0.1 + 1e-3 * number, 0.2, 0.05, 0.3]])).job.id
        assert ended(store, job).state == "succeeded"
        wait_until(lambda: not service.dispatcher._attempts, what="the end of the attempt")
        kept.append(kept_by_dask(service.dispatcher.engine._client))
    assert kept[-1] == kept[1]


def kept_by_dask(client):
    """Spans of the scheduler, which is here, and what its worker has measured."""
    (measured,) = client.run(lambda dask_worker: sorted(map(str, dask_worker.digests_total))).values()
    gc.collect()
    return sum(isinstance(each, Span) for each in gc.get_objects()), measured
