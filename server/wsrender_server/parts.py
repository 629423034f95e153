"""The parts of a running server, as routes use them."""

from dataclasses import dataclass
from typing import Annotated, Protocol

from fastapi import Depends, Request

from wsrender_server.admission import Admissions
from wsrender_server.conversions import ConvertedFiles
from wsrender_server.job_body import Places
from wsrender_server.jobs.records import WorkerRecord
from wsrender_server.jobs.store import JobStore
from wsrender_server.metrics import Metrics
from wsrender_server.settings import Settings
from wsrender_server.side_process import Estimates, SideProcess
from wsrender_server.streams.sessions import Streams
from wsrender_server.streams.view_sessions import ViewSessions
from wsrender_server.views import Views

PLANNERS = 2  # one owner never has them all
MOST_ADMISSION_BYTES = 4 * 2**30  # that reading a body may take


class Jobs(Protocol):
    """The job table and what computes it, as far as routes ask; `jobs.service.JobService` is one."""

    store: JobStore

    def start(self) -> None:
        """Start, and take up unfinished jobs; returns at once."""
        ...

    def stop(self) -> None:
        """Stop; unfinished jobs are taken up at the next start."""
        ...

    def workers(self) -> list[WorkerRecord]:
        """The workers that answer."""
        ...

    def waits_for(self, device: str) -> str:
        """What queued jobs that ask for a device wait for."""
        ...

    @property
    def scheduler_ready(self) -> bool:
        """Whether the scheduler answers."""
        ...

    @property
    def worker_ready(self) -> bool:
        """Whether a live worker is there."""
        ...


@dataclass(eq=False)
class Parts:
    """Everything that routes need beside the request."""

    settings: Settings
    jobs: Jobs

    def __post_init__(self):
        self.store = self.jobs.store
        self.metrics = Metrics()
        settings, models = self.settings, self.store.files.models
        self.side_process = SideProcess(settings.max_memory_bytes, models)
        # Of their own: a plan may take long.
        planning = min(settings.max_planning_memory_bytes, settings.max_memory_bytes)
        planners = [SideProcess(planning, models) for _ in range(PLANNERS)]
        self.estimates = Estimates(planners, settings.max_planning_s)
        admission = SideProcess(min(settings.max_memory_bytes, MOST_ADMISSION_BYTES), models)
        self.admissions = Admissions(self.store, admission, settings.max_samples)
        self.long_bodies, self.uploads = Places(), Places()
        self.streams = Streams(self.settings, self.store.files.models)
        self.view_sessions = ViewSessions(self.settings, self.store.files.models)
        self.converted = ConvertedFiles(self.store.files, self.side_process)
        self.views = Views(self.store.files, self.side_process)


async def _parts(request: Request) -> Parts:  # else every request would wait for a thread that looks them up
    return request.app.state.parts


Server = Annotated[Parts, Depends(_parts)]
