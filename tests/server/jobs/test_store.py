"""The contract of the job store, the same on SQLite and PostgreSQL."""

import asyncio
import hashlib
import json
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from datetime import datetime, timedelta

import pytest
from sqlalchemy import select
from wsrender_server.jobs.documents import CanonicalDocument
from wsrender_server.jobs.faults import DiskFull, IdempotencyConflict, InvalidTransition, QueueFull, StoreUnavailable
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.records import ArtifactRecord, ComputationState, JobState, Progress
from wsrender_server.jobs.store import JobStore
from wsrender_server.jobs.tables import Computation

from tests.server.jobs.documents import canonical
from wsrender.analyses.jobs import canonical_json, parse_job
from wsrender.errors import InputError

RESULT = b'{"analysis": "workspace"}'
AT_ONCE = 1e-6  # s: a timeout that is over when the next statement runs


def running(store, document, owner="ann", **options):
    """A submitted job whose computation has begun: (job id, computation id)."""
    job = store.submit(owner, document, **options).job
    (computation_id,) = store.unfinished()
    assert store.begin(computation_id, store.computation(computation_id).attempt)
    store.time_out()  # as at every tick of the dispatcher: the job's time runs from now on
    return job.id, computation_id


def complete(store, computation_id, content=RESULT):
    """End a computation with one artifact, whose file is returned."""
    sha256 = hashlib.sha256(content).hexdigest()
    path = store.files.artifact(computation_id, sha256)
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(content)
    record = ArtifactRecord("result.json", "application/json", len(content), sha256)
    store.complete(computation_id, store.computation(computation_id).attempt, [record])
    return path


def states(store, owner, *jobs):
    return [store.get(owner, job).state for job in jobs]


def test_a_submitted_job_is_queued_and_complete(store, document):
    submission = store.submit("ann", document, labels={"lab": "7"}, priority=3, timeout_s=60)
    assert not submission.replayed and not submission.cached
    job = store.get("ann", submission.job.id)
    assert job == submission.job
    assert (job.state, job.analysis, job.labels, job.priority) == (JobState.QUEUED, "workspace", {"lab": "7"}, 3)
    assert (job.attempt, job.timeout_s, store.document("ann", job.id), job.error) == (1, 60, document, None)
    assert job.progress == Progress() and job.started_at is None and job.created_at.tzinfo is not None


@pytest.mark.parametrize(
    ("settled", "reported", "expected"),
    [
        ({"shards": [[0, 30], [30, 10], [40, 0]], "iterates": False}, None, (40, 40)),
        ({"shards": [[0, 30], [30, 10]], "iterates": False}, Progress(0.5, 20, 90), (40, 40)),
        ({"shards": [[0, 0]], "iterates": False}, None, (0, None)),
        ({"shards": [[0, 30]], "iterates": True}, Progress(0.0, 70, None), (70, None)),
        (None, Progress(0.5, 20, 40), (40, 40)),
    ],
)
def test_an_ended_job_says_its_samples(store, document, settled, reported, expected):
    """Though it was so fast that nobody looked; and so does an equal one, which the cache answers."""
    job, computation = running(store, document)
    if settled:
        store.settle(computation, settled, "cpu:x86")
    if reported:
        store.report({computation: reported})
    complete(store, computation)
    store.set_targets({"auto": "cpu:x86", "cpu": "cpu:x86"} if settled else {})
    for ended in (store.get("ann", job), *([store.submit("ann", document).job] if settled else [])):
        assert ended.state == JobState.SUCCEEDED
        assert (ended.progress.samples_done, ended.progress.samples_total) == expected


