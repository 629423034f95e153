"""The page for LabVIEW and PLC gateways: each command typed, the bytes that went both ways compared with the page."""

import os
import re
import shutil
import socket
import socketserver
import subprocess
import threading
from pathlib import Path

import numpy as np
import pytest
from wsrender_server.local_server import LocalServer

import wsrender as ws

PAGE = Path(__file__).parent.parent.parent / "clients" / "curl.md"
KEY = "a-secret-of-the-lab-0123456789"
STEP_S = 100
SAME = 1e-9  # numbers of two machines, whose libraries round differently
NUMBER = r"-?\d+\.\d{10,}"
DATE = r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{6}Z"
VARYING = {  # what the page names, and how it is spelled
    "SERVER": r"127\.0\.0\.1:\d+",
    "KEY": re.escape(KEY),
    "PLC-KEY": r"cGxjOmEtc2VjcmV0LW9mLXRoZS1sYWItMDEyMzQ1Njc4OQ==",  # plc:KEY in base64
    "CURL": r"\d+\.\d+\.\d+",
    "HTTP-DATE": r"\w{3}, \d\d \w{3} \d{4} \d\d:\d\d:\d\d GMT",
    "DATE": DATE,
    "DATE-OR-NULL": rf'(?:"{DATE}"|null)',
    "REQUEST": r"[0-9a-f]{16}",
    "TAG": r"[0-9a-f]{64}",
    "VERSION": r"\d+\.\d+\.\d+\S*?",
    "STATE": r"(?:queued|running|canceling|canceled)",
    "MESSAGE": r'[^"]*',
    "N": r"(?:\d+(?:\.\d+)?|null)",
    "JOB": r"[0-9a-f]{32}",
}


class Recorder(socketserver.ThreadingTCPServer):
    """A port that passes bytes on to a server and its answers back, and keeps both."""

    daemon_threads = True

    def __init__(self, server):
        super().__init__(("127.0.0.1", 0), Relay)
        self.to = server
        self.asked, self.answered = bytearray(), bytearray()

    @property
    def address(self):
        return f"127.0.0.1:{self.server_address[1]}"


class Relay(socketserver.BaseRequestHandler):
    """A connection of a recorder."""

    def handle(self):
        """Until either side closes."""
        with socket.create_connection(self.server.to) as server:
            back = threading.Thread(target=pass_on, args=(server, self.request, self.server.answered), daemon=True)
            back.start()
            pass_on(self.request, server, self.server.asked)
            back.join()


def pass_on(source, target, kept):
    while part := source.recv(65536):
        kept += part
        target.sendall(part)
    target.shutdown(socket.SHUT_WR)


def exchanges(text):
    """(command, request, answer) of a page, the last two as they go over the line."""
    blocks = re.findall(r"```(sh|http)\n(.*?)\n```", text, re.DOTALL)
    assert [kind for kind, _ in blocks] == ["sh", "http", "http"] * (len(blocks) // 3), [kind for kind, _ in blocks]
    wire = [block if kind == "sh" else on_the_wire(block) for kind, block in blocks]
    return list(zip(wire[0::3], wire[1::3], wire[2::3], strict=True))


def on_the_wire(block):
    """Bytes of a message: lines of its head end with CR LF."""
    head, _, body = block.partition("\n\n")
    return head.rstrip("\n").replace("\n", "\r\n") + "\r\n\r\n" + body


def assert_same(expected, actual, job):
    """A message is the page's but for what it names; the id of its job. Content-Length counts its body."""
    pieces = re.split(rf"<([A-Z-]+)>|({NUMBER})", expected)
    pattern, numbers, seen = re.escape(pieces[0]), [], job
    for name, number, literal in zip(pieces[1::3], pieces[2::3], pieces[3::3], strict=True):
        if number is not None:
            pattern += f"({NUMBER})"
            numbers.append(float(number))
        elif name == "JOB":
            pattern += "(?P=job)" if "(?P<job>" in pattern else f"(?P<job>{VARYING[name]})"
        else:
            pattern += VARYING[name]
        pattern += re.escape(literal)
    match = re.fullmatch(pattern, actual)
    assert match, f"the page says\n{expected}\nbut it was\n{actual}"
    if "(?P<job>" in pattern:
        seen = match["job"]
        assert job in (None, seen)
    found = [float(group) for group in match.groups() if re.fullmatch(NUMBER, group)]
    np.testing.assert_allclose(found, numbers, rtol=SAME)
    head, _, body = actual.partition("\r\n\r\n")
    (length,) = re.findall(r"(?i)^content-length: (\d+)\r?$", head, re.M) or ["0"]
    assert len(body.encode()) == int(length)
    return seen


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    keys = tmp_path_factory.mktemp("keys") / "keys"
    keys.write_text(f"{KEY} lab read,submit\n")
    keys.chmod(0o600)
    with LocalServer(tmp_path_factory.mktemp("data"), ("--api-key-file", str(keys))) as server:
        with ws.Client(server.url, KEY) as client:  # so that no program is compiled while the page waits
            job = {"analysis": "indices_at", "robot": {"library": "ur5e"}, "configurations": [[0.1] * 6]}
            client.submit(job).result()
        yield server


def typed(command, server, job):
    """(request, answer) that went over the line when a command of the page was typed."""
    host, _, port = server.url.rpartition("//")[2].partition(":")
    with Recorder((host, int(port))) as recorder:
        threading.Thread(target=recorder.serve_forever, daemon=True).start()
        names = os.environ | {"server": f"http://{recorder.address}", "key": KEY, "job": job or ""}
        done = subprocess.run(["bash", "-euc", command], env=names, capture_output=True, timeout=STEP_S)
        recorder.shutdown()
    assert done.returncode == 0, done.stderr
    return recorder.asked.decode(), recorder.answered.decode()


@pytest.mark.skipif(shutil.which("curl") is None, reason="curl is not installed: apt-get install curl")
def test_each_request_and_answer(server):
    job, seen = None, set()
    for command, request, answer in exchanges(PAGE.read_text()):
        if "POST" in request and "cancel" not in request:
            job = None  # another begins
        asked, answered = typed(command, server, job)
        job = assert_same(answer, answered, assert_same(request, asked, job))
        seen.add(answer.split()[1])
    assert seen == {"200", "202", "401", "422"}


def test_what_varies_is_named():
    text = PAGE.read_text()
    named = re.findall(r"^\| `<([A-Z-]+)>` \|", text, re.M)
    assert sorted(named) == sorted(VARYING)
    messages = "".join(request + answer for _, request, answer in exchanges(text))
    assert set(re.findall(r"<([A-Z-]+)>", messages)) == set(VARYING)


@pytest.mark.parametrize(
    ("said", "was"),
    [
        ("HTTP/1.1 200 OK\r\n\r\n", "HTTP/1.1 202 Accepted\r\n\r\n"),
        ("A: <JOB>\r\n\r\n<JOB>", f"A: {'0' * 32}\r\n\r\n{'1' * 32}"),
        ("A: b\r\ncontent-length: <N>\r\n\r\n1.00000000001", "A: b\r\ncontent-length: 13\r\n\r\n1.00000002001"),
        ("A: b\r\ncontent-length: <N>\r\n\r\n12", "A: b\r\ncontent-length: 3\r\n\r\n12"),
    ],
)
def test_what_differs_is_seen(said, was):
    with pytest.raises(AssertionError):
        assert_same(said, was, None)
