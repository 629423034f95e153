"""Errors as problem documents (RFC 9457): one table from exceptions to status, title and ``retryable``."""

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from http import HTTPStatus
from typing import Any

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, ConfigDict, Field
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse, Response

from wsrender.errors import (
    DocumentError,
    FrameNotFoundError,
    InputError,
    MissingExtraError,
    MissingInertiaError,
    ModelError,
    NotConvergedError,
    NumericalError,
    ResourceError,
    WsrenderError,
)
from wsrender_server.jobs.faults import (
    DiskFull,
    EngineUnavailable,
    IdempotencyConflict,
    InvalidTransition,
    JobFault,
    QueueFull,
    QuotaExceeded,
    ResultExpired,
    StoreUnavailable,
    TargetNotAllowed,
)
from wsrender_server.jobs.files import is_full

log = structlog.get_logger("wsrender.http")
MEDIA_TYPE = "application/problem+json"
TRY_AGAIN_S = 5
BODILESS = ("GET", "HEAD", "DELETE")  # methods
_STEP = re.compile(r'"(?:[^"\\]|\\.)*"|[^.]+')  # of a dotted path; a key with dots in it is a JSON string


class ProblemField(BaseModel):
    """One bad field of a request."""

    pointer: str
    """JSON pointer into the body as a URI fragment, ``#/robot/library``; a parameter's name otherwise."""
    detail: str
    """What is allowed there, and what was found."""

    model_config = ConfigDict(use_attribute_docstrings=True, extra="forbid")


class Problem(BaseModel):
    """What went wrong (RFC 9457)."""

    type: str = Field(examples=["urn:wsrender:problem:invalid_document"])
    """URI of the kind of problem."""
    title: str = Field(examples=["The job document is not valid"])
    """The kind of problem in words."""
    status: int = Field(ge=400, le=599, examples=[422])
    """HTTP status."""
    detail: str = Field(examples=["sampling.count: must be at least 1, not 0"])
    """What went wrong this time."""
    code: str = Field(examples=["invalid_document"])
    """The kind of problem for programs; stable."""
    retryable: bool = Field(examples=[False])
    """Whether the same request may succeed later."""
    errors: list[ProblemField] | None = None
    """Every bad field."""
    choices: list[str] | None = None
    """What could have been chosen."""
    checks: dict[str, str] | None = None
    """Parts of the server and how they are: "ok", or what is wrong with them."""
    request_id: str | None = Field(None, examples=["0f9f6a1c2b9d4a0e"])
    """The request in the server's logs."""

    model_config = ConfigDict(use_attribute_docstrings=True)


@dataclass(frozen=True)
class Answer:
    """How a kind of exception is answered."""

    status: int
    title: str
    retryable: bool = False


# A document that breaks its schema is answered with 422; one that keeps to it, but cannot be had on this server or for
# this robot, with 409. The nearest base class counts.
ANSWERS: dict[type[BaseException], Answer] = {
    DocumentError: Answer(422, "The job document is not valid"),
    ModelError: Answer(422, "The robot model is malformed, hostile or unsupported"),
    FrameNotFoundError: Answer(409, "The robot has no such frame"),
    MissingInertiaError: Answer(409, "The robot has no published inertias"),
    ResourceError: Answer(409, "The job is larger than allowed"),
    InputError: Answer(422, "A value is not allowed"),
    NotConvergedError: Answer(409, "The iteration has not converged"),
    NumericalError: Answer(409, "The computation went wrong"),
    MissingExtraError: Answer(503, "The server lacks a package"),
    IdempotencyConflict: Answer(422, "The idempotency key was used with another body"),
    InvalidTransition: Answer(409, "The job's state does not allow that"),
    QueueFull: Answer(429, "Too many unfinished jobs", retryable=True),
    TargetNotAllowed: Answer(409, "No webhook is sent there"),
    QuotaExceeded: Answer(409, "The quota is used up"),
    ResultExpired: Answer(409, "The result is no longer kept"),
    StoreUnavailable: Answer(503, "The database does not answer", retryable=True),
    DiskFull: Answer(503, "The disk is full", retryable=True),
    EngineUnavailable: Answer(503, "No worker answers", retryable=True),
    WsrenderError: Answer(500, "The server failed"),
}

