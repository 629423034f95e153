"""The server's commands, as an administrator types them."""

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time

import httpx2
import psutil
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.server.end_to_end.acceptance import PATIENCE_S, QUICK
from tests.server.jobs.waiting import within


def wsrender(*arguments, **environment):
    """Run the command line in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "wsrender", *arguments],
        capture_output=True,
        text=True,
        timeout=300,
        env={**os.environ, **environment},
    )


def test_another_event_loop_that_is_installed_is_not_taken(tmp_path, monkeypatch):
    """With uvloop, which other packages bring along, a stream of forces never opened."""
    (tmp_path / "uvloop.py").write_text("raise SystemExit('uvloop was taken')")
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}{os.pathsep}{os.environ.get('PYTHONPATH', '')}")
    with LocalServer(tmp_path / "data") as server, ws.Client(server.url) as client:
        assert list(client.jobs()) == []
    assert "uvloop" not in server.log.read_text()


def test_keys_guard_the_server(tmp_path):
    data = ("--data-dir", str(tmp_path / "data"))
    made = wsrender("keys", "create", "--name", "ann", *data)
    secret = made.stdout.strip()
    followed = wsrender("keys", "create", "--name", "cid", *data).stdout.strip()
    reader = wsrender("keys", "create", "--name", "bob", "--scope", "read", *data).stdout.strip()
    listed = wsrender("keys", "list", *data).stdout
    assert (made.returncode, "ann" in listed, secret in listed) == (0, True, False)
    with LocalServer(tmp_path / "data") as server:
        with ws.Client(server.url) as client, pytest.raises(ws.AccessError):
            list(client.jobs())
        with ws.Client(server.url, token=reader) as client, pytest.raises(ws.AccessError, match="submit"):
            client.submit({"analysis": "workspace", "robot": "scara"})
        with ws.Client(server.url, token=secret) as client:
            assert list(client.jobs()) == []
            key_id = re.search(r"[0-9a-f]{16}", listed)[0]
            assert wsrender("keys", "revoke", key_id, *data).returncode == 0
            with pytest.raises(ws.AccessError, match="revoked"):
                list(client.jobs())
        assert_streams_end_with_their_key(server, followed, lambda: wsrender("keys", "revoke", followed[4:20], *data))


def assert_streams_end_with_their_key(server, secret, revoke):
    """Events of a job, a live stream and a view session."""
    key, host = {"Authorization": f"Bearer {secret}"}, server.url.removeprefix("http://")
    long = QUICK | {"sampling": {"method": "sobol", "count": 10**10}}
    job = httpx2.post(f"{server.url}/v1/jobs", json=long, headers=key, timeout=60).json()
    with (
        httpx2.stream("GET", server.url + job["links"]["events"], headers=key, timeout=60) as events,
        connect(f"ws://{host}/v1/kinetostatic-stream", additional_headers=key) as forces,
        connect(f"ws://{host}/v1/robots/ur5e/view/session", additional_headers=key) as view,
    ):
        forces.send('{"type": "open", "robot": "phantom_omni"}')
        assert json.loads(forces.recv(60))["type"] == "opened"
        lines = events.iter_lines()
        while "running" not in next(lines):
            pass
        time.sleep(2)  # all of them are looked at more than once
        assert revoke().returncode == 0
        with within(10):
            assert "data: succeeded" not in list(lines)
            for socket in (forces, view):
                with pytest.raises(ConnectionClosed) as closed:
                    while "revoked" not in str(socket.recv(60)):
                        pass
                    socket.recv(60)
                assert closed.value.rcvd.code == 1008


def test_other_addresses_need_a_key(tmp_path):
    refused = wsrender("serve", "--host", "0.0.0.0", "--port", "0", "--data-dir", str(tmp_path))
    assert refused.returncode == 2
    assert refused.stderr.splitlines()[-1].startswith("error: host: 0.0.0.0 can be reached from other machines")


def test_taken_port(tmp_path):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        refused = wsrender("serve", "--port", port, "--data-dir", str(tmp_path))
    assert (refused.returncode, refused.stdout) == (1, "")
    assert refused.stderr == f"error: cannot listen on 127.0.0.1:{port}: Address already in use\n"


def test_wrong_settings_are_one_line(tmp_path):
    wrong = wsrender("serve", "--scheduler", "tcp://lab:8786", "--data-dir", str(tmp_path))
    assert wrong.returncode == 2
    assert wrong.stderr == "error: settings: scheduler must be a tls:// address, not 'tcp://lab:8786'\n"
    wrong = wsrender("serve", "--port", "70000")
    assert (wrong.returncode, wrong.stderr.count("\n")) == (2, 1)
    wrong = wsrender("worker", "--gpus", "all")
    assert (wrong.returncode, wrong.stderr) == (2, "error: --scheduler: must be given, such as tls://lab:8786\n")


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signals_stop_the_server_and_all_of_its_processes(tmp_path, number):
    server = LocalServer(tmp_path / "data").start()
    with ws.Client(server.url) as client:
        client.submit(QUICK).wait(timeout=PATIENCE_S)
        job = client.submit(QUICK | {"sampling": {"method": "sobol", "count": 10**10}})  # minutes
    family = [psutil.Process(server.process.pid), *psutil.Process(server.process.pid).children(recursive=True)]
    assert len(family) > 2
    with httpx2.stream("GET", f"{server.url}/v1/jobs/{job.id}/events", timeout=60) as events:
        lines = events.iter_lines()
        while "running" not in next(lines):
            pass
        server.process.send_signal(number)
        assert "succeeded" not in "".join(lines)  # to its end, which is in order
    assert server.process.wait(timeout=60) == 0
    _, alive = psutil.wait_procs(family, timeout=60)
    assert alive == []
    assert "Traceback" not in server.log.read_text()
    everything = [server.data_dir, *server.data_dir.rglob("*")]
    assert {path.stat().st_mode & 0o777 for path in everything} == {0o700, 0o600}
    assert any("results" in path.parts for path in everything if path.is_file())


def test_two_servers_do_not_share_a_data_folder(tmp_path):
    with LocalServer(tmp_path / "data"):
        second = wsrender("serve", "--port", "0", "--data-dir", str(tmp_path / "data"))
        assert second.returncode == 2
        assert "Traceback" not in second.stderr
        assert second.stderr.splitlines()[-1].endswith("is in use by another server")


def test_demo_leaves_map_volume_and_pictures(tmp_path):
    done = wsrender("demo", "-o", str(tmp_path / "demo"), "--robot", "scara")
    assert done.returncode == 0, done.stderr
    result = ws.Result.load(tmp_path / "demo")
    assert len(result.map) == result.document["sampling"]["samples"] == 2**20
    assert result.volume.count.sum() == 2**20
    assert {"robot.png", "scatter.png", "slices.png"} <= {path.name for path in (tmp_path / "demo/plots").iterdir()}
    assert str(tmp_path / "demo" / "volume.vtkhdf") in done.stdout