def test_a_job_lives_through_its_states_with_one_event_each(store, document):
    job, computation = running(store, document)
    store.report({computation: Progress(0.25, 10, 40, 5.0, 6.0, "samples")})
    store.report({computation: Progress(0.5, 20, 40, 5.0, 4.0, "samples")})
    assert store.get("ann", job).progress == Progress(0.5, 20, 40, 5.0, 4.0, "samples")
    complete(store, computation)
    ended = store.get("ann", job)
    assert ended.state == JobState.SUCCEEDED and ended.progress.fraction == 1.0
    assert ended.created_at <= ended.started_at <= ended.finished_at
    events = store.news("ann", job, 0)[1]
    assert [(e.id, e.type) for e in events] == [(1, "state"), (2, "state"), (4, "progress"), (5, "state")]
    assert [e.data["state"] for e in events if e.type == "state"] == ["queued", "running", "succeeded"]
    assert [e.id for e in store.news("ann", job, 2)[1]] == [4, 5]
    assert ended.last_event == 5


def test_foreign_jobs_do_not_exist(store, document):
    job, computation = running(store, document)
    complete(store, computation)
    for method in (store.get, store.cancel, store.retry, store.delete, store.result_document):
        assert method("bob", job) is None
    assert store.news("bob", job, 0)[1] == [] and store.artifacts("bob", job) == []
    assert store.artifact_path("bob", job, "result.json") is None
    assert store.list("bob") == ([], None)
    assert store.get("ann", job).state == JobState.SUCCEEDED


def test_unknown_jobs_do_not_exist(store):
    for job in ("0" * 32, "", "../../etc/passwd", "x" * 1000, "%00"):
        assert store.get("ann", job) is None and store.cancel("ann", job) is None


def test_a_repeated_idempotency_key_gives_the_same_job(store, document):
    first = store.submit("ann", document, idempotency_key="k", body_hash="1")
    again = store.submit("ann", document, idempotency_key="k", body_hash="1")
    assert again.replayed and again.job.id == first.job.id
    with pytest.raises(IdempotencyConflict):
        store.submit("ann", document, idempotency_key="k", body_hash="2")
    assert not store.submit("bob", document, idempotency_key="k", body_hash="2").replayed
    assert len(store.list("ann")[0]) == 1


def test_a_key_sent_many_times_at_once_gives_one_job(store, document):
    def submit(_):
        return store.submit("ann", document, idempotency_key="k", body_hash="1").job.id

    with ThreadPoolExecutor(8) as pool:
        assert len(set(pool.map(submit, range(24)))) == 1
    assert len(store.list("ann")[0]) == 1


def test_twins_at_once_share_one_computation(database, tmp_path, document):
    store = JobStore(database, DataFolder(tmp_path / "data"), max_queued_per_owner=100)
    with ThreadPoolExecutor(8) as pool:
        jobs = list(pool.map(lambda _: store.submit("ann", document).job.id, range(24)))
    assert len(set(jobs)) == 24 and len(store.unfinished()) == 1


def test_results_are_cached_per_owner(store, document):
    job, computation = running(store, document)
    complete(store, computation)
    cached = store.submit("ann", document)
    assert cached.cached and cached.job.state == JobState.SUCCEEDED and cached.job.id != job
    assert cached.job.finished_at >= cached.job.started_at
    assert store.result_document("ann", cached.job.id) == {"analysis": "workspace"}
    assert not store.submit("bob", document).cached
    assert not store.submit("ann", canonical(precision="float64")).cached


def test_a_shared_cache_serves_library_robots_only(database, tmp_path):
    store = JobStore(database, DataFolder(tmp_path / "data"), shared_cache=True)
    _, computation = running(store, canonical())
    complete(store, computation)
    assert store.submit("bob", canonical()).cached
    table = {"dh": {"convention": "standard", "rows": [{"joint": "revolute", "a": 1.0}]}}
    _, own = running(store, canonical(robot=table))
    complete(store, own)
    assert store.submit("ann", canonical(robot=table)).cached
    assert not store.submit("bob", canonical(robot=table)).cached


def test_another_target_is_another_computation(store, document):
    _, computation = running(store, document)
    store.settle(computation, {"shards": [[0, 81]]}, "cpu:a")
    complete(store, computation)
    store.set_targets({"auto": "cpu:a", "cpu": "cpu:a"})
    assert store.submit("ann", document).cached  # the target was not known yet when it was submitted
    store.set_targets({"auto": "cpu:b"})
    assert not store.submit("ann", document).cached


