"""Work for requests in a child process: what crashes or costs too much fails its own request only."""

import asyncio
import json
import os
import time
from pathlib import Path

import pytest
from fastapi.testclient import TestClient
from wsrender_server.app import create_app
from wsrender_server.problems import HttpProblem
from wsrender_server.side_process import MOST_WAITING_OF_OWNER, Estimates, SideProcess

from tests.server.http.idle_server import DOCUMENT, HOST, problem_of
from wsrender.errors import FrameNotFoundError

LIMIT = 2**28  # bytes
PATIENCE_S = 120.0


def hold(size):
    """Hold memory, for longer than a test takes."""
    held = b"x" * size
    time.sleep(600)
    return len(held)


def abort(document):
    os.abort()


def sleep(document):
    time.sleep(600)


def noted(document):
    """Sleep as long as a document says, and write down whose it was."""
    document = json.loads(document)
    time.sleep(document["sleep_s"])
    with Path(document["path"]).open("a") as file:
        file.write(document["owner"] + "\n")
    return {}


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

    asyncio.run(asyncio.wait_for(both(), PATIENCE_S))


def test_many_waiting_are_refused(process):
    async def flood():
        answers = await asyncio.gather(*(process.run(abs, -n) for n in range(100)), return_exceptions=True)
        refused = [answer for answer in answers if isinstance(answer, HttpProblem)]
        assert len(refused) == 68 and {problem.status for problem in refused} == {429}
        assert [answer for answer in answers if answer not in refused] == list(range(32))

    asyncio.run(flood())


def test_others_are_answered_while_one_owner_floods(process):
    """After the one of the flood that runs, however many of it wait."""

    async def flood():
        begun = asyncio.get_running_loop().time()
        sleeps = [asyncio.ensure_future(process.run(time.sleep, 0.5, owner="ann")) for _ in range(50)]
        await asyncio.sleep(0.1)
        assert await process.run(abs, -3, owner="bob") == 3
        assert asyncio.get_running_loop().time() - begun < 0.5 * 16  # and of the flood 32 are taken
        for each in sleeps:
            each.cancel()
        told = await asyncio.gather(*sleeps, return_exceptions=True)
        refused = [each for each in told if isinstance(each, HttpProblem)]
        assert len(refused) == 18 and {each.code for each in refused} == {"busy"}
        assert await process.run(abs, -4, owner="ann") == 4  # nothing of it is left

    asyncio.run(process.run(abs, 0))  # it runs
    asyncio.run(asyncio.wait_for(flood(), PATIENCE_S))


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


def test_planning_has_limits_of_its_own(settings, jobs, monkeypatch):
    monkeypatch.setattr("wsrender_server.side_process.planned", sleep)
    settings = settings.model_copy(update={"max_planning_s": 1.0, "max_planning_memory_bytes": LIMIT})
    with TestClient(create_app(settings, jobs), base_url=HOST) as client:
        problem_of(validated(client), 409, "too_slow")
        monkeypatch.setattr("wsrender_server.side_process.planned", hold_much)
        problem = problem_of(validated(client), 409, "out_of_memory")
    assert "0.25 GiB" in problem["detail"]


def hold_much(document):
    return hold(2 * LIMIT)


@pytest.fixture
def estimates(tmp_path, monkeypatch):
    """``estimates(n)`` plans in n processes, by `noted`; ``ask(owner, name, sleep_s)`` asks until it is answered."""
    monkeypatch.setattr("wsrender_server.side_process.planned", noted)
    made = []

    def make(processes):
        made.append(Estimates([SideProcess(2**31, tmp_path) for _ in range(processes)], 60.0))

        async def ask(owner, name, sleep_s=0.0, problems=None):
            text = json.dumps({"owner": owner, "name": name, "sleep_s": sleep_s, "path": str(tmp_path / "order")})
            while True:
                try:
                    return await made[-1].of(owner, name, text)
                except HttpProblem as problem:
                    if problem.code != "planning":
                        raise
                    if problems is not None:
                        problems.append(problem)

        return ask

    yield make
    for each in made:
        each.close()


def test_one_owner_does_not_hold_the_planner_of_all(estimates):
    """Plans of ann's that take ten minutes; others are answered while the first is at work."""
    ask = estimates(2)

    async def all_of_them():
        slow = [asyncio.ensure_future(ask("ann", name, 600.0)) for name in range(3)]
        await asyncio.sleep(0.1)
        for owner in ("bob", "eve", "bob"):
            assert await ask(owner, "quick") == {}
        assert not any(each.done() for each in slow)
        for each in slow:
            each.cancel()

    asyncio.run(asyncio.wait_for(all_of_them(), PATIENCE_S))


def test_who_asks_waits_for_a_plan_of_seconds(estimates, monkeypatch):
    """As long as clients and proxies wait for an answer; then they are told to ask again."""
    ask, problems = estimates(1), []

    async def first_answer(sleep_s):
        began = time.monotonic()
        assert await ask("ann", f"of {sleep_s} s", sleep_s, problems) == {}
        return time.monotonic() - began

    assert asyncio.run(first_answer(6.0)) >= 6.0 and problems == []
    monkeypatch.setattr("wsrender_server.side_process.PATIENCE_S", 0.2)
    asyncio.run(first_answer(1.0))
    assert {problem.code for problem in problems} == {"planning"} and all(each.retryable for each in problems)


def test_owners_are_planned_for_in_turn(estimates, tmp_path):
    ask = estimates(1)

    async def all_of_them():
        asked = [asyncio.ensure_future(ask(owner, name)) for owner in ("ann", "bob") for name in range(3)]
        await asyncio.gather(*asked)

    asyncio.run(asyncio.wait_for(all_of_them(), PATIENCE_S))
    assert (tmp_path / "order").read_text().split() == ["ann", "bob"] * 3


def test_only_so_many_of_an_owner_wait(estimates):
    ask = estimates(2)

    async def flood():
        mine = [asyncio.ensure_future(ask("ann", n, 600.0 * (n == 0))) for n in range(MOST_WAITING_OF_OWNER + 3)]
        for late in mine[-3:]:
            with pytest.raises(HttpProblem) as refused:
                await late
            assert (refused.value.status, refused.value.retryable) == (429, True)
        assert await ask("bob", "quick") == {}
        for each in mine:
            each.cancel()

    asyncio.run(asyncio.wait_for(flood(), PATIENCE_S))