# Codes of statuses that the framework raises by itself.
CODES = {
    400: "bad_request",
    401: "unauthorized",
    403: "forbidden",
    404: "not_found",
    405: "method_not_allowed",
    406: "not_acceptable",
    408: "request_timeout",
    413: "body_too_large",
    415: "unsupported_media_type",
    416: "range_not_satisfiable",
    422: "invalid_request",
    429: "too_many_requests",
    500: "internal_error",
    503: "unavailable",
}


@dataclass(eq=False)
class HttpProblem(Exception):  # noqa: N818
    """A problem that only the HTTP side knows; ``errors`` holds (pointer, detail) of each bad field.

    ``extra`` holds other members of the problem document; ``code`` and ``title`` are those of the status by default.
    """

    status: int
    detail: str
    code: str | None = None
    retryable: bool = False
    errors: Iterable[tuple[str, str]] = ()
    title: str | None = None
    headers: Mapping[str, str] = field(default_factory=dict)
    extra: Mapping[str, Any] = field(default_factory=dict)


def problem(
    status: int,
    code: str,
    detail: str,
    *,
    title: str | None = None,
    retryable: bool = False,
    errors: Iterable[tuple[str, str]] = (),
    **extra: Any,
) -> dict[str, Any]:
    """A problem document; ``errors`` holds (pointer, detail) of each bad field."""
    fields = [{"pointer": pointer, "detail": text} for pointer, text in errors]
    document = {
        "type": f"urn:wsrender:problem:{code}",
        "title": title or HTTPStatus(status).phrase,
        "status": status,
        "detail": detail,
        "code": code,
        "retryable": retryable,
        **({"errors": fields} if fields else {}),
    }
    return document | {name: value for name, value in extra.items() if value is not None}


def problem_of_error(error: BaseException, prefix: str | None = "") -> dict[str, Any]:
    """The problem document of an exception; ``prefix`` is where in the body its fields are, None: in no body."""
    if isinstance(error, HttpProblem):
        code = error.code or CODES[error.status]
        title, errors = error.title, error.errors
        return problem(
            error.status, code, error.detail, title=title, retryable=error.retryable, errors=errors, **error.extra
        )
    if isinstance(error, OSError) and is_full(error):
        return problem_of_error(DiskFull("the server's disk is full; nothing was changed"))
    if isinstance(error, StoreUnavailable) and error.__cause__ is not None:
        # What a driver says names host and user of the database: for the log, not for whoever asks.
        log.warning("database unavailable", error=str(error))
        error = StoreUnavailable("the database does not answer; nothing was changed")
    answer = next((ANSWERS[kind] for kind in type(error).__mro__ if kind in ANSWERS), None)
    if answer is None:
        return problem(500, "internal_error", "The server failed; its logs say more under the request id.")
    return problem(
        answer.status,
        getattr(error, "code", "internal_error"),
        str(error),
        title=answer.title,
        retryable=answer.retryable,
        errors=_bad_fields(error, prefix),
        choices=getattr(error, "choices", None),
    )


def problem_of_job(error: Mapping[str, Any]) -> dict[str, Any]:
    """The problem document of a job's error: code, message, retryable, and where known field or problems."""
    code = str(error.get("code", "internal_error"))
    kinds = {kind.code: answer for kind, answer in ANSWERS.items() if issubclass(kind, WsrenderError)}
    answer = kinds.get(code, Answer(500, code.replace("_", " ").capitalize()))
    fields = error.get("problems") or ([(error["field"], error.get("message", ""))] if error.get("field") else [])
    return problem(
        answer.status,
        code,
        str(error.get("message") or answer.title),
        title=answer.title,
        retryable=bool(error.get("retryable", answer.retryable)),
        errors=[(pointer(name), str(text)) for name, text in fields],
        choices=error.get("choices"),
    )


def refusal(document: Mapping[str, Any], status: int) -> HttpProblem:
    """An exception that is answered with a problem document under another status."""
    return HttpProblem(
        status,
        document["detail"],
        document["code"],
        document["retryable"],
        [(field["pointer"], field["detail"]) for field in document.get("errors", [])],
        document["title"],
        extra={name: document[name] for name in ("choices",) if name in document},
    )


