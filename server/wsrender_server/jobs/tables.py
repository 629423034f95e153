"""The tables (SQLAlchemy 2), and changes of job rows that every part of the store shares.

A job subscribes to a computation; events, labels and artifacts belong to one of them. The caller of a change holds the
lock of the job's computation.
"""

import json
import uuid
from collections.abc import Mapping
from dataclasses import asdict
from datetime import UTC, datetime
from typing import Any

import structlog
from sqlalchemy import (
    JSON,
    BigInteger,
    Dialect,
    Float,
    ForeignKey,
    Index,
    Integer,
    String,
    Text,
    UniqueConstraint,
    delete,
    func,
    select,
)
from sqlalchemy.orm import DeclarativeBase, Mapped, Session, mapped_column, relationship
from sqlalchemy.types import TypeDecorator

from wsrender_server.jobs.records import ENDED, NEXT, ComputationState, JobRecord, JobState, Progress

LONGEST_DETAIL = 1000  # characters of an error that a webhook is told

log = structlog.get_logger("wsrender.jobs")


class Timestamp(TypeDecorator[datetime]):
    """A time as microseconds since 1970 in UTC: ordered and exact in every database."""

    impl = BigInteger
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> int | None:
        """To the database."""
        return None if value is None else round(value.timestamp() * 1e6)

    def process_result_value(self, value: int | None, dialect: Dialect) -> datetime | None:
        """From the database."""
        return None if value is None else datetime.fromtimestamp(value / 1e6, UTC)


class Row(DeclarativeBase):
    """Base of all tables."""

    type_annotation_map = {datetime: Timestamp, dict[str, Any]: JSON(none_as_null=True)}  # noqa: RUF012


class Computation(Row):
    """What is computed, once, for every job of one owner that asks for it."""

    __tablename__ = "computations"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    key: Mapped[str] = mapped_column(String(64), unique=True)
    owner: Mapped[str] = mapped_column(String(64))
    state: Mapped[str] = mapped_column(String(16), index=True)
    document: Mapped[str] = mapped_column(Text)  # empty where a file holds it
    facts: Mapped[dict[str, Any] | None]  # of the document; null in rows of versions that had none
    priority: Mapped[int] = mapped_column(Integer)
    attempt: Mapped[int] = mapped_column(Integer, default=1)
    created_at: Mapped[datetime]
    bytes: Mapped[int] = mapped_column(BigInteger, default=0, server_default="0")  # of its result
    used_at: Mapped[datetime] = mapped_column(default=lambda: datetime.now(UTC), server_default="0")
    resolved: Mapped[dict[str, Any] | None]
    target: Mapped[str | None] = mapped_column(String(128))
    version: Mapped[str] = mapped_column(String(32), server_default="0.1.0")  # of wsrender, whose numbers it holds


class Job(Row):
    """A submission."""

    __tablename__ = "jobs"
    __table_args__ = (
        UniqueConstraint("owner", "idempotency_key"),
        Index("ix_jobs_owner_created_at_id", "owner", "created_at", "id"),
    )

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    owner: Mapped[str] = mapped_column(String(64))
    computation_id: Mapped[str] = mapped_column(ForeignKey("computations.id"), index=True)
    analysis: Mapped[str] = mapped_column(String(64))
    state: Mapped[str] = mapped_column(String(16), index=True)
    created_at: Mapped[datetime]
    started_at: Mapped[datetime | None]
    finished_at: Mapped[datetime | None]
    labels: Mapped[dict[str, Any]]
    priority: Mapped[int] = mapped_column(Integer)
    attempt: Mapped[int] = mapped_column(Integer, default=1)
    timeout_s: Mapped[float | None] = mapped_column(Float)
    ran_s: Mapped[float] = mapped_column(Float, default=0.0, server_default="0")  # of its timeout, as of a while ago
    idempotency_key: Mapped[str | None] = mapped_column(String(255))
    body_hash: Mapped[str] = mapped_column(String(64))
    progress: Mapped[dict[str, Any] | None]
    error: Mapped[dict[str, Any] | None]
    last_event: Mapped[int] = mapped_column(Integer, default=0)
    computation: Mapped[Computation] = relationship()  # says what is written first, as in the tables below


class Label(Row):
    """A label of a job, for filtering."""

    __tablename__ = "labels"
    __table_args__ = (Index("ix_labels_key_value", "key", "value"),)

    job_id: Mapped[str] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"), primary_key=True)
    key: Mapped[str] = mapped_column(String(255), primary_key=True)
    value: Mapped[str] = mapped_column(String(255))
    job: Mapped[Job] = relationship()


class Event(Row):
    """Something that happened to a job; numbered within the job."""

    __tablename__ = "events"

    job_id: Mapped[str] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"), primary_key=True)
    number: Mapped[int] = mapped_column(Integer, primary_key=True, autoincrement=False)
    type: Mapped[str] = mapped_column(String(16))
    data: Mapped[dict[str, Any]]
    job: Mapped[Job] = relationship()


