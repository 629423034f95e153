"""The layers around every request."""

import asyncio

import pytest
import structlog
from anyio import BrokenResourceError
from wsrender_server.connections import BodyLayer
from wsrender_server.metrics import Metrics
from wsrender_server.requests import RequestLayer
from wsrender_server.settings import Settings

SCOPE = {"type": "http", "method": "GET", "path": "/v1/jobs/x/events", "headers": []}
LENGTH = [(b"content-length", b"2")]


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

    asyncio.run(BodyLayer(app, Settings(read_timeout_s=0.01))(SCOPE | {"headers": LENGTH}, receive, None))
    assert read == [{"type": "http.request", "body": b"{}"}]


CHUNKED = [(b"transfer-encoding", b"chunked")]
WAITING = [*LENGTH, (b"expect", b"100-Continue")]


def order_of(headers, chunks, *, asks=False, seconds=0.0):
    """What goes to and fro where an application answers, after asking for the body once or without asking."""
    happened, left = [], list(chunks)

    async def app(scope, receive, send):
        if asks:
            await receive()
        await send({"type": "http.response.start", "status": 403, "headers": []})
        await send({"type": "http.response.body", "body": b"no"})

    async def receive():
        await asyncio.sleep(seconds)
        happened.append("asked")
        body = left.pop(0)
        return {"type": "http.request", "body": body, "more_body": bool(left)}

    async def send(message):
        happened.append(message["type"].rpartition(".")[2])

    settings = Settings(read_timeout_s=0.05 if seconds else 60.0, max_upload_bytes=4)
    asyncio.run(BodyLayer(app, settings)(SCOPE | {"headers": headers}, receive, send))
    return happened


@pytest.mark.parametrize(
    ("headers", "chunks", "options", "asked"),
    [
        (LENGTH, [b"{", b"}"], {}, 2),
        (CHUNKED, [b"{", b"}"], {}, 2),
        (LENGTH, [b"{", b"}"], {"asks": True}, 2),
        ([], [b""], {}, 0),  # no body
        ([(b"content-length", b"0")], [b""], {}, 0),
        (LENGTH, [b"{}"], {"seconds": 1}, 0),  # too slow
        (CHUNKED, [b"12"] * 9, {}, 3),  # too long
        (WAITING, [b"{}"], {}, 0),
        (WAITING, [b"{", b"}"], {"asks": True}, 2),
    ],
)
def test_an_answer_comes_after_the_body(headers, chunks, options, asked):
    assert order_of(headers, chunks, **options) == ["asked"] * asked + ["start", "body"]
