"""What the dispatcher makes of ends of tasks where the database does not answer at the same moment."""

import threading
import time
from types import SimpleNamespace

import pytest
from wsrender_server.jobs.attempt import Attempt
from wsrender_server.jobs.dispatcher import MOST_LAUNCHES, PACE_S, TICK_S, Dispatcher
from wsrender_server.jobs.faults import EngineSlow, StoreUnavailable
from wsrender_server.jobs.records import JobState
from wsrender_server.jobs.task import Outcome, Step, Verdict, error
from wsrender_server.settings import Settings

from tests.server.jobs.documents import canonical
from tests.server.jobs.test_retention import document_of
from tests.server.jobs.test_store import running, states

FULL = error("disk_full", "the server's disk is full", retryable=True)


class Future:
    """A task that has ended."""

    def __init__(self, outcome, key=""):
        self.status, self._outcome, self.key = "finished", outcome, key

    def add_done_callback(self, call):
        """It has ended already; nobody asks."""

    def result(self, timeout):
        return self._outcome


@pytest.mark.parametrize("answers_after", [0, 1, 3])
def test_a_job_fails_for_its_own_reason_once_the_database_takes_it(
    store, document, tmp_path, monkeypatch, answers_after
):
    """The disk of partial results is the database's as well; the tasks that were stopped say nothing new."""
    job, computation = running(store, document)
    dispatcher = Dispatcher(store, Settings(data_dir=tmp_path / "data"))
    attempt = Attempt(store.computation(computation), "cpu:x", {"shards": [[0, 1], [1, 1]]}, 0)
    outcomes = Outcome(Verdict.FAILED, error=FULL), Outcome(Verdict.STOPPED)
    attempt.futures = {(Step.SHARD, shard): Future(outcome) for shard, outcome in enumerate(outcomes)}

    def stop(tokens, futures):
        for future in futures:
            future.status = "cancelled"

    dispatcher.engine = SimpleNamespace(stop=stop)
    dispatcher._attempts = {computation: attempt}
    fail, calls = store.fail, iter(range(100))

    def full(*arguments):
        if next(calls) < answers_after:
            raise StoreUnavailable("database or disk is full")
        fail(*arguments)

    monkeypatch.setattr(store, "fail", full)
    for shard in (0, 1):
        dispatcher._future_done(attempt, Step.SHARD, shard, attempt.futures[Step.SHARD, shard])
    for _ in range(answers_after):
        with pytest.raises(StoreUnavailable):
            dispatcher._handle_inbox()
        assert states(store, "ann", job) == [JobState.RUNNING] and computation in dispatcher._attempts
    dispatcher._handle_inbox()
    assert states(store, "ann", job) == [JobState.FAILED] and store.get("ann", job).error == FULL
    assert not dispatcher._attempts and store.retry("ann", job).state == JobState.QUEUED


def test_owners_take_turns_at_the_scheduler(store, tmp_path, monkeypatch):
    """Within a priority of jobs, whose later steps go first; a backlog of one is no reason for another to wait."""
    dispatcher, sent = Dispatcher(store, Settings(data_dir=tmp_path / "data")), []

    def sends(function, tasks, priority, **options):
        sent.append(priority)
        return [SimpleNamespace(add_done_callback=lambda call: None)] * len(tasks)

    monkeypatch.setattr(dispatcher.engine, "_connected", lambda: SimpleNamespace(map=sends))
    dispatcher._targets = {"auto": "cpu:x", "cpu": "cpu:x"}
    for owner, number, priority in (("ann", 0, 0), ("ann", 1, 0), ("ann", 2, 0), ("bob", 3, 0), ("ann", 4, 1)):
        store.submit(owner, document_of(number), priority=priority)
        computation = next(key for key in store.unfinished() if key not in dispatcher._attempts)
        dispatcher._launch(computation)
    first, second, third, others, urgent = sent
    assert urgent > others == first > second > third
    attempt = next(iter(dispatcher._attempts.values()))
    attempt.resolved = {"shards": [[0, 1]]}
    dispatcher._submit(attempt, Step.SHARD)
    assert urgent > sent[-1] > first


