"""Hostile requests to a server: none reads a file, shows what is another's, takes much memory, crashes or stalls."""

import hashlib
import json
import os
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from http.client import HTTPConnection, HTTPException
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest.mock import patch
from urllib.parse import quote, urlsplit

import psutil
from wsrender_server.jobs.store import open_store
from wsrender_server.local_server import LocalServer
from wsrender_server.settings import Settings

from tests.server.hostile import cases
from tests.server.hostile.cases import DOCUMENT, FILE, Case

TOKEN = "canary-4b1d61c6"
LIMITS = {"WSRENDER_MAX_PLANNING_MEMORY_BYTES": str(2**30), "WSRENDER_MAX_PLANNING_S": "30"}
MIB = 2**20
ANSWER_S = 90.0  # of a case, planning among it; machines are shared
MOST_GROWN = 400 * MIB  # of the process that answers
MOST_HELD = 1536 * MIB  # by a process that plans
MOST_ANSWERED = 200_000  # bytes


@dataclass
class Attack:
    """What came of so many cases: the slowest, memory [MiB], and what was not as it should be."""

    cases: int = 0
    slowest: tuple[float, str] = (0.0, "")
    grown_mib: float = 0.0
    held_mib: float = 0.0
    faults: list[str] = field(default_factory=list)


class Server:
    """A server with a job and a model of ann's, and what is said to it by eve."""

    def __init__(self, url: str, process: psutil.Process, log: Path, keys: dict[str, str], secret: Path):
        self.address = urlsplit(url).netloc
        self.process, self.log, self.keys, self.secret = process, log, keys, secret
        self.attack = Attack()
        before = self.process.memory_info().rss
        content = b"solid private\nendsolid"
        model = json.loads(self._request(_upload(content), "ann")[2])["sha256"]
        job = json.loads(self._request(_job(), "ann")[2])["id"]
        self.private = {"job": job, "model": model}
        self.rss = before

    def meet(self, case: Case) -> None:
        """Send a case and note what is wrong with the answer, and with the server after it."""
        began, failed = time.monotonic(), self.log.read_text().count("request failed")
        _make_old(self.secret)
        found = list(self._faults(case))
        seconds = time.monotonic() - began
        if self.secret.stat().st_atime > 1:
            found.append("it read the secret file")
        if self.log.read_text().count("request failed") > failed:
            found.append("an exception was not answered")
        if self._request(Case("health", method="GET", path="/healthz"), "eve")[0] != 200:
            found.append("the server does not answer any more")
        if seconds > ANSWER_S:
            found.append(f"took {seconds:.0f} s")
        self.attack.cases += 1
        self.attack.slowest = max(self.attack.slowest, (round(seconds, 2), case.name))
        self.attack.grown_mib = (self.process.memory_info().rss - self.rss) / MIB
        self.attack.faults += [f"{case.name}: {each}" for each in found]

    def _faults(self, case: Case) -> Iterator[str]:
        if case.upload is not None:
            status, _, answer = self._request(_upload(case.upload), "eve")
            if status >= 400:
                yield from self._wrong(replace(case, pointer=None), status, "", answer)
                return
            case = replace(case, body=case.body.replace(b"SHA256", hashlib.sha256(case.upload).hexdigest().encode()))
        ends = time.monotonic() + ANSWER_S
        try:
            while True:
                status, media, answer = self._request(case, "eve")
                if b'"planning"' not in answer or time.monotonic() > ends:
                    break
        except (OSError, HTTPException) as fault:
            yield f"no answer: {fault!r}"
            return
        yield from self._wrong(case, status, media, answer)

    def _wrong(self, case: Case, status: int, media: str, answer: bytes) -> Iterator[str]:
        if status not in case.allowed:
            yield f"answered with {status}: {answer[:200]!r}"
        if TOKEN.encode() in answer or b"root:x:" in answer or b"solid private" in answer:
            yield "it shows what it must not"
        if len(answer) > MOST_ANSWERED:
            yield f"an answer of {len(answer)} bytes"
        if status < 400 or case.method == "HEAD":
            return
        if media and media != "application/problem+json":
            yield f"no problem document but {media}"
            return
        problem = json.loads(answer)
        pointers = [each["pointer"] for each in problem.get("errors", [])]
        if status != problem["status"] or not problem["detail"] or "Traceback" in problem["detail"]:
            yield f"an odd problem: {problem}"
        limited = problem["code"] in ("too_slow", "out_of_memory")  # which names no field: all of it was too much
        if problem["code"] == "crashed":
            yield "a process crashed"
        if case.pointer is not None and not limited and not any(each.startswith(case.pointer) for each in pointers):
            yield f"the problem does not name {case.pointer}: {pointers} {problem['detail'][:200]}"

    def _request(self, case: Case, who: str) -> tuple[int, str, bytes]:
        headers = {"Authorization": f"Bearer {self.keys[who]}"} | case.headers
        with closing(HTTPConnection(self.address, timeout=ANSWER_S)) as connection:
            connection.request(case.method, quote(case.path, safe="/%?=&:"), case.body or None, headers)
            response = connection.getresponse()
            if response.headers.get_content_type() == "text/event-stream":
                return response.status, "text/event-stream", b""
            return response.status, response.headers.get_content_type(), response.read()


