"""Artifacts in other formats, slices and plots on request, made in the side process."""

import asyncio
import json
import math
import os
import tempfile
import uuid
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from wsrender import __version__
from wsrender.errors import InputError
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
TIMEOUT_S = 600.0
AXES = "xyz"


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
        return await self._made(record.sha256, format, partial(convert, source, stored, allowed[format]))

    async def renewed(self, source: Path, record: ArtifactRecord, version: str) -> tuple[Path, str]:
        """File and SHA-256 of the result document of another ``version`` in today's form. Raises DiskFull."""
        return await self._made(record.sha256, "renewed", partial(renew, source, version))

    async def _made(self, source_sha256: str, kind: str, write: Callable[[Path], str]) -> tuple[Path, str]:
        """What the side process has written, or writes now, of a source."""
        async with self._turn:  # equal requests find the file that the first of them makes
            kept = await asyncio.to_thread(self._kept, source_sha256, kind)
            if kept is None:
                await asyncio.to_thread(self._files.check_space)
                target = self._folder / f".{uuid.uuid4().hex}.{kind}"
                sha256 = await self._side_process.run(write, target, timeout_s=TIMEOUT_S)
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
        files = sorted(self._folder.iterdir(), key=lambda file: file.stat().st_mtime)
        for old in files[:-MOST_KEPT]:
            old.unlink(missing_ok=True)
        return path, sha256


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


def slice_values(
    volume_file: str, axis: str, at: float | None, index: str | None, statistic: str | None
) -> dict[str, Any]:
    """The plane of voxels at a coordinate ``at`` [m] along an axis; by default the one with most occupied voxels.

    Returns ``values``, float32 (a, b) over the two other axes in the order x, y, z, NaN where empty; ``origin_m``, the
    lower corner of its first voxel (2,); ``voxel_size_m``; ``at_m``, the centre of the plane; ``name`` of the array.
    Raises InputError for a plane outside the volume and an index or statistic that it does not hold.
    """
    import h5py

    normal = AXES.index(axis)
    with h5py.File(volume_file, "r") as file:
        root: Any = file["VTKHDF"]
        name = _array_name(root["CellData"], index, statistic)
        size, first = float(root.attrs["Spacing"][0]), np.asarray(root.attrs["first_voxel"])
        layer = _layer(root["CellData"]["count"], normal, at, size, int(first[normal]))
        where: list[Any] = [slice(None)] * 3
        where[2 - normal] = layer  # files hold z, y, x
        counts = np.asarray(root["CellData"]["count"][tuple(where)]).T
        values = np.asarray(root["CellData"][name][tuple(where)]).T.astype(np.float32)
    values[counts == 0] = np.nan
    across = [k for k in range(3) if k != normal]
    return {
        "values": np.ascontiguousarray(values),
        "origin_m": [float(first[k] * size) for k in across],
        "voxel_size_m": size,
        "at_m": float((first[normal] + layer + 0.5) * size),
        "name": name,
    }


def voxel_values(volume_file: str, at: tuple[float, float, float]) -> dict[str, Any]:
    """What the voxel that holds the point ``at`` (3,) [m] holds: ``cell``, ``center_m``, ``count`` and ``values``.

    Raises InputError for a point outside the volume.
    """
    import h5py

    with h5py.File(volume_file, "r") as file:
        root: Any = file["VTKHDF"]
        size, first = float(root.attrs["Spacing"][0]), np.asarray(root.attrs["first_voxel"])
        cell = np.floor(np.array(at) / size + 1e-9).astype(np.int64) - first
        cells = root["CellData"]
        if (cell < 0).any() or (cell >= cells["count"].shape[::-1]).any():
            low, high = first * size, (first + cells["count"].shape[::-1]) * size
            box = ", ".join(f"{a:g} … {b:g}" for a, b in zip(low, high, strict=True))
            raise InputError("x", f"the point {', '.join(f'{each:g}' for each in at)} is outside the volume, {box} m")
        x, y, z = cell.tolist()
        values = []
        for data in cells.values():
            told = [("statistic", "index", "")] if "statistic" in data.attrs else []
            told = [("vector", "vector", axis) for axis in AXES] if "vector" in data.attrs else told
            for (statistic, name, axis), number in zip(told, np.atleast_1d(data[z, y, x]).tolist(), strict=False):
                unit = str(data.attrs["unit"])
                known = {"name": str(data.attrs[name]), "statistic": axis or str(data.attrs[statistic]), "unit": unit}
                values.append({**known, "value": number if math.isfinite(number) else None})
        count = int(cells["count"][z, y, x])
    center = (first + cell + 0.5) * size
    return {"cell": (x, y, z), "center_m": tuple(center.tolist()), "count": count, "values": values}


def _array_name(cells: Any, index: str | None, statistic: str | None) -> str:
    if statistic == "count":
        return "count"
    arrays = {
        (str(data.attrs["statistic"]), str(data.attrs["index"])): name
        for name, data in cells.items()
        if "statistic" in data.attrs
    }
    if not arrays and index is None and statistic is None:
        return "count"
    order = sorted(arrays, key=lambda key: key[0] != "maximum")  # the maximum first, then as in the file
    for found in order:
        if statistic in (None, found[0]) and index in (None, found[1]):
            return arrays[found]
    held = ", ".join(["count", *(f"{statistic} of {name}" for statistic, name in arrays)])
    raise InputError("index", f"the volume has no {statistic or 'statistic'} of {index or 'an index'}; it holds {held}")


def _layer(counts: Any, normal: int, at: float | None, size: float, first: int) -> int:
    layers = counts.shape[2 - normal]
    if at is None:
        across = tuple(k for k in range(3) if k != 2 - normal)
        return int(np.count_nonzero(counts[...], axis=across).argmax())
    cells = at / size - first
    if not -1e-9 <= cells <= layers + 1e-9:
        low, high = first * size, (first + layers) * size
        raise InputError("at", f"the plane {AXES[normal]} = {at:g} m misses the workspace, {low:g} … {high:g} m")
    return min(max(int(np.floor(cells + 1e-9)), 0), layers - 1)


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
