"""Clients that hold connections open: half heads, half bodies, and too many of them."""

import socket
import time
from contextlib import ExitStack

import httpx2
import pytest
from websockets.sync.client import connect
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.server.jobs.waiting import wait_until, within

TIMEOUT_S, MOST = 1.5, 40
PATIENCE_S = 60.0
HEAD = b"POST /v1/jobs HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("WSRENDER_READ_TIMEOUT_S", str(TIMEOUT_S))
        environment.setenv("WSRENDER_MAX_CONNECTIONS_PER_CLIENT", str(MOST))
        with LocalServer(tmp_path_factory.mktemp("data"), ["--workers", "0"]) as server:
            yield server


@pytest.fixture
def opened(server):
    """``opened(data)`` is a connection on which data was sent."""
    with ExitStack() as sockets:

        def send(data):
            connection = socket.create_connection(("127.0.0.1", int(server.url.rpartition(":")[2])), timeout=PATIENCE_S)
            connection.sendall(data)
            return sockets.enter_context(connection)

        yield send


def end_of(connection):
    """Everything that comes until the server closes a connection."""
    parts = []
    try:
        while part := connection.recv(1 << 16):
            parts.append(part)
    except ConnectionResetError:
        pass
    return b"".join(parts)


def test_half_requests_end_while_others_are_answered(server, opened):
    answered = opened(b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
    answered.recv(1 << 16)
    started = time.monotonic()
    halves = {
        "nothing": (b"", b""), "a head": (HEAD, b" 408 "), "a line": (b"GET /hea", b" 408 "),
        "no body": (HEAD + b"Content-Length: 9\r\n\r\n", b" 408 "),
        "a body": (HEAD + b"Content-Length: 99\r\n\r\n{", b" 408 "),
        "chunks": (HEAD + b"Transfer-Encoding: chunked\r\n\r\n1\r\n{\r\n", b" 408 "),
    }  # fmt: skip
    connections = {name: [opened(data) for _ in range(5)] for name, (data, _) in halves.items()}
    answered.sendall(b"GET /healthz HTTP/1.1\r\n")  # the second request of a kept connection
    with ws.Client(server.url) as client:
        assert list(client.jobs()) == []
    for name, group in connections.items():
        for connection in group:
            said = end_of(connection)
            assert halves[name][1] in said if halves[name][1] else said == b"", (name, said)
    assert b" 408 " in end_of(answered)
    assert TIMEOUT_S <= time.monotonic() - started < PATIENCE_S
    assert b'"code":"request_timeout"' in end_of(opened(HEAD + b"Content-Length: 99\r\n\r\n{"))


def test_a_body_that_keeps_coming_may_take_longer(opened):
    body = b'{"analysis": "nothing"' + b" " * 200_000 + b"}"
    connection = opened(HEAD + b"Content-Length: %d\r\n\r\n" % len(body))
    pieces = 10
    size = -(-len(body) // pieces)
    for number in range(pieces):
        time.sleep(2 * TIMEOUT_S / pieces)
        connection.sendall(body[number * size : (number + 1) * size])
    assert b" 422 " in connection.recv(1 << 16)


def test_answers_that_nobody_takes_in_keep_nobody_waiting(server, opened):
    """Connections that ask again and again for a megabyte, and read none of it, and one that follows events."""
    asked = b"GET /viewer/viewer.js HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n" * 30
    connections = [opened(asked) for _ in range(MOST - 5)]
    with ws.Client(server.url) as client:
        for _ in range(20):
            with within(2):
                assert list(client.jobs()) == []
        whole = httpx2.get(f"{server.url}/viewer/viewer.js", timeout=PATIENCE_S).content
    assert len(connections[0].recv(1 << 20)) > 0 and len(whole) > 500_000  # whose answers had begun
    for connection in connections:
        connection.close()
    wait_until(lambda: httpx2.get(f"{server.url}/healthz", timeout=PATIENCE_S).status_code == 200)


def test_a_client_has_so_many_connections(opened):
    request = b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n"
    connections = [opened(request) for _ in range(MOST)]
    assert b" 429 " in end_of(opened(b""))
    for connection in connections[:3]:
        connection.close()
    # Whether the server has noticed the ends before the next comes is up to it.
    wait_until(lambda: b" 200 " in opened(request + b"\r\n").recv(1 << 16), PATIENCE_S, "a place")
    for connection in connections[3:]:
        connection.sendall(b"\r\n")
        assert b" 200 " in connection.recv(1 << 16)


def test_websockets_are_connections_too(server, opened):
    """Those that have said nothing yet, which no session counts; and their places are given back."""
    request = b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
    url = f"{server.url.replace('http', 'ws')}/v1/robots:view/session"
    with ExitStack() as sockets:
        for _ in range(MOST):
            sockets.enter_context(connect(url, open_timeout=PATIENCE_S))
        assert b" 429 " in end_of(opened(b""))
    wait_until(lambda: b" 200 " in opened(request).recv(1 << 16), PATIENCE_S, "a place")
    with ExitStack() as sockets:
        for _ in range(MOST // 2):
            sockets.enter_context(connect(url, open_timeout=PATIENCE_S))
