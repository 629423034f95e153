"""Views of results and robots: manifests and blobs as files, made in the side process when they are first asked for."""

import asyncio
import contextlib
import hashlib
import json
import os
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any
from weakref import WeakValueDictionary

from pydantic import TypeAdapter

from wsrender import __version__
from wsrender.documents.reading import read_document
from wsrender.errors import InputError
from wsrender.results.export.artifacts import NAMED_PARTS, PARTS, named_files, part_file
from wsrender.results.export.atomic import new_file
from wsrender.results.result import Result
from wsrender.results.view.blobs import ENCODINGS, Encoding
from wsrender.results.view.container import message
from wsrender_server.conversions import result_document
from wsrender_server.jobs.files import DataFolder
from wsrender_server.problems import HttpProblem
from wsrender_server.side_process import SideProcess

if TYPE_CHECKING:
    from wsrender.results.view import View

MOST_KEPT = 64  # views
MOST_KEPT_BYTES = 2 << 30
AT_ONCE_BYTES = 16 << 20  # of blobs that are written with a manifest, the smallest first
MOST_PREVIEW_BYTES = 64 << 20
TIMEOUT_S = 300.0
MANIFEST = "manifest."  # begins the names of the files of manifests; no blob is called so
FILES = "artifacts/"  # where a result's files are, from where its view is


@dataclass(frozen=True)
class Shown:
    """What a view is of: a library robot, or a job: the file of its result document and its SHA-256, files by name."""

    robot: str | None = None
    result: str | None = None
    sha256: str | None = None
    files: Mapping[str, str] | None = None

    @property
    def key(self) -> str:
        """The same for equal views, of this version."""
        return hashlib.sha256(json.dumps([__version__, self.robot, self.sha256]).encode()).hexdigest()


def data_files(names: list[str]) -> list[str]:
    """Of the files of a result those that a view is made of: not the whole map where there is a sample of it."""
    parts = [part_file(part) for part in PARTS]
    named = [file for part in NAMED_PARTS for file in named_files(part, names).values()]
    left_out = {part_file("map")} if part_file("sample") in names else set()
    return [name for name in dict.fromkeys([*parts, *named]) if name in names and name not in left_out]


class Views:
    """Views in the folder ``views`` of the data folder; those not used for longest are removed where there are many."""

    def __init__(self, files: DataFolder, side_process: SideProcess):
        self._files = files
        self._root = files.root / "views"
        self._side_process = side_process
        self._turns: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()
        self._making_room = asyncio.Lock()
        self._warming: asyncio.Task[None] | None = None

    def warm(self) -> None:
        """Start the side process, and let it load what makes views, for who will soon ask for one; returns at once."""
        if self._warming is None:
            self._warming = asyncio.create_task(self._warmed())

    async def _warmed(self) -> None:
        with contextlib.suppress(HttpProblem):  # who asks for a view will be told
            await self._side_process.run(load, timeout_s=TIMEOUT_S)

    async def manifest(self, owner: str, shown: Shown, encoding: Encoding) -> Path:
        """The file of a manifest whose channels are in an encoding. Raises HttpProblem, DiskFull."""
        return await self._made(owner, shown, f"{MANIFEST}{encoding}.json")

    async def blob(self, owner: str, shown: Shown, name: str) -> Path:
        """The file of a blob. Raises HttpProblem for one that there is not, DiskFull."""
        return await self._made(owner, shown, name)

    async def preview(self, owner: str, edited: bytes) -> bytes:
        """The view of a robot or an environment that is edited, as one message. Raises HttpProblem."""
        return await self._side_process.run(preview, edited, owner=owner, timeout_s=TIMEOUT_S)

    async def _made(self, owner: str, shown: Shown, name: str) -> Path:
        folder = self._root / shown.key
        path = folder / name
        if not await asyncio.to_thread(_used, path):
            # Requests of a view come one after another: equal ones find the file that the first of them makes.
            async with self._turns.setdefault(f"{owner} {shown.key}", asyncio.Lock()):
                if not await asyncio.to_thread(_used, path):
                    async with self._making_room:
                        await asyncio.to_thread(self._make_room, folder)
                    part = shown, str(folder), name
                    await self._side_process.run(write_part, *part, owner=owner, timeout_s=TIMEOUT_S)
        return path

    def _make_room(self, folder: Path) -> None:
        self._files.check_space()
        folder.mkdir(parents=True, exist_ok=True)
        kept = 0
        for number, old in enumerate(
            sorted(self._root.iterdir(), key=lambda each: (each == folder, _last_used(each)), reverse=True)
        ):
            kept += sum(file.stat().st_size for file in old.iterdir())
            if old != folder and (number >= MOST_KEPT or kept > MOST_KEPT_BYTES):
                shutil.rmtree(old, ignore_errors=True)


