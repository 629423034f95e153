"""What can be asked of a server, each as steps: the same for waiting clients and asyncio ones."""

import time
import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, cast
from urllib.parse import quote

import httpx2

from wsrender.client.documents import sendable
from wsrender.client.records import FINISHED, Estimate, JobDocument, JobRecord, JobState, job_record, not_understood
from wsrender.client.requests import OnLoss, Pause, Request, Server, Steps, answer, asked, checked, member
from wsrender.errors import WaitTimeoutError

EVENTS = "text/event-stream"
PAGE = 100  # jobs in one answer
LONG_POLL_S = 20.0  # proxies allow it
REPORTED_S = 5.0  # between two reports of progress at the latest
SHORTEST_POLL_S = 0.2
RECONNECT_S = 600.0  # a server's restart, a laptop's sleep

Report = Callable[[JobRecord], object]


def path_of(job_id: str) -> str:
    """Where a job is."""
    return f"/v1/jobs/{quote(job_id, safe='')}"


def listed(server: Server, path: str) -> Steps[list[Any]]:
    """A list of the server's."""
    request = Request("GET", path)
    return member(server, request, (yield from answer(server, request)), "items", list)


def submitted(
    server: Server,
    job: JobDocument,
    labels: Mapping[str, str] | None,
    priority: int,
    timeout_s: float | None,
    idempotency_key: str | None,
) -> Steps[JobRecord]:
    """A job that is queued."""
    body = yield from sendable(server, job)
    if labels:
        body["labels"] = dict(labels)
    if priority:
        body["priority"] = priority
    if timeout_s is not None:
        body["timeout_s"] = timeout_s
    headers = {"Idempotency-Key": idempotency_key or uuid.uuid4().hex}
    return job_record((yield from answer(server, Request("POST", "/v1/jobs", json=body, headers=headers))), server.url)


def stream_document(
    server: Server, robot: str | Mapping[str, object], chosen: Mapping[str, object]
) -> Steps[dict[str, Any]]:
    """The first message of a live stream."""
    given = {name: value for name, value in chosen.items() if value is not None}
    return (yield from sendable(server, {"robot": {"library": robot} if isinstance(robot, str) else robot, **given}))


def estimated(server: Server, job: JobDocument) -> Steps[Estimate]:
    """What a job would take."""
    body = yield from sendable(server, job)
    request = Request("POST", "/v1/jobs:validate", json=body)
    found = yield from answer(server, request)
    member(server, request, found, "valid", bool)
    return cast(Estimate, found)


def looked_at(server: Server, job_id: str) -> Steps[JobRecord]:
    """A job as it is now."""
    return job_record((yield from answer(server, Request("GET", path_of(job_id)))), server.url)


@dataclass(frozen=True)
class PageOfJobs:
    """Which jobs come next: filters as the server takes them, how many are still wanted (None: all), a cursor."""

    filters: Mapping[str, str]
    left: int | None
    cursor: str | None = None


def first_page(
    state: JobState | None, analysis: str | None, label: tuple[str, str] | None, robot: str | None, limit: int | None
) -> PageOfJobs | None:
    """The newest of the jobs asked for; None where none are wanted."""
    filters = {"state": state, "analysis": analysis, "label": "=".join(label) if label else None, "robot": robot}
    given = {name: value for name, value in filters.items() if value is not None}
    return None if limit is not None and limit <= 0 else PageOfJobs(given, limit)


def page_of_jobs(server: Server, page: PageOfJobs) -> Steps[tuple[list[JobRecord], PageOfJobs | None]]:
    """Some jobs, and where the next ones are; None where there are no more, or no more are wanted."""
    size = PAGE if page.left is None else min(PAGE, page.left)
    params = {**page.filters, "limit": size} | ({"cursor": page.cursor} if page.cursor else {})
    request = Request("GET", "/v1/jobs", params=params)
    found = yield from answer(server, request)
    items = member(server, request, found, "items", list)[: page.left]
    left, cursor = None if page.left is None else page.left - len(items), found.get("next_cursor")
    more = cursor is not None and left != 0
    records = [job_record(each, server.url) for each in items]
    return records, PageOfJobs(page.filters, left, cursor) if more else None


def ended(
    server: Server,
    record: JobRecord,
    timeout: float | None,
    report: Report | None = None,
    on_loss: OnLoss | None = None,
) -> Steps[JobRecord]:
    """A job that has ended; ``report`` is told whatever happens to it until then.

    Raises WaitTimeoutError after ``timeout`` seconds, ServerConnectionError where the server stays away.
    """
    end = float("inf") if timeout is None else time.monotonic() + timeout
    if report is not None:
        report(record)
    while record["state"] not in FINISHED:
        asked_at = time.monotonic()
        if (left := end - asked_at) <= 0:
            raise WaitTimeoutError(f"job {record['id']} is still {record['state']} after {timeout:g} s")
        wait_s = min(LONG_POLL_S if report is None else REPORTED_S, left)
        params: dict[str, str | int | float] = {"wait": f"{wait_s:.3f}"}
        if report is not None:  # else no news is worth an answer but the end
            params["after"] = record.get("last_event") or 0
        request = Request("GET", path_of(record["id"]), params=params, timeout_s=wait_s + server.timeout_s)
        said = yield from answer(server, request, patience_s=min(RECONNECT_S, left), on_loss=on_loss)
        record = job_record(said, server.url)
        if report is not None:
            report(record)
        waited = time.monotonic() - asked_at
        if record["state"] not in FINISHED and waited < min(wait_s, SHORTEST_POLL_S):
            yield Pause(min(wait_s, SHORTEST_POLL_S) - waited)  # even where the server answers at once
    return record


def changed(server: Server, job_id: str, verb: str) -> Steps[JobRecord]:
    """A job that is canceled or queued again."""
    request = Request("POST", f"{path_of(job_id)}:{verb}")
    return job_record((yield from answer(server, request, resend=False)), server.url)


def deleted(server: Server, job_id: str) -> Steps[None]:
    """Nothing: the server has forgotten the job."""
    yield from asked(server, Request("DELETE", path_of(job_id)), resend=False)


def events_of(job_id: str, after: str) -> Request:
    """The request for the events of a job that come after one."""
    headers = {"Accept": EVENTS} | ({"Last-Event-ID": after} if after else {})
    return Request("GET", f"{path_of(job_id)}/events", headers=headers)


def stream_checked(server: Server, response: httpx2.Response) -> Steps[None]:
    """Raise what is wrong with an answer that shall be a stream of events."""
    yield from checked(server, response)
    kind = response.headers.get("Content-Type", "nothing").partition(";")[0]
    if kind != EVENTS:
        raise not_understood(server.url, f"{kind} instead of events")
