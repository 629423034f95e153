"""The live stream over WebSocket: where a device is, and the force that it shall render."""

import asyncio
import contextlib
import json
import time
from functools import cache
from typing import Any

import structlog
from fastapi import APIRouter, WebSocket
from fastapi.responses import JSONResponse
from starlette.concurrency import run_in_threadpool
from starlette.websockets import WebSocketDisconnect

from wsrender import __version__
from wsrender.documents.kinetostatic_stream import FROM_CLIENT, FROM_SERVER, LARGEST_SAMPLE, StreamOpen
from wsrender.documents.reading import read_json
from wsrender.errors import DocumentError, WsrenderError
from wsrender_server.admission import check_models, check_uploads, refuse_paths
from wsrender_server.auth import Principal, until_revoked
from wsrender_server.job_body import check_size
from wsrender_server.jobs.child_process import end_of
from wsrender_server.jobs.documents import uploads_in
from wsrender_server.parts import Parts
from wsrender_server.problems import HttpProblem, problem_of_error, problem_responses, response_of_problem
from wsrender_server.routes.websockets import INTERNAL, NORMAL, POLICY, TOO_BIG, principal_of, protocol_of
from wsrender_server.streams.sessions import MessageRate, Session

PATH = "/v1/kinetostatic-stream"
MOST_PER_S = 4000  # messages of a client
OPEN_S = 30.0  # for the client's first message

router = APIRouter(tags=["kinetostatic stream"])
log = structlog.get_logger("wsrender.streams")


@router.get(
    f"{PATH}/asyncapi.json",
    summary="Describe the messages of the live stream",
    response_class=JSONResponse,
    responses=problem_responses(),
)
async def describe_stream() -> JSONResponse:
    """AsyncAPI 3.0 document of the WebSocket at `/v1/kinetostatic-stream`."""
    return JSONResponse(asyncapi())


@router.websocket(PATH)
async def kinetostatic_stream(websocket: WebSocket) -> None:
    """A session: ``open`` → ``opened``, then samples → forces (`wsrender.documents.kinetostatic_stream`)."""
    try:
        principal = await run_in_threadpool(principal_of, websocket, "submit")
    except HttpProblem as problem:
        response = response_of_problem(problem_of_error(problem), None, problem.headers)
        await websocket.send_denial_response(response)
        return
    await websocket.accept(protocol_of(websocket))
    with contextlib.suppress(WebSocketDisconnect):
        try:
            await _serve(websocket, principal)
        except (HttpProblem, WsrenderError) as error:
            await _refuse(websocket, problem_of_error(error))


async def _serve(websocket: WebSocket, principal: Principal) -> None:
    parts: Parts = websocket.app.state.parts
    try:
        async with asyncio.timeout(OPEN_S):
            text = await websocket.receive_text()
    except TimeoutError:
        raise HttpProblem(400, f"no message came within {OPEN_S:g} s", "silent") from None
    except KeyError:
        raise HttpProblem(400, "messages must be text", "bad_request") from None
    if len(text) > parts.settings.max_body_bytes:
        raise HttpProblem(413, f"the first message may have {parts.settings.max_body_bytes} characters")
    document, uploads = await parts.admissions.read(_admitted, text.encode("utf-8", "surrogatepass"))
    await run_in_threadpool(check_uploads, parts.store, principal.owner, uploads)
    async with parts.streams.session(principal.owner, document) as session:
        log.info("stream opened", owner=principal.owner)
        try:
            await _pump(websocket, session, principal)
        finally:
            log.info("stream closed", owner=principal.owner)


def _admitted(text: bytes) -> tuple[str, list[tuple[str, str]]]:
    """The first message, checked, as JSON, and the uploads in it. Raises DocumentError, ModelError, HttpProblem."""
    check_size(text)
    value = read_json(text)
    if not isinstance(value, dict):
        raise DocumentError([("document", f"must be an object, not {type(value).__name__}")])
    choice = StreamOpen(**value)
    canonical = choice.model_dump(mode="json")
    refuse_paths(canonical)
    check_models(canonical)
    return json.dumps(canonical), [*uploads_in(canonical)]