def test_what_a_plan_settled_is_kept(store, document):
    _, computation = running(store, document)
    settled = {"voxel_size_m": 0.1 + 0.2, "scales": [2.0**40], "bounds": [1 / 3], "shards": [[0, 81]]}
    store.settle(computation, settled, "cpu:a")
    record = store.computation(computation)
    assert record.resolved == settled and record.target == "cpu:a" and record.document == CanonicalDocument.of(document)


def test_the_last_job_stops_its_computation(store, document):
    first, computation = running(store, document)
    second = store.submit("ann", document).job.id
    assert states(store, "ann", first, second) == [JobState.RUNNING, JobState.RUNNING]
    assert store.cancel("ann", first).state == JobState.CANCELED
    assert store.unfinished()[computation][0] == ComputationState.RUNNING
    assert store.cancel("ann", second).state == JobState.CANCELING
    assert store.cancel("ann", second).state == JobState.CANCELING
    assert store.unfinished()[computation][0] == ComputationState.STOPPING
    store.stopped(computation, 1)
    assert states(store, "ann", second) == [JobState.CANCELED] and not store.unfinished()


def test_a_waiting_job_is_canceled_at_once(store, document):
    job = store.submit("ann", document).job.id
    assert store.cancel("ann", job).state == JobState.CANCELED
    assert not store.unfinished()


def test_a_job_that_comes_while_its_twin_stops_starts_anew(store, document):
    first, computation = running(store, document)
    store.cancel("ann", first)
    second = store.submit("ann", document).job
    assert second.state == JobState.QUEUED
    store.stopped(computation, 1)
    assert store.unfinished()[computation] == (ComputationState.WAITING, 2)
    assert states(store, "ann", first, second.id) == [JobState.CANCELED, JobState.QUEUED]


def test_failure_reaches_every_job_and_is_not_cached(store, document):
    first, computation = running(store, document)
    second = store.submit("ann", document).job.id
    error = {"code": "kernel_crash", "message": "…", "retryable": False}
    store.fail(computation, 1, error)
    assert states(store, "ann", first, second) == [JobState.FAILED] * 2
    assert store.get("ann", first).error == error
    assert store.submit("ann", document).job.state == JobState.QUEUED
    assert store.unfinished()[computation] == (ComputationState.WAITING, 2)


def test_retry_starts_a_new_attempt(store, document):
    job, computation = running(store, document)
    store.report({computation: Progress(0.5, 1, 2)})
    store.fail(computation, 1, {"code": "x", "message": "y", "retryable": True})
    again = store.retry("ann", job)
    assert (again.state, again.attempt, again.error) == (JobState.QUEUED, 2, None)
    assert again.progress == Progress() and again.started_at is None and again.finished_at is None
    store.begin(computation, 2)
    complete(store, computation)
    assert store.get("ann", job).state == JobState.SUCCEEDED


def test_a_result_that_came_while_the_server_restarted_counts(store, document):
    """A worker elsewhere went on with the last step, and says its beginning no second time."""
    job, computation = running(store, document)
    store.recover()
    assert states(store, "ann", job) == [JobState.RUNNING]
    complete(store, computation)
    assert states(store, "ann", job) == [JobState.SUCCEEDED] and not store.unfinished()


def test_what_an_earlier_attempt_says_is_ignored(store, document):
    job, computation = running(store, document)
    store.fail(computation, 1, {"code": "x", "message": "y", "retryable": True})
    store.retry("ann", job)
    assert not store.begin(computation, 1)
    store.fail(computation, 1, {"code": "late", "message": "", "retryable": False})
    store.complete(computation, 1, [])
    assert store.get("ann", job).state == JobState.QUEUED


