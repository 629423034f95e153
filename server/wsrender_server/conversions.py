"""Artifacts in other formats on request, converted in the side process and kept for a while."""

import asyncio
import os
import uuid
from pathlib import Path

from wsrender import __version__
from wsrender.results.export.artifacts import sha256 as sha256_of
from wsrender.results.export.formats import Format, of_file, others
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.records import ArtifactRecord
from wsrender_server.problems import HttpProblem
from wsrender_server.side_process import SideProcess

MOST_KEPT = 64  # converted files
TIMEOUT_S = 600.0


class ConvertedFiles:
    """Converted artifacts, in the folder ``converted`` of the data folder; the oldest of many are removed.

    What another version of wsrender has converted is converted anew.
    """

    def __init__(self, files: DataFolder, side_process: SideProcess):
        self._files = files
        self._folder = files.root / "converted"
        self._side_process = side_process
        self._turn = asyncio.Lock()

    async def get(self, source: Path, record: ArtifactRecord, format: str) -> tuple[Path, str]:
        """File and SHA-256 of an artifact in another format.

        Raises HttpProblem 404 for a format that it does not have, DiskFull.
        """
        stored = of_file(record.name)
        allowed = others(stored)
        if stored is None or format not in allowed:
            choices = ", ".join(allowed) or "none"
            detail = f"{record.name} does not come as {format}; other formats: {choices}"
            raise HttpProblem(404, detail, "format_not_available", errors=[("format", detail)])
        async with self._turn:  # equal requests find the file that the first of them makes
            kept = await asyncio.to_thread(self._kept, record.sha256, format)
            if kept is None:
                await asyncio.to_thread(self._files.check_space)
                target = self._folder / f".{uuid.uuid4().hex}.{format}"
                wanted = allowed[format]
                sha256 = await self._side_process.run(convert, source, stored, target, wanted, timeout_s=TIMEOUT_S)
                kept = await asyncio.to_thread(self._keep, target, record.sha256, sha256, format)
        return kept

    def _kept(self, source_sha256: str, format: str) -> tuple[Path, str] | None:
        self._folder.mkdir(parents=True, exist_ok=True)
        for path in self._folder.glob(f"{source_sha256}.*.{__version__}.{format}"):
            os.utime(path)
            return path, path.name.split(".")[1]
        return None

    def _keep(self, made: Path, source_sha256: str, sha256: str, format: str) -> tuple[Path, str]:
        path = made.replace(self._folder / f"{source_sha256}.{sha256}.{__version__}.{format}")
        files = sorted(self._folder.iterdir(), key=lambda file: file.stat().st_mtime)
        for old in files[:-MOST_KEPT]:
            old.unlink(missing_ok=True)
        return path, sha256


def convert(source: Path, stored: Format, target: Path, wanted: Format) -> str:
    """Write the file ``source``, whatever its name, in another format; SHA-256 of the file ``target``.

    Raises InputError where the source is damaged.
    """
    wanted.write(stored.read(source), target)
    return sha256_of(target)
