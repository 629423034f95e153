"""The job table seen by an owner: submit, look, cancel, retry, delete. Foreign jobs do not exist here."""

import re
import uuid
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from sqlalchemy import Engine, delete, func, literal, select, tuple_
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from wsrender import __version__
from wsrender.errors import InputError
from wsrender_server.jobs.changes import Changes
from wsrender_server.jobs.computations import ComputationStore
from wsrender_server.jobs.database import Transactions, open_database
from wsrender_server.jobs.documents import CanonicalDocument
from wsrender_server.jobs.faults import (
    CommitUnknown,
    IdempotencyConflict,
    InvalidTransition,
    QueueFull,
    StoreUnavailable,
)
from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.identity import Identity
from wsrender_server.jobs.keys import KeyStore
from wsrender_server.jobs.records import (
    ENDED,
    LIVE,
    RETRYABLE,
    UNFINISHED,
    ComputationState,
    EventRecord,
    JobRecord,
    JobState,
    Submission,
    cursor_after,
    place_of,
)
from wsrender_server.jobs.results import ResultStore
from wsrender_server.jobs.sole_use import SoleUse, bind, locked_folder
from wsrender_server.jobs.tables import (
    OF_COMPUTATION,
    ROBOTS,
    ArtifactFile,
    Computation,
    DeviceTarget,
    Event,
    Job,
    Label,
    Model,
    Timestamp,
    job_record,
    record_of,
    subscribe,
)
from wsrender_server.jobs.webhooks.store import WebhookStore
from wsrender_server.migrations import upgrade
from wsrender_server.settings import Settings

Events = list[EventRecord]  # "list" is a method below
Jobs = list[JobRecord]
Answers = list["Submission | Again | Exception"]

LONGEST_TEXT, MOST_LABELS, HIGHEST_PRIORITY = 255, 32, 1000
NOT_IN_TEXT = re.compile("[\x00-\x1f\x7f\ud800-\udfff]")  # controls, and lone surrogates, which no database keeps
ATTEMPTS = 5  # of a submission whose twin is submitted at the same moment
BUSY = "the same job is being submitted many times at once; nothing was changed, try again"


@dataclass(frozen=True)
class SubmissionRequest:
    """What is asked for by a submission of a canonical job document (all defaults present).

    ``body_hash`` identifies the request's body, so that an idempotency key repeated with another is noticed.
    """

    owner: str
    document: CanonicalDocument
    labels: Mapping[str, str] = field(default_factory=dict)
    priority: int = 0
    timeout_s: float | None = None
    idempotency_key: str | None = None
    body_hash: str = ""
    checked: str = ""
    """A computation whose files are there."""
    new: str = field(default_factory=lambda: uuid.uuid4().hex)
    """The id of its computation, where there is none yet."""


@dataclass(frozen=True)
class Again:
    """A submission that is to be asked for again, once `JobStore.prepare_again` has looked at files or others' rows."""

    request: SubmissionRequest
    computation: str | None
    """Whose files are to be checked; None: another process inserted the same a moment before."""


class _Known:
    """What all submissions of a transaction ask the database, asked once; it goes on with what they add."""

    def __init__(self, session: Session, requests: Sequence[SubmissionRequest], identity: Identity):
        targets = {row.device: row.target for row in session.scalars(select(DeviceTarget))}
        self.keys = {
            request.new: identity.key(request.owner, request.document, targets.get(request.document.device))
            for request in requests
        }
        query = select(Computation).where(Computation.key.in_(set(self.keys.values())))
        # Locked until the transaction ends; in order, so that two transactions never wait for each other.
        found = session.scalars(query.order_by(Computation.id).with_for_update())
        self.computations = {computation.key: computation for computation in found}
        self.added: list[Computation] = []
        """Computations that were added."""
        self.jobs: list[Job] = []
        """Jobs that were added."""
        self.queued: dict[str, int] = {}
        """Unfinished jobs by owner, of those who were looked at."""