@pytest.mark.parametrize(
    ("action", "allowed"),
    [
        ("cancel", {"queued", "running"}),
        ("retry", {"failed", "canceled"}),
        ("delete", {"succeeded", "failed", "canceled"}),
    ],
)
def test_every_state_allows_only_its_actions(store, document, action, allowed):
    for count, state in enumerate(("queued", "running", "succeeded", "failed", "canceled"), start=1):
        own = canonical(sampling={"method": "random", "count": count, "seed": 1})
        job = job_in(store, state, own)
        if state in allowed:
            assert getattr(store, action)("ann", job) is not None
        else:
            with pytest.raises(InvalidTransition) as refused:
                getattr(store, action)("ann", job)
            assert refused.value.state == state


def job_in(store, state, document):
    """A job of its own computation, brought into a state."""
    job = store.submit("ann", document).job.id
    computation = next(c for c in store.unfinished() if store.computation(c).document == CanonicalDocument.of(document))
    if state == "canceled":
        store.cancel("ann", job)
    elif state != "queued":
        store.begin(computation, 1)
    if state == "succeeded":
        complete(store, computation)
    elif state == "failed":
        store.fail(computation, 1, {"code": "x", "message": "y", "retryable": False})
    assert store.get("ann", job).state == state
    return job


def test_deleting_the_last_job_removes_the_result(store, document):
    first, computation = running(store, document)
    complete(store, computation)
    second = store.submit("ann", document).job.id
    path = store.artifact_path("ann", first, "result.json")
    store.delete("ann", first)
    assert store.get("ann", first) is None and path.exists()
    store.delete("ann", second)
    assert not path.exists() and store.computation(computation) is None
    assert not store.submit("ann", document).cached


@pytest.mark.parametrize("end", ["stopped", "completed", "failed"])
def test_a_computation_whose_jobs_are_deleted_while_it_stops_is_forgotten(store, document, end):
    """However it ends: its row would stay for ever."""
    job, computation = running(store, document, timeout_s=AT_ONCE)
    assert store.time_out() == [job]
    store.delete("ann", job)
    assert store.unfinished()[computation][0] == ComputationState.STOPPING
    attempt = store.computation(computation).attempt
    if end == "stopped":
        store.stopped(computation, attempt)
    elif end == "completed":
        assert not complete(store, computation).parent.exists()
    else:
        store.fail(computation, attempt, {"code": "kernel_crash", "message": "…", "retryable": True})
    assert store.computation(computation) is None and store.usage()["results"] == 0
    assert not store.submit("ann", document).cached


def test_a_more_urgent_twin_makes_a_waiting_computation_go_out_anew(store, document):
    store.submit("ann", document)
    ((computation, (_state, attempt)),) = store.unfinished().items()
    store.submit("ann", document, priority=-1)
    assert store.computation(computation).attempt == attempt
    store.submit("ann", document, priority=7)
    urgent = store.computation(computation)
    assert (urgent.attempt, urgent.priority) == (attempt + 1, 7)
    assert not store.begin(computation, attempt) and store.begin(computation, attempt + 1)
    store.submit("ann", document, priority=9)
    assert store.computation(computation).attempt == attempt + 1  # it runs


def test_artifacts_are_of_succeeded_jobs_only(store, document):
    job, computation = running(store, document)
    assert store.artifacts("ann", job) == [] and store.result_document("ann", job) is None
    complete(store, computation)
    (artifact,) = store.artifacts("ann", job)
    assert (artifact.name, artifact.sha256) == ("result.json", hashlib.sha256(RESULT).hexdigest())
    assert store.artifact_path("ann", job, "../result.json") is None


def test_timeouts_detach_their_own_job_only(store, document):
    first, computation = running(store, document, timeout_s=AT_ONCE)
    second = store.submit("ann", document, timeout_s=3600).job.id
    assert store.time_out() == [first] and store.time_out() == []
    assert states(store, "ann", first, second) == [JobState.TIMED_OUT, JobState.RUNNING]
    assert store.get("ann", first).error["code"] == "timed_out"
    assert store.unfinished()[computation][0] == ComputationState.RUNNING