class ArtifactFile(Row):
    """A file of a computation's result; its bytes lie in the data folder under their hash."""

    __tablename__ = "artifacts"

    computation_id: Mapped[str] = mapped_column(ForeignKey("computations.id", ondelete="CASCADE"), primary_key=True)
    name: Mapped[str] = mapped_column(String(255), primary_key=True)
    position: Mapped[int] = mapped_column(Integer)
    sha256: Mapped[str] = mapped_column(String(64))
    record: Mapped[dict[str, Any]]


class Model(Row):
    """A robot model that an owner uploaded; its bytes lie in the data folder under their hash."""

    __tablename__ = "models"

    owner: Mapped[str] = mapped_column(String(64), primary_key=True)
    sha256: Mapped[str] = mapped_column(String(64), primary_key=True)
    bytes: Mapped[int] = mapped_column(BigInteger)
    created_at: Mapped[datetime]


class Key(Row):
    """An API key; of its secret only the SHA-256 is kept."""

    __tablename__ = "keys"

    id: Mapped[str] = mapped_column(String(16), primary_key=True)
    name: Mapped[str] = mapped_column(String(255))
    scopes: Mapped[str] = mapped_column(String(64))
    secret_hash: Mapped[str] = mapped_column(String(64))
    created_at: Mapped[datetime]
    revoked_at: Mapped[datetime | None]


class Webhook(Row):
    """Where an owner is told of the states of their jobs. Its secret signs what is sent, and so is kept as it is."""

    __tablename__ = "webhooks"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    owner: Mapped[str] = mapped_column(String(64), index=True)
    url: Mapped[str] = mapped_column(Text)
    states: Mapped[str] = mapped_column(String(255))  # separated by spaces
    secret: Mapped[str] = mapped_column(String(64))
    created_at: Mapped[datetime]
    disabled_at: Mapped[datetime | None]
    delivered: Mapped[int] = mapped_column(Integer, default=0)
    given_up: Mapped[int] = mapped_column(Integer, default=0)
    last_delivered_at: Mapped[datetime | None]
    last_error_at: Mapped[datetime | None]
    last_error: Mapped[str | None] = mapped_column(Text)


class Delivery(Row):
    """A message that a webhook is to get; gone once it has it, or was given up.

    No foreign key: a job changes its state whether or not a webhook is deleted at that moment.
    """

    __tablename__ = "deliveries"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    webhook_id: Mapped[str] = mapped_column(String(32), index=True)
    created_at: Mapped[datetime]
    body: Mapped[str] = mapped_column(Text)
    attempts: Mapped[int] = mapped_column(Integer, default=0)
    next_at: Mapped[datetime] = mapped_column(index=True)


class StoreId(Row):
    """One row: the identity that this database shares with its data folder."""

    __tablename__ = "store_id"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)


class DeviceTarget(Row):
    """The target that a request for a device means on this server's workers, as last seen."""

    __tablename__ = "device_targets"

    device: Mapped[str] = mapped_column(String(32), primary_key=True)
    target: Mapped[str] = mapped_column(String(128))


ROBOTS = func.coalesce(Computation.facts["robots"].as_string(), "")
# Of a job's computation, what its record says; documents of earlier versions have no facts, or fewer.
OF_COMPUTATION = Computation.version, func.coalesce(Computation.facts["device"].as_string(), "auto"), ROBOTS


def record_of(job: Job, computation: Computation) -> JobRecord:
    """The plain value of a row."""
    facts = computation.facts or {}
    return job_record(job, computation.version, facts.get("device", "auto"), facts.get("robots", ""))


def job_record(job: Job, version: str, device: str, robots: str) -> JobRecord:
    """The plain value of a row, with `OF_COMPUTATION`."""
    return JobRecord(
        id=job.id,
        owner=job.owner,
        analysis=job.analysis,
        state=JobState(job.state),
        created_at=job.created_at,
        started_at=job.started_at,
        finished_at=job.finished_at,
        labels=dict(job.labels),
        priority=job.priority,
        attempt=job.attempt,
        timeout_s=job.timeout_s,
        progress=Progress(**(job.progress or {})),
        error=job.error,
        last_event=job.last_event,
        version=version,
        device=device,
        robots=tuple(filter(None, robots.split("\n"))),
    )


def move(session: Session, job: Job, state: JobState, error: dict[str, Any] | None = None) -> None:
    """Put a job into a state, with times and an event. Raises ValueError for a state that may not follow."""
    if state not in NEXT[JobState(job.state)]:
        raise ValueError(f"a job that is {job.state} does not become {state}")
    enter(session, job, state, error)