@pytest.fixture
def out(store, tmp_path, monkeypatch):
    """A dispatcher whose scheduler takes tasks, named in ``out.sent``, or raises ``out.fault``."""
    dispatcher = Dispatcher(store, Settings(data_dir=tmp_path / "data"))
    found = SimpleNamespace(dispatcher=dispatcher, fault=None, sent=[], stopped=[])

    def submit(tasks, priority, target, turn):
        if found.fault is not None:
            raise found.fault
        found.sent += tasks
        return [Future(None, key) for key in tasks]

    def stop(tokens, futures):
        found.stopped += tokens

    dispatcher.engine = SimpleNamespace(submit=submit, stop=stop, alive=set(), connected=True, embedded=True)
    monkeypatch.setattr(dispatcher, "_future_done", lambda *_: None)
    return found


def test_of_much_that_waits_a_part_goes_out_at_a_time_and_owners_take_turns(store, out):
    """Handing out thousands at once kept the server from answering; whoever comes late waits for no backlog."""
    store.max_queued_per_owner = 100
    for number in range(40):
        store.submit("ann", document_of(number))
    store.submit("bob", document_of(40))
    store.submit("ann", document_of(41), priority=1)
    for number in range(MOST_LAUNCHES):  # which no worker is there for, and which keep nobody else waiting
        store.submit("cat", canonical(device="cuda", sampling={"method": "sobol", "count": 64 + number}), priority=2)
    out.dispatcher._targets, out.dispatcher.engine.embedded = {"auto": "cpu:x", "cpu": "cpu:x"}, False
    out.dispatcher._unfinished(0.0)
    out.dispatcher._launch_some()
    assert {attempt.target for attempt in out.dispatcher._attempts.values()} == {"cuda"}
    out.sent.clear()
    out.dispatcher._launch_some()
    assert len(out.sent) == MOST_LAUNCHES
    record = [store.computation(name.partition("-")[2].partition("-")[0]) for name in out.sent]
    assert record[0].priority == 1 and "bob" in {each.owner for each in record[:3]}
    out.dispatcher._launch_some()
    assert len(out.sent) == MOST_LAUNCHES, "workers have not come to what is there"
    out.dispatcher._launched -= PACE_S
    out.dispatcher._launch_some()
    assert len(out.sent) == MOST_LAUNCHES + 1, "whoever starts workers for what waits sees ever more"
    while len(out.sent) < 42:
        before = len(out.sent)
        for attempt in out.dispatcher._attempts.values():
            if not attempt.begun:
                out.dispatcher._reported({"token": attempt.token, "step": "plan"})
        out.dispatcher._launch_some()
        assert len(out.sent) == min(before + MOST_LAUNCHES, 42)
    assert len(set(out.sent)) == 42


def test_messages_by_the_hundred_are_no_looks_at_the_table_by_the_hundred(store, document, out, monkeypatch):
    looks, unfinished = [], store.unfinished
    monkeypatch.setattr(store, "unfinished", lambda: looks.append(1) or unfinished())
    monkeypatch.setattr(out.dispatcher, "_update_targets", lambda: None)
    out.dispatcher.engine.alive, out.dispatcher.engine.embedded = set(), False
    started = time.monotonic()
    for _ in range(500):
        out.dispatcher._put(lambda: None)
        out.dispatcher._tick()
    assert len(looks) <= 1 + (time.monotonic() - started) / TICK_S
    time.sleep(TICK_S)
    store.submit("ann", document)
    out.dispatcher._tick()
    assert len(out.sent) == 1, "what comes is seen at the next tick"


def test_a_submission_waits_for_no_tick_and_a_flood_of_them_does(store, out, monkeypatch):
    """One goes out at once; what comes with it, and soon after it, at the ticks."""
    dispatcher, never = out.dispatcher, time.monotonic() + 3600
    dispatcher.engine.embedded = False
    store.changes.listener = dispatcher._hear
    dispatcher._ticked = never
    dispatcher._tick()
    for number in range(3):
        store.submit("ann", document_of(number))
    assert dispatcher._wake.is_set()
    dispatcher._tick()
    assert len(out.sent) == 1
    store.submit("ann", document_of(3))
    dispatcher._hurried = never
    dispatcher._tick()
    assert len(out.sent) == 1
    dispatcher._ticked = 0.0
    monkeypatch.setattr(dispatcher, "_update_targets", lambda: None)
    dispatcher._tick()
    assert len(out.sent) == 4


