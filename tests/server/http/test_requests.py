"""The outermost layer around requests."""

import asyncio

import pytest
import structlog
from anyio import BrokenResourceError
from wsrender_server.connections import BodyLayer
from wsrender_server.metrics import Metrics
from wsrender_server.requests import RequestLayer
from wsrender_server.settings import Settings

SCOPE = {"type": "http", "method": "GET", "path": "/v1/jobs/x/events", "headers": []}


def logged(fault: BaseException, *, answering: bool) -> tuple[list[str], list[int]]:
    """What is logged of a request that ends with a fault, and the statuses sent."""
    statuses = []

    async def app(scope, receive, send):
        if answering:
            await send({"type": "http.response.start", "status": 200, "headers": []})
        raise fault

    async def send(message):
        if message["type"] == "http.response.start":
            statuses.append(message["status"])

    async def receive():
        return {"type": "http.disconnect"}

    layer = RequestLayer(app, Metrics(), Settings(max_body_bytes=1))
    with structlog.testing.capture_logs() as logs:
        try:
            asyncio.run(layer(dict(SCOPE), receive, send))
        except Exception as raised:
            assert raised is fault
    return [entry["event"] for entry in logs], statuses


LEFT = ExceptionGroup("unhandled errors in a TaskGroup", [BrokenResourceError()])
MIXED = ExceptionGroup("unhandled errors in a TaskGroup", [BrokenResourceError(), ValueError()])


def test_a_client_that_leaves_an_event_stream_is_no_fault():
    assert logged(LEFT, answering=True) == (["request"], [200])


@pytest.mark.parametrize(("fault", "answering"), [(MIXED, True), (ValueError(), True), (LEFT, False)])
def test_any_other_fault_is_logged(fault, answering):
    assert logged(fault, answering=answering) == (["request failed", "request"], [200 if answering else 500])


def test_a_server_that_is_slow_to_read_refuses_no_body_for_that():
    """The time of a body counts from when it is asked for; a thread may be long in coming."""
    read = []

    async def app(scope, receive, send):
        await asyncio.sleep(0.05)
        read.append(await receive())

    async def receive():
        return {"type": "http.request", "body": b"{}"}

    asyncio.run(BodyLayer(app, 0.01)(dict(SCOPE), receive, None))
    assert read == [{"type": "http.request", "body": b"{}"}]