def _upload(content: bytes) -> Case:
    return Case("upload", content, path="/v1/models", headers=FILE)


def _job() -> Case:
    return Case("job", json.dumps(DOCUMENT).encode(), path="/v1/jobs")


def _make_old(path: Path) -> None:
    """The next reading is seen in the time of the last access, which file systems keep where it was before a change."""
    os.utime(path, (1, time.time()))


@contextmanager
def attacked() -> Iterator[Server]:
    """A server that asks for keys, has no worker, and holds a secret in a file beside it."""
    with TemporaryDirectory(prefix="wsrender-hostile-") as name:
        folder, secret = Path(name), Path(name) / "secret.xml"
        secret.write_text(f"<mujoco model='{TOKEN}'/>")
        _make_old(secret)
        secret.read_text()
        assert secret.stat().st_atime > 1, "this file system does not keep the times of readings"
        with closing(open_store(Settings(data_dir=folder / "data"))) as store:
            keys = {who: store.create_key(who)[1] for who in ("ann", "eve")}
        with patch.dict(os.environ, LIMITS), LocalServer(folder / "data", ["--workers", "0"]) as local:
            yield Server(local.url, psutil.Process(local.process.pid), local.log, keys, secret)


@contextmanager
def _watched(server: Server) -> Iterator[None]:
    """Note the most that a child of the server holds."""
    ends = threading.Event()

    def look() -> None:
        while not ends.wait(0.1):
            for child in server.process.children(recursive=True):
                try:
                    held = child.memory_info().rss / MIB
                except psutil.Error:
                    continue
                server.attack.held_mib = max(server.attack.held_mib, held)

    thread = threading.Thread(target=look)
    thread.start()
    try:
        yield
    finally:
        ends.set()
        thread.join()


def of_kind(kind: str, server: Server) -> Iterable[Case]:
    """The cases of a kind, as they are for a server."""
    arguments = {kind: (str(server.secret),) for kind in ("files", "archives")} | {
        "others": (server.private["job"], server.private["model"])
    }
    return getattr(cases, kind)(*arguments.get(kind, ()))


def attack(kind: str, part: int = 0, parts: int = 1) -> Attack:
    """Every ``parts``-th case of a kind, from ``part`` on."""
    with attacked() as server:
        with _watched(server):
            for case in list(of_kind(kind, server))[part::parts]:
                server.meet(case)
        return server.attack


DIVIDED = {
    "texts": 3,
    "files": 3,
    "archives": 2,
    "values": 2,
    "numbers": 2,
    "bodies": 1,
    "uploads": 3,
    "bombs": 1,
    "others": 1,
}
PARTS = {
    f"{kind} {part}": partial(attack, kind, part, parts) for kind, parts in DIVIDED.items() for part in range(parts)
}


def violations(figures: dict[str, Any]) -> list[str]:
    """What is beyond its bound in attacks by kind."""
    found = [fault for each in figures.values() for fault in each.faults]
    for part, each in figures.items():
        if each.grown_mib * MIB > MOST_GROWN:
            found.append(f"{part}: the server grew by {each.grown_mib:.0f} MiB")
        if each.held_mib * MIB > MOST_HELD:
            found.append(f"{part}: a process held {each.held_mib:.0f} MiB")
    return found
