"""A real server in its own process, with real workers, and results of local runs to compare with."""

import pytest
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.server.end_to_end.acceptance import LONG, LONG_SHARD_SAMPLES, QUICK, local_result


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with LocalServer(tmp_path_factory.mktemp("data")) as server:
        yield server


@pytest.fixture
def client(server):
    with ws.Client(server.url) as client:
        yield client


@pytest.fixture(scope="session")
def quick_local(tmp_path_factory):
    """The quick job run here: result and folder."""
    folder = tmp_path_factory.mktemp("quick") / "out"
    return local_result(QUICK, folder), folder


@pytest.fixture(scope="session")
def long_local(tmp_path_factory):
    """The long job run here."""
    return local_result(LONG, tmp_path_factory.mktemp("long") / "out")


@pytest.fixture
def small_shards(monkeypatch):
    """Servers started from here divide the long job into many shards."""
    monkeypatch.setenv("WSRENDER_SHARD_SAMPLES", str(LONG_SHARD_SAMPLES))
