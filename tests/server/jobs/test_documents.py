"""Documents by reference: long ones are files, written once and named by their hash; rows and tasks refer to them."""

import hashlib
import json
import os
import pickle
import time

import pytest
from sqlalchemy import select, update
from wsrender_server.jobs import steps
from wsrender_server.jobs.attempt import Attempt
from wsrender_server.jobs.documents import LONGEST_IN_ROW, CanonicalDocument
from wsrender_server.jobs.faults import InvalidTransition
from wsrender_server.jobs.files import ABANDONED_S
from wsrender_server.jobs.tables import Computation
from wsrender_server.jobs.task import Step

from tests.server.jobs.documents import indices_at
from tests.server.jobs.test_store import complete, running
from wsrender import __version__
from wsrender.analyses.jobs import parse_job
from wsrender.errors import InputError


@pytest.fixture
def long_document():
    """A canonical document of some 200 kB."""
    return indices_at(configurations=[[k / 4096, 0.5, 0.1, 0.2] for k in range(8192)])


def text_of(document):
    """The text that is hashed, by the standard library alone."""
    return json.dumps(document, sort_keys=True, separators=(",", ":")).encode()


def documents(store):
    return sorted(path for path in (store.files.root / "documents").rglob("*") if path.is_file())


def column(store, name):
    with store.transactions.read() as session:
        return list(session.scalars(select(getattr(Computation, name))))


def test_a_long_document_lies_in_a_file_and_in_no_row_or_task(store, long_document):
    job = store.submit("ann", long_document).job.id
    (computation,) = store.unfinished()
    (path,) = documents(store)
    assert path.read_bytes() == text_of(long_document)
    assert path.name == hashlib.sha256(text_of(long_document)).hexdigest()
    assert column(store, "document") == [""]
    attempt = Attempt(store.computation(computation), "cpu:x", {"shards": [[0, 8192]]}, 0)
    assert len(pickle.dumps(attempt.task(Step.SHARD))) < 2000
    assert store.document("ann", job) == long_document and store.document("bob", job) is None


def test_a_worker_computes_from_the_file(store, long_document, monkeypatch):
    store.submit("ann", long_document)
    (computation,) = store.unfinished()
    task = Attempt(store.computation(computation), "cpu:x", None, 0).task(Step.PLAN)
    monkeypatch.setattr(steps, "_state", {"files": store.files})
    steps._plans.clear()
    plan = steps._planned(pickle.loads(pickle.dumps(task)))
    steps._plans.clear()
    assert plan.job == parse_job(long_document)


def test_a_damaged_file_is_no_document(store, long_document):
    job = store.submit("ann", long_document).job.id
    (path,) = documents(store)
    path.write_bytes(path.read_bytes().replace(b"0.2]", b"0.3]", 1))
    with pytest.raises(InputError, match="is damaged on the server's disk"):
        store.document("ann", job)


def test_equal_documents_share_one_file_which_goes_with_the_last_job(store, long_document):
    first, second = (store.submit("ann", long_document).job.id for _ in range(2))
    assert len(documents(store)) == 1
    with pytest.raises(InputError):
        store.submit("ann", long_document, priority=10**6)
    assert len(documents(store)) == 1
    for job, left in ((first, 1), (second, 0)):
        store.cancel("ann", job)
        store.delete("ann", job)
        assert len(documents(store)) == left
    assert not [*(store.files.root / "documents").iterdir()]


def test_a_file_that_was_written_is_taken_as_it_is(store, long_document, tmp_path):
    whole = CanonicalDocument.of(long_document)
    written = tmp_path / "written"
    written.write_bytes(text_of(long_document))
    reference = CanonicalDocument(whole.sha256, whole.analysis, whole.device, whole.libraries, whole.uploads)
    job = store.submit("ann", reference, written=written).job.id
    assert store.document("ann", job) == long_document and not written.exists()
    assert store.submit("ann", long_document).job.id != job and len(column(store, "id")) == 1  # the twin joins it


def test_short_documents_stay_in_their_rows(store, document):
    job = store.submit("ann", document).job.id
    assert len(text_of(document)) < LONGEST_IN_ROW
    assert column(store, "document") == [text_of(document).decode()] and documents(store) == []
    assert store.document("ann", job) == document


