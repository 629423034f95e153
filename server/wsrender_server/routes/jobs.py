"""Jobs: submit, validate, list, look, cancel, retry, delete."""

import hashlib
import json
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from time import monotonic
from typing import Annotated, Any, cast

from fastapi import APIRouter, Depends, Query, Request, Response
from pydantic import AfterValidator

from wsrender.analyses.registry import job_classes
from wsrender.errors import InputError
from wsrender_server.admission import Admitted
from wsrender_server.auth import Principal, Reader, Submitter, check_priority, unless_revoked
from wsrender_server.hosts import address
from wsrender_server.job_body import job_body, submission_examples
from wsrender_server.jobs.records import ENDED, JobRecord, JobState
from wsrender_server.jobs.store import SubmissionRequest
from wsrender_server.parts import Parts, Server
from wsrender_server.problems import HttpProblem, problem_responses
from wsrender_server.routes.job_views import JobId, JobView, Page, View, found, job_view

LONGEST_WAIT_S = 60.0
POLL_AGAIN_S = "1"
LONGEST_KEY = 255  # characters

router = APIRouter(prefix="/v1", tags=["jobs"])
_Body = Annotated[bytes, Depends(job_body)]


_Rough = Annotated[float, AfterValidator(lambda value: float(f"{value:.3g}"))]  # digits that are no accuracy stay out


class Estimate(View):
    """What a job would take: orders of magnitude, to three digits."""

    valid: bool
    """True: the job can be submitted."""
    samples: float
    """Samples."""
    bytes: _Rough | None
    """Memory [bytes], the same as memory_bytes; null: little."""
    memory_bytes: _Rough | None = None
    """Largest arrays that are held at a time [bytes]."""
    file_bytes: _Rough | None = None
    """Result files [bytes]; of compressed ones as they are before."""
    seconds: _Rough | None
    """Time on this server [s]; null: little."""


def _submission() -> dict[str, Any]:
    """The description of a body that is a submission."""
    reference = {"$ref": "#/components/schemas/JobSubmission"}
    content = {"schema": reference, "examples": submission_examples()}
    return {"requestBody": {"required": True, "content": {"application/json": content}}}


def _link(operation: str, **parameters: str) -> dict[str, Any]:
    return {"operationId": operation, "parameters": {"job_id": "$response.body#/id", **parameters}}


_JOB_LINKS = {
    "job": _link("get_job"),
    "cancel": _link("cancel_job"),
    "delete": _link("delete_job"),
    "result": _link("get_result"),
    "artifacts": _link("list_artifacts"),
    "artifact": _link("get_artifact", name="result.json"),
}
_IDEMPOTENCY_KEY = {
    "name": "Idempotency-Key",
    "in": "header",
    "required": False,
    "description": "Makes the request safe to repeat: the same key with the same body gives the same job.",
    "schema": {"type": "string", "minLength": 1, "maxLength": LONGEST_KEY, "pattern": "^[!-~]([ -~]*[!-~])?$"},
}
_Wait = Annotated[
    float,
    Query(ge=0, le=LONGEST_WAIT_S, allow_inf_nan=False, description="Wait so long for the job to end [s]."),
]
_LOCATION = {"Location": {"description": "The job.", "schema": {"type": "string"}}}
_SOON = {"Retry-After": {"description": "When to look again [s].", "schema": {"type": "integer"}}}