def test_a_submission_waits_for_its_tick_where_others_wait_for_workers(store, out, monkeypatch):
    """Looks at a long table by the dozen kept the server from answering, and workers had enough to do."""
    looks, unfinished, dispatcher = [], store.unfinished, out.dispatcher
    monkeypatch.setattr(store, "unfinished", lambda: looks.append(1) or unfinished())
    store.changes.listener, dispatcher._ticked = dispatcher._hear, time.monotonic() + 3600
    dispatcher._targets = {"auto": "cpu:x", "cpu": "cpu:x"}
    for number in range(3):
        dispatcher._hurried = 0.0
        store.submit("ann", document_of(number))
        dispatcher._tick()
        assert len(out.sent) == len(looks) == 1
    (attempt,) = dispatcher._attempts.values()
    dispatcher._reported({"token": attempt.token, "step": "plan"})
    dispatcher._hurried = 0.0
    dispatcher._tick()
    assert len(out.sent) == len(looks) == 2, "a worker may have a place for it"


def test_a_dispatcher_hears_of_submissions_and_not_of_its_own_changes(store, document, tmp_path, monkeypatch):
    monkeypatch.setattr(Dispatcher, "_loop", lambda self: None)
    dispatcher = Dispatcher(store, Settings(data_dir=tmp_path / "data"))
    dispatcher.start()
    monkeypatch.setattr(dispatcher, "_thread", threading.current_thread())
    store.changes.notify("a job")
    assert not dispatcher._wake.is_set()
    monkeypatch.undo()
    store.submit("ann", document)
    assert dispatcher._wake.is_set() and dispatcher._changed.is_set()


@pytest.mark.parametrize("fault", [EngineSlow("slow"), OSError("stale file handle")])
def test_the_end_of_a_task_is_handled_again_where_the_next_could_not_go_out(store, document, out, fault):
    """Else its attempt would have nothing out, and wait for ever."""
    _, computation = running(store, document)
    dispatcher = out.dispatcher
    attempt = Attempt(store.computation(computation), "cpu", None, 0)
    dispatcher._attempts = {computation: attempt}
    plan = Future(Outcome(Verdict.DONE, {"resolved": {"shards": [[0, 1]]}, "target": "cpu:x"}))
    ends = [((Step.PLAN, 0), plan), ((Step.SHARD, 0), Future(Outcome(Verdict.DONE)))]
    for (place, future), then in zip(ends, (Step.SHARD, Step.FINISH), strict=True):
        attempt.futures = {place: future}
        dispatcher._put(lambda place=place, future=future: dispatcher._ended(attempt, *place, future))
        out.fault = fault
        with pytest.raises(type(fault)):
            dispatcher._handle_inbox()
        out.fault = None
        dispatcher._handle_inbox()
        assert [step for step, _ in attempt.futures] == [then]
    (store.files.partials(computation)).mkdir()
    (store.files.partials(computation) / "0.npz").touch()
    (place, lost), *_ = attempt.futures.items()
    dispatcher._lost(attempt, *place, None)
    assert [*attempt.futures] == [place] and attempt.futures[place] is not lost  # the same step, out once more


def test_a_failure_outlives_the_loss_of_the_scheduler(store, document, out, monkeypatch):
    """Its tasks were stopped: going out again by their names, they would only be lost again and again."""
    job, computation = running(store, document)
    dispatcher = out.dispatcher
    attempt = Attempt(store.computation(computation), "cpu:x", {"shards": [[0, 1]]}, 0)
    future = Future(Outcome(Verdict.FAILED, error=FULL))
    attempt.futures, dispatcher._attempts = {(Step.SHARD, 0): future}, {computation: attempt}
    with monkeypatch.context() as patch:
        patch.setattr(store, "fail", refuse)
        dispatcher._put(lambda: dispatcher._ended(attempt, Step.SHARD, 0, future))
        with pytest.raises(StoreUnavailable):
            dispatcher._handle_inbox()
    dispatcher._resume()
    dispatcher._handle_inbox()
    assert store.get("ann", job).error == FULL and not out.sent and not dispatcher._attempts


