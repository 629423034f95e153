"""Jobs as JSON."""

from collections.abc import Callable
from dataclasses import replace
from datetime import datetime
from typing import Annotated, Any, Generic, Self, TypeVar

from fastapi import Path
from pydantic import BaseModel, ConfigDict, Field

from wsrender.notices import entries
from wsrender_server.hosts import address
from wsrender_server.jobs.identity import notices_of
from wsrender_server.jobs.records import EventRecord, JobRecord, JobState
from wsrender_server.problems import HttpProblem, Problem, problem_of_job
from wsrender_server.query import Identifier

ItemT = TypeVar("ItemT")


def job_not_found() -> HttpProblem:
    """What is said of a job that is not there, or not its owner's."""
    return HttpProblem(404, "there is no such job, or it is not yours", "job_not_found")


JobId = Annotated[
    str,
    Identifier(32, job_not_found),
    Path(description="Id of a job.", examples=["3f2b8c1d9e4a4b5c8d7e6f5a4b3c2d1e"]),
]


class View(BaseModel):
    """Base of what the server answers."""

    model_config = ConfigDict(use_attribute_docstrings=True)

    @classmethod
    def of(cls, record: Any, **made: Any) -> Self:
        """What a record holds, with the fields that are made of it."""
        return cls(**{name: getattr(record, name) for name in cls.model_fields if name not in made}, **made)


class Page(View, Generic[ItemT]):
    """A part of a list."""

    items: list[ItemT]
    """The items."""
    next_cursor: str | None = None
    """Cursor of the next page; null: there is none."""


class ProgressView(View):
    """How far a job is."""

    fraction: float = Field(ge=0, le=1, examples=[0.5])
    """0 … 1."""
    samples_done: int = Field(ge=0)
    """Samples taken."""
    samples_total: int | None
    """Samples to take; null: not known yet."""
    rate_per_s: float | None
    """Samples per second; null: not known yet."""
    eta_s: float | None
    """Seconds to go; null: not known yet."""
    message: str
    """What is being done."""


class JobLinks(View):
    """Where else to look."""

    self: str
    """The job."""
    events: str
    """Its events, as a stream."""
    result: str
    """Its result document."""
    artifacts: str
    """Its files."""


class WarningView(View):
    """Something that a user should know."""

    code: str = Field(examples=["other_version"])
    """The kind of warning for programs; stable."""
    message: str
    """What was found."""
    remedy: str
    """What to do about it."""
    field: str | None
    """The field of the job document that decides it, dotted."""


class JobView(View):
    """A job."""

    id: str = Field(pattern="^[0-9a-f]{32}$")
    """Name of the job."""
    analysis: str = Field(examples=["workspace"])
    """What is analysed."""
    robots: list[str] = Field(examples=[["ur5e"]])
    """Names of its robots and mechanisms, up to 16; jobs that an earlier version has taken in name none."""
    state: JobState
    """queued, running, canceling, succeeded, failed, canceled, timed_out, or expired: the result is no longer kept."""
    created_at: datetime
    """When it was submitted."""
    started_at: datetime | None
    """When its last attempt started."""
    finished_at: datetime | None
    """When it ended."""
    labels: dict[str, str]
    """Free text of its owner."""
    priority: int
    """Jobs of larger priority go first."""
    attempt: int = Field(ge=1)
    """Counts from 1; a retry adds one."""
    timeout_s: float | None
    """Longest time that it may run [s]; null: no limit."""
    progress: ProgressView
    """How far it is."""
    error: Problem | None
    """Why it failed."""
    last_event: int = Field(ge=0)
    """Id of its newest event."""
    version: str = Field(examples=["0.1.0"])
    """Version of wsrender that computes it."""
    warnings: list[WarningView]
    """What should be known of it beside its result, such as that another version has computed it (other_version)."""
    links: JobLinks
    """Where else to look."""


def job_view(job: JobRecord, waits_for: Callable[[str], str]) -> JobView:
    """A job as JSON; ``waits_for`` says what queued jobs wait for that ask for a device."""
    progress = job.progress if job.state != JobState.QUEUED else replace(job.progress, message=waits_for(job.device))
    path, has_result = address(f"/v1/jobs/{job.id}"), job.state == JobState.SUCCEEDED
    return JobView.of(
        job,
        progress=ProgressView.of(progress),
        error=None if job.error is None else Problem(**problem_of_job(job.error)),
        warnings=[WarningView(**entry) for entry in entries(notices_of(job.version) if has_result else ())],
        links=JobLinks(self=path, events=f"{path}/events", result=f"{path}/result", artifacts=f"{path}/artifacts"),
    )


def event_data(event: EventRecord) -> dict[str, Any]:
    """The data of an event as JSON; errors as problem documents."""
    if not event.data.get("error"):
        return event.data
    return {**event.data, "error": problem_of_job(event.data["error"])}


def found(job: JobRecord | None) -> JobRecord:
    """The job; HttpProblem 404 where there is none, or not for this owner."""
    if job is None:
        raise job_not_found()
    return job
