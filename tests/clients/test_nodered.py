"""The flow of Node-RED, on Node-RED as npm has it: a job at start and jobs by HTTP, with and without a key."""

import os
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

import httpx2
import numpy as np
import pytest
from wsrender_server.local_server import LocalServer

import wsrender as ws

HERE = Path(__file__).parent.parent.parent / "clients" / "nodered"
STEP_S = 120
KEY = "a-secret-of-the-lab-0123456789"
CONFIGURATION = [0, -1.5, 1.5, 0, 1, 0]
JOB = {"analysis": "indices_at", "robot": {"library": "ur5e"}, "configurations": [CONFIGURATION]}

pytestmark = pytest.mark.skipif(
    shutil.which("npm") is None, reason="npm is not installed: pip install wsrender[test-clients]"
)


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("nodered")
    shutil.copytree(HERE, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("node_modules"))
    command = ["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--cache", str(folder / "cache")]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=STEP_S)
    assert done.returncode == 0, done.stderr
    return folder


class NodeRed:
    """Node-RED with the flow, asking a server; what it says goes to a file."""

    def __init__(self, folder, url, key):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.log = folder / f"log{self.port}"
        self.command = ["npm", "start", "--", "--port", str(self.port)]
        self.settings = {"cwd": folder, "env": os.environ | {"WSRENDER_SERVER": url, "WSRENDER_TOKEN": key}}

    def __enter__(self):
        with self.log.open("w") as log:
            self.process = subprocess.Popen(
                self.command, stdout=log, stderr=log, start_new_session=True, **self.settings
            )
        self.said("Started flows")
        return self

    def __exit__(self, *_):
        os.killpg(self.process.pid, signal.SIGTERM)
        self.process.wait(STEP_S)

    def said(self, words):
        """The log, once it has the words."""
        end = time.monotonic() + STEP_S
        while words not in (text := self.log.read_text()):
            assert time.monotonic() < end and self.process.poll() is None, text
            time.sleep(0.1)
        return text

    def post(self, job):
        return httpx2.post(f"http://127.0.0.1:{self.port}/jobs", json=job, timeout=STEP_S)


@pytest.mark.parametrize("key", ["", KEY])
def test_walk(key, installed, tmp_path):
    (tmp_path / "keys").write_text(f"{KEY} lab read,submit\n")
    (tmp_path / "keys").chmod(0o600)
    options = ("--api-key-file", str(tmp_path / "keys")) if key else ()
    with LocalServer(tmp_path / "data", options) as server, NodeRed(installed, server.url, key) as flow:
        assert "analysis: 'indices_at'" in flow.said("provenance")
        answer = flow.post({**JOB, "indices": "manipulability"})
        refused = flow.post({"analysis": "workspace"})
        failed = flow.post({**JOB, "robot": {"model": "0" * 64}})
        log = flow.log.read_text()
    assert answer.status_code == 200, answer.text
    expected = ws.evaluate_indices(ws.load_robot("ur5e"), CONFIGURATION, ["manipulability"])["manipulability"]
    np.testing.assert_allclose(answer.json()["indices"]["manipulability"]["maximum"], np.ravel(expected)[0], rtol=1e-12)
    assert (refused.status_code, refused.json()["errors"][0]["pointer"]) == (502, "#/robot")
    assert failed.status_code == 502 and failed.json()["code"], failed.text
    assert KEY not in log + str([(each.headers.raw, each.text) for each in (answer, refused, failed)])


def test_wrong_key_and_no_server(installed, tmp_path):
    (tmp_path / "keys").write_text(f"{KEY} lab read,submit\n")
    (tmp_path / "keys").chmod(0o600)
    with (
        LocalServer(tmp_path / "data", ("--api-key-file", str(tmp_path / "keys"))) as server,
        NodeRed(installed, server.url, "another-secret-9876543210") as flow,
    ):
        wrong = flow.post(JOB)
        server.stop()
        gone = flow.post(JOB)
    assert (wrong.status_code, wrong.json()["code"]) == (502, "unauthorized")
    assert gone.status_code == 502 and "ECONNREFUSED" in gone.text