class JobStore(ComputationStore, ResultStore, KeyStore, WebhookStore):
    """The only place with SQL. Methods block for milliseconds and may be called from any thread.

    Every method raises StoreUnavailable, and changes nothing, where the database is locked, gone or full.
    """

    def __init__(
        self,
        engine: Engine,
        files: DataFolder,
        *,
        max_queued_per_owner: int = 1000,
        max_model_bytes_per_owner: int | None = None,
        shared_cache: bool = False,
        timeout_of: Callable[[float | None], float | None] = lambda requested: requested,
    ):
        self.transactions = Transactions(engine)
        self.files = files
        self.changes = Changes()
        self.identity = Identity(shared_cache)
        self.max_queued_per_owner = max_queued_per_owner
        self.max_model_bytes_per_owner = max_model_bytes_per_owner
        self.timeout_of = timeout_of
        self.sole_use = SoleUse(engine)
        self.running_since = {}
        self.removed = Counter[str]()  # by retention in this process: things by kind, and bytes
        self.deliveries = Counter[str]()
        self.times_kept = 0.0

    @contextmanager
    def claimed(self) -> Iterator[None]:
        """Be the only server on database and data folder. Raises InputError where another is, or they are no pair."""
        with locked_folder(self.files.root):
            self.sole_use.take()
            try:
                bind(self.transactions, self.files)
                yield
            finally:
                self.sole_use.release()

    def close(self) -> None:
        """Close the connections that are open; the next call opens new ones."""
        self.transactions.engine.dispose()

    def submit(
        self,
        owner: str,
        document: CanonicalDocument | Mapping[str, Any],
        *,
        written: Path | None = None,
        **options: Any,
    ) -> Submission:
        """A new job of a canonical job document, whose text may be ``written`` to a file.

        It is answered from the cache, joins a twin that is running, or waits; the row is committed when this returns.
        ``options`` are those of `SubmissionRequest`.

        Raises IdempotencyConflict, QueueFull, DiskFull; InputError for a robot given by a path, and for labels, key or
        priority out of bounds.
        """
        if not isinstance(document, CanonicalDocument):
            document = CanonicalDocument.of(document)
        return self.submit_alone(SubmissionRequest(owner, document, **options), written)

    def submit_alone(self, request: SubmissionRequest, written: Path | None = None) -> Submission:
        """As `submit`: what is asked for, whose document may be long, in transactions of its own."""
        _check_options(request)
        self.files.check_space()
        new, used = request.new, ""
        request = replace(request, document=request.document.kept(self.files, new, written))
        try:
            for _ in range(ATTEMPTS):
                (answer,) = self.submit_all([request])
                if isinstance(answer, Submission):
                    used = answer.computation
                    return answer
                if isinstance(answer, Exception):
                    raise answer
                request = self.prepare_again(answer)
        except CommitUnknown:
            used = new  # a row may name its document; where none does, it goes as what nothing names
            raise
        finally:
            if used != new:
                self.files.forget_document(new)
        raise StoreUnavailable(BUSY)

    def submit_all(self, requests: Sequence[SubmissionRequest]) -> Answers:
        """Submissions in one transaction: what came of each, in order, or what `submit` would raise.

        A transaction waits for the disk, however much is in it. Documents that are too long for a row are in their
        files, as `CanonicalDocument.kept` leaves them. Where another process inserts the same, each goes alone.
        """
        try:
            self.files.check_space()
            with self.transactions.write() as session, session.no_autoflush:
                known = _Known(session, requests, self.identity)
                answers = [self._answer(session, known, request) for request in requests]
                session.bulk_save_objects([*known.added, *known.jobs])  # before what refers to them
        except IntegrityError:
            if len(requests) == 1:
                return [Again(requests[0], None)]
            return [answer for request in requests for answer in self.submit_all([request])]
        entered = [each for each in answers if isinstance(each, Submission) and not each.replayed]
        if entered:
            self.changes.notify(*(each.job.id for each in entered))
        return answers

    def prepare_again(self, again: Again) -> SubmissionRequest:
        """The submission once the files of its computation were looked at: it takes as long as they are large."""
        request, computation = again.request, again.computation
        if computation is None:
            return request
        self.check_result(computation)
        if request.document.text is None:
            self.files.mend_document(computation, request.document.sha256, request.new)
        return replace(request, checked=computation)

    def get(self, owner: str, job_id: str) -> JobRecord | None:
        """A job."""
        with self.transactions.read() as session:
            row = session.execute(
                select(Job, *OF_COMPUTATION)
                .join(Computation, Job.computation_id == Computation.id)
                .where(Job.id == job_id, Job.owner == owner)
            ).first()
            return None if row is None else job_record(*row)

    def document(self, owner: str, job_id: str) -> Any:
        """The canonical document of a job; None where there is none."""
        with self.transactions.read() as session:
            query = select(Computation).join(Job, Job.computation_id == Computation.id)
            row = session.scalar(query.where(Job.id == job_id, Job.owner == owner))
            kept = None if row is None else (CanonicalDocument.of_row(row.document, row.facts), row.id)
        return None if kept is None else kept[0].read(self.files, kept[1])

    def list(
        self,
        owner: str,
        *,
        state: str | None = None,
        analysis: str | None = None,
        label: tuple[str, str] | None = None,
        robot: str | None = None,
        limit: int = 50,
        cursor: str | None = None,
    ) -> tuple[Jobs, str | None]:
        """Jobs, newest first, and the cursor of the next page; ``robot`` is a part of a name.

        Raises InputError for a cursor that this method did not give.
        """
        query = select(Job, *OF_COMPUTATION).join(Computation, Job.computation_id == Computation.id)
        query = query.where(Job.owner == owner)
        if state is not None:
            query = query.where(Job.state == state)
        if analysis is not None:
            query = query.where(Job.analysis == analysis)
        if label is not None:
            key, value = label
            query = query.join(Label, Label.job_id == Job.id).where(Label.key == key, Label.value == value)
        if robot is not None:
            query = query.where(ROBOTS.icontains(robot, autoescape=True))
        if cursor is not None:
            time, last = place_of(cursor)
            place = tuple_(literal(time, Timestamp), literal(last))
            query = query.where(tuple_(Job.created_at, Job.id) < place)
        query = query.order_by(Job.created_at.desc(), Job.id.desc()).limit(limit + 1)
        with self.transactions.read() as session:
            records = [job_record(*row) for row in session.execute(query)]
        more = len(records) > limit
        return records[:limit], cursor_after(records[limit - 1]) if more else None

    def cancel(self, owner: str, job_id: str) -> JobRecord | None:
        """Detach a job; its computation stops with its last job. Raises InvalidTransition for an ended job."""
        with self.transactions.write() as session:
            job, computation = self._job(session, owner, job_id)
            if job is None or computation is None:
                return None
            if job.state in ENDED:
                raise InvalidTransition(job.state, "canceled")
            if job.state in LIVE:
                self._detach(session, job, computation, JobState.CANCELED)
            record = record_of(job, computation)
        self.changes.notify(job_id)
        return record

    def retry(self, owner: str, job_id: str) -> JobRecord | None:
        """Queue a failed, canceled, timed-out or expired job again. Raises InvalidTransition for others, DiskFull."""
        self.files.check_space()
        with self.transactions.read() as session:
            query = select(Computation.id, Computation.version, Computation.state).join(
                Job, Job.computation_id == Computation.id
            )
            found = session.execute(query.where(Job.id == job_id, Job.owner == owner)).first()
        if found is not None:
            self.check_result(found.id)
            if (
                found.version != __version__ and found.state not in UNFINISHED
            ):  # its result has expired since this version runs
                self._renew(found.id)
        with self.transactions.write() as session:
            job, computation = self._job(session, owner, job_id)
            if job is None or computation is None:
                return None
            if job.state not in RETRYABLE:
                raise InvalidTransition(job.state, "retried")
            self._check_queue(session, owner)
            job.attempt += 1
            job.started_at = job.finished_at = job.progress = None
            subscribe(session, job, computation)
            record = record_of(job, computation)
        self.changes.notify(job_id)
        return record

    def delete(self, owner: str, job_id: str) -> JobRecord | None:
        """Forget an ended job, and its result with its last job. Raises InvalidTransition for an unfinished one."""
        with self.transactions.write() as session:
            job, computation = self._job(session, owner, job_id)
            if job is None or computation is None:
                return None
            if job.state not in ENDED:
                raise InvalidTransition(job.state, "deleted")
            record = record_of(job, computation)
            computation_id = computation.id
            for table in (Event, Label):
                session.execute(delete(table).where(table.job_id == job_id))
            session.delete(job)
            session.flush()
            unused = session.scalar(select(func.count()).where(Job.computation_id == computation.id)) == 0
            if unused and computation.state not in (ComputationState.RUNNING, ComputationState.STOPPING):
                session.execute(delete(ArtifactFile).where(ArtifactFile.computation_id == computation.id))
                session.delete(computation)
        if unused:
            self.files.forget(computation_id)
        self.changes.notify(job_id)
        return record

    def news(self, owner: str, job_id: str, after: int) -> tuple[JobState | None, Events]:
        """State of a job, None where there is none, and its events with ids above ``after``, in order."""
        with self.transactions.read() as session:
            state = session.scalar(select(Job.state).where(Job.id == job_id, Job.owner == owner))
            if state is None:
                return None, []
            query = select(Event).where(Event.job_id == job_id, Event.number > after).order_by(Event.number)
            return JobState(state), [EventRecord(row.number, row.type, row.data) for row in session.scalars(query)]

    def _answer(self, session: Session, known: "_Known", request: SubmissionRequest) -> Submission | Again | Exception:
        """What comes of one submission of a transaction; the others go on where it is refused."""
        try:
            _check_options(request)
            return self._replay(session, request) or self._enter(session, known, request)
        except (IdempotencyConflict, QueueFull, InputError) as error:  # before anything of it was added
            return error

    def _replay(self, session: Session, request: SubmissionRequest) -> Submission | None:
        if request.idempotency_key is None:
            return None
        key = Job.owner == request.owner, Job.idempotency_key == request.idempotency_key
        job = session.scalar(select(Job).where(*key))
        if job is None:
            return None
        if job.body_hash != request.body_hash:
            raise IdempotencyConflict("the idempotency key was used with another body; send a new key")
        computation = session.get_one(Computation, job.computation_id)
        return Submission(record_of(job, computation), replayed=True)

    def _enter(self, session: Session, known: "_Known", request: SubmissionRequest) -> Submission | Again:
        """A new job and, where there is none, its computation; or that whose files are to be checked before."""
        document, owner = request.document, request.owner
        for path, model in document.uploads:
            if session.get(Model, (owner, model)) is None:
                raise InputError(path, f"{model} is not among your models; upload it first")
        key = known.keys[request.new]
        computation = known.computations.get(key)
        if computation is not None and computation.id != request.checked:
            has_files = computation.state == ComputationState.SUCCEEDED or document.text is None
            if has_files:
                return Again(request, computation.id)
        if computation is None or computation.state != ComputationState.SUCCEEDED:
            self._check_queue(session, owner, known)
        if computation is None:
            computation = known.computations[key] = _computation(request, key)
            known.added.append(computation)
        job = _job(request, self.timeout_of(request.timeout_s))
        job.computation_id = computation.id
        known.jobs.append(job)
        session.add_all(Label(job_id=job.id, key=key, value=value) for key, value in request.labels.items())
        subscribe(session, job, computation)
        cached = job.state == JobState.SUCCEEDED
        return Submission(record_of(job, computation), cached=cached, computation=computation.id)

    def _check_queue(self, session: Session, owner: str, known: "_Known | None" = None) -> None:
        """Raise QueueFull where an owner's queue has no place; else one place of those that are ``known`` is taken."""
        queued = {} if known is None else known.queued
        if owner not in queued:
            unfinished = [JobState.QUEUED, JobState.RUNNING, JobState.CANCELING]
            count = session.scalar(select(func.count()).where(Job.owner == owner, Job.state.in_(unfinished)))
            queued[owner] = count or 0
        if queued[owner] >= self.max_queued_per_owner:
            raise QueueFull(self.max_queued_per_owner)
        queued[owner] += 1

    def _job(self, session: Session, owner: str, job_id: str) -> tuple[Job | None, Computation | None]:
        """A job and its computation, the latter locked: whoever changes a job holds its computation's lock."""
        computation = session.scalar(
            select(Computation)
            .join(Job, Job.computation_id == Computation.id)
            .where(Job.id == job_id, Job.owner == owner)
            .with_for_update(of=Computation)
        )
        return (None, None) if computation is None else (session.get(Job, job_id), computation)


