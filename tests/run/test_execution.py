"""Threads and chunks that are asked for are those of every step of every analysis, and change no number."""

import inspect
import sys

import pytest

import wsrender as ws
from tests.lasting import lasting
from tests.run.small_jobs import SMALL_JOBS
from wsrender.analyses.execution import Execution
from wsrender.analyses.registry import job_classes
from wsrender.engine import thread_count
from wsrender.errors import InputError
from wsrender.run import execute

ASKED = 3
ON_ONE_CORE = {"five_bar"}  # closed forms in NumPy
DOORS = (
    ws.analyze,
    ws.boundary_patches,
    ws.capability,
    ws.collaborative_volume,
    ws.design_optimization,
    ws.five_bar,
    ws.indices_at,
    ws.kinetostatic_field,
    ws.master_slave_mapping,
    ws.method_comparison,
    ws.parallel_workspace,
    ws.planar_boundary,
    ws.robot_comparison,
    ws.shared_workspace,
    ws.execute,
)


@pytest.fixture
def requested(monkeypatch):
    """What the engine is asked for after planning, whose first samples are few: every request passes thread_count."""
    found = []

    def spy(requested=None):
        if not _is_planning():
            found.append(requested)
        return thread_count(requested)

    for name, module in list(sys.modules.items()):
        if name.startswith("wsrender.") and vars(module).get("thread_count") is thread_count:
            monkeypatch.setattr(module, "thread_count", spy)
    return found


def _is_planning():
    frame = sys._getframe()
    while frame := frame.f_back:
        if frame.f_code.co_name == "plan" or frame.f_code.co_name.startswith("plan_"):
            return True
    return False


def test_there_is_a_job_of_every_analysis():
    assert set(SMALL_JOBS) == set(job_classes())


@pytest.mark.parametrize("analysis", SMALL_JOBS)
def test_every_step_takes_the_threads_that_are_asked_for(analysis, requested):
    found = execute(SMALL_JOBS[analysis], threads=ASKED)
    assert set(requested) == {ASKED}
    asked_by_steps = 2 if "design" not in SMALL_JOBS[analysis] else 0  # Execution, of the shard and of finish
    assert (len(requested) > asked_by_steps) == (analysis not in ON_ONE_CORE)
    assert lasting(execute(SMALL_JOBS[analysis], threads=1).document) == lasting(found.document)


@pytest.mark.parametrize("door", DOORS, ids=lambda door: door.__name__)
def test_every_door_has_threads_and_chunks(door):
    parameters = inspect.signature(door).parameters
    assert [parameters[name].default for name in ("threads", "chunk_size")] == [None, None]


@pytest.mark.parametrize("field", ["threads", "chunk_size"])
@pytest.mark.parametrize("value", [0, -1, 2.5, "2", True])
def test_what_is_no_count_is_refused_in_every_analysis(field, value):
    message = rf"{field}: {value!r} is not allowed; a positive whole number is"
    with pytest.raises(InputError, match=message):
        Execution(**{field: value})
    with pytest.raises(InputError, match=message):
        execute(SMALL_JOBS["five_bar"], **{field: value})


def test_the_variable_is_read_once_for_a_step(monkeypatch):
    monkeypatch.setenv("WSRENDER_THREADS", "5")
    execution = Execution()
    monkeypatch.setenv("WSRENDER_THREADS", "2")
    assert execution.threads == 5
    assert Execution(threads=4).threads == 4


def test_a_misspelt_option_is_no_longer_swallowed():
    with pytest.raises(TypeError, match="thread"):
        execute(SMALL_JOBS["five_bar"], thread=1)  # pyright: ignore[reportCallIssue]
