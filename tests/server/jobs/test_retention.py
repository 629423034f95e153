"""What is kept no longer: by age, size and owner, the least recently used first; rows stay and can be run again."""

import os
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from sqlalchemy import event, func, select, text
from sqlalchemy.exc import OperationalError
from wsrender_server.jobs import clock
from wsrender_server.jobs.database import LONGEST_LOG
from wsrender_server.jobs.faults import InvalidTransition, QuotaExceeded, StoreUnavailable
from wsrender_server.jobs.records import JobState
from wsrender_server.jobs.retention import UPLOAD_S, Retention
from wsrender_server.jobs.store import JobStore
from wsrender_server.jobs.tables import Row
from wsrender_server.settings import Settings

from tests.server.jobs.documents import canonical
from tests.server.jobs.test_store import complete, running, states

LONG_AGO = 10 * 86400.0


def document_of(number):
    return canonical(sampling={"method": "random", "count": 10 + number, "seed": 0})


def results(store, *sizes, owner="ann"):
    """Jobs with results of so many bytes each, used an hour after one another, the last one ten hours ago."""
    jobs = []
    for number, size in enumerate(sizes):
        job, computation = running(store, document_of(number), owner=owner)
        complete(store, computation, content=bytes([number]) * size)
        used = datetime.now(UTC) - timedelta(hours=10 + len(sizes) - 1 - number)
        used_at(store, computation, used)
        jobs.append(job)
    return jobs


def used_at(store, computation, moment):
    from sqlalchemy import update
    from wsrender_server.jobs.tables import Computation

    with store.transactions.write() as session:
        session.execute(update(Computation).where(Computation.id == computation).values(used_at=moment))


@pytest.fixture
def retention(store, tmp_path):
    """``retention(**settings)`` of the store."""
    return lambda **settings: Retention(store, Settings(data_dir=tmp_path / "data", **settings))


def removed(retention, what):
    """Ids of what a sweep removes of a kind; the plan that was asked for before says the same."""
    planned = retention.due()
    done = retention.sweep()
    assert [(each.what, each.id, each.bytes) for each in planned] == [(each.what, each.id, each.bytes) for each in done]
    return [each.id for each in done if each.what == what]


EXPIRED, KEPT = JobState.EXPIRED, JobState.SUCCEEDED


def test_a_clock_that_jumps_ahead_makes_nothing_old(store, retention, monkeypatch):
    (job,) = results(store, 10)
    running = retention(keep_results_s=86400, keep_jobs_s=86400)
    monkeypatch.setattr(clock, "datetime", Jumped)
    monkeypatch.setattr(clock.time, "time", lambda: Jumped.now(UTC).timestamp())
    assert not running.sweep() and states(store, "ann", job) == [KEPT]
    assert retention(keep_results_s=86400).due(), "by the clock that a new process finds, it is old"


class Jumped(datetime):
    """A clock that someone has set ten days ahead."""

    @classmethod
    def now(cls, zone=None):
        return datetime.now(zone) + timedelta(days=10)


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ({}, [KEPT] * 4),
        ({"keep_results_s": 11.5 * 3600}, [EXPIRED, EXPIRED, KEPT, KEPT]),
        ({"keep_results_bytes": 1000}, [KEPT] * 4),
        ({"keep_results_bytes": 999}, [EXPIRED, KEPT, KEPT, KEPT]),
        ({"keep_results_bytes": 700}, [EXPIRED, EXPIRED, KEPT, KEPT]),
        ({"keep_results_bytes_per_owner": 400}, [EXPIRED, EXPIRED, EXPIRED, KEPT]),
        ({"keep_results_bytes": 0}, [EXPIRED] * 4),
        ({"keep_results_s": 12.5 * 3600, "keep_results_bytes": 900}, [EXPIRED, KEPT, KEPT, KEPT]),
    ],
)
def test_the_least_recently_used_results_go_first(store, retention, settings, expected):
    jobs = results(store, 100, 200, 300, 400)
    of_others = [] if "keep_results_bytes" in settings else results(store, 50, 350, owner="bob")
    before = store.usage()["results"]
    swept = retention(**settings)
    gone = removed(swept, "result")
    assert states(store, "ann", *jobs) == expected and len(gone) == expected.count(EXPIRED)
    freed = sum(size for size, state in zip((100, 200, 300, 400), expected, strict=True) if state == EXPIRED)
    assert store.removed["bytes"] == before - store.usage()["results"] == freed
    assert states(store, "bob", *of_others) == [KEPT] * len(of_others)
    folders = {path.name for path in (store.files.root / "results").iterdir()}
    assert not folders & set(gone) and len(folders) == 4 + len(of_others) - len(gone)
    assert not swept.sweep()


