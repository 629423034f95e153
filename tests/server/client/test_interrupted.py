"""Ctrl-C, or the cancellation of a task, while a job is waited for: the job goes on, or is stopped by choice."""

import asyncio

import httpx2
import pytest

import wsrender as ws
from tests.server.client.recorded_server import refuses, says
from tests.server.client.test_requests import DOCUMENT, JOB

CANCEL = ("POST", "/v1/jobs/j1:cancel")
GOES_ON = "the job goes on at the server; Client.job('j1') finds it"


def press(request):
    return KeyboardInterrupt() if "wait" in request.url.params else says(JOB)


@pytest.mark.parametrize(
    ("choice", "answer", "canceled", "note"),
    [
        ({}, None, 0, GOES_ON),
        ({"on_interrupt": "detach"}, None, 0, GOES_ON),
        ({"on_interrupt": "cancel"}, says({**JOB, "state": "canceling"}), 1, "job j1 was canceled"),
        ({"on_interrupt": "cancel"}, refuses(409, "invalid_transition", detail="it has ended"), 1,
         "job j1 could not be canceled: it has ended"),
        ({"on_interrupt": "cancel"}, httpx2.ReadError("reset"), 1, "job j1 could not be canceled: lost the server"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("progress", [False, True])
def test_a_wait_that_is_interrupted(choice, answer, canceled, note, progress, server, client):
    server.answer("GET", "/v1/jobs/j1", press)
    server.answer(*CANCEL, answer)
    job = client.job("j1")
    with pytest.raises(KeyboardInterrupt) as stopped:
        job.wait(progress=progress, **choice)
    assert len(server.sent(*CANCEL)) == canceled
    (said,) = stopped.value.__notes__
    assert said.startswith(note)


def test_an_unknown_choice_is_refused(server, client):
    server.answer("GET", "/v1/jobs/j1", says(JOB))
    with pytest.raises(ws.InputError, match="on_interrupt: must be detach or cancel, not 'stop'"):
        client.job("j1").wait(on_interrupt="stop")


@pytest.mark.parametrize(("choice", "canceled"), [("detach", 0), ("cancel", 1)])
def test_a_task_that_is_canceled(choice, canceled, server):
    """Of asyncio, whose Ctrl-C cancels the main task, as `asyncio.timeout` does its block."""

    class Held(httpx2.AsyncBaseTransport):
        async def handle_async_request(self, request):
            if "wait" in request.url.params:
                await asyncio.sleep(60)
            return server.handle_request(request)

    async def timed_out():
        async with ws.AsyncClient("http://lab:8000", transport=Held()) as client:
            job = await client.job("j1")
            async with asyncio.timeout(0.05):
                await job.wait(on_interrupt=choice)

    server.answer("GET", "/v1/jobs/j1", says(JOB))
    server.answer(*CANCEL, says({**JOB, "state": "canceling"}))
    with pytest.raises(TimeoutError) as stopped:
        asyncio.run(timed_out())
    assert len(server.sent(*CANCEL)) == canceled
    assert stopped.value.__cause__.__notes__ == ["job j1 was canceled" if canceled else GOES_ON]


@pytest.mark.parametrize("cancel", [False, True])
def test_a_batch_that_is_left_by_an_exception(cancel, server):
    """Of asyncio; one on its way to the server is not left behind. Those of threads are tested against a server."""
    submitted = asyncio.Event()

    class Slow(httpx2.AsyncBaseTransport):
        async def handle_async_request(self, request):
            if request.method == "POST" and request.url.path == "/v1/jobs":
                submitted.set()
                await asyncio.sleep(0.05)
            return server.handle_request(request)

    async def left():
        async with (
            ws.AsyncClient("http://lab:8000", transport=Slow()) as client,
            client.batch(at_once=1, cancel=cancel) as batch,
        ):
            for _ in range(3):
                batch.submit(DOCUMENT)
            await submitted.wait()
            raise ZeroDivisionError

    server.answer("POST", "/v1/jobs", says(JOB, 202))
    server.answer(*CANCEL, says({**JOB, "state": "canceling"}))
    with pytest.raises(ZeroDivisionError):
        asyncio.run(left())
    assert (len(server.sent("POST", "/v1/jobs")), len(server.sent(*CANCEL))) == (1, int(cancel))
