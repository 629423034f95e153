"""The result of a job on a server: as of a local run, its files downloaded when needed, with resume, and verified."""

import hashlib
import re
import shutil
import tempfile
import weakref
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

import httpx2
import numpy as np

from wsrender.client.connection import Connection, worth_repeating
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
from wsrender.results.export.formats import check_asked, of_file, readable
from wsrender.results.result import Result
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    import trimesh

ATTEMPTS = 2  # at a file that was damaged on its way
_SHA256 = re.compile(r'"([0-9a-f]{64})"')


def download(
    connection: Connection, path: str, target: Path, sha256: str | None = None, format: str | None = None
) -> Path:
    """Download ``path`` of the server to the file ``target``, which appears complete or not at all.

    A lost connection goes on where it was. ``sha256`` is what the file must have; without it, what the server's
    ETag says. ``format`` asks for a conversion. Raises ServerError where the contents are not what they should be,
    ServerConnectionError, NotFoundError.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    partial = target.with_name(f"{target.name}.part")
    partial.unlink(missing_ok=True)
    try:
        for _ in range(ATTEMPTS):
            announced = _fetch(connection, path, partial, format)
            if (sha256 or announced) in (None, _sha256(partial)):
                return partial.replace(target)
            partial.unlink()
    finally:
        partial.unlink(missing_ok=True)
    raise ServerError(f"{path}: what arrived has another SHA-256 than the server says, in {ATTEMPTS} attempts")


def _fetch(connection: Connection, path: str, partial: Path, format: str | None) -> str | None:
    """Append to ``partial`` until it is complete; the SHA-256 that the server says it has, if it does."""
    pauses = connection.pauses()
    etag = ""
    while True:
        have = partial.stat().st_size if partial.exists() else 0
        headers = {"Accept-Encoding": "identity"}
        if have and etag:
            headers |= {"Range": f"bytes={have}-", "If-Range": etag}
        try:
            with connection.stream(path, headers=headers, params={"format": format} if format else {}) as response:
                if worth_repeating(response) and pauses.after_refusal(response):
                    continue
                if response.status_code == 416:  # nothing was missing but the end of the answer
                    break
                connection.checked(response)
                etag = response.headers.get("ETag", "")
                _write(response, partial)
            break
        except httpx2.TransportError as error:
            if partial.exists() and partial.stat().st_size > have:
                pauses.again()
            pauses.after(error)
    found = _SHA256.fullmatch(etag)
    return found[1] if found else None


def _write(response: httpx2.Response, partial: Path) -> None:
    with partial.open("ab" if response.status_code == 206 else "wb") as file:
        for chunk in response.iter_raw():
            file.write(chunk)


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


class RemoteFiles:
    """The artifacts of one job; each is downloaded once, to a temporary folder that goes with this object."""

    def __init__(self, connection: Connection, job_id: str, document: dict[str, Any]):
        self._connection = connection
        self._path = f"/v1/jobs/{quote(job_id, safe='')}/artifacts"
        self.records = dict(artifact_records(document))
        self._downloaded: dict[tuple[str, str | None], Path] = {}

    @cached_property
    def _folder(self) -> Path:
        folder = tempfile.mkdtemp(prefix="wsrender-")
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        return Path(folder)

    def fetch(self, name: str, target: Path, format: str | None = None) -> Path:
        """Download an artifact to the file ``target``."""
        sha256 = self.records[name].get("sha256") if format is None and name in self.records else None
        return download(self._connection, f"{self._path}/{quote(name)}", target, sha256, format)

    def local(self, name: str, format: str | None = None) -> Path:
        """Path of a downloaded artifact."""
        key = (name, format)
        if key not in self._downloaded:
            target = self._folder / f"{len(self._downloaded)}-{Path(name).name}"
            self._downloaded[key] = self.fetch(name, target, format)
        return self._downloaded[key]

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


class RemoteResult(Result):
    """A Result whose map, sample, volumes, tables, meshes and skeleton are downloaded when they are first used.

    They raise ServerConnectionError where the server is gone by then; ``save`` keeps everything.
    """

    def __init__(self, document: dict[str, Any], files: RemoteFiles):
        self.document = document
        self._files = files

    @cached_property
    def map(self) -> DistributionMap | None:  # type: ignore[override]
        """One row per sample, where it was kept."""
        return self._files.part("map")

    @cached_property
    def sample(self) -> DistributionMap | None:  # type: ignore[override]
        """The fixed subsample that pictures use."""
        return self._files.part("sample")

    @cached_property
    def volume(self) -> VolumeData | None:  # type: ignore[override]
        """Statistics by voxel."""
        return self._files.part("volume")

    @cached_property
    def skeleton(self) -> np.ndarray | None:  # type: ignore[override]
        """World positions [m] of base, joint origins and tip, (K, L+2, 3)."""
        return self._files.part("skeleton")

    @cached_property
    def meshes(self) -> "dict[str, trimesh.Trimesh]":  # type: ignore[override]
        """Meshes by name [m, world frame]; they need the extra [engine]."""
        return self._files.named("meshes")

    @cached_property
    def tables(self) -> dict[str, Table]:  # type: ignore[override]
        """Tables by name."""
        return self._files.named("tables")

    @cached_property
    def volumes(self) -> dict[str, VolumeData]:  # type: ignore[override]
        """Further volumes by name."""
        return self._files.named("volumes")

    def save(self, folder: str | Path, formats: Iterable[str] = ()) -> None:
        """Download every file of the result to a folder, as a local run would have written it.

        With ``formats`` all files are written here, which needs the extra [engine]. If
        anything fails, nothing changes. Raises InputError, ServerConnectionError, ServerError.
        """
        formats = check_asked(formats)
        if formats:
            super().save(folder, formats)
            return
        with staging_folder(folder) as staging:
            for name in self._files.records:
                self._files.fetch(name, staging / name)
            write_document(self.document, staging / DOCUMENT)
            publish(staging, Path(folder).absolute())
