"""The job table seen by the dispatcher: computations to start, their progress, their ends."""

import time
from collections.abc import Collection, Iterable, Mapping
from contextlib import suppress
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import bindparam, delete, func, select, update
from sqlalchemy.orm import Session

from wsrender import __version__
from wsrender.analyses.jobs import parse_job
from wsrender.errors import InputError
from wsrender_server.jobs.changes import Changes
from wsrender_server.jobs.database import Transactions
from wsrender_server.jobs.documents import CanonicalDocument
from wsrender_server.jobs.faults import DiskFull
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.identity import Identity
from wsrender_server.jobs.records import (
    LIVE,
    UNFINISHED,
    ArtifactRecord,
    ComputationRecord,
    ComputationState,
    JobState,
    Progress,
    QueueSummary,
)
from wsrender_server.jobs.sole_use import SoleUse
from wsrender_server.jobs.tables import ArtifactFile, Computation, DeviceTarget, Job, enter, finish, move, report

KEEP_TIMES_S = 5.0
STATES = {str(state): state for state in ComputationState}  # of thousands of rows


class ComputationStore:
    """The dispatcher's part of the store. An attempt that is over changes nothing: every end names its attempt."""

    transactions: Transactions
    changes: Changes
    files: DataFolder
    identity: Identity
    sole_use: SoleUse
    running_since: dict[tuple[str, int], float]  # by job and attempt, of `time.monotonic`
    times_kept: float

    def unfinished(self) -> dict[str, tuple[ComputationState, int]]:
        """State and attempt of the computations that wait, run or are to stop, the most urgent first."""
        query = select(Computation.id, Computation.state, Computation.attempt)
        query = query.where(Computation.state.in_(UNFINISHED))
        query = query.order_by(Computation.priority.desc(), Computation.created_at)
        with self.transactions.read() as session:
            return {key: (STATES[state], attempt) for key, state, attempt in session.execute(query)}

    def in_turn(self, most: int, but: Collection[str] = ()) -> list[str]:
        """So many unfinished computations, the most urgent first, ``but`` some: of equals the first of every owner.

        Then the second of every owner, and so on.
        """
        of_owner = {"partition_by": (Computation.priority, Computation.owner), "order_by": Computation.created_at}
        place = func.row_number().over(**of_owner)
        query = select(Computation.id).where(Computation.state.in_(UNFINISHED))
        query = query.order_by(Computation.priority.desc(), place, Computation.created_at).limit(most + len(but))
        with self.transactions.read() as session:
            return [key for key in session.scalars(query) if key not in but][:most]

    def computation(self, computation_id: str) -> ComputationRecord | None:
        """A computation with its document."""
        with self.transactions.read() as session:
            row = session.get(Computation, computation_id)
            return None if row is None else _record(row)

    def begin(self, computation_id: str, attempt: int) -> bool:
        """A waiting computation runs, and its queued jobs with it; False where it no longer should."""
        with self.transactions.write() as session:
            row = self._current(session, computation_id, attempt)
            if row is None or row.state not in (ComputationState.WAITING, ComputationState.RUNNING):
                return False
            row.state = ComputationState.RUNNING
            jobs = self._jobs(session, computation_id, [JobState.QUEUED])
            for job in jobs:
                move(session, job, JobState.RUNNING)
            ids = [job.id for job in jobs]
        self.changes.notify(*ids)
        return True

    def settle(self, computation_id: str, resolved: Mapping[str, Any], target: str) -> None:
        """Keep what the plan settled; a restart and every worker use it unchanged."""
        with self.transactions.write() as session:
            row = session.get(Computation, computation_id, with_for_update=True)
            if row is None:
                return
            row.resolved, row.target = dict(resolved), target
            # The key was made for the target that the workers had when the job was submitted, if any was known.
            key = self.identity.key(row.owner, _document(row), target)
            if session.scalar(select(Computation.id).where(Computation.key == key)) is None:
                row.key = key

    def report(self, progress: Mapping[str, Progress]) -> None:
        """Record the progress of computations for their running jobs."""
        told: list[str] = []
        with self.transactions.write() as session:
            for computation_id in sorted(progress):
                row = session.get(Computation, computation_id, with_for_update=True)
                if row is None:
                    continue
                for job in self._jobs(session, computation_id, [JobState.RUNNING]):
                    report(session, job, progress[computation_id])
                    told.append(job.id)
        self.changes.notify(*told)

    def complete(self, computation_id: str, attempt: int, artifacts: Iterable[ArtifactRecord]) -> None:
        """The result is there: its files are listed and every job that waited for it succeeds."""
        with self.transactions.write() as session:
            row = self._current(session, computation_id, attempt)
            if row is None or row.state not in UNFINISHED:  # it waits where a worker went on while the server restarted
                return
            artifacts = list(artifacts)
            row.state, row.used_at = ComputationState.SUCCEEDED, datetime.now(UTC)
            row.bytes = sum({record.sha256: record.bytes for record in artifacts}.values())
            session.execute(delete(ArtifactFile).where(ArtifactFile.computation_id == computation_id))
            for position, record in enumerate(artifacts):
                session.add(
                    ArtifactFile(
                        computation_id=computation_id,
                        name=record.name,
                        position=position,
                        sha256=record.sha256,
                        record=vars(record),
                    )
                )
            ids = self._end(session, computation_id, None)
            forgotten = self._forget_unwanted(session, row)
        self.files.forget(computation_id) if forgotten else self.files.forget_partials(computation_id)
        self.changes.notify(*ids)

    def fail(self, computation_id: str, attempt: int, error: Mapping[str, Any]) -> None:
        """The computation failed, and every job that waited for it: code, message, retryable, perhaps field."""
        with self.transactions.write() as session:
            row = self._current(session, computation_id, attempt)
            if row is None or row.state not in UNFINISHED:
                return
            row.state = ComputationState.FAILED
            if not error.get("retryable"):
                self.files.forget_partials(computation_id)
            ids = self._end(session, computation_id, dict(error))
            forgotten = self._forget_unwanted(session, row)
        if forgotten:
            self.files.forget(computation_id)
        self.changes.notify(*ids)

    def stopped(self, computation_id: str, attempt: int) -> None:
        """Nothing of a computation that was to stop runs any more; it waits again if a new job wants it."""
        with self.transactions.write() as session:
            row = self._current(session, computation_id, attempt)
            if row is None or row.state != ComputationState.STOPPING:
                return
            canceling = self._jobs(session, computation_id, [JobState.CANCELING])
            for job in canceling:
                move(session, job, JobState.CANCELED)
            wanted = bool(self._jobs(session, computation_id, LIVE))
            row.state = ComputationState.WAITING if wanted else ComputationState.STOPPED
            row.attempt += wanted
            ids = [job.id for job in canceling]
            forgotten = self._forget_unwanted(session, row)
        if forgotten:
            self.files.forget(computation_id)
        self.changes.notify(*ids)

    def time_out(self, now: float | None = None) -> list[str]:
        """Detach the jobs whose time is up; their ids. ``now`` is of `time.monotonic`, which nobody sets.

        How long they have run is kept in the database every few seconds, for the next process.
        """
        now = time.monotonic() if now is None else now
        query = select(Job.id, Job.attempt, Job.computation_id, Job.timeout_s, Job.ran_s)
        query = query.where(Job.state == JobState.RUNNING, Job.timeout_s.is_not(None))
        with self.transactions.read() as session:
            running = session.execute(query.order_by(Job.computation_id, Job.created_at, Job.id)).all()
        begun: dict[tuple[str, int], float] = {(row.id, row.attempt): now - row.ran_s for row in running}
        self.running_since = {
            key: self.running_since[key] if key in self.running_since else begun[key] for key in begun
        }
        if self.running_since and now - self.times_kept >= KEEP_TIMES_S:
            self.times_kept = now
            row = Job.id == bindparam("job"), Job.attempt == bindparam("of_attempt"), Job.state == JobState.RUNNING
            times = [
                {"job": job, "of_attempt": attempt, "seconds": now - began}
                for (job, attempt), began in self.running_since.items()
            ]
            with self.transactions.write() as session:
                session.connection().execute(update(Job).where(*row).values(ran_s=bindparam("seconds")), times)
        candidates = [
            (row.id, row.computation_id)
            for row in running
            if now - self.running_since[row.id, row.attempt] >= (row.timeout_s or 0.0)
        ]
        if not candidates:
            return []
        ids: list[str] = []
        with self.transactions.write() as session:
            for job_id, computation_id in candidates:
                computation = session.get(Computation, computation_id, with_for_update=True)
                job = session.get(Job, job_id)
                if job is None or computation is None or job.state != JobState.RUNNING:
                    continue
                error = {
                    "code": "timed_out",
                    "message": f"the job ran longer than its {job.timeout_s:g} s",
                    "retryable": False,
                }
                self._detach(session, job, computation, JobState.TIMED_OUT, error)
                ids.append(job_id)
        self.changes.notify(*ids)
        return ids

    def recover(self) -> None:
        """At the start, when this server has nothing out yet: what was running waits again.

        What another version of wsrender has begun starts anew: parts of two versions do not mix.
        """
        with self.transactions.write() as session:
            running = Computation.state == ComputationState.RUNNING
            session.execute(update(Computation).where(running).values(state=ComputationState.WAITING))
            others = Computation.version != __version__, Computation.state != ComputationState.SUCCEEDED
            old = list(session.scalars(select(Computation.id).where(*others)))
            known = set(session.scalars(select(Computation.id)))
            of_this = Computation.facts.is_(None), Computation.version == __version__  # no other's keys are asked for
            plain = list(session.scalars(select(Computation.id).where(*of_this)))
        for computation_id in old:
            self._renew(computation_id)
        for computation_id in plain:
            self._describe(computation_id)
        self.files.forget_documents_but(known)

    def set_targets(self, targets: Mapping[str, str]) -> None:
        """Keep which target a request for a device ("auto", "cpu", "cuda", …) means on the workers there are."""
        with self.transactions.write() as session:
            for device, target in targets.items():
                session.merge(DeviceTarget(device=device, target=target))

    def queue_summary(self) -> QueueSummary:
        """Jobs by state and computations waiting and running, of the whole server."""
        with self.transactions.read() as session:
            jobs = _counts(session, Job)
            states = _counts(session, Computation)
            oldest = session.scalar(select(func.min(Job.created_at)).where(Job.state == JobState.QUEUED))
        return QueueSummary(
            {state.value: jobs.get(state, 0) for state in JobState},
            states.get(ComputationState.WAITING, 0),
            states.get(ComputationState.RUNNING, 0),
            oldest,
        )

    def ping(self) -> None:
        """Raise StoreUnavailable where the database does not answer."""
        with self.transactions.read() as session:
            session.execute(select(1))

    def _renew(self, computation_id: str) -> None:
        """Let a computation without a result be one of this version, its document in this version's form."""
        with self.transactions.read() as session:
            row = session.get(Computation, computation_id)
            if row is None or row.state == ComputationState.SUCCEEDED:
                return
            document = _document(row)
        with suppress(InputError):  # which its plan will meet again, and its jobs fail with
            read = parse_job(document.read(self.files, computation_id))
            document = CanonicalDocument.of(read.model_dump(mode="json"))
        with suppress(DiskFull):  # the row may hold it as well
            document = document.kept(self.files, computation_id)
        with self.transactions.write() as session:
            row = session.get(Computation, computation_id)
            if row is None or row.version == __version__:  # deleted or renewed meanwhile
                return
            row.version, row.resolved, row.target = __version__, None, None
            row.document, row.facts = document.text or "", document.facts
            row.attempt += row.state == ComputationState.WAITING
            key = self.identity.key(row.owner, document, self._target(session, document.device))
            if session.scalar(select(Computation.id).where(Computation.key == key)) is None:
                row.key = key
        self.files.forget_partials(computation_id)
        self.files.forget_document(computation_id, but=document.sha256)

    def _describe(self, computation_id: str) -> None:
        """Give a computation without facts those of its document, and the key that goes with them."""
        with self.transactions.read() as session:
            document = _document(session.get_one(Computation, computation_id))
        with self.transactions.write() as session:
            row = session.get(Computation, computation_id)
            if row is None or row.facts is not None:
                return
            row.facts = document.facts
            target = row.target or self._target(session, document.device)
            key = self.identity.key(row.owner, document, target)
            taken = session.scalar(select(Computation.id).where(Computation.key == key))
            if taken is None:
                row.key = key

    def _target(self, session: Session, device: str) -> str | None:
        row = session.get(DeviceTarget, device)
        return row.target if row else None

    def _current(self, session: Session, computation_id: str, attempt: int) -> Computation | None:
        row = session.get(Computation, computation_id, with_for_update=True)
        return row if row is not None and row.attempt == attempt else None

    def _jobs(self, session: Session, computation_id: str, states: Iterable[JobState]) -> list[Job]:
        query = select(Job).where(Job.computation_id == computation_id, Job.state.in_(list(states)))
        return list(session.scalars(query.order_by(Job.created_at, Job.id)))

    def _forget_unwanted(self, session: Session, row: Computation) -> bool:
        """Delete a computation whose jobs were deleted while it stopped: nothing else ever would."""
        unwanted = session.scalar(select(func.count()).where(Job.computation_id == row.id)) == 0
        if unwanted:
            session.delete(row)
        return unwanted

    def _end(self, session: Session, computation_id: str, error: dict[str, Any] | None) -> list[str]:
        """The jobs that waited succeed, or fail with an error; those being canceled are canceled."""
        jobs = self._jobs(session, computation_id, [*LIVE, JobState.CANCELING])
        resolved = session.get_one(Computation, computation_id).resolved
        for job in jobs:
            if job.state == JobState.CANCELING:
                move(session, job, JobState.CANCELED)
            elif error is None:
                finish(session, job, resolved)
            else:
                move(session, job, JobState.FAILED, error)
        return [job.id for job in jobs]

    def _detach(
        self, session: Session, job: Job, computation: Computation, end: JobState, error: dict[str, Any] | None = None
    ) -> None:
        """Take a job off its computation, which stops with its last job; a canceled one waits for that."""
        others = [other for other in self._jobs(session, computation.id, LIVE) if other.id != job.id]
        running = computation.state == ComputationState.RUNNING
        if not others and running:
            computation.state = ComputationState.STOPPING
        elif not others and computation.state == ComputationState.WAITING:
            computation.state = ComputationState.STOPPED
        waits = end == JobState.CANCELED and not others and running
        enter(session, job, JobState.CANCELING if waits else end, error)


def _counts(session: Session, table: type[Job] | type[Computation]) -> dict[str, int]:
    """Number of rows by state."""
    rows = session.execute(select(table.state, func.count()).group_by(table.state))
    return {row[0]: row[1] for row in rows}


def _document(row: Computation) -> CanonicalDocument:
    return CanonicalDocument.of_row(row.document, row.facts)


def _record(row: Computation) -> ComputationRecord:
    return ComputationRecord(
        id=row.id,
        owner=row.owner,
        state=ComputationState(row.state),
        document=_document(row),
        priority=row.priority,
        attempt=row.attempt,
        resolved=row.resolved,
        target=row.target,
    )