def test_time_runs_by_a_clock_that_nobody_sets(store, database, tmp_path, document, monkeypatch):
    """Neither a jump of the time of day nor a restart gives or takes time; what another attempt took does not count."""
    began = time.monotonic()
    job, computation = running(store, document, timeout_s=100)

    class Jumped(datetime):
        @classmethod
        def now(cls, tz=None):
            return datetime.now(tz) + timedelta(days=10)

    for module in ("computations", "store", "tables"):
        monkeypatch.setattr(f"wsrender_server.jobs.{module}.datetime", Jumped, raising=False)
    assert store.time_out() == [] and store.time_out(began + 60) == []
    another = JobStore(database, DataFolder(tmp_path / "data"))  # of a later process
    another.recover()
    another.begin(computation, 1)
    assert another.time_out(1e6) == [] and another.time_out(1e6 + 35) == [] and another.time_out(1e6 + 45) == [job]
    another.stopped(computation, 1)
    another.retry("ann", job)
    another.begin(computation, 2)
    assert another.time_out(1e6 + 46) == [] and another.time_out(1e6 + 145) == []
    assert another.time_out(1e6 + 147) == [job]


def test_a_timed_out_computation_stops(store, document):
    job, computation = running(store, document, timeout_s=AT_ONCE)
    store.time_out()
    assert states(store, "ann", job) == [JobState.TIMED_OUT]
    assert store.unfinished()[computation][0] == ComputationState.STOPPING
    store.stopped(computation, 1)
    assert store.retry("ann", job).state == JobState.QUEUED


def test_recovery_lets_what_ran_wait_again(store, document):
    job, computation = running(store, document)
    store.recover()
    assert store.unfinished()[computation] == (ComputationState.WAITING, 1)
    assert store.get("ann", job).state == JobState.RUNNING
    assert store.begin(computation, 1)


def test_pages_hold_every_job_once_newest_first(store):
    for index in range(5):
        store.submit("ann", canonical(sampling={"method": "random", "count": 10 + index, "seed": 0}))
    seen, cursor = [], None
    while True:
        page, cursor = store.list("ann", limit=2, cursor=cursor)
        seen += page
        if cursor is None:
            break
    assert len({job.id for job in seen}) == 5
    assert [job.created_at for job in seen] == sorted((job.created_at for job in seen), reverse=True)


def test_lists_are_filtered(store, document):
    job = store.submit("ann", document, labels={"lab": "7", "run": "a"}).job.id
    other = store.submit("ann", canonical(precision="float64"), labels={"lab": "8"}).job.id
    store.cancel("ann", other)

    def ids(**query):
        return [record.id for record in store.list("ann", **query)[0]]

    assert ids(label=("lab", "7")) == [job] and ids(label=("lab", "9")) == []
    assert ids(state="canceled") == [other] and ids(state="queued", label=("run", "a")) == [job]
    assert ids(analysis="workspace") == [other, job] and ids(analysis="indices_at") == []


ROWS = [{"a": 0.4, "limits": [-1, 1]}] * 2
MJCF = (
    "<mujoco model='crane'><worldbody><body><joint name='a' range='-1 1'/><geom size='.1'/></body></worldbody></mujoco>"
)
URDF = '<?xml version="1.0"?><!-- <robot name="other"> --><robot name="Bären&#10;arm"><link name="base"/></robot>'
UPLOADED = {"model": hashlib.sha256(MJCF.encode()).hexdigest()}


@pytest.mark.parametrize(
    ("robot", "name"),
    [
        ({"library": "ur5e"}, "ur5e"),
        ({"dh": {"convention": "standard", "rows": ROWS, "name": "two links"}}, "two links"),
        ({"mjcf": MJCF}, "crane"),
        ({"mjcf": MJCF.replace("model='crane'", "")}, "MJCF"),
        ({"urdf": URDF}, "Bären arm"),
        (UPLOADED, f"model {UPLOADED['model'][:8]}"),
        (UPLOADED | {"entry": "urdf/panda.urdf"}, "panda"),
    ],
)
def test_jobs_name_their_robots(store, robot, name):
    """And are found by a part of that, in whatever case; signs of patterns stand for themselves."""
    store.put_model("ann", MJCF.encode())
    job = store.submit("ann", canonical(robot=robot)).job
    store.submit("ann", canonical(robot="scara"))
    assert job.robots == (name,) == store.get("ann", job.id).robots

    def found(part):
        return [record.id for record in store.list("ann", robot=part)[0]]

    assert found(name) == found(name[1:-1]) == found(name.swapcase() if name.isascii() else name) == [job.id]
    assert found("_" * len(name)) == found("%") == found(f"{name}%") == []


