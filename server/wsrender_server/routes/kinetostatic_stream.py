"""The live stream over WebSocket: where a device is, and the force that it shall render."""

import asyncio
import contextlib
import json
import time
from functools import cache
from typing import Any
from urllib.parse import urlsplit

import structlog
from fastapi import APIRouter, WebSocket
from fastapi.responses import JSONResponse
from starlette.concurrency import run_in_threadpool
from starlette.websockets import WebSocketDisconnect

from wsrender import __version__
from wsrender.documents.kinetostatic_stream import FROM_CLIENT, FROM_SERVER, LARGEST_SAMPLE, StreamOpen
from wsrender.documents.reading import read_json
from wsrender.errors import DocumentError, WsrenderError
from wsrender_server.admission import Admission, refuse_paths
from wsrender_server.auth import Principal, entitled
from wsrender_server.parts import Parts
from wsrender_server.problems import HttpProblem, problem_of_error, problem_responses, response_of_problem
from wsrender_server.query import check_parameters
from wsrender_server.streams.sessions import MessageRate, Session

PATH = "/v1/kinetostatic-stream"
PROTOCOL = "wsrender.v1"  # the WebSocket subprotocol, where a client offers any
KEY_PREFIX = "wsrender.key."  # of a subprotocol that carries an API key: browsers cannot set headers
MOST_PER_S = 4000  # messages of a client
OPEN_S = 30.0  # for the client's first message
POLICY, TOO_BIG, INTERNAL, NORMAL = 1008, 1009, 1011, 1000  # close codes (RFC 6455)

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
    offered = websocket.scope.get("subprotocols", [])
    try:
        principal = await run_in_threadpool(_entitled, websocket, offered)
    except HttpProblem as problem:
        response = response_of_problem(problem_of_error(problem), None, problem.headers)
        await websocket.send_denial_response(response)
        return
    await websocket.accept(PROTOCOL if PROTOCOL in offered else None)
    with contextlib.suppress(WebSocketDisconnect):
        try:
            await _serve(websocket, principal)
        except (HttpProblem, WsrenderError) as error:
            await _refuse(websocket, problem_of_error(error))


def _entitled(websocket: WebSocket, offered: list[str]) -> Principal:
    """Who connects: by the header Authorization, or by a subprotocol; raises HttpProblem."""
    check_parameters(websocket)
    origin = websocket.headers.get("origin")
    if origin is not None and _host_of(origin) != websocket.url.hostname:
        raise HttpProblem(403, f"pages of {origin} may not connect", "wrong_origin")
    scheme, _, secret = websocket.headers.get("authorization", "").partition(" ")
    keys = [secret] if scheme.lower() == "bearer" else []
    keys += [name.removeprefix(KEY_PREFIX) for name in offered if name.startswith(KEY_PREFIX)]
    return entitled(websocket, keys[0] if keys else None, "submit")


def _host_of(origin: str) -> str | None:
    try:
        return urlsplit(origin).hostname
    except ValueError:
        return None


async def _serve(websocket: WebSocket, principal: Principal) -> None:
    parts: Parts = websocket.app.state.parts
    try:
        text = await asyncio.wait_for(websocket.receive_text(), OPEN_S)
    except TimeoutError:
        raise HttpProblem(400, f"no message came within {OPEN_S:g} s", "silent") from None
    except KeyError:
        raise HttpProblem(400, "messages must be text", "bad_request") from None
    if len(text) > parts.settings.max_body_bytes:
        raise HttpProblem(413, f"the first message may have {parts.settings.max_body_bytes} characters")
    document = await run_in_threadpool(_admitted, parts, principal, text)
    async with parts.streams.session(principal.owner, document) as session:
        log.info("stream opened", owner=principal.owner)
        try:
            await _pump(websocket, session)
        finally:
            log.info("stream closed", owner=principal.owner)


def _admitted(parts: Parts, principal: Principal, text: str) -> str:
    """The first message, checked; JSON text. Raises DocumentError, ModelError, HttpProblem."""
    value = read_json(text)
    if not isinstance(value, dict):
        raise DocumentError([("document", f"must be an object, not {type(value).__name__}")])
    choice = StreamOpen(**value)
    canonical = choice.model_dump(mode="json")
    refuse_paths(canonical)
    Admission(parts.store, principal.owner, parts.settings.max_samples, "").check_models(canonical)
    return json.dumps(canonical)


async def _pump(websocket: WebSocket, session: Session) -> None:
    """Pass messages both ways until one side ends."""
    inwards = asyncio.create_task(_to_loop(websocket, session))
    outwards = asyncio.create_task(_to_client(websocket, session))
    done, pending = await asyncio.wait({inwards, outwards}, return_when=asyncio.FIRST_COMPLETED)
    if inwards in done and outwards in pending and inwards.exception() is None:
        done, pending = await asyncio.wait({outwards}, timeout=1.0)  # what the loop says of the end
    for task in (inwards, outwards):
        task.cancel()
    results = await asyncio.gather(inwards, outwards, return_exceptions=True)
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
        raise HttpProblem(500, "the process of this stream ended", "crashed")


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
