"""Submissions that come at the same time: one transaction, and each gets its own answer."""

import asyncio
import json
from typing import cast

import pytest
from psycopg import OperationalError
from wsrender_server.admission import LONGEST_TOGETHER, Admissions
from wsrender_server.jobs.documents import CanonicalDocument
from wsrender_server.jobs.faults import CommitUnknown, IdempotencyConflict, QueueFull, StoreUnavailable
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.records import Submission
from wsrender_server.jobs.store import ATTEMPTS, Again, JobStore, SubmissionRequest, _Known
from wsrender_server.side_process import SideProcess
from wsrender_server.together import Together

from tests.server.http.idle_server import DOCUMENT
from tests.server.jobs.documents import canonical, indices_at


def of_seed(seed):
    return CanonicalDocument.of(sampled(seed))


def sampled(seed):
    return canonical(sampling={"method": "random", "count": 64, "seed": seed})


def test_each_of_a_transaction_meets_its_own_limits(store):
    """Twins share a computation, a queue takes as many as it may, a key taken by another body is refused."""
    store.max_queued_per_owner = 5
    told, written = [], store.transactions.written
    store.changes.notify = lambda *jobs: told.append(set(jobs))
    store.submit("eve", sampled(1), idempotency_key="mine", body_hash="one")

    def of(owner, seed, **options):
        return SubmissionRequest(owner, of_seed(seed), **options)

    requests = [of("ann", seed // 2) for seed in range(12)]
    requests += [of("bob", 3, priority=seed) for seed in range(2)] + [of("bob", 3, priority=2000)]
    requests += [of("eve", seed, idempotency_key="mine", body_hash=text) for seed, text in ((4, "two"), (1, "one"))]
    answers = store.submit_all(requests)
    assert store.transactions.written == written + 2, "more than one transaction"
    ann, bob, eve = answers[:12], answers[12:15], answers[15:]
    assert [type(each) for each in ann] == [Submission] * 5 + [QueueFull] * 7
    assert len(store.list("ann")[0]) == 5 and bob[0].computation == bob[1].computation
    assert store.computation(bob[0].computation).priority == 1 and "priority" in str(bob[2])
    assert isinstance(eve[0], IdempotencyConflict) and eve[1].replayed
    kept = {each.computation for each in (*ann, *bob) if isinstance(each, Submission)}
    assert len(store.unfinished()) == len(kept) + 1, "a computation without a job"
    assert told[1:] == [{each.job.id for each in (*ann[:5], *bob[:2])}], "who replays has changed nothing"
    for answer in (*ann[:5], *bob[:2]):
        job = answer.job
        assert store.get(job.owner, job.id) == job
        assert [each.data["state"] for each in store.news(job.owner, job.id, 0)[1]] == ["queued"]


def test_those_whose_twin_came_a_moment_before_go_alone(store, monkeypatch):
    """Another process inserted what a transaction was about to: its others are not refused for it."""
    request, other = (SubmissionRequest("ann", of_seed(seed)) for seed in (1, 2))
    store.submit("ann", sampled(1))
    known = []

    def blind(self, session, requests, identity, look=_Known.__init__):
        look(self, session, requests, identity)
        if len(known) < 2 and request in requests:  # as long as the other process has not committed
            known.append(len(requests))
            self.computations.clear()

    monkeypatch.setattr(_Known, "__init__", blind)
    answers = store.submit_all([request, other])
    assert answers[0] == Again(request, None) and isinstance(answers[1], Submission) and known == [2, 1]
    assert store.prepare_again(answers[0]) == request
    (answer,) = store.submit_all([request])
    assert isinstance(answer, Submission) and len(store.unfinished()) == 2


def body(**parts):
    return json.dumps({**DOCUMENT, **parts}).encode()


def indices(row, count):
    document = {"analysis": "indices_at", "robot": {"library": "scara"}, "configurations": [row] * count}
    return json.dumps(document, separators=(",", ":")).encode()


def request_of(admitted):
    return SubmissionRequest("ann", admitted.document, labels=admitted.options.labels)


def submitted(store, bodies):
    """What becomes of bodies that come at the same moment, and the submissions of each transaction."""
    turns, submit_all = [], store.submit_all
    store.submit_all = lambda requests: turns.append(len(requests)) or submit_all(requests)
    admissions = Admissions(store, cast(SideProcess, None), 10**9)
    answer_all = admissions._submit_all

    def short(asked):
        assert all(len(getattr(each, "text", b"")) <= LONGEST_TOGETHER for each in asked), "others wait for a long one"
        return answer_all(asked)

    admissions._together = Together(short)

    async def submit():
        return await asyncio.gather(
            *(admissions.submit("ann", each, request_of) for each in bodies), return_exceptions=True
        )

    return asyncio.run(submit()), turns


def test_many_submissions_take_few_transactions(store):
    """Wrong ones among them are refused by themselves."""
    store.max_queued_per_owner = 100
    bodies = [body(voxel_size_m=0.1 + k / 100, labels={"number": str(k)}) for k in range(32)]
    bodies[5:5] = [body(voxel_size_m=-1), b"{", body(robot={"model": "0" * 64})]
    answers, turns = submitted(store, bodies)
    wrong, right = answers[5:8], answers[:5] + answers[8:]
    assert [each.job.labels["number"] for each in right] == [str(k) for k in range(32)]
    assert [each.status for each in wrong] == [422, 400, 404]
    assert sum(turns) == 32 and len(turns) <= 2
    assert len({each.job.id for each in right}) == 32 == len(store.unfinished())


def test_submissions_whose_result_is_there_are_asked_for_again_once_it_was_looked_at(store, monkeypatch):
    store.max_queued_per_owner = 100
    store.changes.listener = lambda: None
    first, _ = submitted(store, [body()])
    computation = first[0].computation
    store.begin(computation, 1)
    store.complete(computation, 1, [])
    looked = []
    monkeypatch.setattr(store, "check_result", looked.append)
    answers, turns = submitted(store, [body(), body(), body(voxel_size_m=0.2)])
    assert [each.cached for each in answers] == [True, True, False]
    assert looked == [computation] * 2 and turns[0] == 3 and sum(turns) == 5


def test_a_submission_that_never_comes_through_is_told_so(store, monkeypatch):
    monkeypatch.setattr(store, "submit_all", lambda requests: [Again(each, None) for each in requests])
    (answer,), turns = submitted(store, [body()])
    assert isinstance(answer, StoreUnavailable) and "many times at once" in str(answer) and len(turns) == ATTEMPTS
    with pytest.raises(StoreUnavailable, match="many times at once"):
        store.submit("ann", canonical())


def test_what_is_long_holds_up_no_others(store):
    """A long body, and a document that becomes too long for a row, have a turn and a file of their own."""

    long, wordy = indices([0.125, 0.25, 0.05, 0.3], 900), indices([0, 0, 0, 0], 900)
    assert len(wordy) <= LONGEST_TOGETHER < len(long)
    answers, turns = submitted(store, [long, body(voxel_size_m=0.2), wordy])
    assert all(isinstance(each, Submission) for each in answers), answers
    assert turns == [1, 1, 1]
    for answer, kept in zip(answers, (True, False, True), strict=True):
        assert (store.computation(answer.computation).document.text is None) is kept


def test_a_document_stays_where_the_answer_to_a_commit_is_lost(database, tmp_path, monkeypatch):
    """The row may be there; before, its document was removed, and the job failed."""
    if database.dialect.name == "sqlite":
        pytest.skip("answers of SQLite are not lost")
    store = JobStore(database, DataFolder(tmp_path / "data"))
    long = indices_at(configurations=[[0.1, 0.2, 0.05, 0.3]] * 2000)
    commit = database.dialect.do_commit

    def commit_and_lose(connection):
        commit(connection)
        monkeypatch.undo()
        raise OperationalError("server closed the connection unexpectedly")

    monkeypatch.setattr(database.dialect, "do_commit", commit_and_lose)
    with pytest.raises(CommitUnknown, match="whether"):
        store.submit("ann", long)
    (job,) = store.list("ann")[0]
    assert store.document("ann", job.id) == long
