"""The parts of a running server, as routes use them."""

from dataclasses import dataclass, field
from typing import Annotated, Any, Protocol

from fastapi import Depends, Request

from wsrender_server.conversions import ConvertedFiles
from wsrender_server.jobs.records import WorkerRecord
from wsrender_server.jobs.store import JobStore
from wsrender_server.metrics import Metrics
from wsrender_server.settings import Settings
from wsrender_server.side_process import SideProcess


class Engine(Protocol):
    """The scheduler and its workers, as far as routes ask."""

    @property
    def connected(self) -> bool:
        """Whether the scheduler answers."""
        ...

    def workers(self) -> list[WorkerRecord]:
        """Workers that answer."""
        ...


class Executor(Protocol):
    """What computes the jobs of the store: started with the server and stopped with it."""

    engine: Any  # an Engine; protocols do not take subtypes of plain attributes

    @property
    def alive(self) -> bool:
        """Whether the scheduler answers and a worker is there."""
        ...

    def start(self) -> None:
        """Start, and take up unfinished jobs; returns at once."""
        ...

    def stop(self) -> None:
        """Stop; unfinished jobs are taken up at the next start."""
        ...


@dataclass(eq=False)
class Parts:
    """Everything that routes need beside the request."""

    settings: Settings
    store: JobStore
    executor: Executor
    side_process: SideProcess = field(default_factory=SideProcess)
    metrics: Metrics = field(default_factory=Metrics)

    def __post_init__(self):
        self.converted = ConvertedFiles(self.store.files, self.side_process)

    @property
    def engine(self) -> Engine:
        """The scheduler and its workers."""
        return self.executor.engine


def _parts(request: Request) -> Parts:
    return request.app.state.parts


Server = Annotated[Parts, Depends(_parts)]