def pointer(dotted: str, prefix: str = "") -> str:
    """JSON pointer, as a URI fragment, of a dotted path within ``prefix``; the whole body for "document"."""
    steps = [] if dotted == "document" else map(_key, _STEP.findall(dotted))
    return "#" + prefix + "".join("/" + step.replace("~", "~0").replace("/", "~1") for step in steps)


def _key(step: str) -> str:
    try:
        return json.loads(step, strict=False) if step.startswith('"') else step
    except ValueError:  # the quotation mark is the key's own
        return step


def _bad_fields(error: BaseException, prefix: str | None) -> list[tuple[str, str]]:
    if prefix is None:
        return [(error.field, error.message)] if isinstance(error, InputError) else []
    if isinstance(error, DocumentError):
        return [(pointer(name, prefix), message) for name, message in error.problems]
    if isinstance(error, InputError):
        return [(pointer(error.field, prefix), error.message)]
    return []


def response_of_problem(
    document: Mapping[str, Any], request_id: str | None, headers: Mapping[str, str] | None = None
) -> Response:
    """The response with a problem document; Retry-After where another attempt may help."""
    all_headers = dict(headers or {})
    if document["retryable"] and document["status"] in (409, 429, 503):
        all_headers.setdefault("Retry-After", str(TRY_AGAIN_S))
    content = {**document, **({"request_id": request_id} if request_id else {})}
    return JSONResponse(content, document["status"], all_headers, MEDIA_TYPE)


def answer_errors(app: FastAPI) -> None:
    """Answer every exception of ``app`` with a problem document."""
    for kind in (HttpProblem, WsrenderError, JobFault, OSError):
        app.add_exception_handler(kind, _answer_error)
    app.add_exception_handler(RequestValidationError, _answer_invalid_parameters)
    app.add_exception_handler(HTTPException, _answer_http_exception)


async def _answer_error(request: Request, error: Exception) -> Response:
    document = problem_of_error(error, None if request.method in BODILESS else "")
    if document["status"] == 500:
        raise error  # the outermost layer logs it and answers
    headers = error.headers if isinstance(error, HttpProblem) else {}
    return response_of_problem(document, _request_id(request), headers)


async def _answer_invalid_parameters(request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    faults = error.errors()
    if faults[0]["type"] == "json_invalid":
        document = problem(400, "malformed_json", "the body is not JSON", errors=[("#", faults[0]["msg"])])
        return response_of_problem(document, _request_id(request))
    fields = []
    for fault in faults:
        place, *path = fault["loc"]
        name = "#" + "".join(f"/{step}" for step in path) if place == "body" else ".".join(map(str, path))
        fields.append((name, fault["msg"]))
    detail = "; ".join(f"{name}: {message}" for name, message in fields)
    document = problem(422, "invalid_request", detail, title="A parameter is not valid", errors=fields)
    return response_of_problem(document, _request_id(request))


async def _answer_http_exception(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    headers = dict(error.headers or {})
    if error.status_code == 405:
        headers["Allow"] = ", ".join(sorted(allowed_methods(request)))
        detail = f"{request.method} is not allowed here; allowed: {headers['Allow']}"
    elif error.status_code == 404:
        detail = f"there is nothing at {request.url.path}"
    else:
        detail = str(error.detail)
    document = problem(error.status_code, CODES.get(error.status_code, "http_error"), detail)
    return response_of_problem(document, _request_id(request), headers)


def allowed_methods(request: Request) -> set[str]:
    """Methods of every route of the app that matches the request's path; the documentation is there to be read."""
    methods = [methods for path, methods in request.app.state.methods_by_path if path.match(request.scope["path"])]
    return set[str]().union(*methods) or {"GET", "HEAD"}


def _request_id(request: Request) -> str | None:
    return getattr(request.state, "request_id", None)


def problem_responses(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """The declaration of problem responses for OpenAPI; those that any request may get are included."""
    content = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}
    retry = {"Retry-After": {"description": "Seconds to wait.", "schema": {"type": "integer", "minimum": 0}}}
    return {
        status: {
            "description": HTTPStatus(status).phrase,
            "content": content,
            **({"headers": retry} if status in (429, 503) else {}),
        }
        for status in sorted({*statuses, 400, 403, 422, 500, 503})
    }
