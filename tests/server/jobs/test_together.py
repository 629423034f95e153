"""What comes at the same time shares a transaction, and each gets its own answer."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from psycopg import OperationalError
from wsrender_server.jobs.faults import CommitUnknown, IdempotencyConflict, QueueFull
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.store import JobStore
from wsrender_server.jobs.together import Together

from tests.server.jobs.documents import canonical, indices_at
from tests.server.jobs.waiting import wait_until


class Gate:
    """Answers the first only when it is opened; what comes meanwhile waits."""

    def __init__(self):
        self.open, self.asked = threading.Event(), []

    def __call__(self, asked):
        self.asked.append(list(asked))
        assert self.open.wait(60)
        return [ValueError(each) if each < 0 else 2 * each for each in asked]


def test_who_comes_while_others_are_answered_is_answered_together_with_the_rest():
    gate = Gate()
    together = Together(gate)
    with ThreadPoolExecutor(8) as pool:
        first = pool.submit(together.answer, 1)
        wait_until(lambda: gate.asked, what="the first")
        others = [pool.submit(together.answer, number) for number in (2, 3, -4, 5)]
        wait_until(lambda: len(together._waiting) == 4, what="the others")
        gate.open.set()
        assert first.result(60) == 2
        assert [others[k].result(60) for k in (0, 1, 3)] == [4, 6, 10]
        with pytest.raises(ValueError, match="-4"):
            others[2].result(60)
    assert [sorted(asked) for asked in gate.asked] == [[1], [-4, 2, 3, 5]]
    assert together.answer(7) == 14  # nobody is left to lead


def test_one_leads_at_a_time():
    """Who comes while the second transaction is under way waits, too."""
    turns, asked = threading.Semaphore(0), []

    def answer(numbers):
        asked.append(list(numbers))
        assert turns.acquire(timeout=60)
        return numbers

    together = Together(answer)
    with ThreadPoolExecutor(4) as pool:
        first = pool.submit(together.answer, 1)
        wait_until(lambda: asked, what="the first")
        second = pool.submit(together.answer, 2)
        wait_until(lambda: together._waiting, what="the second")
        turns.release()
        wait_until(lambda: len(asked) == 2, what="the second to lead")
        third = pool.submit(together.answer, 3)
        wait_until(lambda: together._waiting or len(asked) > 2, what="the third")
        time.sleep(0.1)
        begun = list(asked)
        turns.release(9)
        assert [each.result(60) for each in (first, second, third)] == [1, 2, 3]
    assert begun == [[1], [2]]


def test_all_meet_what_meets_their_transaction_and_the_next_goes_on():
    faults = [RuntimeError("gone")]

    def answer(asked):
        if faults:
            raise faults.pop()
        return asked

    together = Together(answer)
    with pytest.raises(RuntimeError, match="gone"):
        together.answer(1)
    assert together.answer(2) == 2


def at_once(requests):
    """What each of some functions returns, or raises, called at the same moment."""
    start = threading.Barrier(len(requests))

    def call(request):
        start.wait(60)
        try:
            return request()
        except (QueueFull, IdempotencyConflict) as fault:
            return fault

    with ThreadPoolExecutor(len(requests)) as pool:
        return [each.result(60) for each in [pool.submit(call, request) for request in requests]]


def sampled(seed):
    return canonical(sampling={"method": "random", "count": 64, "seed": seed})


def test_many_submissions_take_few_transactions(database, store):
    store.max_queued_per_owner = 100
    documents = [sampled(seed) for seed in range(32)]
    begun, answer_all = [], store._submit_all

    def slowly(requests):
        begun.append(len(requests))
        time.sleep(0.1)
        return answer_all(requests)

    store._submissions._answer_all = slowly
    jobs = at_once([lambda document=document: store.submit("ann", document).job for document in documents])
    assert sum(begun) == 32 and len(begun) <= 8
    assert len({job.id for job in jobs}) == 32 == len(store.unfinished())
    for job in jobs:
        assert store.get("ann", job.id) == job and [e.data["state"] for e in store.news("ann", job.id, 0)[1]] == [
            "queued"
        ]


def test_each_of_a_transaction_meets_its_own_limits(store):
    """Twins share a computation, a queue takes as many as it may, a key taken by another body is refused."""
    store.max_queued_per_owner = 5
    store.submit("eve", sampled(1), idempotency_key="mine", body_hash="one")
    requests = [lambda seed=seed: store.submit("ann", sampled(seed // 2)) for seed in range(12)]
    requests += [lambda: store.submit("bob", sampled(3)), lambda: store.submit("bob", sampled(3))]
    requests += [lambda: store.submit("eve", sampled(4), idempotency_key="mine", body_hash="two")]
    requests += [lambda: store.submit("eve", sampled(1), idempotency_key="mine", body_hash="one")]
    answers = at_once(requests)
    ann, bob, eve = answers[:12], answers[12:14], answers[14:]
    assert sum(isinstance(each, QueueFull) for each in ann) == 7
    assert len(store.list("ann")[0]) == 5 and bob[0].computation == bob[1].computation
    assert isinstance(eve[0], IdempotencyConflict) and eve[1].replayed
    kept = {each.computation for each in (*ann, *bob) if not isinstance(each, QueueFull)}
    assert len(store.unfinished()) == len(kept) + 1, "a computation without a job"


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
