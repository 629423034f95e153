"""Distributed mode for real: PostgreSQL, a Dask scheduler, two workers, mutual TLS on loopback."""

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from distributed import Security
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.server.conftest import empty
from tests.server.end_to_end.acceptance import LONG, PATIENCE_S, QUICK, assert_same_result

STOP_S = 2.0


@pytest.fixture(scope="module")
def certificates(tmp_path_factory):
    """Options that name a certificate authority, a certificate and a key."""
    folder = tmp_path_factory.mktemp("tls")
    made = Security.temporary()
    texts = {"ca-file": made.tls_ca_file, "cert-file": made.tls_worker_cert, "key-file": made.tls_worker_key}
    for name, text in texts.items():
        (folder / name).write_text(text)
    return {name: str(folder / name) for name in texts}


@pytest.fixture(scope="module")
def scheduler(certificates, tmp_path_factory):
    """Address of a Dask scheduler, started as the systemd unit starts it."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    arguments = ["--protocol", "tls", "--host", "127.0.0.1", "--port", str(port), "--dashboard-address", "127.0.0.1:0"]
    arguments += ["--tls-ca-file", certificates["ca-file"], "--tls-cert", certificates["cert-file"]]
    arguments += ["--tls-key", certificates["key-file"]]
    with started([sys.executable, "-m", "dask", "scheduler", *arguments], tmp_path_factory.mktemp("scheduler")):
        wait_for_port(port)
        yield f"tls://127.0.0.1:{port}"


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    return tmp_path_factory.mktemp("data")


@pytest.fixture(scope="module")
def options(certificates, scheduler, data):
    """Options that server and workers share, and an environment of many small shards."""
    tls = [part for name, path in certificates.items() for part in (f"--tls-{name}", path)]
    return ["--scheduler", scheduler, *tls]


@pytest.fixture(scope="module")
def workers(options, data, tmp_path_factory):
    command = [sys.executable, "-m", "wsrender", "worker", "--data-dir", str(data), *options]
    with started(command, tmp_path_factory.mktemp("a")) as a, started(command, tmp_path_factory.mktemp("b")) as b:
        yield [a, b]


@pytest.fixture(scope="module")
def server(options, data, postgres_url, workers):
    empty(postgres_url)  # other tests have left a store, of another folder
    upgrade = ["database", "upgrade", "--database", postgres_url]
    subprocess.run([sys.executable, "-m", "wsrender", *upgrade], check=True, cwd=data)
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("WSRENDER_SHARD_SAMPLES", str(2**18))
        with LocalServer(data, [*options, "--database", postgres_url]) as server:
            yield server


class started:  # noqa: N801
    """A process for as long as a block lasts; its output goes to a file."""

    def __init__(self, command: list[str], folder: Path):
        with (folder / "log").open("w") as log:
            environment = {**os.environ, "WSRENDER_SHARD_SAMPLES": str(2**18), "PYTHONUNBUFFERED": "1"}
            self.process = subprocess.Popen(command, stdout=log, stderr=log, cwd=folder, env=environment)

    def __enter__(self) -> subprocess.Popen:
        return self.process

    def __exit__(self, *_: object) -> None:
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


def wait_for_port(port: int) -> None:
    end = time.monotonic() + 60
    while True:
        try:
            socket.create_connection(("127.0.0.1", port), timeout=1).close()
            return
        except OSError:
            assert time.monotonic() < end
            time.sleep(0.1)


def wait_for_workers(client: ws.Client, count: int) -> None:
    end = time.monotonic() + PATIENCE_S
    while len(client.workers()) != count:
        assert time.monotonic() < end
        time.sleep(0.2)


def within_s() -> float:
    """How long a stop may take by now [s]."""
    return STOP_S * max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))


def busy(client: ws.Client) -> int:
    """How many workers compute."""
    return sum(worker["busy"] for worker in client.workers())


def test_results_are_those_of_a_local_run(server, quick_local, long_local):
    with ws.Client(server.url) as client:
        wait_for_workers(client, 2)
        jobs = [client.submit(document) for document in (QUICK, LONG)]
        for job, local in zip(jobs, (quick_local[0], long_local), strict=True):
            assert_same_result(job.wait(timeout=PATIENCE_S).result(), local)


@pytest.mark.parametrize(
    ("line", "computes", "number"),
    [
        ("Start worker at", False, signal.SIGTERM),
        ("worker joined", False, signal.SIGINT),
        ("worker joined", True, signal.SIGTERM),
    ],
)
def test_a_worker_stops_within_2_s_whatever_it_does(server, options, data, tmp_path, line, computes, number):
    """While it starts, once it has joined, while it computes; on a busy machine as much longer as others get of it."""
    command = [sys.executable, "-m", "wsrender", "worker", "--data-dir", str(data), *options]
    endless = LONG | {"sampling": LONG["sampling"] | {"count": 10**10}}
    seconds = []
    with ws.Client(server.url) as client:
        job = client.submit(endless) if computes else None
        while len(seconds) < 3 and min(seconds, default=PATIENCE_S) > within_s():
            (tmp_path / "log").write_text("")
            with started(command, tmp_path) as worker:
                end = time.monotonic() + PATIENCE_S
                while line not in (tmp_path / "log").read_text() or (computes and busy(client) < 3):
                    assert worker.poll() is None and time.monotonic() < end
                    time.sleep(0.05)
                family = [psutil.Process(worker.pid), *psutil.Process(worker.pid).children(recursive=True)]
                began = time.monotonic()
                worker.send_signal(number)
                assert worker.wait(20) == 0
                assert psutil.wait_procs(family, timeout=20)[1] == []
                seconds.append(time.monotonic() - began)
        if job is not None:
            job.cancel()
    assert min(seconds) <= within_s(), seconds


def test_strangers_without_a_certificate_are_turned_away(server, scheduler):
    from distributed import Client

    stranger = Security.temporary()
    with pytest.raises(OSError):
        Client(scheduler, security=stranger, timeout=5, set_as_default=False)


def test_worker_killed_in_mid_job(server, workers):
    """The other worker finishes the job; the same bits as with both."""
    document = {**LONG, "sampling": {**LONG["sampling"], "count": 20 * 2**18}}
    local = ws.execute(document)
    with ws.Client(server.url) as client:
        job = client.submit(document)
        while job.refresh().progress["samples_done"] == 0:
            assert not job.finished
            time.sleep(0.05)
        workers[0].kill()
        result = job.wait(timeout=PATIENCE_S).result()
        for statistic, by_index in local.volume.statistics.items():
            for index, values in by_index.items():
                assert values.tobytes() == result.volume.statistics[statistic][index].tobytes()
        assert local.volume.count.tobytes() == result.volume.count.tobytes()