@router.post(
    "/jobs",
    summary="Submit a job",
    status_code=202,
    response_model=JobView,
    responses={
        200: {
            "model": JobView,
            "description": "From the cache, replayed, or ended while it was waited for",
            "headers": _LOCATION,
            "links": _JOB_LINKS,
        },
        202: {"description": "Queued", "headers": _LOCATION | _SOON, "links": _JOB_LINKS},
        **problem_responses(401, 403, 404, 408, 409, 413, 415, 422, 429),
    },
    openapi_extra=_submission() | {"parameters": [_IDEMPOTENCY_KEY]},
)
async def submit_job(server: Server, principal: Submitter, request: Request, text: _Body, wait: _Wait = 0) -> Response:
    """Queue a job document; labels, priority and timeout_s may stand beside its fields.

    Equal jobs of one owner are computed once: a job whose result is there already succeeds at once (200). The header
    `Idempotency-Key` (1 to 255 printable characters) makes a request safe to repeat: the same key with the same body
    gives the same job (200), with another body 422, while the first request is still at work 409.

    With `wait` the answer comes when the job has ended (200), or, where the time is up, as without it (202).
    """
    key = _idempotency_key(request)
    with _one_at_a_time(request.app.state.keys_at_work, principal.owner, key):
        submission = await server.admissions.submit(principal.owner, text, partial(_request, principal, key))
    job = submission.job
    request.state.job_id = job.id
    outcome = "replayed" if submission.replayed else "cached" if submission.cached else "queued"
    server.metrics.submissions.labels(outcome).inc()
    if wait:
        job = await unless_revoked(request, principal, _watched(server, principal.owner, job.id, wait, None))
    headers = {"Location": address(f"/v1/jobs/{job.id}")}
    is_open = job.state not in ENDED if wait else outcome == "queued"
    if is_open:
        headers["Retry-After"] = POLL_AGAIN_S
    content = job_view(job, server.jobs.waits_for).model_dump_json()
    return Response(content, 202 if is_open else 200, headers, "application/json")


@router.post(
    "/jobs:validate",
    summary="Check a job and estimate what it would take",
    response_model=Estimate,
    responses=problem_responses(401, 403, 404, 408, 409, 413, 415, 422, 429),
    openapi_extra=_submission(),
)
async def validate_job(server: Server, principal: Submitter, text: _Body) -> Estimate:
    """Everything that can be wrong with a job is found here, the robot's model included; nothing is queued."""
    planned = await server.admissions.of(principal.owner, text, partial(_to_plan, principal))
    return Estimate.model_validate({"valid": True} | await server.estimates.of(principal.owner, *planned))


@router.get(
    "/jobs",
    summary="List your jobs, newest first",
    response_model=Page[JobView],
    responses=problem_responses(401, 403, 404, 422),
)
def list_jobs(
    server: Server,
    principal: Reader,
    state: Annotated[JobState | None, Query(description="Only jobs in this state.")] = None,
    analysis: Annotated[
        str | None, Query(description="Only jobs of this analysis.", json_schema_extra={"enum": [*job_classes()]})
    ] = None,
    label: Annotated[
        str | None,
        Query(pattern=r"^[^=\x00]{1,63}=[^\x00]{0,255}$", description="Only jobs with this label, key=value."),
    ] = None,
    robot: Annotated[
        str | None,
        Query(
            pattern=r"^[^\x00-\x1f\x7f]{1,100}$",
            description="Only jobs of a robot or mechanism whose name has this in it.",
        ),
    ] = None,
    limit: Annotated[int, Query(ge=1, le=200, description="Jobs of a page.")] = 50,
    cursor: Annotated[
        str | None, Query(pattern="^[A-Za-z0-9_-]{1,200}$", description="next_cursor of the page before.")
    ] = None,
) -> Page[JobView]:
    """Filters are combined. Follow `next_cursor` until it is null."""
    if analysis is not None and analysis not in job_classes():
        raise InputError("analysis", f"must be one of {', '.join(job_classes())}")
    key_value = None if label is None else (label.partition("=")[0], label.partition("=")[2])
    try:
        jobs, following = server.store.list(
            principal.owner, state=state, analysis=analysis, label=key_value, robot=robot, limit=limit, cursor=cursor
        )
    except InputError as error:  # only the cursor can still be wrong
        raise HttpProblem(404, str(error), "unknown_cursor", errors=[("cursor", error.message)]) from None
    return Page(items=[job_view(job, server.jobs.waits_for) for job in jobs], next_cursor=following)


@router.get(
    "/jobs/{job_id:id}",
    summary="Look at a job",
    response_model=JobView,
    responses={
        202: {"model": JobView, "description": "Not ended, though waited for"},
        **problem_responses(401, 403, 404, 422),
    },
)
async def get_job(
    server: Server,
    principal: Reader,
    job_id: JobId,
    request: Request,
    response: Response,
    wait: _Wait = 0,
    after: Annotated[
        int | None, Query(ge=0, le=2**31 - 1, description="Wait only until there is an event newer than this one.")
    ] = None,
) -> JobView:
    """With `wait` the answer comes when the job has ended, with `after` when anything has happened to it.

    202 says that the time is up and the job has not ended: ask again.
    """
    watched = _watched(server, principal.owner, job_id, wait, after)
    job = await (unless_revoked(request, principal, watched) if wait else watched)
    if wait and job.state not in ENDED:
        response.status_code = 202
    return job_view(job, server.jobs.waits_for)


