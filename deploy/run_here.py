"""Runs the commands of a recipe on this machine, outside systemd and containers, and a job through them.

    python deploy/run_here.py systemd [--database URL]
    python deploy/run_here.py compose --database postgresql+psycopg://…      (needs docker-compose, not Docker)
    python deploy/run_here.py kubernetes --database postgresql+psycopg://…

Programs, arguments, environment, umask and order are read from the recipe; folders, ports and the database are others.
The database must be empty.
"""

import argparse
import ctypes
import json
import os
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import yaml

import wsrender as ws

HERE = Path(__file__).parent
PATIENCE_S = 120.0  # until a process answers; machines are shared
OURS = ("PATH", "WARP_CACHE_PATH")  # programs, and kernels that have been compiled
PR_SET_MDWE, PR_MDWE_REFUSE_EXEC_GAIN = 65, 1  # Linux 6.3
JOB = {
    "analysis": "workspace",
    "robot": {"library": "ur5e"},
    "sampling": {"method": "sobol", "count": 4096},
    "voxel_size_m": 0.1,
    "device": "cpu",
}


@dataclass(frozen=True)
class Process:
    """A process of a recipe, in the recipe's own words."""

    name: str
    command: list[str]
    environment: dict[str, str]
    replicas: int = 1
    ends: bool = False  # before the next one starts
    umask: int = 0o022
    deny_write_execute: bool = False
    stop_s: float = 30.0


def of_systemd(folder: Path = HERE / "systemd") -> list[Process]:
    """The units, with the files of settings that README.md tells of."""
    tls = {f"WSRENDER_TLS_{kind}_FILE": f"/etc/wsrender/{kind.lower()}.pem" for kind in ("CA", "CERT", "KEY")}
    settings = {"WSRENDER_SCHEDULER": "tls://localhost:8786"}
    files = {"wsrender-scheduler": {}, "wsrender": {**settings, **tls}, "wsrender-worker": settings}
    common = _directives(folder / "hardening.conf")
    processes = []
    for unit, more in files.items():
        directives = [*_directives(folder / f"{unit}.service"), *common]
        last = dict(directives)
        environment = dict(value.split("=", 1) for key, value in directives if key == "Environment")
        command = shlex.split(last["ExecStart"].removeprefix("/opt/wsrender/bin/"))
        if command[-2:] == ["--gpus", "all"] and shutil.which("nvidia-smi") is None:
            command = command[:-2]  # as the unit says
        process = Process(
            unit,
            command,
            environment | more,
            umask=int(last.get("UMask", "022"), 8),
            deny_write_execute=last.get("MemoryDenyWriteExecute") == "yes",
            stop_s=float(last.get("TimeoutStopSec", 90)),
        )
        processes.append(process)
    return processes


def of_compose(files: tuple[Path, ...] = (HERE / "compose.yaml",)) -> list[Process]:
    """The services of our image, each after those that it depends on. Raises ValueError where Compose finds a fault."""
    options = [part for file in files for part in ("-f", str(file))]
    command = ["docker-compose", *options, "config", "--format", "json"]
    environment = {**os.environ, "POSTGRES_PASSWORD": "secret"}
    found = subprocess.run(command, capture_output=True, text=True, env=environment)
    if found.returncode or not found.stdout:
        raise ValueError(found.stderr)
    services: dict[str, Any] = {
        k: v for k, v in json.loads(found.stdout)["services"].items() if v["image"] == "wsrender"
    }
    processes: dict[str, Process] = {}
    while len(processes) < len(services):
        name, service = next(
            (name, service)
            for name, service in services.items()
            if name not in processes and set(service.get("depends_on", ())) & set(services) <= set(processes)
        )
        processes[name] = Process(
            name,
            service["command"],
            _image_environment() | service.get("environment", {}),
            service.get("scale", 1),
            ends=service["restart"] == "no",
            stop_s=float(service["stop_grace_period"].removesuffix("s")),
        )
    return list(processes.values())


def of_kubernetes(file: Path = HERE / "kubernetes.yaml") -> list[Process]:
    """The containers, a pod's initial ones first. A secret's value is its name in braces; any resource is 1."""
    documents = list(yaml.safe_load_all(file.read_text()))
    maps = {d["metadata"]["name"]: d["data"] for d in documents if d["kind"] == "ConfigMap"}
    processes = []
    for deployment in (d for d in documents if d["kind"] == "Deployment"):
        pod = deployment["spec"]["template"]["spec"]
        for container in [*pod.get("initContainers", ()), *pod["containers"]]:
            environment = _image_environment()
            for source in container.get("envFrom", ()):
                environment |= maps[source["configMapRef"]["name"]]
            environment |= {entry["name"]: _value_of(entry) for entry in container.get("env", ())}
            process = Process(
                container["name"],
                container["command"],
                environment,
                deployment["spec"].get("replicas", 1),
                ends=container in pod.get("initContainers", ()),
                stop_s=pod.get("terminationGracePeriodSeconds", 30),
            )
            processes.append(process)
    return processes


