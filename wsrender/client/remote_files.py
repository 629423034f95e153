"""The files of a job on a server: downloaded when needed, with resume, and verified."""

import hashlib
import io
import json
import re
import shutil
import tempfile
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cached_property, partial
from pathlib import Path
from typing import Any, BinaryIO
from urllib.parse import quote

import httpx2

from wsrender.client.connection import Connection
from wsrender.client.operations import path_of
from wsrender.client.range_file import RangeFile
from wsrender.client.records import not_understood
from wsrender.client.requests import Request, Server, Steps, T, TakeBytes, checked, sent, worth_repeating
from wsrender.errors import ServerError
from wsrender.results.export.artifacts import (
    DOCUMENT,
    artifact_records,
    named_files,
    part_file,
    publish,
    write_document,
)
from wsrender.results.export.atomic import staging_folder
from wsrender.results.export.formats import of_file, readable
from wsrender.results.export.result_format import current_document

ATTEMPTS = 2  # at a file that was damaged on its way
_SHA256 = re.compile(r'"([0-9a-f]{64})"')

OnBytes = Callable[[int], object]
Document = dict[str, Any]  # a result document, as `wsrender.Result` has it


def downloaded(
    server: Server,
    path: str,
    target: Path,
    sha256: str | None = None,
    format: str | None = None,
    on_bytes: OnBytes | None = None,
) -> Steps[Path]:
    """Download ``path`` of the server to the file ``target``, which appears complete or not at all.

    A lost connection goes on where it was. ``sha256`` is what the file must have; without it, what the server's
    ETag says. ``format`` asks for a conversion; ``on_bytes`` is told how many have arrived. Raises ServerError where
    the contents are not what they should be, ServerConnectionError, NotFoundError.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    partial = target.with_name(f"{target.name}.part")
    try:
        with partial.open("wb") as file:
            yield from _written(server, path, file, sha256, format, on_bytes)
        return partial.replace(target)
    finally:
        partial.unlink(missing_ok=True)


def _written(
    server: Server, path: str, file: BinaryIO, sha256: str | None, format: str | None, on_bytes: OnBytes | None
) -> Steps[None]:
    """Write what `downloaded` downloads to an open file."""
    for _ in range(ATTEMPTS):
        download = _Download(file, on_bytes)
        yield from _fetched(server, path, format, download)
        if (sha256 or download.announced) in (None, download.digest.hexdigest()):
            return
    raise ServerError(f"{path}: what arrived has another SHA-256 than the server says, in {ATTEMPTS} attempts")


def result_document(server: Server, job_id: str) -> Steps[Document]:
    """The result document of a job, in today's form; it may be long, so it is downloaded as files are.

    Raises InputError where a later version wrote it, ServerError where something else comes, what `downloaded` raises.
    """
    path = f"{path_of(job_id)}/result"
    file = io.BytesIO()
    yield from _written(server, path, file, None, None, None)
    try:
        found = json.loads(file.getvalue())
    except ValueError:
        found = None
    if not isinstance(found, dict):
        raise not_understood(server.url, f"no JSON object at {path}")
    return current_document(found)


class _Download:
    """What has arrived in a file: how many bytes, their digest, and the server's tag of the whole."""

    def __init__(self, file: BinaryIO, on_bytes: OnBytes | None):
        self.file, self.on_bytes, self.etag = file, on_bytes or (lambda have: None), ""
        self._begin()

    def _begin(self) -> None:
        self.digest, self.have = hashlib.sha256(), 0
        self.file.seek(0)
        self.file.truncate()

    @property
    def announced(self) -> str | None:
        """The SHA-256 that the server says the file has, if it does."""
        found = _SHA256.fullmatch(self.etag)
        return found[1] if found else None

    @property
    def headers(self) -> dict[str, str]:
        """What asks for the rest."""
        rest = {"Range": f"bytes={self.have}-", "If-Range": self.etag} if self.have and self.etag else {}
        return {"Accept-Encoding": "identity", **rest}

    @contextmanager
    def into(self, response: httpx2.Response) -> Iterator[TakeBytes]:
        """What takes the bytes of an answer: the rest, or the whole anew."""
        self.etag = response.headers.get("ETag", "")
        if response.status_code != 206:
            self._begin()

        def take(piece: bytes) -> None:
            self.file.write(piece)
            self.digest.update(piece)
            self.have += len(piece)
            self.on_bytes(self.have)

        yield take


