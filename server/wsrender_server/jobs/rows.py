"""Changes of job rows that every part of the store shares; the caller holds the lock of the job's computation."""

from dataclasses import asdict
from datetime import UTC, datetime, timedelta
from typing import Any

import structlog
from sqlalchemy import delete
from sqlalchemy.orm import Session

from wsrender_server.jobs.records import JobRecord, Progress
from wsrender_server.jobs.states import ENDED, NEXT, ComputationState, JobState
from wsrender_server.jobs.tables import Computation, Event, Job

log = structlog.get_logger("wsrender.jobs")


def job_record(job: Job, version: str, document: dict[str, Any] | None = None) -> JobRecord:
    """The plain value of a row; ``version`` is that of its computation."""
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
        document=document,
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
        job.started_at = now
        job.deadline = None if job.timeout_s is None else now + timedelta(seconds=job.timeout_s)
    if state in ENDED:
        job.finished_at, job.deadline = now, None
    add_event(session, job, "state", {"state": state, "attempt": job.attempt, "error": error})


def subscribe(session: Session, job: Job, computation: Computation) -> None:
    """Let a new or retried job wait for a computation, which starts again if it had failed or been stopped.

    Where it is more urgent than those that wait already, the computation goes out anew, by another attempt.
    """
    restarts = computation.state in (ComputationState.FAILED, ComputationState.STOPPED)
    if restarts:
        computation.state = ComputationState.WAITING
        computation.priority = job.priority
    if restarts or (computation.state == ComputationState.WAITING and job.priority > computation.priority):
        computation.attempt += 1
    computation.priority = max(computation.priority, job.priority)
    if computation.state == ComputationState.SUCCEEDED:
        finish(session, job)
    elif computation.state == ComputationState.RUNNING:
        enter(session, job, JobState.RUNNING)
    else:
        enter(session, job, JobState.QUEUED)


def finish(session: Session, job: Job) -> None:
    """Let a job succeed; one that never ran, answered from the cache, starts and ends at once."""
    done = job.progress["samples_total"] if job.progress else None
    job.progress = asdict(Progress(1.0, done or 0, done, message="finished"))
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
