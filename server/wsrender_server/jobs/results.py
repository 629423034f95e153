"""Files of results, and models: the part of the store whose bytes lie in the data folder."""

import contextlib
import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from sqlalchemy import Select, select
from sqlalchemy.exc import IntegrityError

from wsrender_server.jobs.database import Transactions
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.records import ArtifactRecord, JobState
from wsrender_server.jobs.tables import ArtifactFile, Job, Model


class ResultStore:
    """Artifacts and models as their owner sees them."""

    transactions: Transactions
    files: DataFolder

    def artifacts(self, owner: str, job_id: str) -> list[ArtifactRecord]:
        """Files of a succeeded job's result, ``result.json`` first; none for any other job."""
        with self.transactions.read() as session:
            rows = session.scalars(_artifacts(owner, job_id).order_by(ArtifactFile.position))
            return [ArtifactRecord(**row.record) for row in rows]

    def artifact_path(self, owner: str, job_id: str, name: str) -> Path | None:
        """File of an artifact; None where the job has none of that name."""
        with self.transactions.read() as session:
            row = session.scalar(_artifacts(owner, job_id).where(ArtifactFile.name == name))
            return None if row is None else self.files.artifact(row.computation_id, row.sha256)

    def result_document(self, owner: str, job_id: str) -> dict[str, Any] | None:
        """The result document of a succeeded job; None where there is none, or no more."""
        path = self.artifact_path(owner, job_id, "result.json")
        try:
            return None if path is None else json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:  # the job was deleted a moment ago
            return None

    def put_model(self, owner: str, content: bytes) -> str:
        """Keep an uploaded model for its owner; its SHA-256. Raises DiskFull."""
        sha256 = self.files.put_model(content)
        # IntegrityError: the same model arrived twice at once, and is kept.
        with contextlib.suppress(IntegrityError), self.transactions.write() as session:
            if session.get(Model, (owner, sha256)) is None:
                session.add(Model(owner=owner, sha256=sha256, bytes=len(content), created_at=datetime.now(UTC)))
        return sha256

    def get_model(self, owner: str, sha256: str) -> bytes | None:
        """A model that the owner uploaded."""
        with self.transactions.read() as session:
            known = session.get(Model, (owner, sha256)) is not None
        return self.files.model(sha256).read_bytes() if known else None


def _artifacts(owner: str, job_id: str) -> Select[ArtifactFile]:
    return (
        select(ArtifactFile)
        .join(Job, Job.computation_id == ArtifactFile.computation_id)
        .where(Job.id == job_id, Job.owner == owner, Job.state == JobState.SUCCEEDED)
    )
