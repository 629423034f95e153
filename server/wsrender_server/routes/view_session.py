"""Interactive sessions over WebSocket: what a page asks of the engine about a result or a robot, and the answers."""

import asyncio
import contextlib
import json
import struct
import time
from collections.abc import Awaitable, Callable, Mapping
from functools import cache, partial
from typing import Any

import structlog
from fastapi import APIRouter, WebSocket
from fastapi.responses import JSONResponse
from starlette.concurrency import run_in_threadpool
from starlette.websockets import WebSocketDisconnect

from wsrender import __version__
from wsrender.documents.view_requests import REQUESTS
from wsrender.errors import ModelError, WsrenderError
from wsrender.results.export.artifacts import named_files, part_file
from wsrender.robots import library
from wsrender_server.admission import EDITED
from wsrender_server.auth import Principal, Scope, until_revoked
from wsrender_server.jobs.child_process import end_of
from wsrender_server.jobs.records import JobState
from wsrender_server.parts import Parts
from wsrender_server.problems import HttpProblem, problem_of_error, problem_responses
from wsrender_server.routes.artifacts import RESULT, files_of
from wsrender_server.routes.job_views import found
from wsrender_server.routes.websockets import INTERNAL, NORMAL, POLICY, TOO_BIG, principal_of, protocol_of
from wsrender_server.streams.sessions import MessageRate
from wsrender_server.streams.view_sessions import ViewSession

MOST_PER_S = 120  # questions of a page: one for each picture of a fast screen
LARGEST_QUESTION = 1 << 16  # bytes
OPEN_S = 30.0  # for the first message, where it says what the session is about
IDLE_S = 600.0  # without a question: the session ends
SEND_S = 10.0  # for a page to take in an answer
LONGEST_REASON = 120  # bytes of a close frame

router = APIRouter(prefix="/v1", tags=["views"])
log = structlog.get_logger("wsrender.views")


@router.get(
    "/view-session/asyncapi.json",
    summary="Describe the messages of interactive sessions",
    response_class=JSONResponse,
    responses=problem_responses(),
)
async def describe_view_session() -> JSONResponse:
    """AsyncAPI 3.0 document of the WebSockets `/v1/jobs/{id}/view/session` and `/v1/robots/{robot}/view/session`.

    That of `/v1/robots:view/session` is the same, about a robot that is edited: its first message is what
    `POST /v1/robots:view` takes.

    A question is a JSON text `{"id": …, "ask": …, …}`. Every answer is one binary message: a little-endian uint32, the
    length of a header; the header, JSON with `id`, `answer` or `refused` (`message`, `field`, `code`) and `blobs`
    (names and sizes), padded by spaces to a multiple of 4; then the blobs, one after the other. A question that a
    later one of its kind replaces is refused with the code `replaced`. Keys travel as the subprotocol `wsrender.key.`
    and the key, or `wsrender.key64.` and the key in base64url without `=`, beside `wsrender.v1`.
    """
    return JSONResponse(asyncapi())


@router.websocket("/jobs/{job_id:id}/view/session")
async def job_view_session(websocket: WebSocket, job_id: str) -> None:
    """Questions about the result of a job."""

    def of_job(parts: Parts, principal: Principal) -> dict[str, Any]:
        job = found(parts.store.get(principal.owner, job_id))
        if job.state != JobState.SUCCEEDED:
            raise HttpProblem(409, f"the job is {job.state}; it has no result", "no_result")
        names = [record.name for record in parts.store.artifacts(job.owner, job.id)]
        wanted = [
            part_file("volume"),
            *(file for part in ("tables", "volumes") for file in named_files(part, names).values()),
        ]
        result = files_of(parts, job, [RESULT])[RESULT]
        return {"result": result, "files": files_of(parts, job, [name for name in wanted if name in names])}

    await _session(websocket, partial(run_in_threadpool, of_job))