def test_an_expired_job_says_why_and_runs_again(store, retention):
    (job,) = results(store, 100)
    retention(keep_results_s=3600).sweep()
    record = store.get("ann", job)
    assert record.error["code"] == "result_expired" and "was not used for more than 3600" in record.error["message"]
    assert store.retry("ann", job).state == JobState.QUEUED
    (computation,) = store.unfinished()
    store.begin(computation, 2)
    complete(store, computation)
    retention(keep_results_s=3600).sweep()
    assert states(store, "ann", job) == [KEPT]


@pytest.mark.parametrize("use", ["read", "hit"])
def test_what_is_used_is_kept(store, retention, use):
    jobs = results(store, 100, 100)
    if use == "hit":
        assert store.submit("ann", document_of(0)).cached
    else:
        assert store.artifact_path("ann", jobs[0], "result.json")
    retention(keep_results_bytes=150).sweep()
    assert states(store, "ann", *jobs) == [KEPT, EXPIRED]


def test_a_new_result_outlives_a_limit_that_it_exceeds(store, retention):
    """Else nobody could fetch it."""
    job, computation = running(store, document_of(0))
    complete(store, computation, content=b"x" * 1000)
    swept = retention(keep_results_bytes=10, keep_results_s=0, keep_jobs_per_owner=1)
    assert not swept.sweep() and states(store, "ann", job) == [KEPT]
    assert len(swept.due(datetime.now(UTC) + timedelta(seconds=61))) == 1


def test_jobs_that_ended_go_by_age_and_number(store, retention):
    """Answers from the cache are rows as well, and count."""
    first, computation = running(store, document_of(0))
    complete(store, computation)
    cached = [store.submit("ann", document_of(0)).job.id for _ in range(3)]
    waiting = store.submit("ann", document_of(1)).job.id
    other = store.submit("bob", document_of(1)).job.id
    later = datetime.now(UTC) + timedelta(seconds=120)
    assert not retention(keep_jobs_per_owner=4).due(later) and not retention(keep_jobs_per_owner=2).due()
    assert {each.id for each in retention(keep_jobs_per_owner=2).sweep(later)} == {first, cached[0]}
    assert [store.get("ann", job) is None for job in (first, *cached)] == [True, True, False, False]
    assert store.result_document("ann", cached[2])
    assert not retention(keep_jobs_s=130).due(later)
    assert {each.id for each in retention(keep_jobs_s=100).sweep(later)} == set(cached[1:])
    assert store.get("ann", waiting) and store.get("bob", other)
    assert not list((store.files.root / "results").iterdir()) and store.computation(computation) is None


def old(path):
    path.mkdir(parents=True, exist_ok=True)
    (path / "0.npz").write_bytes(b"12345")
    os.utime(path, (time.time() - LONG_AGO,) * 2)
    return path


@pytest.mark.parametrize("end", ["fails", "fails for good", "canceled", "runs", "succeeds"])
def test_partial_results_of_what_ended_are_removed(store, retention, end):
    job, computation = running(store, document_of(0))
    folder = old(store.files.partials(computation))
    if end.startswith("fails"):
        store.fail(computation, 1, {"code": "x", "message": "y", "retryable": end == "fails"})
    elif end == "canceled":
        store.cancel("ann", job)
        store.stopped(computation, 1)
    elif end == "succeeds":
        complete(store, computation)
        old(folder)  # as by a process that was killed before it could remove them
    assert folder.exists() == (end != "fails for good")
    assert not removed(retention(keep_partials_s=LONG_AGO + 3600), "files") or end == "succeeds"
    swept = removed(retention(keep_partials_s=LONG_AGO - 3600), "files")
    assert swept == ([computation] if end in ("fails", "canceled") else [])
    assert folder.exists() == (end == "runs")


