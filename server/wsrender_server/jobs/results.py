"""Files of results, and models: the part of the store whose bytes lie in the data folder."""

import contextlib
import hashlib
import json
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import structlog
from sqlalchemy import Select, String, cast, delete, func, select, update
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from wsrender_server.jobs.changes import Changes
from wsrender_server.jobs.database import Transactions, lock_name
from wsrender_server.jobs.faults import InvalidTransition, QuotaExceeded, ResultExpired, StoreUnavailable
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.records import UNFINISHED, ArtifactRecord, ComputationState, JobState, ModelRecord
from wsrender_server.jobs.sole_use import check_bound
from wsrender_server.jobs.tables import ArtifactFile, Computation, Job, Model, move

USE_AGAIN = timedelta(minutes=10)

log = structlog.get_logger("wsrender.jobs")


class ResultStore:
    """Artifacts and models as their owner sees them."""

    transactions: Transactions
    files: DataFolder
    changes: Changes
    max_model_bytes_per_owner: int | None

    def artifacts(self, owner: str, job_id: str) -> list[ArtifactRecord]:
        """Files of a succeeded job's result, ``result.json`` first; none for any other job."""
        with self.transactions.read() as session:
            rows = session.scalars(_artifacts(owner, job_id).order_by(ArtifactFile.position))
            return [ArtifactRecord(**row.record) for row in rows]

    def artifact_path(self, owner: str, job_id: str, name: str) -> Path | None:
        """File of an artifact, its bytes those that were written; None where the job has none of that name.

        Where the file is lost or damaged, the job has expired now.
        """
        with self.transactions.read() as session:
            query = _artifacts(owner, job_id).where(ArtifactFile.name == name)
            columns = ArtifactFile.computation_id, ArtifactFile.sha256, Computation.attempt, Computation.used_at
            row = session.execute(query.with_only_columns(*columns)).first()
        if row is None:
            return None
        path = self.files.artifact(row.computation_id, row.sha256)
        if self.files.is_intact(path):
            self._use(row.computation_id, row.used_at)
            return path
        self._lost(row.computation_id, row.attempt, [name])
        return None

    def check_result(self, computation_id: str) -> bool:
        """Whether a result's files are as they were written; where they are not, its jobs have expired now."""
        with self.transactions.read() as session:
            rows = session.execute(
                select(ArtifactFile.name, ArtifactFile.sha256, Computation.attempt)
                .join(Computation, Computation.id == ArtifactFile.computation_id)
                .where(Computation.id == computation_id)
            ).all()
        lost = [row.name for row in rows if not self.files.is_intact(self.files.artifact(computation_id, row.sha256))]
        if lost:
            self._lost(computation_id, rows[0].attempt, lost)
        return not lost

    def expire(self, computation_id: str, attempt: int, reason: str) -> bool:
        """Keep a result no longer: its jobs have expired, and can be retried. False where the attempt has none."""
        message = f"{reason}; retry the job to compute it again"
        fault = {"code": ResultExpired.code, "message": message, "retryable": True}
        with self.transactions.write() as session:
            row = session.get(Computation, computation_id, with_for_update=True)
            if row is None or (row.state, row.attempt) != (ComputationState.SUCCEEDED, attempt):
                return False
            row.state, row.resolved, row.target = ComputationState.EXPIRED, None, None
            session.execute(delete(ArtifactFile).where(ArtifactFile.computation_id == computation_id))
            query = select(Job).where(Job.computation_id == computation_id, Job.state == JobState.SUCCEEDED)
            jobs = list(session.scalars(query))
            for job in jobs:
                move(session, job, JobState.EXPIRED, fault)
            ids = [job.id for job in jobs]
        self.forget_files(computation_id)
        self.changes.notify(*ids)
        return True

    def forget_files(self, computation_id: str) -> bool:
        """Remove the files that a computation needs no longer: of one that goes on none, and False is returned."""
        with self.transactions.write() as session:  # whoever retries waits, and then finds none of them
            row = session.get(Computation, computation_id, with_for_update=True)
            if row is not None and row.state in UNFINISHED:
                return False
            if row is None:
                self.files.forget(computation_id)
            elif row.state == ComputationState.SUCCEEDED:
                self.files.forget_partials(computation_id)
            else:
                self.files.forget_results(computation_id)
            return True

    def list_models(self, owner: str) -> list[ModelRecord]:
        """What an owner has uploaded, newest first."""
        with self.transactions.read() as session:
            query = select(Model).where(Model.owner == owner).order_by(Model.created_at.desc(), Model.sha256)
            return [ModelRecord(row.sha256, row.bytes, row.created_at) for row in session.scalars(query)]

    def delete_model(self, owner: str, sha256: str) -> bool:
        """Forget what an owner has uploaded; False where there is none. InvalidTransition while a job needs it."""
        with self.transactions.write() as session:
            lock_name(session, sha256)
            model = session.get(Model, (owner, sha256))
            if model is None:
                return False
            names = cast(Computation.facts, String).contains(sha256)
            needs = Computation.owner == owner, Computation.state.in_(UNFINISHED), names
            if session.scalar(select(Computation.id).where(*needs).limit(1)) is not None:
                raise InvalidTransition("used by an unfinished job", "deleted", "a model")
            session.delete(model)
        with contextlib.suppress(StoreUnavailable):  # then retention finds it
            self.forget_model_file(sha256)  # now that nothing brings the row back
        return True

    def forget_model_file(self, sha256: str) -> bool:
        """Remove the file of a model that nobody has; False where somebody has it."""
        with self.transactions.write() as session:
            lock_name(session, sha256)
            if session.scalar(select(func.count()).where(Model.sha256 == sha256)):
                return False
            self.files.model(sha256).unlink(missing_ok=True)
            return True

    def usage(self) -> dict[str, int]:
        """Bytes of all results and of all models."""
        with self.transactions.read() as session:
            succeeded = Computation.state == ComputationState.SUCCEEDED
            results = session.scalar(select(func.sum(Computation.bytes)).where(succeeded))
            models = session.scalar(select(func.sum(Model.bytes)))
        return {"results": int(results or 0), "models": int(models or 0)}

    def _use(self, computation_id: str, used_at: datetime) -> None:
        """Keep that a result is used, every few minutes: reading it must neither wait nor fail for that."""
        now = datetime.now(UTC)
        if now - used_at > USE_AGAIN:
            with contextlib.suppress(StoreUnavailable), self.transactions.write() as session:
                session.execute(update(Computation).where(Computation.id == computation_id).values(used_at=now))

    def _lost(self, computation_id: str, attempt: int, names: list[str]) -> None:
        check_bound(self.transactions, self.files)  # a folder that is not mounted has lost nothing
        if self.expire(computation_id, attempt, f"files of the result are lost or damaged: {', '.join(names)}"):
            log.error("files of a result are lost or damaged", computation_id=computation_id, names=names)

    def result_document(self, owner: str, job_id: str) -> dict[str, Any] | None:
        """The result document of a succeeded job; None where there is none, or no more. It may be long."""
        path = self.artifact_path(owner, job_id, "result.json")
        try:
            return None if path is None else json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:  # the job was deleted a moment ago
            return None

    def put_model(self, owner: str, content: bytes) -> str:
        """Keep an uploaded model for its owner; its SHA-256. Raises DiskFull, QuotaExceeded."""
        sha256 = hashlib.sha256(content).hexdigest()
        with self.transactions.read() as session:
            self._check_quota(session, owner, sha256, len(content))
        self.files.put_model(content)
        # IntegrityError: the same model arrived twice at once, and is kept.
        with contextlib.suppress(IntegrityError), self.transactions.write() as session:
            lock_name(session, f"models of {owner}")  # many at once would each find room for one
            self._check_quota(session, owner, sha256, len(content))
            lock_name(session, sha256)
            self.files.put_model(content)  # again where its last owner has deleted it in between
            if session.get(Model, (owner, sha256)) is None:
                session.add(Model(owner=owner, sha256=sha256, bytes=len(content), created_at=datetime.now(UTC)))
        return sha256

    def _check_quota(self, session: Session, owner: str, sha256: str, size: int) -> None:
        """Raise QuotaExceeded where an owner's models leave no room for one more."""
        most = self.max_model_bytes_per_owner
        if most is None:
            return
        others = Model.owner == owner, Model.sha256 != sha256
        kept = int(session.scalar(select(func.sum(Model.bytes)).where(*others)) or 0)
        if kept + size > most:
            raise QuotaExceeded(f"your models may take {most} bytes, and take {kept}; delete some of them")

    def model_path(self, owner: str, sha256: str) -> Path | None:
        """File of a model that the owner uploaded; None where it is not there, or damaged: it can be sent again."""
        with self.transactions.read() as session:
            known = session.get(Model, (owner, sha256)) is not None
        path = self.files.model(sha256)
        return path if known and self.files.is_intact(path) else None


def _artifacts(owner: str, job_id: str) -> Select[ArtifactFile]:
    return (
        select(ArtifactFile)
        .join(Job, Job.computation_id == ArtifactFile.computation_id)
        .join(Computation, Computation.id == ArtifactFile.computation_id)
        .where(Job.id == job_id, Job.owner == owner, Job.state == JobState.SUCCEEDED)
    )
