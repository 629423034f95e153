"""The MATLAB class under GNU Octave: its walk against a server, with a key, without and with a wrong one."""

import http.server
import os
import re
import shutil
import socketserver
import subprocess
import threading
from pathlib import Path

import numpy as np
import pytest
from wsrender_server.local_server import LocalServer

import wsrender as ws

HERE = Path(__file__).parent.parent.parent / "clients" / "matlab"
STEP_S = 200
PRINTED = 1e-8  # nine digits are
SECRET = "a-secret-of-the-lab-0123456789"


pytestmark = pytest.mark.skipif(
    shutil.which("octave-cli") is None, reason="GNU Octave is not installed: apt-get install octave"
)


@pytest.fixture
def asking_for_a_key(tmp_path):
    keys = tmp_path / "keys"
    keys.write_text(f"{SECRET} lab read,submit\n")
    keys.chmod(0o600)
    return ("--api-key-file", str(keys))


def walk(url, key):
    asked = os.environ | {"WSRENDER_SERVER": url, "WSRENDER_TOKEN": key}
    command = ["octave-cli", "--quiet", "--norc", "walk.m"]
    return subprocess.run(command, cwd=HERE, env=asked, capture_output=True, text=True, timeout=STEP_S)


@pytest.mark.parametrize("key", ["", SECRET])
def test_walk(key, asking_for_a_key, tmp_path):
    with LocalServer(tmp_path / "data", asking_for_a_key if key else ()) as server:
        done = walk(server.url, key)
        assert done.returncode == 0, done.stdout + done.stderr
        told = dict(line.split(": ", 1) for line in done.stdout.splitlines())
        with ws.Client(server.url, key or None) as client:
            jobs = {job.record["analysis"]: job for job in client.jobs(state="succeeded")}
            values, workspace = (jobs[name].result() for name in ("indices_at", "workspace"))
    expected = ws.evaluate_indices(ws.load_robot("ur5e"), [0, -1.5, 1.5, 0, 1, 0], ["manipulability"])
    np.testing.assert_allclose(float(told["indices_at"]), np.ravel(expected["manipulability"])[0], rtol=PRINTED)
    np.testing.assert_allclose(float(told["workspace"]), workspace.document["headline"]["value"], rtol=PRINTED)
    assert values.document["analysis"] == "indices_at"
    written = {record["name"] for record in workspace.document["artifacts"]}
    assert set(told["files"].split()) == {"result.json"} | written
    rows, columns = map(int, re.fullmatch(r"(\d+) x (\d+)", told["voxels"]).groups())
    assert rows > 100 and columns > 3
    assert told["refused"] == "wsrender:invalid_document"
    assert told["stopped"] == "wsrender:canceled"


def test_wrong_key(asking_for_a_key, tmp_path):
    with LocalServer(tmp_path / "data", asking_for_a_key) as server:
        done = walk(server.url, "not-" + SECRET)
    assert done.returncode != 0
    assert "API key" in done.stderr and not done.stdout
    assert SECRET not in done.stderr


def test_no_server_and_a_proxy_that_answers(tmp_path):
    with socketserver.TCPServer(("127.0.0.1", 0), Proxy) as proxy:
        threading.Thread(target=proxy.serve_forever, daemon=True).start()
        url = f"http://127.0.0.1:{proxy.server_address[1]}"
        done = walk(url, "")
        proxy.shutdown()
    assert done.returncode != 0 and "HTTP status 502: <html>no gateway</html>" in done.stderr
    done = walk(url, "")
    assert done.returncode != 0 and f"no server answers at {url}" in done.stderr


class Proxy(http.server.BaseHTTPRequestHandler):
    """Answers as one whose server is gone does."""

    def do_POST(self):
        """502 with a page."""
        body = b"<html>no gateway</html>"
        self.send_response(502)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format, *arguments):
        """Say nothing."""