def enter(session: Session, job: Job, state: JobState, error: dict[str, Any] | None = None) -> None:
    """Record, and log, that a job is in a state, whatever it was in before."""
    now = datetime.now(UTC)
    job.state, job.error = state, error
    log.info(
        "job", job_id=job.id, owner=job.owner, state=str(state), attempt=job.attempt, code=(error or {}).get("code")
    )
    if state == JobState.RUNNING:
        job.started_at, job.ran_s = now, 0.0
    if state in ENDED and state != JobState.EXPIRED:  # which had finished before
        job.finished_at = now
    add_event(session, job, "state", {"state": state, "attempt": job.attempt, "error": error})
    _announce(session, job, now)


def _announce(session: Session, job: Job, now: datetime) -> None:
    """Let the webhooks that ask for it be told, by the same transaction, of the state that a job is in now."""
    webhooks = session.info.setdefault("webhooks", {})  # by owner: a session is one transaction
    if job.owner not in webhooks:
        with session.no_autoflush:
            query = select(Webhook.id, Webhook.states).where(Webhook.owner == job.owner, Webhook.disabled_at.is_(None))
            webhooks[job.owner] = session.execute(query).all()
    told = [row.id for row in webhooks[job.owner] if job.state in row.states.split()]
    if not told:
        return
    error = job.error and {
        "code": job.error.get("code", "internal_error"),
        "detail": str(job.error.get("message", ""))[:LONGEST_DETAIL],
        "retryable": bool(job.error.get("retryable")),
    }
    data = {name: getattr(job, name) for name in ("id", "analysis", "state", "attempt", "labels")}
    body = message(f"job.{job.state}", now, {**data, "event": job.last_event, "error": error})
    for webhook in told:
        add_delivery(session, webhook, now, body)


def add_delivery(session: Session, webhook_id: str, now: datetime, body: str) -> str:
    """Let a webhook get a message: its id, which is the same in every attempt."""
    message_id = f"msg_{uuid.uuid4().hex}"
    row = Delivery(id=message_id, webhook_id=webhook_id, created_at=now, body=body, attempts=0, next_at=now)
    session.add(row)
    return message_id


def message(kind: str, now: datetime, data: Mapping[str, Any]) -> str:
    """The body of what a webhook gets (Standard Webhooks 1.0); timestamps are in order as text too."""
    timestamp = now.isoformat(timespec="microseconds").replace("+00:00", "Z")
    return json.dumps({"type": kind, "timestamp": timestamp, "data": data})


def subscribe(session: Session, job: Job, computation: Computation) -> None:
    """Let a new or retried job wait for a computation, which starts again if it has no result.

    Where it is more urgent than those that wait already, the computation goes out anew, by another attempt.
    """
    restarts = computation.state in (ComputationState.FAILED, ComputationState.STOPPED, ComputationState.EXPIRED)
    if restarts:
        computation.state = ComputationState.WAITING
        computation.priority = job.priority
    if restarts or (computation.state == ComputationState.WAITING and job.priority > computation.priority):
        computation.attempt += 1
    computation.priority = max(computation.priority, job.priority)
    if computation.state == ComputationState.SUCCEEDED:
        computation.used_at = datetime.now(UTC)
        finish(session, job, computation.resolved)
    elif computation.state == ComputationState.RUNNING:
        enter(session, job, JobState.RUNNING)
    else:
        enter(session, job, JobState.QUEUED)


def finish(session: Session, job: Job, resolved: Mapping[str, Any] | None) -> None:
    """Let a job succeed; one that never ran, answered from the cache, starts and ends at once.

    Its samples are those of the plan that was ``resolved``, whether or not anybody looked while it ran.
    """
    told = Progress(**(job.progress or {}))
    done, total = told.samples_total or 0, told.samples_total
    if resolved:
        done = sum(count for _, count in resolved["shards"])
        total = done or None
        if resolved.get("iterates"):  # nobody knew beforehand how many there would be
            same = select(Job.progress).where(Job.computation_id == job.computation_id, Job.progress.is_not(None))
            done, total = max([done, *(each["samples_done"] for each in session.scalars(same) if each)]), None
    job.progress = asdict(Progress(1.0, done, total, message="finished"))
    job.started_at = job.started_at or datetime.now(UTC)
    enter(session, job, JobState.SUCCEEDED)


def add_event(session: Session, job: Job, kind: str, data: dict[str, Any]) -> None:
    """Append an event to a job's."""
    job.last_event += 1
    session.add(Event(job_id=job.id, number=job.last_event, type=kind, data=data))


def report(session: Session, job: Job, progress: Progress) -> None:
    """Record a job's progress; of the events of progress only the newest is kept."""
    job.progress = asdict(progress)
    session.execute(delete(Event).where(Event.job_id == job.id, Event.type == "progress"))
    add_event(session, job, "progress", asdict(progress))