def run(processes: list[Process], folder: Path, database: str | None = None) -> None:
    """Start the processes, do a job through them, and stop them. Raises AssertionError where something is not as told.

    ``folder`` must be empty; what the processes print goes to files in it.
    """
    certificates, data, port, server_port = folder / "certificates", folder / "data", _free_port(), _free_port()
    subprocess.run([HERE / "certificates.sh", certificates], check=True)
    (certificates / "keys").write_text("a-secret-of-the-key-file check\n")
    here = {
        "/run/secrets/wsrender-keys": certificates,
        "/run/secrets/wsrender": certificates,
        "/run/secrets": certificates,
        "/etc/wsrender": certificates,
        "/var/lib/wsrender": data,
        "/tmp/": f"{folder}/",
        "/data": data,
        "wsrender-scheduler:": "127.0.0.1:",
        "scheduler:": "127.0.0.1:",
        "8786": port,
        "postgresql+psycopg://wsrender@database/wsrender": database,
        "{wsrender-database}": database,
    }
    with ExitStack() as stack:
        for process in processes:
            theirs = {key: _here(value, here) for key, value in process.environment.items() if key not in OURS}
            environment = {**os.environ, "WSRENDER_PORT": str(server_port), **theirs}
            if database is not None and process.name == "wsrender":  # the unit's settings are the administrator's
                environment["WSRENDER_DATABASE"] = database
                _end([sys.executable, "-m", "wsrender", "database", "upgrade"], environment)
            command = [sys.executable, "-m", *(_here(part, here) for part in process.command)]
            if process.ends:
                _end(command, environment)
                continue
            if "serve" in command:
                key = _end([*command[:3], "keys", "create", "--name", "check"], environment).split()[-1]
                host = environment.get("WSRENDER_HOST", "127.0.0.1")
            for replica in range(process.replicas):
                log = folder / f"{process.name}.{replica}.log"
                stack.enter_context(_running(process, command, environment, log))
        workers = sum(process.replicas for process in processes if "worker" in process.command)
        url = f"http://127.0.0.1:{server_port}"
        _wait(lambda: _answers(server_port), "the server")
        assert _refuses_strangers(url), f"the server on {host} wants no key"
        with ws.Client(url, token=key) as client:
            _wait(lambda: len(client.workers()) == workers, f"{workers} workers")
            volume = client.submit(JOB).wait(timeout=PATIENCE_S).result().document["volume_m3"]
        assert volume == ws.execute(JOB).document["volume_m3"]


def _directives(file: Path) -> list[tuple[str, str]]:
    text = file.read_text().replace("\\\n", " ")
    return [(key, value.strip()) for key, value in re.findall(r"^(\w+)=(.*)$", text, re.MULTILINE)]


def _image_environment() -> dict[str, str]:
    (line,) = re.findall(r"^ENV (.*)$", (HERE / "Dockerfile").read_text(), re.MULTILINE)
    return dict(part.split("=", 1) for part in shlex.split(line))


def _value_of(entry: Mapping[str, Any]) -> str:
    if "value" in entry:
        return entry["value"]
    secret = entry["valueFrom"].get("secretKeyRef")
    return "1" if secret is None else f"{{{secret['name']}}}"


def _here(text: str, here: Mapping[str, Any]) -> str:
    return re.sub("|".join(map(re.escape, here)), lambda found: str(here[found[0]]), text)


def _end(command: list[str], environment: dict[str, str]) -> str:
    ended = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=PATIENCE_S)
    assert ended.returncode == 0, f"{shlex.join(command)}: {ended.stderr}"
    return ended.stdout


@contextmanager
def _running(process: Process, command: list[str], environment: dict[str, str], log: Path) -> Iterator[None]:
    """A process for as long as a block lasts; stopped as its recipe stops it, it must end by itself, in time."""
    with log.open("w") as out:
        running = subprocess.Popen(
            command,
            env=environment,
            cwd=log.parent,
            stdout=out,
            stderr=out,
            start_new_session=True,
            preexec_fn=partial(_confine, process),
        )
    try:
        yield
        assert running.poll() is None, f"{process.name} has ended: {log.read_text()[-2000:]}"
        running.send_signal(signal.SIGTERM)
        code = running.wait(process.stop_s)
        assert code in (0, -signal.SIGTERM), f"{process.name} ended with {code}: {log.read_text()[-2000:]}"
    finally:
        if running.poll() is None:
            os.killpg(running.pid, signal.SIGKILL)
            running.wait()


def _confine(process: Process) -> None:
    os.umask(process.umask)
    if process.deny_write_execute:
        ctypes.CDLL(None).prctl(PR_SET_MDWE, PR_MDWE_REFUSE_EXEC_GAIN, 0, 0, 0)


def _free_port() -> int:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


def _answers(port: int) -> bool:
    with socket.socket() as client:
        return client.connect_ex(("127.0.0.1", port)) == 0


def _refuses_strangers(url: str) -> bool:
    try:
        with ws.Client(url) as stranger:
            stranger.workers()
    except ws.WsrenderError as error:
        return "key" in str(error)
    return False


def _wait(condition: Any, what: str) -> None:
    ends = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < ends, f"{what} did not come in {PATIENCE_S:g} s"
        time.sleep(0.1)


RECIPES = {"systemd": of_systemd, "compose": of_compose, "kubernetes": of_kubernetes}


def main() -> None:
    """Run what the command line names."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipe", choices=RECIPES)
    parser.add_argument("--database")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="wsrender-") as folder:
        run(RECIPES[options.recipe](), Path(folder), options.database)
    print(f"{options.recipe}: its commands did a job")


if __name__ == "__main__":
    main()
