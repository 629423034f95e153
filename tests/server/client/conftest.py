"""Both clients of a server made of answers, with a clock that does not wait."""

import asyncio
import contextlib
import inspect
from types import SimpleNamespace

import pytest

import wsrender as ws
from tests.server.client.recorded_server import RecordedServer
from wsrender.client import AsyncJob


@pytest.fixture
def clock(monkeypatch):
    """Pauses pass at once; ``clock.pauses`` lists them."""
    clock = SimpleNamespace(now=0.0, pauses=[])

    def sleep(seconds):
        clock.now += seconds
        clock.pauses.append(seconds)

    time = SimpleNamespace(monotonic=lambda: clock.now, sleep=sleep)
    for module in ("connection", "job", "operations", "requests"):
        monkeypatch.setattr(f"wsrender.client.{module}.time", time)

    async def pause(seconds):
        sleep(seconds)

    pausing = SimpleNamespace(**vars(asyncio) | {"sleep": pause})
    for module in ("connection", "async_job"):
        monkeypatch.setattr(f"wsrender.client.{module}.asyncio", pausing)
    return clock


@pytest.fixture
def server():
    return RecordedServer()


@pytest.fixture(params=[ws.Client, ws.AsyncClient], ids=lambda kind: kind.__name__)
def client(request, server, clock):
    """Either client; what is said of one holds for the other."""
    client = request.param("http://lab:8000", token="secret", transport=server)
    if request.param is ws.Client:
        with client:
            yield client
        return
    with asyncio.Runner() as runner:
        yield Waited(client, runner)
        runner.run(client.close())


class Waited:
    """What asyncio's client gives, run by waiting: each call returns when what it awaits is there."""

    def __init__(self, of, runner):
        self._of, self._runner = of, runner

    def __getattr__(self, name):
        found = getattr(self._of, name)
        return (lambda *args, **named: self._waited(found(*args, **named))) if inspect.isroutine(found) else found

    def _waited(self, value):
        if inspect.isasyncgen(value):
            return self._each(value)
        if inspect.isawaitable(value):
            value = self._runner.run(arrived(value))
        if value is self._of:
            return self
        return Waited(value, self._runner) if isinstance(value, AsyncJob) else value

    def _each(self, values):
        with contextlib.suppress(StopAsyncIteration):
            while True:
                yield self._waited(anext(values))


async def arrived(awaitable):
    return await awaitable