@router.websocket("/robots/{robot}/view/session")
async def robot_view_session(websocket: WebSocket, robot: str) -> None:
    """Questions about a library robot."""

    def of_library(parts: Parts, principal: Principal) -> dict[str, Any]:
        try:
            library.find(robot)
        except ModelError as error:
            raise HttpProblem(404, error.message, "robot_not_found") from None
        return {"robot": robot}

    await _session(websocket, partial(run_in_threadpool, of_library))


@router.websocket("/robots:view/session")
async def edited_view_session(websocket: WebSocket) -> None:
    """Questions about a robot that is edited, which the first message holds."""

    async def of_edited(parts: Parts, principal: Principal) -> dict[str, Any]:
        text = await _first(websocket, parts.settings.max_body_bytes)
        await parts.admissions.check_edited(principal.owner, text)
        return {"edited": text}

    await _session(websocket, of_edited, "submit")


async def _first(websocket: WebSocket, most: int) -> bytes:
    """The first message, of so many bytes at most. Raises HttpProblem."""
    try:
        async with asyncio.timeout(OPEN_S):
            message = await websocket.receive()
    except TimeoutError:
        raise HttpProblem(400, f"no message came within {OPEN_S:g} s", "silent") from None
    if message["type"] == "websocket.disconnect":
        raise WebSocketDisconnect
    text = _bytes_of(message)
    if len(text) > most:
        raise HttpProblem(413, f"the first message may have {most} bytes, not {len(text)}", "message_too_large")
    return text


def _bytes_of(message: Mapping[str, Any]) -> bytes:
    return (message.get("text") or "").encode("utf-8", "surrogatepass") or (message.get("bytes") or b"")


async def _session(
    websocket: WebSocket, subject: Callable[[Parts, Principal], Awaitable[dict[str, Any]]], right: Scope = "read"
) -> None:
    """A session, which is accepted before it is refused: pages are told nothing of what is closed before."""
    parts: Parts = websocket.app.state.parts
    await websocket.accept(protocol_of(websocket))
    with contextlib.suppress(WebSocketDisconnect):
        try:
            principal = await run_in_threadpool(principal_of, websocket, right)
            about = await subject(parts, principal)
            async with parts.view_sessions.session(principal.owner, about) as session:
                log.info("view session opened", owner=principal.owner)
                await _pump(websocket, session, principal)
        except (HttpProblem, WsrenderError) as error:
            await _refuse(websocket, problem_of_error(error))


async def _pump(websocket: WebSocket, session: ViewSession, principal: Principal) -> None:
    """Pass messages both ways until one side ends, or the key is revoked."""
    both = _to_engine(websocket, session), _to_page(websocket, session), until_revoked(websocket, principal)
    tasks = [asyncio.create_task(each) for each in both]
    await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    for task in tasks:
        task.cancel()
    for result in await asyncio.gather(*tasks, return_exceptions=True):
        if isinstance(result, Exception) and not isinstance(result, WebSocketDisconnect):
            raise result


async def _to_engine(websocket: WebSocket, session: ViewSession) -> None:
    rate = MessageRate(MOST_PER_S)
    while True:
        try:
            async with asyncio.timeout(IDLE_S):
                message = await websocket.receive()
        except TimeoutError:
            await websocket.close(NORMAL, "idle")
            return
        if message["type"] == "websocket.disconnect":
            return
        if rate.exceeded(time.monotonic()):
            raise HttpProblem(429, f"more than {MOST_PER_S} questions came in a second", "too_fast")
        text = _bytes_of(message)
        if len(text) > LARGEST_QUESTION:
            raise HttpProblem(
                413, f"a question may have {LARGEST_QUESTION} bytes, not {len(text)}", "message_too_large"
            )
        if not session.send(text):
            raise HttpProblem(503, "the engine does not answer", "hung", retryable=True)


async def _to_page(websocket: WebSocket, session: ViewSession) -> None:
    first = True
    while (answer := await session.received()) is not None:
        if first and (refused := _refused_in(answer)):  # what the session is about cannot be had
            raise HttpProblem(409, refused["message"], refused["code"])
        first = False
        await _taken_in(websocket.send_bytes(answer))
    if session.too_large:
        raise HttpProblem(409, "the session took more memory than is allowed", "out_of_memory")
    how = await run_in_threadpool(end_of, session.process)
    log.error("the process of a session ended", how=how, pid=session.process.pid)
    raise HttpProblem(500, f"the process of this session ended ({how})", "crashed")


