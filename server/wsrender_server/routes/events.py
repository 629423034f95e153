"""Events of a job as a stream (server-sent events), with replay."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import ExitStack
from functools import partial
from time import monotonic
from typing import Annotated

from fastapi import APIRouter, Depends, Header, Request
from fastapi.sse import EventSourceResponse, ServerSentEvent

from wsrender_server.auth import Reader, until_revoked
from wsrender_server.jobs.records import ENDED, JobRecord
from wsrender_server.parts import Server
from wsrender_server.problems import problem_responses
from wsrender_server.routes.job_views import JobId, event_data, found

# A client that goes on with Last-Event-ID misses nothing; one that has silently gone does not stay for ever.
LONGEST_STREAM_S = 3600.0
CHECK_S = 30.0
RECONNECT_MS = 1000

router = APIRouter(prefix="/v1", tags=["jobs"])


def _job(server: Server, principal: Reader, job_id: JobId) -> JobRecord:
    return found(server.store.get(principal.owner, job_id))


@router.get(
    "/jobs/{job_id:id}/events",
    summary="Follow a job",
    response_class=EventSourceResponse,
    responses={
        200: {"description": "Events until the job has ended", "content": {"text/event-stream": {}}},
        **problem_responses(401, 403, 404, 422),
    },
)
async def follow_job(
    server: Server,
    principal: Reader,
    request: Request,
    job: Annotated[JobRecord, Depends(_job)],
    last_event_id: Annotated[
        int, Header(ge=0, le=2**31 - 1, description="Start after this event; 0: from the beginning.")
    ] = 0,
) -> AsyncIterator[ServerSentEvent]:
    """Server-sent events `state` (state, attempt, error) and `progress`, with ids that count from 1.

    The stream ends with the job, when its key is revoked, or when the server stops. A client that reconnects with
    `Last-Event-ID` gets what it missed; of the events of progress the newest is kept.
    """
    store, seen, ends = server.store, last_event_id, monotonic() + LONGEST_STREAM_S
    revoked = asyncio.create_task(until_revoked(request, principal))
    revoked.add_done_callback(lambda task: task.cancelled() or task.exception())  # the stream's end says it
    with store.changes.watch(job.id) as watch, ExitStack() as end:
        end.callback(revoked.cancel)
        while monotonic() < ends and not store.changes.closed and not revoked.done():
            (state, events), news = await watch.read((job.owner, seen), partial(store.news, job.owner, job.id, seen))
            for event in events:
                seen = event.id
                yield ServerSentEvent(data=event_data(event), event=event.type, id=str(event.id), retry=RECONNECT_MS)
            if state is None or state in ENDED:
                return
            waiting = asyncio.create_task(watch.wait(news, CHECK_S))
            await asyncio.wait((waiting, revoked), return_when=asyncio.FIRST_COMPLETED)
            waiting.cancel()
