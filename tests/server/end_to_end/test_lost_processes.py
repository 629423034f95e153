"""Processes killed in mid-job: after a restart the job finishes with the same bits."""

import os
import time
from pathlib import Path
from threading import Thread

import pytest
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.server.end_to_end.acceptance import LONG, PATIENCE_S, assert_same_result
from tests.server.jobs.waiting import partial_times

pytestmark = pytest.mark.usefixtures("small_shards")


def wait_for_partials(data_dir: Path, count: int) -> dict[str, int]:
    """Wait until there are so many."""
    end = time.monotonic() + PATIENCE_S
    while len(found := partial_times(data_dir)) < count:
        assert time.monotonic() < end
        time.sleep(0.02)
    return found


@pytest.fixture
def server(tmp_path):
    with LocalServer(tmp_path / "data") as server:
        yield server


@pytest.mark.parametrize("kill", ["api", "everything"])
def test_server_killed_in_mid_job(server, long_local, kill):
    with ws.Client(server.url) as client:
        job = client.submit(LONG)
        before = wait_for_partials(server.data_dir, 3)
        if kill == "api":
            os.kill(server.process.pid, 9)
            server.process.wait()
        else:
            server.kill_all()
        waiting = Thread(target=job.wait, kwargs={"timeout": PATIENCE_S})  # through the time without a server
        waiting.start()
        server.start()
        again = set()
        while waiting.is_alive():
            now = partial_times(server.data_dir)
            again |= {name for name in before.keys() & now.keys() if now[name] != before[name]}
            waiting.join(0.05)
        assert job.state == "succeeded"
        assert again == set()  # only shards in flight were run again
        assert_same_result(job.result(), long_local)


def test_stopped_server_takes_its_jobs_up_again(server, long_local):
    with ws.Client(server.url) as client:
        job = client.submit(LONG)
        wait_for_partials(server.data_dir, 2)
        assert server.stop() == 0
        server.start()
        assert_same_result(job.wait(timeout=PATIENCE_S).result(), long_local)