def test_jobs_name_each_of_several_robots_once_and_mechanisms(store):
    def robots(**fields):
        return store.submit("ann", json.loads(canonical_json(parse_job(fields)))).job.robots

    sampling = {"method": "sobol", "count": 64}
    arms = [{"robot": {"library": name}, "sampling": sampling} for name in ("ur5e", "puma560", "ur5e")]
    assert robots(analysis="shared_workspace", robots=arms, voxel_size_m=0.1) == ("ur5e", "puma560")
    assert robots(analysis="parallel_workspace", mechanism="six_pus", voxel_size_m=0.1) == ("six_pus",)
    several = [
        {
            "name": f"r{k}",
            "robot": {"dh": {"convention": "standard", "rows": ROWS, "name": f"arm {k}"}},
            "sampling": sampling,
        }
        for k in range(20)
    ]
    assert robots(analysis="robot_comparison", robots=several, voxel_size_m=0.1) == tuple(f"arm {k}" for k in range(16))


def test_jobs_that_an_earlier_version_has_taken_in_name_no_robots(store, document):
    job = store.submit("ann", document).job
    with store.transactions.write() as session:
        (row,) = session.scalars(select(Computation))
        row.facts = {name: value for name, value in row.facts.items() if name != "robots"}
    assert store.get("ann", job.id).robots == () and store.document("ann", job.id) == document
    assert [record.robots for record in store.list("ann")[0]] == [()]
    assert store.list("ann", robot="scara")[0] == []


@pytest.mark.parametrize("cursor", ["", "x", "....", "é", "MTIz", "OTk5OTk5OTk5OTk5OTk5OTk5OTk5OTk5Lng", "A" * 5000])
def test_a_made_up_cursor_is_refused(store, cursor):
    with pytest.raises(InputError, match="cursor"):
        store.list("ann", cursor=cursor)


def test_an_owner_has_a_limit_of_unfinished_jobs(store):
    jobs = [canonical(sampling={"method": "random", "count": 10 + i, "seed": 0}) for i in range(6)]
    submitted = [store.submit("ann", job).job.id for job in jobs[:5]]
    with pytest.raises(QueueFull) as refused:
        store.submit("ann", jobs[5])
    assert refused.value.limit == 5
    store.submit("bob", jobs[5])
    store.cancel("ann", submitted[0])
    store.submit("ann", jobs[5])


def test_the_limit_holds_against_a_burst(database, tmp_path):
    store = JobStore(database, DataFolder(tmp_path / "data"), max_queued_per_owner=60)
    documents = [canonical(sampling={"method": "random", "count": 10 + i, "seed": 0}) for i in range(200)]

    def submit(document):
        try:
            return store.submit("ann", document).job.id
        except QueueFull:
            return None

    with ThreadPoolExecutor(8) as pool:
        accepted = [job for job in pool.map(submit, documents) if job]
    found, cursor = store.list("ann", limit=500)
    assert cursor is None and sorted(job.id for job in found) == sorted(accepted)
    # Several connections of PostgreSQL may count at the same moment; SQLite has one writer.
    assert 60 <= len(accepted) <= 68 and len(store.unfinished()) == len(accepted)


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"labels": {"a": "x" * 256}}, "labels"),
        ({"labels": {"a\x00": "x"}}, "labels"),
        ({"labels": {"a": "\ud800"}}, "labels"),
        ({"labels": {str(i): "" for i in range(33)}}, "labels"),
        ({"idempotency_key": "k\n"}, "idempotency_key"),
        ({"priority": 10**6}, "priority"),
    ],
)
def test_options_out_of_bounds_are_refused(store, document, options, field):
    with pytest.raises(InputError) as refused:
        store.submit("ann", document, **options)
    assert refused.value.field == field and store.list("ann") == ([], None)


