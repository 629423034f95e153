"""Operation: queue, workers, health, readiness, metrics, version."""

import platform
from datetime import datetime
from typing import Annotated, Literal

from fastapi import APIRouter, Response
from pydantic import Field

from wsrender import __version__
from wsrender_server.auth import Reader
from wsrender_server.jobs.faults import DiskFull, StoreUnavailable
from wsrender_server.metrics import MEDIA_TYPE
from wsrender_server.parts import Parts, Server
from wsrender_server.problems import HttpProblem, problem_of_error, problem_responses
from wsrender_server.routes.job_views import Page, View

OK = "ok"

router = APIRouter(tags=["operation"])


class QueueView(View):
    """Jobs of the whole server."""

    jobs: dict[str, Annotated[int, Field(ge=0)]]
    """Number of jobs by state."""
    waiting: int = Field(ge=0)
    """Computations that wait for a worker; equal jobs share one."""
    running: int = Field(ge=0)
    """Computations at work."""
    oldest_queued_at: datetime | None
    """When the job that has waited longest was submitted."""


class WorkerView(View):
    """A worker."""

    address: str
    """Its address in the cluster."""
    host: str
    """The machine that it runs on."""
    target: str | None
    """What its kernels are compiled for."""
    devices: list[str]
    """Its devices."""
    busy: bool
    """Whether it is at work."""


class Health(View):
    """The server answers."""

    status: Literal["ok"] = "ok"
    """ok."""


class Readiness(View):
    """The server can compute jobs."""

    status: Literal["ready"] = "ready"
    """ready."""
    checks: dict[str, str]
    """database, scheduler, workers and disk: ok."""


class Version(View):
    """What is running."""

    wsrender: str
    """Version of wsrender."""
    api: Literal["v1"] = "v1"
    """Version of the interface."""
    python: str
    """Version of Python."""


@router.get("/v1/queue", summary="Look at the queue", response_model=QueueView, responses=problem_responses(401, 403))
def get_queue(server: Server, principal: Reader) -> QueueView:
    """How many jobs wait and run, of everyone together."""
    return QueueView.of(server.store.queue_summary())


@router.get(
    "/v1/workers", summary="List the workers", response_model=Page[WorkerView], responses=problem_responses(401, 403)
)
def list_workers(server: Server, principal: Reader) -> Page[WorkerView]:
    """Workers that answer; all in one page."""
    return Page(items=[WorkerView.of(worker) for worker in server.jobs.workers()])


@router.get("/healthz", summary="Whether the server answers", response_model=Health, responses=problem_responses())
async def get_health() -> Health:
    """For liveness probes: restart the server where this does not answer."""
    return Health()


@router.get("/readyz", summary="Whether jobs can be computed", response_model=Readiness, responses=problem_responses())
def get_readiness(server: Server) -> Readiness:
    """For readiness probes: 503 names what is missing of database, scheduler, a live worker and free disk."""
    checks = {name: check(server) for name, check in _CHECKS.items()}
    missing = [f"{name}: {state}" for name, state in checks.items() if state != OK]
    if missing:
        raise HttpProblem(503, "; ".join(missing), "not_ready", retryable=True, extra={"checks": checks})
    return Readiness(checks=checks)


@router.get(
    "/metrics",
    summary="Metrics for Prometheus",
    response_class=Response,
    responses={
        200: {"description": "Text format", "content": {"text/plain": {"schema": {"type": "string"}}}},
        **problem_responses(401, 403),
    },
)
def get_metrics(server: Server, principal: Reader) -> Response:
    """Requests, jobs, workers, webhooks and disk."""
    store = server.store
    text = server.metrics.text(
        store.queue_summary(),
        server.jobs.workers(),
        store.files.free_bytes(),
        store.usage(),
        store.removed,
        store.deliveries,
        store.waiting_deliveries(),
    )
    return Response(text, media_type=MEDIA_TYPE)


@router.get("/v1/version", summary="What is running", response_model=Version, responses=problem_responses())
async def get_version() -> Version:
    """Versions of wsrender, of this interface and of Python."""
    return Version(wsrender=__version__, python=platform.python_version())


def _database(server: Parts) -> str:
    try:
        server.store.ping()
    except StoreUnavailable as error:
        return problem_of_error(error)["detail"]
    return OK


def _scheduler(server: Parts) -> str:
    return OK if server.jobs.scheduler_ready else "does not answer"


def _workers(server: Parts) -> str:
    return OK if server.jobs.worker_ready else "none is there"


def _disk(server: Parts) -> str:
    try:
        server.store.files.check_space()
    except (DiskFull, OSError) as error:
        return str(error)
    return OK


_CHECKS = {"database": _database, "scheduler": _scheduler, "workers": _workers, "disk": _disk}
