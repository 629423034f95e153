"""Artifacts in other formats on request, converted in the side process and kept for a while."""

import asyncio
import hashlib
import os
import uuid
from pathlib import Path
from typing import Any

from wsrender import __version__, export
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.records import ArtifactRecord
from wsrender_server.problems import HttpProblem
from wsrender_server.side_process import SideProcess

MOST_KEPT = 64  # converted files
TIMEOUT_S = 600.0

MEDIA_TYPES = {
    "csv": "text/csv",
    "glb": "model/gltf-binary",
    "mat": "application/x-matlab-data",
    "npz": "application/x-npz",
    "ply": "model/ply",
    "stl": "model/stl",
    "vti": "application/vnd.vtk.vti",
}
# What each kind of file can be converted to, by its ending.
FORMATS = {".parquet": ("npz", "csv", "mat"), ".vtkhdf": ("npz", "csv", "mat", "vti"), ".glb": ("ply", "stl")}
FORMATS[".ply"] = ("glb", "stl")


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
        ending = Path(record.name).suffix
        allowed = FORMATS.get(ending, ())
        if format not in allowed:
            choices = ", ".join(allowed) or "none"
            detail = f"{record.name} does not come as {format}; other formats: {choices}"
            raise HttpProblem(404, detail, "format_not_available", errors=[("format", detail)])
        async with self._turn:  # equal requests find the file that the first of them makes
            kept = await asyncio.to_thread(self._kept, record.sha256, format)
            if kept is None:
                await asyncio.to_thread(self._files.check_space)
                target = self._folder / f".{uuid.uuid4().hex}.{format}"
                sha256 = await self._side_process.run(convert, str(source), ending, str(target), timeout_s=TIMEOUT_S)
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


def convert(source: str, ending: str, target: str) -> str:
    """Write the file ``source``, whose kind is that of ``ending``, in the format of the name ``target``; its SHA-256.

    Raises InputError where the source is damaged.
    """
    format = Path(target).suffix.removeprefix(".")
    if ending == ".parquet":
        getattr(export, f"write_table_{format}")(export.read_table_parquet(source), target)
    elif ending == ".vtkhdf":
        volume = export.read_volume_vtkhdf(source)
        _volume_writer(format)(volume, target)
    else:
        export.write_mesh(export.read_mesh(source, ending), target)
    with Path(target).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _volume_writer(format: str) -> Any:
    if format == "vti":
        from wsrender_server.vti import write_volume_vti

        return write_volume_vti
    return getattr(export, f"write_volume_{format}")
