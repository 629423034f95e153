"""A server that is not spared: kill -9 of any process, round after round; and 3,000 small jobs in an hour.

Killed are server, workers and kernels, backends of the database and its postmaster, and clients in mid-upload and
mid-stream.

``PARTS`` and ``violations`` make it a long measurement.
"""

import multiprocessing
import os
import random
import socket
import sqlite3
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, closing, contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import psutil
from wsrender_server.jobs import backups
from wsrender_server.jobs.retention import GRACE, Retention
from wsrender_server.jobs.store import open_store
from wsrender_server.local_server import LocalServer
from wsrender_server.settings import Settings

import wsrender as ws
from tests.golden.files import job_of
from tests.server.conftest import Postmaster, postgres_server
from tests.server.jobs.waiting import comparable, wait_until

ANALYSES = ("workspace", "indices_at", "base_placement", "reachability", "postures", "planar_boundary")
ROUNDS = 50
PATIENCE_S = 600.0
GONE_S = 20.0  # within which nothing is left of what was killed
JOBS, MINUTES, SETTLED = 3000, 60.0, 10.0  # of the hour: jobs, minutes, and those after which all is level
KEPT_BYTES, INTERVAL_S = 4_000_000, 5
# After which a result counts among those that are limited; younger ones are kept, as many as the pace gives.
YOUNG_S = GRACE.total_seconds() + 3 * INTERVAL_S
FOLDERS = ("results", "partials", "scratch")


def kills(rounds: int = ROUNDS, postgres: bool = False, seed: int = 0) -> dict[str, Any]:
    """Figures of rounds in each of which six analyses run while processes are killed."""
    rng, killed, wrong = random.Random(seed), Counter[str](), []
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="wsrender-soak-")))
        url, postmaster = stack.enter_context(postgres_server()) if postgres else (None, None)
        stack.enter_context(_environment(WSRENDER_RETENTION_INTERVAL_S="1", WSRENDER_SHARD_SAMPLES="65536"))
        expected = {name: _local(job_of(name), folder / name) for name in ANALYSES}
        options = () if url is None else ("--database", url)
        if url is not None:
            _upgrade(url)
        server = stack.enter_context(LocalServer(folder / "data", options))
        client = stack.enter_context(ws.Client(server.url))
        seen: set[psutil.Process] = set()
        for number in range(rounds):
            jobs = {name: client.submit(job_of(name)) for name in rng.sample(ANALYSES, len(ANALYSES))}
            for _ in range(rng.randint(1, 3)):
                time.sleep(rng.uniform(0.1, 4.0))
                seen |= _kill_one(server, postmaster, rng.choice(list(jobs.values())).id, rng, killed)
            for name, job in jobs.items():
                job.wait(timeout=PATIENCE_S)
                if job.state != "succeeded" or comparable(job.result().document) != expected[name]:
                    wrong.append(f"round {number}, {name}: {job.state} {job.error or 'with other bits'}")
                job.delete()
        last = client.submit(_long()).wait(timeout=PATIENCE_S)
        if last.state != "succeeded":
            wrong.append(f"a long job after all of them: {last.state} {last.error}")
        last.delete()
        seen |= set(_tree(server))
        left = _files_left(server.data_dir)
        server.stop()
        orphans = _alive_after(seen, GONE_S)
        server.start()
        server.stop()  # which empties what is written to at the start
        settings = Settings(data_dir=server.data_dir, database=url)
        with closing(open_store(settings)) as store:
            checked = backups.check(store, Retention(store, settings))
        return {
            "rounds": rounds,
            "killed": dict(killed),
            "wrong": wrong,
            "orphans": orphans,
            "files left": left + _files_left(server.data_dir, 0.0),
            "findings": [finding.text for finding in checked.findings],
        }