def test_robots_by_path_are_refused(store):
    with pytest.raises(InputError, match=r"robot\.path"):
        store.submit("ann", canonical(robot={"path": "/etc/passwd"}))


def test_models_belong_to_their_owner(store):
    sha256 = store.put_model("ann", b"<mujoco/>")
    assert store.put_model("ann", b"<mujoco/>") == sha256
    assert store.model_path("ann", sha256).read_bytes() == b"<mujoco/>" and store.model_path("bob", sha256) is None
    with pytest.raises(InputError, match=r"robot\.model"):
        store.submit("bob", canonical(robot={"model": sha256}))
    assert store.submit("ann", canonical(robot={"model": sha256})).job.state == JobState.QUEUED


def test_a_model_sent_many_times_at_once_is_kept_once(store):
    content = b"<mujoco/>" + b" " * 2**20
    with ThreadPoolExecutor(8) as pool:
        (sha256,) = set(pool.map(lambda _: store.put_model("ann", content), range(24)))
    assert [path.name for path in (store.files.root / "models").iterdir()] == [sha256]
    assert store.model_path("ann", sha256).read_bytes() == content


def test_keys_are_found_until_revoked(store):
    assert not store.has_key()
    made, secret = store.create_key("lab", ["read", "submit"])
    key = made.id
    assert store.has_key()
    found = store.find_key(secret)
    assert (found.id, found.name, found.scopes) == (key, "lab", ("read", "submit"))
    for wrong in ("", "wsr", secret[:-1], secret + "x", secret.replace(key, "0" * 16), "wsr_é_x", "\ud800"):
        assert store.find_key(wrong) is None
    assert store.revoke_key(key).revoked_at is not None and store.revoke_key("0" * 16) is None
    assert store.find_key(secret) is None and not store.has_key() and [k.id for k in store.list_keys()] == [key]


def test_no_secret_is_kept(store, database):
    _, secret = store.create_key("lab")
    with database.connect() as connection:
        rows = connection.exec_driver_sql("SELECT * FROM keys").fetchall()
    assert secret.split("_", 2)[2] not in repr(rows)


@pytest.mark.parametrize("scopes", [[], ["root"], ["read", "write"]])
def test_unknown_scopes_are_refused(store, scopes):
    with pytest.raises(InputError, match="scopes"):
        store.create_key("lab", scopes)


def test_followers_are_woken_by_a_change_and_share_what_they_read(store, document):
    job, computation = running(store, document)
    reads = []

    def read():
        reads.append(threading.get_ident())
        return store.get("ann", job).state

    async def follow():
        with store.changes.watch(job) as watch:
            seen, news = await watch.read("state", read)
            return seen, await watch.wait(news, 10), (await watch.read("state", read))[0]

    async def follow_many():
        threading.Timer(0.3, lambda: complete(store, computation)).start()
        return await asyncio.gather(*(follow() for _ in range(20)))

    assert set(asyncio.run(follow_many())) == {(JobState.RUNNING, True, JobState.SUCCEEDED)}
    assert len(reads) == 2


def test_waiting_ends_in_time_and_reads_anew(store, document):
    job = store.submit("ann", document).job.id
    reads = iter(range(3))

    async def follow():
        with store.changes.watch(job) as watch:
            first, news = await watch.read("", lambda: next(reads))
            assert (await watch.read("", lambda: next(reads)))[0] == first
            assert not await watch.wait(news, 0.05)
            return first, (await watch.read("", lambda: next(reads)))[0]

    assert asyncio.run(follow()) == (0, 1)


