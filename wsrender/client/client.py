"""A job server, as seen from Python."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Literal, Self

import httpx2

from wsrender.client import operations
from wsrender.client.batch import Batch
from wsrender.client.connection import Connection
from wsrender.client.documents import uploaded
from wsrender.client.job import Job
from wsrender.client.kinetostatic_stream import KinetostaticStream
from wsrender.client.records import Analysis, Estimate, JobDocument, JobState, LibraryRobot, Worker
from wsrender.keywords import keywords


@keywords
class Client:
    """A connection to a job server; a context manager. `AsyncClient` is the same for asyncio.

    ``url`` is the server's address, ``token`` an API key where it asks for one. ``timeout_s`` bounds the wait for an
    answer, ``patience_s`` for how long a request is sent again while the connection is lost.

    Every method raises ServerConnectionError where the server cannot be reached or the client is closed, AccessError
    for a wrong key, NotFoundError, QuotaError, and the errors of a local run (DocumentError, ModelError, …) for a wrong
    document; ServerError, with both versions where it can, for an answer that this version does not understand.
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
        self._token = token
        self._connection = Connection(url, token, timeout_s, patience_s, transport)
        self._server = self._connection.server

    def close(self) -> None:
        """Close all sockets."""
        self._connection.close()

    def __repr__(self) -> str:
        return f"Client({self._server.url!r})"

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def analyses(self) -> list[Analysis]:
        """The analyses of the server: id, title, description and JSON Schema of their documents."""
        return self._connection.run(operations.listed(self._server, "/v1/analyses"))

    def robots(self) -> list[LibraryRobot]:
        """The robots of the server's library."""
        return self._connection.run(operations.listed(self._server, "/v1/robots"))

    def workers(self) -> list[Worker]:
        """The workers that compute for the server: address, host, target, devices, busy."""
        return self._connection.run(operations.listed(self._server, "/v1/workers"))

    def upload_model(self, model: str | Path | bytes, field: str = "robot.path") -> str:
        """Upload an MJCF or URDF file, or its bytes; the SHA-256 for ``robot: {"model": sha256}``.

        Meshes and included files travel in a ZIP alone, its .zip file, its bytes, or a folder, of which one is made;
        beside a model by itself, geometry that needs meshes is dropped by the server. A mesh (.stl, .obj, .ply) that
        is a shape by itself is uploaded alike, for ``{"shape": "mesh", "model": sha256}``, as are heights (.npy) and
        tables (.csv, .parquet, .npy) of targets, configurations and points, for ``"targets": {"model": sha256}``.
        Raises InputError, naming ``field``, where the file cannot be read, ModelError where it is no model.
        """
        return self._connection.run(uploaded(self._server, model, field))

    def submit(
        self,
        job: JobDocument,
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
        steps = operations.submitted(self._server, job, labels, priority, timeout_s, idempotency_key)
        return Job(self._connection, self._connection.run(steps))

    def batch(self, *, at_once: int = 8, cancel: bool = False) -> Batch:
        """Many jobs, submitted and waited for ``at_once`` (1 to 64) at a time.

        A context manager, whose ``submit`` gives the future of a result. Left by an exception, such as Ctrl-C, it lets
        its jobs go on at the server; with ``cancel`` it stops them. Raises InputError.
        """
        return Batch(self.submit, at_once, cancel)

    def estimate(self, job: JobDocument) -> Estimate:
        """Check a job without running it: samples, bytes and seconds that it would take."""
        return self._connection.run(operations.estimated(self._server, job))

    def job(self, id: str) -> Job:
        """The job of that id, whichever program submitted it. Raises NotFoundError."""
        return Job(self._connection, self._connection.run(operations.looked_at(self._server, id)))

    def jobs(
        self,
        *,
        state: JobState | None = None,
        analysis: str | None = None,
        label: tuple[str, str] | None = None,
        robot: str | None = None,
        limit: int | None = None,
    ) -> Iterator[Job]:
        """Your jobs, newest first, page by page; ``robot`` is a part of a name, ``limit`` bounds their number."""
        page = operations.first_page(state, analysis, label, robot, limit)
        while page is not None:
            records, page = self._connection.run(operations.page_of_jobs(self._server, page))
            for record in records:
                yield Job(self._connection, record)

    def kinetostatic_stream(
        self,
        robot: str | Mapping[str, object],
        *,
        field: Mapping[str, object] | None = None,
        input: Literal["configuration", "pose"] | None = None,
        base: str | None = None,
        tip: str | None = None,
        start: Sequence[float] | None = None,
        cues: Mapping[str, object] | None = None,
        stale_after_s: float | None = None,
        rise_s: float | None = None,
    ) -> KinetostaticStream:
        """A live stream of a robot's limits and conditioning as forces; a context manager (extra ``stream``).

        ``robot`` is the name of a library robot or its part of a job document. ``field`` says which forces, as in
        `wsrender.force_field`, ``input`` what samples hold, ``start`` the configuration [rad or m] from which the first
        pose is solved, ``cues`` what is felt besides the force; after ``stale_after_s`` of silence [s] the force is
        zero, and rises again in ``rise_s`` [s]. Raises what the server refuses: DocumentError, ModelError, AccessError,
        QuotaError; MissingExtraError without the package websockets.
        """
        chosen = {"field": field, "input": input, "base": base, "tip": tip, "start": start, "cues": cues}
        steps = operations.stream_document(
            self._server, robot, {**chosen, "stale_after_s": stale_after_s, "rise_s": rise_s}
        )
        return KinetostaticStream(self._server.url, self._token, self._connection.run(steps), self._server.timeout_s)
