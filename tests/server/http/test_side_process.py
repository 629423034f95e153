"""Work for requests in a child process: what crashes or costs too much fails its own request only."""

import asyncio
import os
import time

import pytest
from wsrender_server.problems import HttpProblem
from wsrender_server.side_process import SideProcess

from tests.server.http.idle_server import DOCUMENT, problem_of
from wsrender.errors import FrameNotFoundError

LIMIT = 2**28  # bytes


def hold(size):
    """Hold memory, for longer than a test takes."""
    held = b"x" * size
    time.sleep(600)
    return len(held)


def abort(document):
    os.abort()


def sleep(document):
    time.sleep(600)


def refuse():
    raise FrameNotFoundError("tip", "is not there", ["tool"])


@pytest.fixture(scope="module")
def process(tmp_path_factory):
    process = SideProcess(LIMIT, tmp_path_factory.mktemp("models"))
    yield process
    process.close()


@pytest.mark.parametrize(
    ("function", "arguments", "timeout_s", "code"),
    [
        (os.abort, (), 60.0, "crashed"),
        (time.sleep, (600,), 0.5, "too_slow"),
        (hold, (2 * LIMIT,), 60.0, "out_of_memory"),
        (refuse, (), 60.0, "frame_not_found"),
    ],
)
def test_a_fault_costs_its_own_request_only(process, function, arguments, timeout_s, code):
    async def both():
        faulty = asyncio.ensure_future(process.run(function, *arguments, timeout_s=timeout_s))
        beside = asyncio.ensure_future(process.run(abs, -1))
        with pytest.raises(HttpProblem) as fault:
            await faulty
        assert (fault.value.status, fault.value.code) == (409, code)
        assert await beside == 1

    asyncio.run(asyncio.wait_for(both(), 30))


def test_many_waiting_are_refused(process):
    async def flood():
        answers = await asyncio.gather(*(process.run(abs, -n) for n in range(100)), return_exceptions=True)
        refused = [answer for answer in answers if isinstance(answer, HttpProblem)]
        assert len(refused) == 68 and {problem.status for problem in refused} == {429}
        assert [answer for answer in answers if answer not in refused] == list(range(32))

    asyncio.run(flood())


def validated(client):
    """The answer once planning has ended."""
    while True:
        response = client.post("/v1/jobs:validate", json=DOCUMENT)
        if response.json().get("code") != "planning":
            return response


def test_a_job_whose_planning_crashes_is_refused(client, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr("wsrender_server.side_process.planned", abort)
        problem_of(validated(client), 409, "crashed")
    assert client.get("/healthz").status_code == 200


def test_planning_that_takes_too_long_is_refused(client, monkeypatch):
    monkeypatch.setattr("wsrender_server.side_process.planned", sleep)
    monkeypatch.setattr("wsrender_server.side_process.TIMEOUT_S", 1.0)
    problem_of(validated(client), 409, "too_slow")
