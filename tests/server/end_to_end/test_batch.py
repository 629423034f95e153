"""Batches of the client: so many jobs at a time, all waited for, errors by job, and a block that breaks off."""

import pytest

import wsrender as ws
from tests.server.end_to_end.acceptance import PATIENCE_S

AT_ONCE, JOBS, WRONG = 3, 12, 5
LONG = {"analysis": "workspace", "robot": {"library": "ur5e"}, "sampling": {"method": "sobol", "count": 10**10}}


def configuration(number):
    return [0.1 * number, -1.5, 1.5, 0, 1, 0]


def document(number):
    robot = {"library": "ur5e" if number != WRONG else "no_such_robot"}
    return {"analysis": "indices_at", "robot": robot, "configurations": [configuration(number)]}


def test_all_are_waited_for_and_errors_name_their_jobs(client):
    with pytest.raises(ExceptionGroup, match=f"1 of {JOBS} jobs") as raised, client.batch(at_once=AT_ONCE) as batch:
        futures = [batch.submit(document(k), labels={"batch": str(k)}) for k in range(JOBS)]
    (error,) = raised.value.exceptions
    assert isinstance(error, ws.DocumentError) and error.__notes__ == [f"job {WRONG} of the batch"]
    assert batch.errors == {WRONG: error} and futures[WRONG].exception() is error
    for number, future in enumerate(futures):
        if number != WRONG:
            assert future.result(0).document["job"]["configurations"] == [configuration(number)]

    records = [job.record for job in client.jobs() if "batch" in job.record["labels"]]
    assert {int(record["labels"]["batch"]) for record in records} == set(range(JOBS)) - {WRONG}
    begun = [record["created_at"] for record in records]
    together = [sum(r["created_at"] <= t < r["finished_at"] for r in records) for t in begun]
    assert 1 < max(together) <= AT_ONCE


@pytest.mark.parametrize("cancel", [False, True])
def test_a_block_that_breaks_off(client, cancel):
    label = ("broken", str(cancel))
    with pytest.raises(KeyboardInterrupt), client.batch(at_once=1, cancel=cancel) as batch:
        futures = [batch.submit(LONG, labels=dict([label])) for _ in range(2)]
        while not list(client.jobs(label=label)):
            assert not futures[0].done()
        raise KeyboardInterrupt
    assert futures[1].cancelled() and isinstance(futures[0].exception(0), ws.WaitTimeoutError)
    (job,) = client.jobs(label=label)
    if not cancel:
        assert job.state in ("queued", "running")
        job.cancel()
    assert job.wait(timeout=PATIENCE_S).state == "canceled"


@pytest.mark.parametrize("at_once", [0, 65, 2.0, True])
def test_at_once(at_once):
    with ws.Client() as client, pytest.raises(ws.InputError, match="at_once: must be an integer from 1 to 64, not"):
        client.batch(at_once=at_once)