def open_store(settings: Settings) -> JobStore:
    """The store of the settings; a SQLite database is made or upgraded, any other must be up to date.

    Raises StoreUnavailable for a database that does not answer, InputError for one that needs an upgrade.
    """
    return _opened(settings, make=True)


def open_existing_store(settings: Settings) -> JobStore | None:
    """The store of the settings as it is, None where there is none: for queries, which make and upgrade nothing.

    Raises StoreUnavailable, and InputError for a database that needs an upgrade.
    """
    file = settings.database_file
    return None if file is not None and not file.exists() else _opened(settings, make=False)


def _opened(settings: Settings, make: bool) -> JobStore:
    files = DataFolder(settings.data_dir, settings.min_free_disk_bytes, make)  # before the database is made in it
    engine = open_database(settings.database_url)
    upgrade(engine, check_only=not make or engine.dialect.name != "sqlite")
    return JobStore(
        engine,
        files,
        max_queued_per_owner=settings.max_queued_per_owner,
        max_model_bytes_per_owner=settings.max_model_bytes_per_owner,
        shared_cache=settings.shared_cache,
        timeout_of=settings.timeout_of,
    )


def _computation(request: SubmissionRequest, key: str) -> Computation:
    return Computation(
        id=request.new,
        key=key,
        owner=request.owner,
        state=ComputationState.WAITING,
        document=request.document.text or "",
        facts=request.document.facts,
        priority=request.priority,
        attempt=1,
        created_at=datetime.now(UTC),
        version=__version__,
    )