def _refused_in(answer: bytes) -> dict[str, str] | None:
    (length,) = struct.unpack("<I", answer[:4])
    return json.loads(answer[4 : 4 + length]).get("refused")


async def _taken_in(sending: Awaitable[None]) -> None:
    try:
        async with asyncio.timeout(SEND_S):
            await sending
    except TimeoutError:
        raise HttpProblem(409, f"the page took in nothing for {SEND_S:g} s", "stalled") from None


async def _refuse(websocket: WebSocket, problem: dict[str, Any]) -> None:
    """Say what is wrong, and end."""
    refused = {"message": problem["detail"], "field": "", "code": problem["code"]}
    header = json.dumps({"id": None, "refused": refused, "blobs": []}).encode()
    header += b" " * (-len(header) % 4)
    codes = {413: TOO_BIG, 500: INTERNAL, 503: INTERNAL}
    with contextlib.suppress(RuntimeError, TimeoutError):  # the page is gone, or takes in nothing
        async with asyncio.timeout(1.0):
            await websocket.send_bytes(struct.pack("<I", len(header)) + header)
    with contextlib.suppress(RuntimeError, TimeoutError):
        reason = f"{problem['code']}: {problem['detail']}".encode()[:LONGEST_REASON].decode(errors="ignore")
        async with asyncio.timeout(1.0):
            await websocket.close(codes.get(problem["status"], POLICY), reason)


@cache
def asyncapi() -> dict[str, Any]:
    """The AsyncAPI 3.0 document of the sessions; schemas are those of the pydantic models."""
    schemas: dict[str, Any] = {}
    for ask, model in REQUESTS.items():
        schema = model.model_json_schema(ref_template="#/components/schemas/{model}")
        schemas |= schema.pop("$defs", {})
        schema["properties"] = {"id": {"type": ["integer", "string"]}, **schema["properties"]}
        schema["required"] = ["id", "ask", *schema.get("required", [])]
        schemas[ask] = schema
    answer = {
        "description": "The header of an answer, a binary message; its blobs follow.",
        "type": "object",
        "properties": {
            "id": {"type": ["integer", "string", "null"]},
            "answer": {"type": "object"},
            "refused": {
                "type": "object",
                "properties": {name: {"type": "string"} for name in ("message", "field", "code")},
            },
            "blobs": {
                "type": "array",
                "items": {"type": "object", "properties": {"name": {"type": "string"}, "bytes": {"type": "integer"}}},
            },
        },
    }
    names = [*REQUESTS, "answer"]
    messages = {name: {"$ref": f"#/components/messages/{name}"} for name in names}
    edited = EDITED.json_schema(ref_template="#/components/schemas/{model}")
    schemas |= edited.pop("$defs", {}) | {"edited": edited}
    paths = {
        "job": "/v1/jobs/{id}/view/session",
        "robot": "/v1/robots/{robot}/view/session",
        "edited": "/v1/robots:view/session",
    }
    first = {"edited": ["edited"]}  # what comes before all questions
    return {
        "asyncapi": "3.0.0",
        "info": {"title": "wsrender interactive sessions", "version": __version__},
        "channels": {
            name: {
                "address": path,
                "messages": messages
                | {each: {"$ref": f"#/components/messages/{each}"} for each in first.get(name, ())},
            }
            for name, path in paths.items()
        },
        "operations": {
            f"{action}_{name}": {
                "action": action,
                "channel": {"$ref": f"#/channels/{name}"},
                "messages": [{"$ref": f"#/channels/{name}/messages/{each}"} for each in which],
            }
            for name in paths
            for action, which in (("receive", [*first.get(name, ()), *REQUESTS]), ("send", ["answer"]))
        },
        "components": {
            "messages": {name: {"payload": {"$ref": f"#/components/schemas/{name}"}} for name in [*names, "edited"]},
            "schemas": {**schemas, "answer": answer},
        },
    }
