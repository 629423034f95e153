"""Artifacts in other formats and plots on request, made in the side process."""

import asyncio
import json
import os
import tempfile
import time
import uuid
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any
from weakref import WeakValueDictionary

from wsrender import __version__
from wsrender.notices import entries
from wsrender.results.export.artifacts import sha256 as sha256_of
from wsrender.results.export.formats import Format, of_file, others
from wsrender.results.export.result_format import current_document
from wsrender.results.presentation import picture_of
from wsrender.results.result import Result, files_of_parts
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.identity import notices_of
from wsrender_server.jobs.records import ArtifactRecord
from wsrender_server.problems import HttpProblem
from wsrender_server.side_process import SideProcess

MOST_KEPT = 64  # converted files
MOST_KEPT_BYTES = 2 << 30
TIMEOUT_S = 600.0


class ConvertedFiles:
    """Converted artifacts, in the folder ``converted`` of the data folder; the oldest of many are removed.

    What another version of wsrender has converted is converted anew.
    """

    def __init__(self, files: DataFolder, side_process: SideProcess):
        self._files = files
        self._folder = files.root / "converted"
        self._side_process = side_process
        self._turns: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()
        self._looking = asyncio.Lock()

    async def get(self, owner: str, source: Path, record: ArtifactRecord, format: str) -> tuple[Path, str]:
        """File and SHA-256 of an artifact in another format.

        Raises HttpProblem 404 for a format that it does not have, DiskFull.
        """
        stored = of_file(record.name)
        allowed = others(stored)
        if stored is None or format not in allowed:
            choices = ", ".join(allowed) or "none"
            detail = f"{record.name} does not come as {format}; other formats: {choices}"
            raise HttpProblem(404, detail, "format_not_available", errors=[("format", detail)])
        return await self._made(owner, record.sha256, format, partial(convert, source, stored, allowed[format]))

    async def renewed(self, owner: str, source: Path, record: ArtifactRecord, version: str) -> tuple[Path, str]:
        """File and SHA-256 of the result document of another ``version`` in today's form. Raises DiskFull."""
        return await self._made(owner, record.sha256, "renewed", partial(renew, source, version))

    async def _made(self, owner: str, source_sha256: str, kind: str, write: Callable[[Path], str]) -> tuple[Path, str]:
        """What the side process has written, or writes now, of a source."""
        async with self._turns.setdefault(f"{owner} {source_sha256} {kind}", asyncio.Lock()):  # made once
            async with self._looking:
                kept = await asyncio.to_thread(self._kept, source_sha256, kind)
            if kept is None:
                await asyncio.to_thread(self._files.check_space)
                target = self._folder / f".{uuid.uuid4().hex}.{kind}"
                sha256 = await self._side_process.run(write, target, owner=owner, timeout_s=TIMEOUT_S)
                async with self._looking:
                    kept = await asyncio.to_thread(self._keep, target, source_sha256, sha256, kind)
        return kept

    def _kept(self, source_sha256: str, format: str) -> tuple[Path, str] | None:
        self._folder.mkdir(parents=True, exist_ok=True)
        for path in self._folder.glob(f"{source_sha256}.*.{__version__}.{format}"):
            os.utime(path)
            return path, path.name.split(".")[1]
        return None

    def _keep(self, made: Path, source_sha256: str, sha256: str, format: str) -> tuple[Path, str]:
        path = made.replace(self._folder / f"{source_sha256}.{sha256}.{__version__}.{format}")
        kept = 0
        files = sorted(self._folder.iterdir(), key=lambda file: file.stat().st_mtime, reverse=True)
        for number, old in enumerate(each for each in files if not _being_written(each)):
            kept += old.stat().st_size
            if old != path and (number >= MOST_KEPT or kept > MOST_KEPT_BYTES):
                old.unlink(missing_ok=True)
        return path, sha256


def _being_written(path: Path) -> bool:
    """Whether it may be what the side process writes now; one that was killed leaves such a file."""
    return path.name.startswith(".") and time.time() - path.stat().st_mtime < TIMEOUT_S


def convert(source: Path, stored: Format, wanted: Format, target: Path) -> str:
    """Write the file ``source``, whatever its name, in another format; SHA-256 of the file ``target``.

    Raises InputError where the source is damaged.
    """
    wanted.write(stored.read(source), target)
    return sha256_of(target)


def renew(source: Path, version: str, target: Path) -> str:
    """Write the result document of another version in today's form, with a warning; SHA-256 of the file ``target``."""
    document = result_document(source)
    document["warnings"] = [*document["warnings"], *entries(notices_of(version))]
    target.write_text(json.dumps(document, ensure_ascii=False), encoding="utf-8")
    return sha256_of(target)


def result_document(source: Path | str) -> dict[str, Any]:
    """The result document of a file, in today's form."""
    return current_document(json.loads(Path(source).read_text(encoding="utf-8")))


def files_for_plot(result: str, plot: str, names: list[str]) -> list[str]:
    """Of the files ``names`` of a result, whose document is in a file, those that a picture is drawn from.

    Raises InputError for a picture that results of its analysis do not have.
    """
    picture = picture_of(result_document(result), plot)
    return files_of_parts((*picture.needs, *picture.uses), names)


def draw(result: str, files: dict[str, str], name: str, format: Format, options: dict[str, Any]) -> bytes:
    """A picture of a result, whose document is in a file; ``files`` maps names of its artifacts to paths.

    ``options``: those that the picture takes are used. Raises InputError where the result does not hold what it shows.
    """
    document = result_document(result)
    plot = Result.of_files(document, {file: Path(path) for file, path in files.items()}).plot
    taken = picture_of(document, name).takes
    figure = plot(name, **{key: value for key, value in options.items() if value is not None and key in taken})
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / format.file(name)
        format.write(figure, path)
        return path.read_bytes()