def _job(request: SubmissionRequest, timeout_s: float | None) -> Job:
    return Job(
        id=uuid.uuid4().hex,
        owner=request.owner,
        analysis=request.document.analysis,
        state=JobState.QUEUED,
        created_at=datetime.now(UTC),
        labels=dict(request.labels),
        priority=request.priority,
        attempt=1,
        timeout_s=timeout_s,
        idempotency_key=request.idempotency_key,
        body_hash=request.body_hash,
        last_event=0,
    )


def _check_options(request: SubmissionRequest) -> None:
    labels, priority, idempotency_key = request.labels, request.priority, request.idempotency_key
    texts = [("labels", text) for pair in labels.items() for text in pair]
    texts += [] if idempotency_key is None else [("idempotency_key", idempotency_key)]
    for name, text in texts:
        if len(text) > LONGEST_TEXT or NOT_IN_TEXT.search(text):
            raise InputError(name, f"must have at most {LONGEST_TEXT} characters each, and no control characters")
    if len(labels) > MOST_LABELS:
        raise InputError("labels", f"at most {MOST_LABELS} are allowed, not {len(labels)}")
    if not -HIGHEST_PRIORITY <= priority <= HIGHEST_PRIORITY:
        raise InputError("priority", f"must lie between -{HIGHEST_PRIORITY} and {HIGHEST_PRIORITY}, not {priority}")