def test_files_that_nothing_names_are_removed_and_others_left(store, retention):
    job, computation = running(store, document_of(0))
    path = complete(store, computation)
    for kind in ("results", "partials"):
        old(store.files.root / kind / ("0" * 32))
        old(store.files.root / kind / "lost+found")
    model = store.put_model("ann", b"<mujoco/>")
    for name in ("1" * 64, model, "readme.txt"):
        (store.files.models / name).touch()
        os.utime(store.files.models / name, (time.time() - LONG_AGO,) * 2)
    (store.files.models / ("2" * 64)).touch()  # being uploaded
    assert sorted(each.id for each in retention().sweep()) == ["0" * 32, "0" * 32, "1" * 64]
    assert path.exists() and {each.name for each in store.files.models.iterdir()} == {model, "2" * 64, "readme.txt"}
    assert all((store.files.root / kind / "lost+found").exists() for kind in ("results", "partials"))
    assert states(store, "ann", job) == [KEPT]


def test_the_folder_of_another_database_is_left_alone(store, retention):
    with store.claimed():
        stray = old(store.files.root / "results" / ("0" * 32))
    (store.files.root / "store-id").write_text("1" * 32)
    with pytest.raises(StoreUnavailable, match="is not the data folder"):
        retention().sweep()
    assert stray.exists()


def test_what_is_needed_again_by_now_stays(store, retention):
    """Between plan and removal."""
    (job,) = results(store, 100)
    swept = retention(keep_results_s=3600)
    planned = swept.due()
    store.expire(planned[0].id, 1, "before")
    store.retry("ann", job)
    store.begin(planned[0].id, 2)
    path = complete(store, planned[0].id)
    assert not any(swept.remove(each) for each in planned) and path.exists()
    assert states(store, "ann", job) == [KEPT]


def test_models_are_listed_and_deleted(store):
    first, second = store.put_model("ann", b"<mujoco/>"), store.put_model("ann", b"<robot/>")
    store.put_model("bob", b"<mujoco/>")
    assert {(each.sha256, each.bytes) for each in store.list_models("ann")} == {(first, 9), (second, 8)}
    job = store.submit("ann", canonical(robot={"model": first})).job.id
    with pytest.raises(InvalidTransition, match="a model that is used by an unfinished job cannot be deleted"):
        store.delete_model("ann", first)
    store.cancel("ann", job)
    assert store.delete_model("ann", first) and not store.delete_model("ann", first)
    assert store.model_path("ann", first) is None
    assert store.model_path("bob", first).read_bytes() == b"<mujoco/>"
    assert store.delete_model("bob", first) and not store.files.model(first).exists()
    assert [each.sha256 for each in store.list_models("ann")] == [second] and store.list_models("bob") == []


def test_a_model_whose_deletion_the_database_did_not_take_keeps_its_file(store):
    sha256 = store.put_model("ann", b"<mujoco/>")

    def full(connection):
        raise OperationalError("COMMIT", {}, OSError("database or disk is full"))

    event.listen(store.transactions.engine, "commit", full)
    try:
        with pytest.raises(StoreUnavailable):
            store.delete_model("ann", sha256)
    finally:
        event.remove(store.transactions.engine, "commit", full)
    assert store.model_path("ann", sha256).read_bytes() == b"<mujoco/>"
    assert store.delete_model("ann", sha256) and not store.files.model(sha256).exists()


def test_an_owner_has_a_quota_of_models(store, database):
    bounded = JobStore(database, store.files, max_model_bytes_per_owner=20)
    kept = bounded.put_model("ann", b"x" * 12)
    with pytest.raises(QuotaExceeded, match="may take 20 bytes, and take 12"):
        bounded.put_model("ann", b"y" * 9)
    assert bounded.put_model("ann", b"x" * 12) == kept and bounded.put_model("ann", b"z" * 8)
    assert bounded.put_model("bob", b"y" * 20)
    bounded.delete_model("ann", kept)
    bounded.put_model("ann", b"y" * 9)


