"""A job server, as seen from Python."""

import math
import uuid
from collections.abc import Iterator, Mapping
from io import BytesIO
from pathlib import Path
from typing import Any, Self
from urllib.parse import quote

import httpx2

from wsrender.client.batch import Batch
from wsrender.client.connection import Connection
from wsrender.client.job import Job
from wsrender.client.kinetostatic_stream import KinetostaticStream
from wsrender.documents.arm import FILED, OF_POINTS, dotted, models_in
from wsrender.documents.array_files import TABLE_TYPES
from wsrender.documents.problems import path_text
from wsrender.documents.shapes import MEDIA_TYPES
from wsrender.errors import DocumentError, InputError
from wsrender.keywords import keywords

PAGE = 100  # jobs in one answer
LONGEST_SENT = 100_000  # numbers of an array that a document lists
NPY, ZIP = b"\x93NUMPY", b"PK"  # with which such files begin


@keywords
class Client:
    """A connection to a job server; a context manager.

    ``url`` is the server's address, ``token`` an API key where it asks for one. ``timeout_s`` bounds the wait for an
    answer, ``patience_s`` for how long a request is sent again while the connection is lost.

    Every method raises ServerConnectionError where the server cannot be reached, AccessError for a wrong key,
    NotFoundError, QuotaError, and the errors of a local run (DocumentError, ModelError, …) for a wrong document.
    """

    def __init__(
        self,
        url: str = "http://127.0.0.1:8000",
        token: str | None = None,
        *,
        timeout_s: float = 30.0,
        patience_s: float = 60.0,
        transport: httpx2.BaseTransport | None = None,
    ):
        self._url, self._token, self._timeout_s = url, token, timeout_s
        self._connection = Connection(url, token, timeout_s, patience_s, transport)

    def close(self) -> None:
        """Close all sockets."""
        self._connection.close()

    def __repr__(self) -> str:
        return f"Client({self._url!r})"

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def analyses(self) -> list[dict[str, Any]]:
        """The analyses of the server: id, title, description and JSON Schema of their documents."""
        return _items(self._get("/v1/analyses"))

    def robots(self) -> list[dict[str, Any]]:
        """The robots of the server's library."""
        return _items(self._get("/v1/robots"))

    def workers(self) -> list[dict[str, Any]]:
        """The workers that compute for the server: address, host, target, devices, busy."""
        return _items(self._get("/v1/workers"))

    def upload_model(self, model: str | Path | bytes, field: str = "robot.path") -> str:
        """Upload an MJCF or URDF file, or its bytes; the SHA-256 for ``robot: {"model": sha256}``.

        Meshes and included files travel in a ZIP alone, its .zip file, its bytes, or a folder, of which one is made;
        beside a model by itself, geometry that needs meshes is dropped by the server. A mesh (.stl, .obj, .ply) that
        is a shape by itself is uploaded alike, for ``{"shape": "mesh", "model": sha256}``, as are heights (.npy) and
        tables (.csv, .parquet, .npy) of targets, configurations and points, for ``"targets": {"model": sha256}``.
        Raises InputError, naming ``field``, where the file cannot be read, ModelError where it is no model.
        """
        content = model if isinstance(model, bytes) else _read(Path(model), field)
        headers = {"Content-Type": _media_type(model, content)}
        answer = self._connection.request("POST", "/v1/models", content=content, headers=headers)
        return answer.json()["sha256"]

    def submit(
        self,
        job: Any,
        *,
        labels: Mapping[str, str] | None = None,
        priority: int = 0,
        timeout_s: float | None = None,
        idempotency_key: str | None = None,
    ) -> Job:
        """Submit a job document (dict) or typed job; files given by path are uploaded first.

        So are NumPy arrays of more than 100,000 numbers that are ``configurations`` or ``points``: the document names
        them by their hash.
        ``labels`` are free text to find the job by, larger ``priority`` goes first, ``timeout_s`` bounds the run. The
        idempotency key (default: a new one) makes sure that a request sent again after a lost connection is one job.
        """
        body = self._document(job)
        if labels:
            body["labels"] = dict(labels)
        if priority:
            body["priority"] = priority
        if timeout_s is not None:
            body["timeout_s"] = timeout_s
        headers = {"Idempotency-Key": idempotency_key or uuid.uuid4().hex}
        return Job(self._connection, self._connection.request("POST", "/v1/jobs", json=body, headers=headers).json())

    def batch(self, *, at_once: int = 8, cancel: bool = False) -> Batch:
        """Many jobs, submitted and waited for ``at_once`` (1 to 64) at a time.

        A context manager, whose ``submit`` gives the future of a result. Left by an exception, such as Ctrl-C, it lets
        its jobs go on at the server; with ``cancel`` it stops them. Raises InputError.
        """
        return Batch(self.submit, at_once, cancel)

    def estimate(self, job: Any) -> dict[str, Any]:
        """Check a job without running it: samples, bytes and seconds that it would take."""
        return self._connection.request("POST", "/v1/jobs:validate", json=self._document(job)).json()

    def job(self, id: str) -> Job:
        """The job of that id. Raises NotFoundError."""
        return Job(self._connection, self._get(f"/v1/jobs/{quote(id, safe='')}"))

    def jobs(
        self,
        *,
        state: str | None = None,
        analysis: str | None = None,
        label: tuple[str, str] | None = None,
        limit: int | None = None,
    ) -> Iterator[Job]:
        """Your jobs, newest first, page by page; ``limit`` bounds their number."""
        filters = {"state": state, "analysis": analysis, "label": "=".join(label) if label else None}
        params: dict[str, Any] = {name: value for name, value in filters.items() if value is not None}
        left = limit
        while left is None or left > 0:
            params["limit"] = PAGE if left is None else min(PAGE, left)
            page = self._get("/v1/jobs", params)
            for record in page["items"][:left]:
                yield Job(self._connection, record)
            left = None if left is None else left - len(page["items"])
            params["cursor"] = page.get("next_cursor")
            if params["cursor"] is None:
                return

    def kinetostatic_stream(self, robot: Any, **choices: Any) -> KinetostaticStream:
        """A live stream of a robot's limits and conditioning as forces; a context manager (extra ``stream``).

        ``robot`` is the name of a library robot or its part of a job document; ``choices`` are the other fields of the
        message ``open``: field (which forces, as in `wsrender.force_field`), input ("configuration" or "pose"), base,
        tip, start, cues, stale_after_s, rise_s. Raises what the server refuses: DocumentError, ModelError,
        AccessError, QuotaError; MissingExtraError without the package websockets.
        """
        document = self._document({"robot": {"library": robot} if isinstance(robot, str) else robot, **choices})
        return KinetostaticStream(self._url, self._token, document, self._timeout_s)

    def _get(self, path: str, params: dict[str, Any] | None = None) -> Any:
        return self._connection.request("GET", path, params=params or {}).json()

    def _document(self, job: Any) -> dict[str, Any]:
        if not isinstance(job, Mapping) and not hasattr(job, "model_dump"):
            raise InputError("job", f"must be a job document (dict) or a typed job, not {type(job).__name__}")
        document = _plain(self._with_uploads(job) if isinstance(job, Mapping) else job)
        for name in FILED:
            if isinstance(document.get(name), str):
                document[name] = {"path": document[name]}
        for path, robot in models_in(document):
            if isinstance(robot.get("path"), str):
                field = dotted(path, "path")
                model = _expanded(robot, field)
                robot["model"] = self.upload_model(robot["path"] if model is None else model, field)
                for name in ("path", "packages", "xacro"):
                    robot.pop(name, None)
        return document

    def _with_uploads(self, job: Mapping[str, Any]) -> dict[str, Any]:
        """The document with long arrays of configurations and points uploaded."""
        document = dict(job)
        if content := _long_array(document.get("configurations")):
            document["configurations"] = {"model": self.upload_model(content, "configurations")}
        for name in OF_POINTS:
            points = document.get(name)
            if (
                isinstance(points, Mapping)
                and points.keys() == {"points"}
                and (content := _long_array(points["points"]))
            ):
                document[name] = {"model": self.upload_model(content, dotted((name,), "points"))}
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


def _items(answer: Any) -> list[dict[str, Any]]:
    return answer["items"]


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