async def _watched(server: Parts, owner: str, job_id: str, wait_s: float, after: int | None) -> JobRecord:
    """A job when it has ended, where ``after`` is given when it has a newer event, or when the time is up."""
    store, ends = server.store, monotonic() + wait_s
    with store.changes.watch(job_id) as watch:
        while True:
            job, news = await watch.read(owner, partial(store.get, owner, job_id))
            waiting = found(job).state not in ENDED and (after is None or job.last_event <= after)
            left = ends - monotonic()
            if not waiting or left <= 0 or store.changes.closed or not await watch.wait(news, left):
                return job


@router.post(
    "/jobs/{job_id:id}:cancel",
    summary="Cancel a job",
    response_model=JobView,
    responses=problem_responses(401, 403, 404, 409, 422),
)
def cancel_job(server: Server, principal: Submitter, job_id: JobId) -> JobView:
    """Its state becomes canceling, then canceled; what another job waits for goes on. 409 for a job that has ended."""
    return job_view(found(server.store.cancel(principal.owner, job_id)), server.jobs.waits_for)


@router.post(
    "/jobs/{job_id:id}:retry",
    summary="Retry a job",
    response_model=JobView,
    responses=problem_responses(401, 403, 404, 409, 422, 429),
)
def retry_job(server: Server, principal: Submitter, job_id: JobId) -> JobView:
    """Queue a job again that failed, was canceled, timed out or has expired; 409 for any other."""
    return job_view(found(server.store.retry(principal.owner, job_id)), server.jobs.waits_for)


@router.delete(
    "/jobs/{job_id:id}",
    summary="Delete a job",
    status_code=204,
    response_class=Response,
    responses=problem_responses(401, 403, 404, 409, 422),
)
def delete_job(server: Server, principal: Submitter, job_id: JobId) -> Response:
    """Forget an ended job and, with the last job that shares it, its result; 409 for a job that has not ended."""
    found(server.store.delete(principal.owner, job_id))
    return Response(status_code=204)


def _to_plan(principal: Principal, admitted: Admitted) -> tuple[str, str]:
    """Hash and text of a document."""
    check_priority(principal, admitted.options.priority, "#/priority")
    document = admitted.document
    return document.sha256, document.text or cast(Path, admitted.written).read_text("utf-8")


def _request(principal: Principal, key: str | None, admitted: Admitted) -> SubmissionRequest:
    options = admitted.options
    check_priority(principal, options.priority, "#/priority")
    return SubmissionRequest(
        principal.owner,
        admitted.document,
        labels=options.labels,
        priority=options.priority,
        timeout_s=options.timeout_s,  # the store applies the limits of the settings
        idempotency_key=key,
        body_hash="" if key is None else _body_hash(admitted),
    )


def _idempotency_key(request: Request) -> str | None:
    key = request.headers.get("idempotency-key")
    if key is not None and not (1 <= len(key) <= LONGEST_KEY and key.isascii() and key.isprintable()):
        detail = f"must have 1 to {LONGEST_KEY} printable ASCII characters"
        raise HttpProblem(422, f"Idempotency-Key {detail}", "invalid_request", errors=[("Idempotency-Key", detail)])
    return key


@contextmanager
def _one_at_a_time(at_work: dict[tuple[str, str], object], owner: str, key: str | None) -> Iterator[None]:
    """Refuse a request whose idempotency key is that of another one at work."""
    if key is None:
        yield
        return
    mine = object()
    if at_work.setdefault((owner, key), mine) is not mine:
        raise HttpProblem(409, "a request with this idempotency key is at work", "in_flight", retryable=True)
    try:
        yield
    finally:
        del at_work[owner, key]


def _body_hash(admitted: Admitted) -> str:
    document = admitted.document
    told = document.sha256 if document.text is None else json.loads(document.text)
    content = [told, admitted.options.model_dump()]
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
