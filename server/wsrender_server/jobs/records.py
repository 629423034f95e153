"""What the store hands out: states and plain values, never rows of the database. Times are aware datetimes in UTC."""

import base64
import binascii
import re
from dataclasses import dataclass, field
from datetime import UTC, datetime
from enum import StrEnum
from typing import Any

from wsrender.errors import InputError
from wsrender_server.jobs.documents import CanonicalDocument

ID = re.compile("[0-9a-f]{32}")


class JobState(StrEnum):
    """State of a job, as a client sees it."""

    QUEUED = "queued"
    RUNNING = "running"
    CANCELING = "canceling"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELED = "canceled"
    TIMED_OUT = "timed_out"
    EXPIRED = "expired"  # it had succeeded; its result is no longer kept


class ComputationState(StrEnum):
    """State of a computation, which one or more jobs of one owner wait for."""

    WAITING = "waiting"
    RUNNING = "running"
    STOPPING = "stopping"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    STOPPED = "stopped"
    EXPIRED = "expired"


LIVE = (JobState.QUEUED, JobState.RUNNING)  # jobs for which a computation goes on
RETRYABLE = (JobState.FAILED, JobState.CANCELED, JobState.TIMED_OUT, JobState.EXPIRED)
ENDED = (JobState.SUCCEEDED, *RETRYABLE)
UNFINISHED = (ComputationState.WAITING, ComputationState.RUNNING, ComputationState.STOPPING)

NEXT: dict[JobState, tuple[JobState, ...]] = {
    JobState.QUEUED: (JobState.RUNNING, JobState.CANCELING, JobState.SUCCEEDED, JobState.FAILED, JobState.CANCELED),
    JobState.RUNNING: (JobState.CANCELING, JobState.SUCCEEDED, JobState.FAILED, JobState.CANCELED, JobState.TIMED_OUT),
    JobState.CANCELING: (JobState.CANCELED,),
    JobState.SUCCEEDED: (JobState.EXPIRED,),
    JobState.FAILED: (JobState.QUEUED, JobState.RUNNING, JobState.SUCCEEDED),
    JobState.CANCELED: (JobState.QUEUED, JobState.RUNNING, JobState.SUCCEEDED),
    JobState.TIMED_OUT: (JobState.QUEUED, JobState.RUNNING, JobState.SUCCEEDED),
    JobState.EXPIRED: (JobState.QUEUED, JobState.RUNNING, JobState.SUCCEEDED),
}
"""The states that may follow each state; an ended job moves again only by a retry."""


@dataclass(frozen=True)
class Progress:
    """How far a job is: fraction 0 … 1, samples, samples per second, seconds to go (None: unknown)."""

    fraction: float = 0.0
    samples_done: int = 0
    samples_total: int | None = None
    rate_per_s: float | None = None
    eta_s: float | None = None
    message: str = ""


@dataclass(frozen=True)
class JobRecord:
    """A job. ``error`` holds code, message, retryable and where known field.

    ``last_event`` is the id of the job's newest event, ``version`` that of the wsrender that computes it; ``device`` is
    what its document asks for, ``robots`` are the names of its robots and mechanisms.
    """

    id: str
    owner: str
    analysis: str
    state: JobState
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    labels: dict[str, str]
    priority: int
    attempt: int
    timeout_s: float | None
    progress: Progress
    error: dict[str, Any] | None
    last_event: int
    version: str
    device: str = "auto"
    robots: tuple[str, ...] = ()


@dataclass(frozen=True)
class Submission:
    """A submitted job: ``replayed`` by its idempotency key, or answered from the cache (``cached``)."""

    job: JobRecord
    replayed: bool = False
    cached: bool = False
    computation: str = ""
    """Id of what it waits for; empty for a replayed one."""


@dataclass(frozen=True)
class EventRecord:
    """Something that happened to a job; ids count from 1 within the job.

    ``type`` "state": data {state, attempt, error}; "progress": data as Progress, only the newest one is kept.
    """

    id: int
    type: str
    data: dict[str, Any]


@dataclass(frozen=True)
class ArtifactRecord:
    """A file of a result, as the result document lists it."""

    name: str
    media_type: str
    bytes: int
    sha256: str
    shape: list[int] | None = None
    units: dict[str, str] = field(default_factory=dict)
    frame: str | None = None


@dataclass(frozen=True)
class ModelRecord:
    """An uploaded model, mesh or table."""

    sha256: str
    bytes: int
    created_at: datetime


@dataclass(frozen=True)
class KeyRecord:
    """An API key without its secret; ``scopes`` from read, submit, admin."""

    id: str
    name: str
    scopes: tuple[str, ...]
    created_at: datetime
    revoked_at: datetime | None = None


@dataclass(frozen=True)
class WebhookRecord:
    """Where an owner is told of the states of their jobs, without its secret.

    ``waiting``, ``delivered`` and ``given_up`` count messages; ``disabled_at`` is when its receiver wanted no more.
    """

    id: str
    url: str
    states: tuple[JobState, ...]
    created_at: datetime
    disabled_at: datetime | None
    waiting: int
    delivered: int
    given_up: int
    last_delivered_at: datetime | None
    last_error_at: datetime | None
    last_error: str | None


@dataclass(frozen=True)
class DeliveryRecord:
    """A message to a webhook, as it is sent, again and again if need be."""

    id: str
    webhook: str
    url: str
    secret: str
    body: str
    attempts: int = 0
    """How often it has failed."""


@dataclass(frozen=True)
class DeliveryOutcome:
    """What came of an attempt to deliver a message. ``gone``: the receiver wants no more of anything."""

    delivered: bool
    said: str
    gone: bool = False


@dataclass(frozen=True)
class ComputationRecord:
    """What the dispatcher needs of a computation; ``resolved`` is what its plan settled once and for all."""

    id: str
    owner: str
    state: ComputationState
    document: CanonicalDocument
    priority: int
    attempt: int
    resolved: dict[str, Any] | None
    target: str | None


@dataclass(frozen=True)
class WorkerRecord:
    """A worker: its address in the cluster, host, device target, devices, and whether it is at work."""

    address: str
    host: str
    target: str | None
    devices: tuple[str, ...]
    busy: bool


@dataclass(frozen=True)
class QueueSummary:
    """Jobs of the whole server by state, and computations waiting and running."""

    jobs: dict[str, int]
    waiting: int
    running: int
    oldest_queued_at: datetime | None = None


def cursor_after(record: JobRecord) -> str:
    """The cursor of the page that follows a job."""
    text = f"{round(record.created_at.timestamp() * 1e6)}.{record.id}"
    return base64.urlsafe_b64encode(text.encode()).decode().rstrip("=")


def place_of(cursor: str) -> tuple[datetime, str]:
    """Time and id of the job before a cursor; InputError for a text that is no cursor."""
    try:
        text = base64.urlsafe_b64decode(cursor + "=" * (-len(cursor) % 4)).decode("ascii")
        time, job_id = text.split(".")
        if not ID.fullmatch(job_id):  # a database may refuse what is no id as well, in words of its own
            raise ValueError(job_id)
        return datetime.fromtimestamp(int(time) / 1e6, UTC), job_id
    except (binascii.Error, ValueError, OverflowError, OSError) as error:
        raise InputError("cursor", "is not one that a list of jobs has given") from error