def small_jobs(jobs: int = JOBS, minutes: float = MINUTES, settled: float = SETTLED) -> dict[str, Any]:
    """Figures of a server that gets small jobs at an even pace, with retention: what it takes, minute by minute."""
    limits = {"KEEP_RESULTS_BYTES": KEPT_BYTES, "KEEP_JOBS_PER_OWNER": 100, "RETENTION_INTERVAL_S": INTERVAL_S}
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="wsrender-soak-")))
        stack.enter_context(_environment(**{f"WSRENDER_{name}": str(value) for name, value in limits.items()}))
        server = stack.enter_context(LocalServer(folder / "data"))
        client = stack.enter_context(ws.Client(server.url))
        ended, taken = [], []
        began = time.monotonic()
        sampled = threading.Event()

        def sample() -> None:
            while not sampled.wait(max(minutes, 1.0)):  # sixty times in all
                taken.append({"minute": (time.monotonic() - began) / 60} | _taken(server))

        sampling = stack.enter_context(ThreadPoolExecutor(1)).submit(sample)
        try:
            for number in range(jobs):
                time.sleep(max(0.0, began + number * minutes * 60 / jobs - time.monotonic()))
                ended.append(client.submit(_small(number)).wait(timeout=PATIENCE_S).state)
        finally:
            sampled.set()
        sampling.result()
        minutes_taken = (time.monotonic() - began) / 60
    level = [each for each in taken if each["minute"] >= settled]
    third = max(1, len(level) // 3)
    return {
        "jobs": dict(Counter(ended)),
        "minutes": round(minutes_taken, 1),
        "taken": {
            name: [round(sum(each[name] for each in part) / len(part), 1) for part in (level[:third], level[-third:])]
            for name in (taken[0] if level else {})
            if name != "minute"
        },
        "all": taken,
    }


def violations(figures: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """What must not be: a lost or wrong job, an orphan, a file left; or that anything grows after it has settled."""
    found = []
    for part, of_part in figures.items():
        for kind in ("wrong", "orphans", "files left", "findings"):
            found += [f"{part}, {kind}: {each}" for each in of_part.get(kind, [])]
        if set(of_part.get("jobs", {"succeeded": 0})) != {"succeeded"}:
            found.append(f"{part}: not all jobs have succeeded: {of_part['jobs']}")
        if of_part.get("taken") == {}:
            found.append(f"{part}: nothing was measured once all should be level")
        for name, (first, last) in of_part.get("taken", {}).items():
            if last > first * ALLOWED[name][0] + ALLOWED[name][1]:
                found.append(f"{part}: {name} grows from {first} to {last}")
    return found


# By figure: factor and offset of what the last third of the time may take more than the first.
ALLOWED = {
    "resident MiB": (1.05, 20.0),
    "descriptors": (1.0, 10.0),
    "threads": (1.0, 5.0),
    "old results MiB": (0.0, 1.1 * KEPT_BYTES / 2**20),  # however many there were before
    "other disk MiB": (1.1, 2.0),
    "rows": (1.1, 50.0),
}
PARTS = {
    "soak_sqlite": kills,
    "soak_postgresql": partial(kills, postgres=True),
    "soak_hour": small_jobs,
}
TOO_LONG = frozenset(PARTS)  # to be among those that are chosen at random


def _small(number: int) -> dict[str, Any]:
    """A job that no other one is equal to."""
    angles = [[0.1 + 1e-6 * number, 0.2, 0.05, 0.3]]
    return {"analysis": "indices_at", "robot": {"library": "scara"}, "configurations": angles}


def _long() -> dict[str, Any]:
    """A job whose body takes one of the places of long ones: who was killed holds none."""
    return _small(0) | {"configurations": [[0.1, 0.2, 0.05, 0.3]] * 20_000}


def _local(job: dict[str, Any], folder: Path) -> dict[str, Any]:
    result = ws.execute(job)
    result.save(folder)
    return comparable(result.document)


def _tree(server: LocalServer) -> list[psutil.Process]:
    with suppress(psutil.NoSuchProcess):
        process = psutil.Process(server.process.pid)
        return [process, *process.children(recursive=True)]
    return []


def _kill_one(
    server: LocalServer, postmaster: Postmaster | None, job: str, rng: random.Random, killed: "Counter[str]"
) -> set[psutil.Process]:
    """Kill a process, of the server's, of the database's or of a client; what serves is started again.

    Those of the server that there were.
    """
    tree = _tree(server)
    choice = {"server": [tree[0]], "worker": tree[1:], "upload": [], "stream": []}
    if postmaster is not None:
        choice |= {"database": psutil.Process(postmaster.process.pid).children(), "postmaster": []}
    kind = rng.choice([kind for kind, processes in choice.items() if processes or kind in BY_THEMSELVES])
    if kind == "postmaster":
        assert postmaster is not None
        postmaster.kill()
        postmaster.start()
    elif kind in CLIENTS:
        _kill_client(CLIENTS[kind](server.url, job))
    else:
        with suppress(psutil.NoSuchProcess):
            rng.choice(choice[kind]).kill()
    killed[kind] += 1
    if kind == "server":
        server.process.wait()
        server.start()
    return set(tree)


def _kill_client(request: tuple[str, int, bytes]) -> None:
    """Kill a client once it is in the middle of what it sends or reads."""
    spawn = multiprocessing.get_context("spawn")
    there, here = spawn.Pipe()
    client = spawn.Process(target=_talk, args=(request, there), daemon=True)
    client.start()
    try:
        assert here.poll(PATIENCE_S), "the client did not come to the middle"
    finally:
        client.kill()
        client.join()


def _talk(request: tuple[str, int, bytes], middle: Any) -> None:
    """Send a request, read what comes, and say when something has; what is half-sent is not answered."""
    host, port, content = request
    with socket.create_connection((host, port), timeout=PATIENCE_S) as server:
        server.sendall(content)
        if not content.startswith(b"POST"):
            server.recv(1)
        middle.send(True)
        while server.recv(1 << 16):
            time.sleep(0.01)


def _upload(url: str, job: str) -> tuple[str, int, bytes]:
    """Half of a long job document."""
    at = urlsplit(url)
    body = b'{"analysis":"indices_at","robot":{"library":"scara"},"configurations":[' + b"[0.1,0.2,0.05,0.3]," * 60_000
    head = f"POST /v1/jobs HTTP/1.1\r\nHost: {at.netloc}\r\nContent-Type: application/json\r\n"
    return str(at.hostname), at.port or 80, f"{head}Content-Length: {2 * len(body)}\r\n\r\n".encode() + body


def _stream(url: str, job: str) -> tuple[str, int, bytes]:
    """The events of a job."""
    at = urlsplit(url)
    return str(at.hostname), at.port or 80, f"GET /v1/jobs/{job}/events HTTP/1.1\r\nHost: {at.netloc}\r\n\r\n".encode()


CLIENTS = {"upload": _upload, "stream": _stream}
BY_THEMSELVES = (*CLIENTS, "postmaster")  # kinds whose process is made, or known, here


def _alive_after(processes: set[psutil.Process], seconds: float) -> list[str]:
    """Commands of those that live on."""
    # Not by psutil.wait_procs, which fails where the number of one that has gone is a thread's of another by now.
    with suppress(AssertionError):
        wait_until(lambda: not any(map(_lives, processes)), seconds, "the end of processes")
    return [_command(process) for process in processes if _lives(process)]


def _lives(process: psutil.Process) -> bool:
    with suppress(psutil.NoSuchProcess):
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    return False


def _command(process: psutil.Process) -> str:
    with suppress(psutil.NoSuchProcess):
        return " ".join(process.cmdline())
    return "one that has just ended"


def _files_left(data_dir: Path, patience_s: float = GONE_S) -> list[str]:
    """Files of results, partial results and scratch, those of a running server after a while."""

    def left() -> list[str]:
        return [str(path) for name in FOLDERS for path in (data_dir / name).rglob("*") if path.is_file()]

    with suppress(AssertionError):
        wait_until(lambda: not left(), patience_s, "the end of files")
    return left()


def _taken(server: LocalServer) -> dict[str, float]:
    memory = descriptors = threads = 0
    for process in _tree(server):
        with suppress(psutil.NoSuchProcess):
            memory += process.memory_info().rss
            descriptors += process.num_fds()
            threads += process.num_threads()
    with closing(sqlite3.connect(server.data_dir / "wsrender.db")) as connection:
        tables = ("jobs", "computations", "events", "labels", "artifacts")
        rows = sum(connection.execute(f"SELECT count(*) FROM {table}").fetchone()[0] for table in tables)
        results = dict(connection.execute("SELECT id, used_at / 1e6 FROM computations WHERE state = 'succeeded'"))
    taken = old = 0
    for folder, _, names in os.walk(server.data_dir):  # folders go while one looks
        used_at = results.get(Path(folder).name)
        for name in names:
            with suppress(FileNotFoundError):
                size = 0 if name.endswith(".log") else Path(folder, name).stat().st_size
                taken += size if used_at is None else 0
                old += size if used_at is not None and time.time() - used_at > YOUNG_S else 0
    return {
        "resident MiB": memory / 2**20,
        "descriptors": descriptors,
        "threads": threads,
        "old results MiB": old / 2**20,
        "other disk MiB": taken / 2**20,
        "rows": rows,
    }


def _upgrade(url: str) -> None:
    from wsrender_server.jobs.database import open_database
    from wsrender_server.migrations import upgrade

    engine = open_database(url)
    upgrade(engine)
    engine.dispose()


@contextmanager
def _environment(**variables: str) -> Iterator[None]:
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})
