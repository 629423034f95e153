"""Job documents as they are sent: plain data, with the files and long arrays that they name uploaded before."""

import math
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

from wsrender.client.records import JobDocument
from wsrender.client.requests import Request, Server, Steps, answer, member
from wsrender.documents.arm import FILED, OF_POINTS, dotted, models_in
from wsrender.documents.array_files import TABLE_TYPES
from wsrender.documents.problems import path_text
from wsrender.documents.shapes import MEDIA_TYPES
from wsrender.errors import DocumentError, InputError

LONGEST_SENT = 100_000  # numbers of an array that a document lists
NPY, ZIP = b"\x93NUMPY", b"PK"  # with which such files begin


def uploaded(server: Server, model: str | Path | bytes, field: str) -> Steps[str]:
    """The SHA-256 of a file or its bytes, uploaded."""
    content = model if isinstance(model, bytes) else _read(Path(model), field)
    headers = {"Content-Type": _media_type(model, content)}
    request = Request("POST", "/v1/models", headers=headers, content=content)
    return member(server, request, (yield from answer(server, request)), "sha256", str)


def sendable(server: Server, job: JobDocument) -> Steps[dict[str, Any]]:
    """The document of a job as it is sent. Raises InputError for what is no job, DocumentError naming the field."""
    if not isinstance(job, Mapping) and not hasattr(job, "model_dump"):
        raise InputError("job", f"must be a job document (dict) or a typed job, not {type(job).__name__}")
    document = _plain((yield from _with_uploads(server, job)) if isinstance(job, Mapping) else job)
    for name in FILED:
        if isinstance(document.get(name), str):
            document[name] = {"path": document[name]}
    for path, robot in models_in(document):
        if isinstance(robot.get("path"), str):
            field = dotted(path, "path")
            model = _expanded(robot, field)
            robot["model"] = yield from uploaded(server, robot["path"] if model is None else model, field)
            for name in ("path", "packages", "xacro"):
                robot.pop(name, None)
    return document


def _with_uploads(server: Server, job: Mapping[str, Any]) -> Steps[dict[str, Any]]:
    """The document with long arrays of configurations and points uploaded."""
    document = dict(job)
    if content := _long_array(document.get("configurations")):
        document["configurations"] = {"model": (yield from uploaded(server, content, "configurations"))}
    for name in OF_POINTS:
        points = document.get(name)
        if isinstance(points, Mapping) and points.keys() == {"points"} and (content := _long_array(points["points"])):
            document[name] = {"model": (yield from uploaded(server, content, dotted((name,), "points")))}
    return document


def _long_array(value: Any) -> bytes | None:
    """The .npy file of a NumPy array that is too long for a document; None of anything else, which is sent as it is."""
    import numpy as np

    if not isinstance(value, np.ndarray) or value.size <= LONGEST_SENT or value.ndim != 2:
        return None
    if value.dtype.kind not in "fiu" or value.dtype.itemsize > 8 or not np.isfinite(value).all():
        return None  # what is wrong with it is told by its place
    file = BytesIO()
    np.save(file, value, allow_pickle=False)
    return file.getvalue()


def _plain(document: Any) -> Any:
    """The document as JSON has it, NumPy's numbers and arrays written out. Raises DocumentError naming the field."""

    def plain(value: Any, *path: str | int) -> Any:
        if hasattr(value, "tolist"):
            value = value.tolist()
        elif hasattr(value, "model_dump"):
            value = value.model_dump(mode="json")
        elif isinstance(value, Path):
            value = str(value)
        if isinstance(value, Mapping):
            return {key: plain(each, *path, str(key)) for key, each in value.items()}
        if isinstance(value, list | tuple):
            return [plain(each, *path, k) for k, each in enumerate(value)]
        if isinstance(value, float) and not math.isfinite(value):
            raise DocumentError([(path_text(*path), f"must be a finite number, not {value}")])
        if value is None or isinstance(value, str | int | float):
            return value
        raise DocumentError(
            [(path_text(*path), f"must be plain data, not {type(value).__name__}: a server runs no code")]
        )

    return plain(document)


def _expanded(robot: Mapping[str, Any], field: str) -> bytes | None:
    """The URDF of a xacro file, which a server does not expand; None of another file."""
    path = Path(robot["path"])
    if path.suffix.lower() != ".xacro" and not robot.get("xacro"):
        return None
    from wsrender.robots import xacro_files

    return xacro_files.expanded(path, robot.get("xacro") or {}, robot.get("packages") or {}, field)


def _media_type(model: str | Path | bytes, content: bytes) -> str:
    if content[:2] == ZIP:
        return "application/zip"
    ending = Path(model).suffix.lower() if not isinstance(model, bytes) else ".npy" if model[:6] == NPY else ""
    return (MEDIA_TYPES | TABLE_TYPES).get(ending, "application/xml")


def _read(path: Path, field: str) -> bytes:
    if path.is_dir():
        from wsrender.robots import archives

        return archives.of_folder(path, field)
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(field, f"{path} cannot be read: {error.strerror}") from None