@pytest.mark.parametrize("version", ["0.0.1", __version__])
@pytest.mark.parametrize("length", ["document", "long_document"])
def test_rows_of_an_earlier_database_are_read(store, request, length, version):
    """They hold their documents, however long, and nothing of them is known beside."""
    document = request.getfixturevalue(length)
    job = store.submit("ann", document).job.id
    old = {"document": text_of(document).decode(), "facts": None, "version": version, "key": "of another kind"}
    with store.transactions.write() as session:
        session.execute(update(Computation).values(**old))
    for path in documents(store):
        path.unlink()
    (computation,) = store.unfinished()
    assert store.document("ann", job) == document
    assert store.computation(computation).document.device == "auto"
    store.recover()
    assert store.computation(computation).document.read(store.files, computation) == document
    store.submit("ann", document)
    assert len(column(store, "id")) == 1  # an equal job joins it
    store.settle(computation, {"shards": []}, "cpu:x")
    assert store.computation(computation).target == "cpu:x"


def test_documents_whose_jobs_never_came_about_go(store, long_document):
    job = store.submit("ann", long_document).job.id
    (kept,) = documents(store)
    for name, age in (("aa", 2 * ABANDONED_S), ("bb", 0.0)):
        store.files.put_document(name, "cc", b"{}")
        os.utime(store.files.document(name, "cc").parent, (time.time() - age,) * 2)
    os.utime(kept.parent, (0, 0))
    store.recover()
    assert documents(store) == sorted([kept, store.files.document("bb", "cc")])
    assert store.document("ann", job) == long_document


def test_no_document_is_read_or_written_within_a_write(store, long_document, monkeypatch):
    """Writes wait for each other: seconds of JSON within one would be everyone's."""
    within = []

    def watched(function):
        def call(*arguments, **options):
            assert not within, "JSON within a write"
            return function(*arguments, **options)

        return call

    class Watching:
        def __init__(self, transaction):
            self.transaction = transaction

        def __enter__(self):
            session = self.transaction.__enter__()
            within.append(self)
            return session

        def __exit__(self, *fault):
            within.pop()
            return self.transaction.__exit__(*fault)

    write = store.transactions.write
    monkeypatch.setattr(store.transactions, "write", lambda: Watching(write()))
    for name in ("of", "read"):
        monkeypatch.setattr(CanonicalDocument, name, watched(getattr(CanonicalDocument, name)))
    job = store.submit("ann", long_document, idempotency_key="k").job.id
    (computation,) = store.unfinished()
    assert store.submit("ann", long_document, idempotency_key="k").replayed
    store.begin(computation, 1)
    store.settle(computation, {"shards": []}, "cpu:x")
    store.fail(computation, 1, {"code": "x", "message": "", "retryable": True})
    store.retry("ann", job)
    store.recover()
    store.cancel("ann", job)
    store.delete("ann", job)


def test_a_long_document_outlives_its_result(store, long_document):
    job, computation = running(store, long_document)
    complete(store, computation)
    assert store.expire(computation, 1, "it is old")
    assert store.document("ann", job) == long_document
    store.retry("ann", job)
    assert store.computation(computation).document.read(store.files, computation) == long_document
    store.cancel("ann", job)
    assert store.delete("ann", job) and documents(store) == []


def test_an_upload_that_an_unfinished_long_document_names_is_not_deleted(store):
    model = store.put_model("ann", b"<mujoco/>")
    named = indices_at(robot={"model": model}, configurations=[[k / 4096, 0.5, 0.1, 0.2] for k in range(8192)])
    job = store.submit("ann", named).job.id
    with pytest.raises(InvalidTransition, match="used by an unfinished job"):
        store.delete_model("ann", model)
    store.cancel("ann", job)
    assert store.delete_model("ann", model)


def lose(path):
    path.unlink()


def damage(path):
    path.write_bytes(b"{}")


@pytest.mark.parametrize("spoil", [lose, damage])
def test_a_document_that_is_spoilt_holds_up_no_other_and_comes_back_with_the_next_job(
    store, document, long_document, another_version, spoil
):
    job, other = (store.submit("ann", each).job.id for each in (long_document, document))
    (path,) = documents(store)
    spoil(path)
    with pytest.raises(InputError, match="submit the job again"):
        store.document("ann", job)
    store.submit("ann", long_document)
    assert documents(store) == [path] and store.document("ann", job) == long_document
    spoil(path)
    another_version("9.9.9")
    store.recover()
    assert store.get("ann", job).version == store.get("ann", other).version == "9.9.9"


def test_a_full_disk_holds_up_no_start(store, long_document, monkeypatch):
    """Documents of an earlier version stay where they are, in their rows."""
    job = store.submit("ann", long_document).job.id
    old = {"document": text_of(long_document).decode(), "facts": None, "version": "0.0.1"}
    with store.transactions.write() as session:
        session.execute(update(Computation).values(**old))
    monkeypatch.setattr(store.files, "reserve_bytes", 2**80)
    store.recover()
    assert store.document("ann", job) == long_document and column(store, "version") == [__version__]
    assert column(store, "document") == [text_of(long_document).decode()]
