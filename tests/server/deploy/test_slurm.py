"""Workers as jobs of a real Slurm, which come for work, go without, and are lost in the middle of it."""

import asyncio
import os
import signal
import subprocess
import sys
from contextlib import contextmanager

import pytest
from distributed import Client
from wsrender_server.jobs.worker import security
from wsrender_server.local_server import LocalServer
from wsrender_server.settings import Settings

import wsrender as ws
from tests.server.conftest import free_port, wait_for_port
from tests.server.deploy.conftest import RECIPES, require
from tests.server.deploy.slurm import PROGRAMS, Slurm
from tests.server.end_to_end.acceptance import QUICK
from tests.server.jobs.waiting import PATIENCE_S, comparable, local_document, wait_until

SHARD = 1 << 20
LONG = {**QUICK, "sampling": {"method": "sobol", "count": 100 * SHARD}}


@pytest.fixture
def slurm(tmp_path):
    require(*PROGRAMS)
    if os.geteuid() != 0:
        pytest.skip("only root may start slurmd")
    with Slurm(tmp_path / "slurm") as slurm:
        yield slurm


@pytest.fixture
def certificates(tmp_path):
    """A cluster's certificates, as settings."""
    folder = tmp_path / "certificates"
    subprocess.run([RECIPES / "certificates.sh", folder], check=True)
    return {f"tls_{name}_file": folder / f"{name}.pem" for name in ("ca", "cert", "key")}


@contextmanager
def running(command, folder, environment, port):
    """A process for as long as a block lasts, once it answers on a port."""
    with (folder / "log").open("w") as log:
        process = subprocess.Popen(list(map(str, command)), stdout=log, stderr=log, cwd=folder, env=environment)
    try:
        wait_for_port(port, process, 120)
        yield
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) in (0, -signal.SIGTERM), (folder / "log").read_text()
    finally:
        process.kill()
        process.wait()


def test_workers_come_for_what_is_queued_and_go(slurm, certificates, tmp_path, monkeypatch):
    pytest.importorskip("dask_jobqueue")
    monkeypatch.setenv("WSRENDER_SHARD_SAMPLES", str(SHARD))
    port, data = free_port(), tmp_path / "data"
    command = [sys.executable, RECIPES / "slurm" / "cluster.py", "--certificates", tmp_path / "certificates"]
    command += ["--data-dir", data, "--interface", "lo", "--port", port, "--maximum", 2, "--cores", 1]
    command += ["--memory", "1GiB", "--time", "00:10:00", "--directive=--nice=1"]
    options = [part for name, file in certificates.items() for part in (f"--{name.replace('_', '-')}", str(file))]
    with (
        running(command, tmp_path, slurm.environment, port),
        LocalServer(data, ["--scheduler", f"tls://127.0.0.1:{port}", *options]) as server,
        ws.Client(server.url) as client,
    ):
        assert client.workers() == []
        assert slurm.jobs() == []
        for seed in range(4):  # small ones, so that one worker is not enough from the first moment
            client.submit({**QUICK, "sampling": {"method": "random", "count": 1024, "seed": seed}})
        job = client.submit(LONG)
        wait_until(lambda: job.refresh().progress["samples_done"], what="samples")
        wait_until(lambda: sum(worker["busy"] for worker in client.workers()) == 2, what="two busy workers")
        slurm.run("scancel", slurm.jobs()[0])
        assert not job.refresh().finished
        document = job.wait(timeout=PATIENCE_S).result().document
        assert comparable(document) == local_document(LONG, tmp_path / "local")
        wait_until(lambda: slurm.jobs() == [], what="the end of idle workers")
        assert client.workers() == []


def test_a_worker_is_called_after_its_job(slurm, certificates, tmp_path):
    port = free_port()
    files = dict(zip(("--tls-ca-file", "--tls-cert", "--tls-key"), certificates.values(), strict=True))
    command = [sys.executable, "-m", "dask", "scheduler", "--host", "127.0.0.1", "--protocol", "tls", "--port", port]
    command += ["--dashboard-address", "127.0.0.1:0", *(part for option in files.items() for part in option)]
    slurm.environment |= {f"WSRENDER_{name.upper()}": str(file) for name, file in certificates.items()}
    slurm.environment["WSRENDER_DATA_DIR"] = str(tmp_path / "data")
    address = f"tls://127.0.0.1:{port}"

    async def names():
        settings = Settings(data_dir=tmp_path / "data", scheduler=address, **certificates)
        async with Client(address, security=security(settings), asynchronous=True) as client:
            return [info["name"] for info in (await client.scheduler.identity(n_workers=-1))["workers"].values()]

    with running(command, tmp_path, slurm.environment, port):
        worker = RECIPES / "slurm" / "worker.sbatch"
        output = f"--output={tmp_path / 'worker.log'}"
        slurm.run("sbatch", "--cpus-per-task=1", "--mem=1G", output, str(worker), address)
        (job,) = slurm.jobs()
        assert wait_until(lambda: asyncio.run(names()), what="the worker") == [f"slurm-{job}"]
        slurm.run("scancel", job)
        wait_until(lambda: asyncio.run(names()) == [], what="the end of the worker")
