"""Artifacts: the files beside a result document, and the record that the document keeps of each."""

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from wsrender.errors import InputError
from wsrender.results.export.formats import kept, media_type

DOCUMENT = "result.json"
# Parts of a result and what they hold, each in a file of its name; and those of which there may be several, by name.
PARTS = {"map": "table", "sample": "table", "volume": "volume", "skeleton": "skeleton"}
NAMED_PARTS = {"meshes": "mesh", "tables": "table", "volumes": "volume"}


@dataclass(frozen=True)
class Artifact:
    """A file to be written: its name in the result folder, what writes it, and what it holds."""

    name: str
    write: Callable[[Path], Any]
    shape: tuple[int, ...] | None = None
    units: dict[str, str] = field(default_factory=dict)
    frame: str | None = "world"


def write_artifacts(artifacts: Iterable[Artifact], folder: Path) -> list[dict[str, Any]]:
    """Write each artifact under ``folder``; the records for the result document."""
    return [_written(artifact, folder) for artifact in artifacts]


def _written(artifact: Artifact, folder: Path) -> dict[str, Any]:
    path = folder / artifact.name
    path.parent.mkdir(exist_ok=True)
    artifact.write(path)
    return {
        "name": artifact.name,
        "media_type": media_type(artifact.name),
        "bytes": path.stat().st_size,
        "sha256": sha256(path),
        "shape": None if artifact.shape is None else list(artifact.shape),
        "units": artifact.units,
        "frame": artifact.frame,
    }


def sha256(path: Path) -> str:
    """SHA-256 of a file, hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def write_document(document: dict[str, Any], path: Path) -> dict[str, Any]:
    """Write a result document as JSON; returns it as it will be read: plain lists, numbers and strings.

    Raises InputError for values that JSON does not have, NaN and infinity included.
    """
    try:
        text = json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False, default=_plain)
    except (TypeError, ValueError) as error:
        raise InputError("document", f"cannot be written as JSON: {error}") from error
    path.write_text(text + "\n", encoding="utf-8")
    return json.loads(text)


def _plain(value: Any) -> Any:
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is not a JSON type")


def read_document(folder: Path) -> dict[str, Any]:
    """The result document in a folder; InputError where it is missing or not one."""
    path = folder / DOCUMENT
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise InputError(DOCUMENT, f"is missing in {folder}: not a result folder") from error
    except (OSError, ValueError) as error:
        raise InputError(DOCUMENT, f"cannot be read: {error}") from error
    if not isinstance(document, dict):
        raise InputError(DOCUMENT, f"holds {type(document).__name__}, not a result document")
    return document


def verified_artifacts(document: dict[str, Any], folder: Path) -> dict[str, Path]:
    """Paths of the artifacts that a document lists, by name.

    Raises InputError, naming the file, where one is missing, changed, or outside the folder.
    """
    paths = {}
    for name, record in artifact_records(document):
        path = folder / name
        if not path.is_file():
            raise InputError(name, f"is listed in {DOCUMENT} but missing in {folder}")
        if sha256(path) != record.get("sha256"):
            raise InputError(name, f"has changed since it was saved: its SHA-256 is not that in {DOCUMENT}")
        paths[name] = path
    return paths


def artifact_records(document: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """(name, record) of every artifact that a document lists; InputError for names outside its folder."""
    artifacts = document.get("artifacts", [])
    if not isinstance(artifacts, list):
        raise InputError("artifacts", f"must be a list, not {type(artifacts).__name__}")
    for record in artifacts:
        name = record.get("name") if isinstance(record, dict) else None
        if not isinstance(name, str) or not _stays_inside(name):
            raise InputError("artifacts", f"{name!r} is not the name of a file in the result folder")
        yield name, record


def part_file(part: str) -> str:
    """Name of the file that holds a part of ``PARTS``."""
    return kept(PARTS[part]).file(part)


def named_files(part: str, names: Iterable[str]) -> dict[str, str]:
    """By name, such as ``scan`` → ``scan.parquet``, the files that hold a part of ``NAMED_PARTS``.

    The map, its sample and the volume are parts of their own; folders hold pictures.
    """
    ending, own = kept(NAMED_PARTS[part]).file(""), {part_file(each) for each in PARTS}
    named = (name for name in names if name.endswith(ending) and "/" not in name and name not in own)
    return {name.removesuffix(ending): name for name in named}


def _stays_inside(name: str) -> bool:
    parts = PurePosixPath(name).parts
    plain = not set(name) & {"\\", ":", "\0"}
    return bool(parts) and plain and not name.startswith("/") and ".." not in parts


def publish(staging: Path, target: Path) -> None:
    """Move a finished result from its staging folder to ``target``.

    A new target appears by one rename. In a folder that exists, the document goes first and comes last, so
    that one is never seen beside files of another; files of the result before are removed, others stay.
    """
    if not target.exists():
        staging.rename(target)
        return
    _remove_previous(target)
    files = sorted(path.relative_to(staging) for path in staging.rglob("*") if path.is_file())
    for name in sorted(files, key=lambda name: name.as_posix() == DOCUMENT):
        (target / name).parent.mkdir(exist_ok=True)
        (staging / name).replace(target / name)


def _remove_previous(target: Path) -> None:
    try:
        names = [name for name, _ in artifact_records(read_document(target))]
    except InputError:  # none there, or none of ours
        names = []
    for name in (DOCUMENT, *names):
        (target / name).unlink(missing_ok=True)