async def _pump(websocket: WebSocket, session: Session, principal: Principal) -> None:
    """Pass messages both ways until one side ends, or the key is revoked."""
    revoked = asyncio.create_task(until_revoked(websocket, principal))
    inwards = asyncio.create_task(_to_loop(websocket, session))
    outwards = asyncio.create_task(_to_client(websocket, session))
    done, pending = await asyncio.wait({inwards, outwards, revoked}, return_when=asyncio.FIRST_COMPLETED)
    if inwards in done and outwards in pending and inwards.exception() is None:
        done, pending = await asyncio.wait({outwards}, timeout=1.0)  # what the loop says of the end
    for task in (inwards, outwards, revoked):
        task.cancel()
    results = await asyncio.gather(inwards, outwards, revoked, return_exceptions=True)
    for result in results:
        if isinstance(result, Exception) and not isinstance(result, WebSocketDisconnect):
            raise result


async def _to_loop(websocket: WebSocket, session: Session) -> None:
    rate = MessageRate(MOST_PER_S)
    while True:
        message = await websocket.receive()
        if rate.exceeded(time.monotonic()):
            raise HttpProblem(429, f"more than {MOST_PER_S} messages came in a second", "too_fast")
        if message["type"] == "websocket.disconnect":
            session.close()
            return
        text = (message.get("text") or "").encode() or (message.get("bytes") or b"")
        if len(text) > LARGEST_SAMPLE:
            raise HttpProblem(413, f"a message may have {LARGEST_SAMPLE} bytes, not {len(text)}", "message_too_large")
        if not session.send(text):
            raise HttpProblem(503, "the loop does not answer", "loop_hung", retryable=True)


async def _to_client(websocket: WebSocket, session: Session) -> None:
    last = b""
    while lines := await session.received():
        for line in lines:
            await websocket.send_text(line.decode())
            last = line
    if last.startswith(b'{"type":"closed"'):
        await websocket.close(NORMAL)
    elif last.startswith(b'{"type":"fault"'):
        await websocket.close(POLICY)
    else:
        how = await run_in_threadpool(end_of, session.process)
        log.error("the process of a stream ended", how=how, pid=session.process.pid)
        raise HttpProblem(500, f"the process of this stream ended ({how})", "crashed")


async def _refuse(websocket: WebSocket, problem: dict[str, Any]) -> None:
    """Say what is wrong, and end."""
    fault = {"type": "fault", "code": problem["code"], "detail": problem["detail"]}
    fault["errors"] = problem.get("errors", [])
    codes = {413: TOO_BIG, 500: INTERNAL, 503: INTERNAL}
    with contextlib.suppress(RuntimeError):  # the client is gone
        await websocket.send_text(json.dumps(fault))
        await websocket.close(codes.get(problem["status"], POLICY))


@cache
def asyncapi() -> dict[str, Any]:
    """The AsyncAPI 3.0 document of the stream; schemas are those of the pydantic models."""
    schemas: dict[str, Any] = {}
    for model in (*FROM_CLIENT, *FROM_SERVER):
        schema = model.model_json_schema(ref_template="#/components/schemas/{model}")
        schemas |= schema.pop("$defs", {})
        schemas[model.__name__] = schema
    names = [model.__name__ for model in (*FROM_CLIENT, *FROM_SERVER)]
    references = {name: {"$ref": f"#/channels/stream/messages/{name}"} for name in names}
    return {
        "asyncapi": "3.0.0",
        "info": {"title": "wsrender kinetostatic stream", "version": __version__},
        "channels": {
            "stream": {"address": PATH, "messages": {name: {"$ref": f"#/components/messages/{name}"} for name in names}}
        },
        "operations": {
            "receive": {
                "action": "receive",
                "channel": {"$ref": "#/channels/stream"},
                "messages": [references[model.__name__] for model in FROM_CLIENT],
            },
            "send": {
                "action": "send",
                "channel": {"$ref": "#/channels/stream"},
                "messages": [references[model.__name__] for model in FROM_SERVER],
            },
        },
        "components": {
            "messages": {name: {"payload": {"$ref": f"#/components/schemas/{name}"}} for name in names},
            "schemas": schemas,
        },
    }
