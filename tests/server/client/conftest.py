"""A client of a server made of answers, with a clock that does not wait."""

from types import SimpleNamespace

import pytest

import wsrender as ws
from tests.server.client.recorded_server import RecordedServer


@pytest.fixture
def clock(monkeypatch):
    """Pauses pass at once; ``clock.pauses`` lists them."""
    clock = SimpleNamespace(now=0.0, pauses=[])

    def sleep(seconds):
        clock.now += seconds
        clock.pauses.append(seconds)

    time = SimpleNamespace(monotonic=lambda: clock.now, sleep=sleep)
    monkeypatch.setattr("wsrender.client.connection.time", time)
    monkeypatch.setattr("wsrender.client.job.time", time)
    return clock


@pytest.fixture
def server():
    return RecordedServer()


@pytest.fixture
def client(server, clock):
    with ws.Client("http://lab:8000", token="secret", transport=server) as client:
        yield client
