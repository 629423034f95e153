"""A server without workers: its jobs wait until a test lets them run, succeed with a given result, or fail."""

from pathlib import Path
from typing import Any

from sqlalchemy import select
from wsrender_server.jobs.records import ArtifactRecord, Progress, WorkerRecord
from wsrender_server.jobs.store import JobStore
from wsrender_server.jobs.tables import Computation, Job

from wsrender.results.export.artifacts import sha256
from wsrender.results.export.formats import media_type

HOST = "http://127.0.0.1"
DOCUMENT = {
    "analysis": "workspace",
    "robot": {"library": "scara"},
    "sampling": {"method": "grid", "per_joint": 4},
    "indices": ["manipulability"],
    "voxel_size_m": 0.05,
    "keep_map": True,
    "device": "cpu",
}


class IdleJobs:
    """The jobs of a server whose workers do nothing."""

    def __init__(self, store: JobStore):
        self.store = store
        self.started = self.scheduler_ready = self.worker_ready = False
        self.waits_for = lambda device: "waiting for a free worker"

    def start(self) -> None:
        self.started = self.scheduler_ready = self.worker_ready = True

    def stop(self) -> None:
        self.started = False

    def workers(self) -> list[WorkerRecord]:
        return [WorkerRecord("tls://127.0.0.1:1", "127.0.0.1", "cpu:x86", ("cpu",), busy=False)]

    def complete(self, job_id: str, folder: Path) -> None:
        """Let a job succeed with the files of a result folder."""
        computation, attempt = self._computation(job_id)
        self.store.begin(computation, attempt)
        self.store.complete(computation, attempt, [self._keep(computation, path, folder) for path in _files(folder)])

    def begin(self, job_id: str, done: int = 0, total: int = 64) -> None:
        """Let a job run, and report its progress."""
        computation, attempt = self._computation(job_id)
        self.store.begin(computation, attempt)
        self.store.report({computation: Progress(done / total, done, total, 10.0, 1.0, "samples")})

    def fail(self, job_id: str, error: dict[str, Any]) -> None:
        """Let a job fail."""
        computation, attempt = self._computation(job_id)
        self.store.begin(computation, attempt)
        self.store.fail(computation, attempt, error)

    def _computation(self, job_id: str) -> tuple[str, int]:
        query = select(Computation.id, Computation.attempt).join(Job, Job.computation_id == Computation.id)
        with self.store.transactions.read() as session:
            computation, attempt = session.execute(query.where(Job.id == job_id)).one()
        return computation, attempt

    def _keep(self, computation: str, path: Path, folder: Path) -> ArtifactRecord:
        digest = sha256(path)
        target = self.store.files.artifact(computation, digest)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(path.read_bytes())
        name = path.relative_to(folder).as_posix()
        return ArtifactRecord(name, media_type(name), path.stat().st_size, digest)


def _files(folder: Path) -> list[Path]:
    return sorted((path for path in folder.rglob("*") if path.is_file()), key=lambda path: path.name != "result.json")


def problem_of(response: Any, status: int, code: str | None = None) -> dict[str, Any]:
    """The problem document of a response, checked for its form."""
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == "application/problem+json"
    problem = response.json()
    assert problem["status"] == status and problem["title"] and problem["detail"]
    assert problem["request_id"] == response.headers["x-request-id"]
    assert isinstance(problem["retryable"], bool)
    assert problem["type"].endswith(problem["code"])
    if code is not None:
        assert problem["code"] == code
    return problem