def test_a_quota_holds_for_uploads_at_the_same_moment(store, database, monkeypatch):
    """Each would find room for itself; what was refused leaves a file that retention takes."""
    bounded = JobStore(database, store.files, max_model_bytes_per_owner=20)
    start = threading.Barrier(6)
    late = threading.Barrier(6)
    put, first = store.files.put_model, threading.local()

    def put_together(content):
        if not hasattr(first, "gone"):  # all have looked before any row is there
            first.gone = late.wait(60)
        return put(content)

    monkeypatch.setattr(store.files, "put_model", put_together)

    def upload(number):
        start.wait(60)
        try:
            return bounded.put_model("ann", bytes([number]) * 8)
        except QuotaExceeded:
            return None

    with ThreadPoolExecutor(6) as pool:
        kept = [sha256 for sha256 in pool.map(upload, range(6)) if sha256]
    assert len(kept) == 2 == len(bounded.list_models("ann"))


def test_documents_whose_jobs_never_came_about_are_removed(store, retention):
    """Their server was killed in between; one that comes about now is young."""
    for name, age in (("aa", 2 * UPLOAD_S), ("bb", 0.0)):
        store.files.put_document(name, "cc", b"{}")
        os.utime(store.files.document(name, "cc").parent, (time.time() - age,) * 2)
    assert removed(retention(), "files") == ["aa"]
    assert [path.name for path in (store.files.root / "documents").iterdir()] == ["bb"]


def test_200_jobs_leave_no_more_rows_and_pages_than_50(store, retention):
    """Of jobs that are gone nothing stays, and the pages of the database that they had are used again."""
    swept = retention(keep_jobs_per_owner=5, keep_results_bytes=100)
    taken = []
    for number in range(200):
        content = f"{number:032d}".encode()
        _, computation = running(store, document_of(number), labels={"of": str(number)}, idempotency_key=f"k{number}")
        complete(store, computation, content=content)
        if number % 10 == 9:
            swept.sweep(datetime.now(UTC) + timedelta(minutes=2))
            taken.append(_taken(store))
    rows, files, pages = zip(*taken, strict=True)
    assert set(rows[1:]) == {rows[1]} and set(files[1:]) == {files[1]}
    assert len(store.list("ann", limit=200)[0]) == 5
    assert max(pages[5:]) <= max(pages[:5]) + 2


def _taken(store):
    """Rows by table, files of results, and pages of the database that a file of SQLite's has."""
    with store.transactions.read() as session:
        rows = tuple(session.scalar(select(func.count()).select_from(each)) for each in Row.metadata.sorted_tables)
        of_sqlite = session.get_bind().dialect.name == "sqlite"
        pages = session.scalar(text("PRAGMA page_count")) if of_sqlite else 0
    return rows, sum(path.is_file() for path in (store.files.root / "results").rglob("*")), pages


def test_the_log_of_the_database_does_not_grow_for_ever(store, retention, database):
    """SQLite begins it anew when nobody reads; where there is always somebody, it goes on, and stays that long."""
    if database.dialect.name != "sqlite":
        pytest.skip("only SQLite has one")
    log = Path(f"{database.url.database}-wal")
    (job,) = results(store, 10)
    with ExitStack() as reading:
        for _ in range(12):
            following = ExitStack()
            following.enter_context(store.transactions.read()).execute(text("SELECT * FROM jobs")).all()
            reading.close()
            reading.push(following)
            with store.transactions.write() as session:
                session.execute(text("UPDATE jobs SET error = json_quote(hex(randomblob(500000)))"))
        assert log.stat().st_size > LONGEST_LOG
        retention().sweep()
        assert log.stat().st_size > LONGEST_LOG, "somebody reads for long, and is not waited for for long"
    with store.transactions.write() as session:
        session.execute(text("UPDATE jobs SET error = NULL"))
    assert log.stat().st_size > LONGEST_LOG
    retention().sweep()
    assert log.stat().st_size == 0 and states(store, "ann", job) == [KEPT]