def _used(path: Path) -> bool:
    """Whether a file is there; its folder was used now."""
    try:
        os.utime(path.parent)
        return path.is_file()
    except FileNotFoundError:
        return False


def _last_used(folder: Path) -> float:
    return folder.stat().st_mtime


_last: "dict[tuple[str, Encoding], View]" = {}


def write_part(shown: Shown, folder: str, name: str) -> None:
    """Write a manifest, with the smallest of its blobs, or a blob of a view to a folder.

    The view is kept until another is asked for. Raises InputError for a blob that there is not.
    """
    encoding: Encoding | None = next((each for each in ENCODINGS if name == f"{MANIFEST}{each}.json"), None)
    view = _view(shown, encoding)
    if encoding is None:
        if name not in view.blobs:
            raise InputError("blob", f"the view has no {name!r}")
        _write(Path(folder) / name, view.blobs[name])
        return
    left = AT_ONCE_BYTES
    for size, blob in sorted((size_of(data), data["blob"]) for data in data_in(view.manifest)):
        left -= size
        if left >= 0 and not (path := Path(folder) / blob).exists():
            _write(path, view.blobs[blob])
    _write(Path(folder) / name, json.dumps(view.manifest, allow_nan=False).encode())


def load() -> None:
    """Make a small view, so that all is loaded that views are made with."""
    from wsrender.results.view import robot_view

    view = robot_view("scara")
    _ = [view.blobs[data["blob"]] for data in data_in(view.manifest)]


def preview(edited: bytes) -> bytes:
    """The view of an admitted text of an `Edited` as one message: its manifest as header, with its blobs.

    Raises InputError, ModelError for what cannot be had; InputError for one of too many bytes.
    """
    from wsrender.results.view import Edited, edited_view  # heavy: the side process has it alone

    view = edited_view(read_document(edited, TypeAdapter(Edited)))
    size = sum(map(size_of, data_in(view.manifest)))
    if size > MOST_PREVIEW_BYTES:
        raise InputError("robot", f"its shapes take {size} bytes; a preview has {MOST_PREVIEW_BYTES}")
    names = [data["blob"] for data in data_in(view.manifest)]
    return message({"manifest": view.manifest}, {name: view.blobs[name] for name in names})


def _write(path: Path, content: bytes) -> None:
    with new_file(path) as temporary:
        temporary.write_bytes(content)


def _view(shown: Shown, encoding: Encoding | None) -> "View":
    """A view, of an encoding, or any: blobs are there in all."""
    from wsrender.results.view import robot_view

    found = next((view for (key, each), view in _last.items() if key == shown.key and encoding in (None, each)), None)
    if found is None:
        encoding = encoding or "float16"
        found = robot_view(shown.robot) if shown.result is None else _of_result(shown, encoding)
        _last.clear()
        _last[shown.key, encoding] = found
    return found


def _of_result(shown: Shown, encoding: Encoding) -> "View":
    from wsrender.results.view import view_of

    paths = {name: Path(path) for name, path in (shown.files or {}).items()}
    document = result_document(shown.result or "")
    return view_of(Result.of_files(document, paths), encoding=encoding, pictures=FILES)


def data_in(part: Any) -> list[Any]:
    """Every entry of a blob in a part of a manifest."""
    if isinstance(part, dict):
        inner = [each for value in part.values() for each in data_in(value)]
        return [part] if "blob" in part else inner
    return [each for value in part for each in data_in(value)] if isinstance(part, list) else []


def size_of(data: Mapping[str, Any]) -> int:
    """Bytes of a blob."""
    return int(data["length"]) * {"glb": 1, "uint8": 1, "uint16": 2, "float16": 2}.get(data["type"], 4)
