"""An attempt at a computation: in which order its shards begin, and what it says of how far they are."""

from contextlib import suppress

import pytest
from wsrender_server.jobs.attempt import Attempt
from wsrender_server.jobs.dispatcher import Dispatcher
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.records import ComputationRecord, ComputationState
from wsrender_server.jobs.steps import partial_name
from wsrender_server.jobs.task import Step, TaskLimits
from wsrender_server.settings import Settings

SHARDS = [[0, 10], [10, 10], [20, 10], [30, 0], [30, 0]]  # the last two are refinements


@pytest.fixture
def files(tmp_path):
    return DataFolder(tmp_path)


def begun(files, there=(), **resolved):
    """An attempt whose shards begin, where those ``there`` are on disk already, and which are to be computed."""
    record = ComputationRecord("a", "ann", ComputationState.RUNNING, {}, 0, 1, None, None)
    attempt = Attempt(record, "cpu:x", {"shards": SHARDS, **resolved}, 0)
    files.partials("a").mkdir(parents=True, exist_ok=True)
    for shard in there:
        (files.partials("a") / partial_name(shard)).touch()
    return attempt, attempt.begin_shards(files)


@pytest.mark.parametrize(("there", "order"), [((), [0, 3, 4, 1, 2]), ((0, 4), [3, 1, 2]), (range(5), [])])
def test_refinements_begin_after_the_first_samples(files, there, order):
    assert begun(files, there)[1] == order


def test_points_of_refinements_are_no_samples(files):
    attempt, _ = begun(files, there=[1])
    attempt.reported(3, 500)
    progress = attempt.progress()
    assert (progress.samples_done, progress.samples_total, progress.rate_per_s) == (10, 30, None)
    assert progress.fraction == pytest.approx(0.99 / 3) and progress.message == "samples"
    attempt.reported(0, 10)
    attempt.reported(2, 10)
    progress = attempt.progress()
    assert (progress.fraction, progress.eta_s) == (0.99, 0) and progress.rate_per_s > 0
    assert progress.message == "refining: 500 points decided by inverse kinematics"


@pytest.mark.parametrize(("resolved", "total"), [({"most_samples": 120}, 120), ({"iterates": True}, None)])
def test_of_a_search_the_most_samples_are_the_total_and_of_what_iterates_nothing_is(files, resolved, total):
    attempt, _ = begun(files, **resolved)
    attempt.reported(0, 10)
    progress = attempt.progress()
    assert (progress.samples_done, progress.samples_total) == (10, total)
    assert progress.fraction == pytest.approx(0.99 * 10 / 120 if total else 0)


def test_planning_tells_how_many_tables_are_made(files):
    attempt, _ = begun(files)
    attempt.step = Step.PLAN
    attempt.refined(3, 21)
    assert attempt.progress().message == "planning: 3 of 21 collision tables"
    attempt.begin_shards(files)
    attempt.step = Step.FINISH
    assert attempt.progress().message == "finishing"


def test_tasks_carry_the_limits_of_the_server(opened, tmp_path, document):
    limited = {"max_memory_bytes": 2**29, "max_planning_memory_bytes": 2**28, "max_planning_s": 7.0, "max_samples": 99}
    settings = Settings(data_dir=tmp_path, **limited)
    store, sent = opened(settings), []
    dispatcher = Dispatcher(store, settings)
    dispatcher._targets = {"auto": "cpu:x"}
    dispatcher.engine.submit = lambda tasks, *_: sent.extend(tasks.values()) or []
    store.submit("ann", document)
    (computation,) = store.unfinished()
    with suppress(ValueError):  # no future of it
        dispatcher._launch(computation)
    assert [task.limits for task in sent] == [TaskLimits(2**29, 2**28, 7.0, 99)]