def test_a_read_that_failed_is_not_kept(store, document):
    job = store.submit("ann", document).job.id
    answers = iter([StoreUnavailable("locked"), None])

    def read():
        answer = next(answers)
        if answer is not None:
            raise answer
        return "read"

    async def follow():
        with store.changes.watch(job) as watch:
            with pytest.raises(StoreUnavailable):
                await watch.read("", read)
            return (await watch.read("", read))[0]

    assert asyncio.run(follow()) == "read"


def test_the_queue_is_summarised(store, document):
    running(store, document)
    store.submit("bob", document)
    summary = store.queue_summary()
    assert summary.jobs["running"] == 1 and summary.jobs["queued"] == 1
    assert (summary.waiting, summary.running) == (1, 1) and summary.oldest_queued_at is not None


def test_a_nearly_full_disk_accepts_nothing(database, tmp_path, document):
    store = JobStore(database, DataFolder(tmp_path / "data", reserve_bytes=2**60))
    for refused in (lambda: store.submit("ann", document), lambda: store.put_model("ann", b"<mujoco/>")):
        with pytest.raises(DiskFull) as fault:
            refused()
        assert fault.value.retryable
    assert store.list("ann") == ([], None)


def test_results_of_another_version_are_no_hits(store, document, another_version):
    another_version("0.0.9")
    old, computation = running(store, document)
    complete(store, computation)
    assert store.submit("ann", document).cached and store.get("ann", old).version == "0.0.9"
    another_version("0.1.0")
    again = store.submit("ann", document)
    assert not again.cached and again.job.state == JobState.QUEUED and again.job.version == "0.1.0"
    assert [job.version for job in store.list("ann")[0]] == ["0.1.0", "0.0.9", "0.0.9"]
    assert store.result_document("ann", old) == {"analysis": "workspace"}


def test_what_expires_and_is_retried_is_of_the_version_that_computes_it_again(store, document, another_version):
    another_version("0.0.9")
    job, computation = running(store, document)
    complete(store, computation)
    another_version("0.1.0")
    store.recover()
    assert store.expire(computation, 1, "it is old") and store.get("ann", job).version == "0.0.9"
    assert store.retry("ann", job).version == "0.1.0" and store.computation(computation).resolved is None
    assert store.submit("ann", document).job.version == "0.1.0" and len(store.unfinished()) == 1  # the twin joins it


def test_parts_of_two_versions_do_not_mix(store, document, another_version):
    another_version("0.0.9")
    failed, other = running(store, canonical(precision="float64"))
    store.fail(other, store.computation(other).attempt, {"code": "crashed", "message": "", "retryable": True})
    job, computation = running(store, document)
    store.settle(computation, {"shards": [[0, 81]]}, "cpu:a")
    kept = [store.files.partials(each) / "0.npz" for each in (computation, other)]
    for path in kept:
        path.parent.mkdir()
        path.touch()
    store.recover()
    assert all(path.exists() for path in kept) and store.computation(computation).resolved
    another_version("0.1.0")
    before = store.computation(computation).attempt
    store.recover()
    record = store.computation(computation)
    assert not any(path.exists() for path in kept)
    assert (record.resolved, record.target, record.attempt) == (None, None, before + 1)
    assert store.get("ann", job).version == store.retry("ann", failed).version == "0.1.0"
    assert not store.submit("ann", document).cached and len(store.unfinished()) == 2  # the twin joins it


@pytest.mark.parametrize("known", [True, False])
def test_waiting_jobs_of_an_earlier_version_take_todays_form(store, document, another_version, known):
    """A document that this version does not know stays: its plan says what is wrong, and the job fails with that."""
    earlier = {name: value for name, value in document.items() if name != "format"} | ({} if known else {"gone": 1})
    another_version("0.1.0")
    _, computation = running(store, earlier)
    another_version("0.2.0")
    store.recover()
    found = store.computation(computation).document.read(store.files, computation)
    assert found == (document if known else earlier)
    store.submit("ann", document)
    assert len(store.unfinished()) == (1 if known else 2)  # an equal job joins it