def _fetched(server: Server, path: str, format: str | None, download: _Download) -> Steps[None]:
    """Ask until everything has arrived."""
    pauses = server.pauses()
    while True:
        had = download.have
        params = {"format": format} if format else {}
        try:
            response = yield from sent(Request("GET", path, params, download.headers, into=download.into))
        except httpx2.TransportError as error:
            if download.have > had:
                server.reached = True
                pauses.again()
            yield pauses.after(error)
            continue
        server.reached = True
        if worth_repeating(response) and (pause := pauses.after_refusal(response)):
            yield pause
            continue
        if response.status_code != 416:  # else nothing was missing but the end of the answer
            yield from checked(server, response)
        return


def _after(on_bytes: OnBytes, before: int, have: int) -> None:
    on_bytes(before + have)


class RemoteFiles:
    """The artifacts of one job; each is downloaded once, to a temporary folder that goes with this object."""

    def __init__(self, connection: Connection, job_id: str, document: Document):
        self._connection, self.job_id = connection, job_id
        self.records = dict(artifact_records(document))
        self._downloaded: dict[tuple[str, str | None], Path] = {}

    @cached_property
    def _folder(self) -> Path:
        folder = tempfile.mkdtemp(prefix="wsrender-")
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        return Path(folder)

    def fetched(
        self, name: str, target: Path, format: str | None = None, on_bytes: OnBytes | None = None
    ) -> Steps[Path]:
        """Download an artifact to the file ``target``."""
        sha256 = self.records[name].get("sha256") if format is None and name in self.records else None
        path = f"{path_of(self.job_id)}/artifacts/{quote(name)}"
        return downloaded(self._connection.server, path, target, sha256, format, on_bytes)

    def saved(self, folder: str | Path, document: Document, on_bytes: OnBytes | None = None) -> Steps[None]:
        """Download all files to a folder, and write the document beside; if anything fails, nothing changes."""
        folder, done = Path(folder).absolute(), 0
        with staging_folder(folder) as staging:
            for name in self.records:
                tell = None if on_bytes is None else partial(_after, on_bytes, done)
                target = yield from self.fetched(name, staging / name, None, tell)
                done += target.stat().st_size
            write_document(document, staging / DOCUMENT)
            publish(staging, folder)
        self._downloaded |= {(name, None): folder / name for name in self.records}

    @property
    def bytes(self) -> int:
        """Size of all files together, as far as the document says it."""
        return sum(int(record.get("bytes") or 0) for record in self.records.values())

    def run(self, steps: Steps[T]) -> T:
        """What comes of steps, by waiting."""
        return self._connection.run(steps)

    def local(self, name: str, format: str | None = None) -> Path:
        """Path of a downloaded artifact."""
        key = (name, format)
        if key not in self._downloaded:
            target = self._folder / f"{len(self._downloaded)}-{Path(name).name}"
            self._downloaded[key] = self._connection.run(self.fetched(name, target, format))
        return self._downloaded[key]

    def opened(self, name: str) -> RangeFile | Path:
        """An artifact as a file of which only what is read is downloaded; its path where it has been downloaded."""
        if (path := self._downloaded.get((name, None))) is not None:
            return path
        record, path_there = self.records[name], f"{path_of(self.job_id)}/artifacts/{quote(name)}"
        return RangeFile(self._connection, path_there, f'"{record["sha256"]}"', int(record["bytes"]))

    def read(self, name: str) -> Any:
        """What the artifact holds, converted by the server where a package is missing here; None where it is not."""
        stored = of_file(name)
        if name not in self.records or stored is None:
            return None
        here = readable(stored)
        return here.read(self.local(name, None if here is stored else here.suffix))

    def part(self, part: str) -> Any:
        """What the file of a part holds, such as the map; None where there is none."""
        return self.read(part_file(part))

    def named(self, part: str) -> dict[str, Any]:
        """What the files of a part of several hold, such as the tables, by name."""
        return {name: self.read(file) for name, file in named_files(part, self.records).items()}
