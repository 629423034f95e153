"""The layer around every request: its id, limit, log line and metrics, and the last answer to a fault."""

import re
import time
import uuid
from collections.abc import Callable, MutableMapping
from typing import Any

import structlog
from anyio import BrokenResourceError
from starlette.datastructures import MutableHeaders
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from wsrender_server.metrics import Metrics
from wsrender_server.problems import HttpProblem, problem_of_error, response_of_problem
from wsrender_server.settings import PREFIX, Settings

REQUEST_ID = re.compile(r"[A-Za-z0-9._-]{8,64}")
UPLOADS = "/v1/models"
SAFE_HEADERS = {"X-Content-Type-Options": "nosniff"}

log = structlog.get_logger("wsrender.http")


def at_end(request: Request, function: Callable[[], None]) -> None:
    """Call a function once a request has ended, however it does; on the event loop."""
    request.state.at_end.append(function)


class RequestLayer:
    """Gives each request an id (the client's ``X-Request-Id`` if it is plain), limits its body, logs its end.

    Whatever the application does not answer is answered with a problem document and logged with its traceback.
    """

    def __init__(self, app: ASGIApp, metrics: Metrics, settings: Settings):
        self.app = app
        self._metrics = metrics
        self._settings = settings

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request (ASGI)."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        state: MutableMapping[str, Any] = scope.setdefault("state", {})
        state["request_id"] = request_id = _request_id(scope)
        state["at_end"] = ends = []
        started, status, first_byte = time.perf_counter(), 0, 0.0

        async def send_with_headers(message: Message) -> None:
            nonlocal status, first_byte
            if message["type"] == "http.response.start":
                status, first_byte = message["status"], time.perf_counter() - started
                headers = MutableHeaders(scope=message)
                headers["X-Request-Id"] = request_id
                for name, value in SAFE_HEADERS.items():
                    headers.setdefault(name, value)
            await send(message)

        with structlog.contextvars.bound_contextvars(request_id=request_id):
            try:
                await self.app(scope, self._limited(scope, receive), send_with_headers)
            except Exception as error:
                if status and _client_left(error):
                    return
                log.exception("request failed", path=scope["path"])
                if status:  # the answer is on its way and breaks off
                    raise
                response = response_of_problem(problem_of_error(error), request_id)
                await response(scope, receive, send_with_headers)
            finally:
                for each in ends:
                    each()
                self._record(scope, state, status, first_byte, time.perf_counter() - started)

    def _limited(self, scope: Scope, receive: Receive) -> Receive:
        setting = "max_upload_bytes" if scope["path"].endswith(UPLOADS) else "max_body_bytes"
        limit, received = getattr(self._settings, setting), 0
        announced = dict(scope["headers"]).get(b"content-length", b"0")

        async def receive_within_limit() -> Message:
            nonlocal received
            if announced.isdigit() and int(announced) > limit:
                raise _too_large(limit, setting)
            message = await receive()
            received += len(message.get("body", b""))
            if received > limit:
                raise _too_large(limit, setting)
            return message

        return receive_within_limit

    def _record(
        self, scope: Scope, state: MutableMapping[str, Any], status: int, first_byte: float, seconds: float
    ) -> None:
        route = getattr(scope.get("route"), "path_format", "unmatched")
        self._metrics.answered(scope["method"], route, status, first_byte or seconds)
        known = {name: state[name] for name in ("owner", "job_id") if name in state}
        job_id = (scope.get("path_params") or {}).get("job_id")
        if job_id is not None:
            known["job_id"] = job_id
        log.info(
            "request", method=scope["method"], path=scope["path"], status=status, seconds=round(seconds, 4), **known
        )


def _client_left(error: Exception) -> bool:
    """Whether an exception is only what FastAPI's event streams end with when their client is gone."""
    return isinstance(error, ExceptionGroup) and error.split(BrokenResourceError)[1] is None


def _too_large(limit: int, setting: str) -> HttpProblem:
    return HttpProblem(413, f"the body may have {limit:,} bytes, which {PREFIX}{setting.upper()} of this server allows")


def _request_id(scope: Scope) -> str:
    given = dict(scope["headers"]).get(b"x-request-id", b"").decode("latin-1")
    return given if REQUEST_ID.fullmatch(given) else uuid.uuid4().hex[:16]