def refuse(*_):
    raise StoreUnavailable("database or disk is full")


def test_a_backlog_of_another_priority_is_nobody_elses(store, out):
    """What begins first because it is urgent says nothing of the turns of all that is not."""
    dispatcher = out.dispatcher
    dispatcher._targets = {"auto": "cpu:x", "cpu": "cpu:x"}

    def launched(owner, number, priority):
        store.submit(owner, document_of(number), priority=priority)
        computation = next(key for key in store.unfinished() if key not in dispatcher._attempts)
        dispatcher._launch(computation)
        return dispatcher._attempts[computation]

    backlog = [launched("ann", number, 0) for number in range(3)]
    urgent = launched("ann", 3, 1)
    dispatcher._reported({"token": urgent.token, "step": "plan"})
    assert launched("bob", 4, 0).turn == backlog[0].turn


@pytest.mark.parametrize(("device", "left"), [("auto", True), ("cuda", False)])
def test_a_plan_waits_for_no_gpu_that_has_gone_where_any_hardware_will_do(store, out, device, left):
    dispatcher = out.dispatcher
    dispatcher.engine.alive, dispatcher._targets = {"cuda:x"}, {"auto": "cuda:x", "cuda": "cuda:x"}
    store.submit("ann", canonical(device=device))
    (computation,) = store.unfinished()
    dispatcher._launch(computation)
    attempt = dispatcher._attempts[computation]
    assert attempt.target == "cuda"
    dispatcher._leave_lost_targets()
    dispatcher.engine.alive, dispatcher._targets = {"cpu:x"}, {"auto": "cpu:x", "cpu": "cpu:x"}
    dispatcher._leave_lost_targets()
    assert computation in dispatcher._attempts  # it may come back
    dispatcher._seen["cuda"] -= dispatcher._workers_s + 1
    dispatcher._leave_lost_targets()
    assert (computation not in dispatcher._attempts) == left
    if left:
        dispatcher._launch(computation)
        assert dispatcher._attempts[computation].target == "auto" and len(set(out.sent)) == 2


@pytest.mark.parametrize(("embedded", "planners"), [(True, "auto"), (False, "cuda")])
def test_a_job_for_a_gpu_waits_for_a_worker_that_has_one_where_workers_come(store, out, embedded, planners):
    """One's own workers are all that come: they say that they have none."""
    dispatcher = out.dispatcher
    dispatcher._targets, dispatcher.engine.embedded = {"auto": "cpu:x", "cpu": "cpu:x"}, embedded
    store.submit("ann", canonical(device="cuda:0"))
    (computation,) = store.unfinished()
    dispatcher._launch(computation)
    assert dispatcher._attempts[computation].target == planners
    assert dispatcher.waits_for("cuda:0") == "waiting for a worker with a CUDA GPU"
    assert dispatcher.waits_for("cpu") == dispatcher.waits_for("auto") == "waiting for a free worker"


def test_a_job_that_is_canceled_while_the_database_is_away_costs_no_connection(store, document, out, monkeypatch):
    job, computation = running(store, document)
    dispatcher = out.dispatcher
    attempt = Attempt(store.computation(computation), "cpu:x", {"shards": [[0, 1]]}, 0)
    future = Future(None)
    attempt.futures, dispatcher._attempts = {(Step.SHARD, 0): future}, {computation: attempt}
    store.cancel("ann", job)
    with monkeypatch.context() as patch:
        patch.setattr(store, "stopped", refuse)
        with pytest.raises(StoreUnavailable):
            dispatcher._stop([computation])
    future.status = "cancelled"
    dispatcher._put(lambda: dispatcher._ended(attempt, Step.SHARD, 0, future))
    dispatcher._handle_inbox()
    dispatcher._resume()
    assert not out.sent and dispatcher._attempts
    dispatcher._stop([computation])
    assert states(store, "ann", job) == [JobState.CANCELED] and not dispatcher._attempts
