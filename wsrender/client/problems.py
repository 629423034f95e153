"""Problem documents (RFC 9457) as the exceptions of wsrender.errors."""

from collections.abc import Mapping
from typing import Any

import httpx2

from wsrender.errors import (
    AccessError,
    DocumentError,
    FrameNotFoundError,
    InputError,
    MissingInertiaError,
    ModelError,
    NotConvergedError,
    NotFoundError,
    NumericalError,
    QuotaError,
    ResourceError,
    ServerError,
    WsrenderError,
)

_INPUT_ERRORS: dict[str, type[InputError]] = {
    error.code: error
    for error in (InputError, DocumentError, ModelError, FrameNotFoundError, MissingInertiaError, ResourceError)
}


def error_of_response(response: httpx2.Response, url: str) -> WsrenderError:
    """The exception that a response which is no success stands for; its body must have been read."""
    problem = problem_in(response)
    if problem is None:  # of a proxy, or of what is no wsrender
        status = f"{response.status_code} {response.reason_phrase}".rstrip()
        kind = response.headers.get("Content-Type", "no text").partition(";")[0]
        detail = f"{url} answers {status} with {kind}; that is a proxy, or another server than wsrender"
        problem = {"detail": detail, "status": response.status_code}
    if response.status_code in (401, 403):
        return AccessError(_text(problem), problem)
    if response.status_code == 404:
        return NotFoundError(_text(problem), problem)
    if response.status_code == 429:
        return QuotaError(_text(problem), problem, retry_after(response))
    return error_of_problem(problem)


def problem_in(response: httpx2.Response) -> dict[str, Any] | None:
    """The problem document of a response; None where there is none, such as in a page of a proxy."""
    try:
        problem = response.json()
    except ValueError:
        return None
    return {**problem, "status": response.status_code} if isinstance(problem, dict) else None


def error_of_problem(problem: Mapping[str, Any], default: type[ServerError] = ServerError) -> WsrenderError:
    """The exception that a problem document stands for: that of a local run where there is one.

    ``default`` is the class for codes that a local run does not have.
    """
    code, text = problem.get("code"), _text(problem)
    if code in _INPUT_ERRORS:
        return _input_error(_INPUT_ERRORS[code], problem, text)
    if code == NotConvergedError.code:
        return NotConvergedError(text, problem.get("sequence") or [])
    if code == NumericalError.code:
        return NumericalError(text)
    return default(text, dict(problem))


def retry_after(response: httpx2.Response) -> float | None:
    """Seconds of the header Retry-After, None where there are none."""
    try:
        return max(0.0, float(response.headers["Retry-After"]))
    except (KeyError, ValueError):
        return None


def _input_error(kind: type[InputError], problem: Mapping[str, Any], text: str) -> InputError:
    faults = _faults(problem)
    if kind is DocumentError:
        return DocumentError(faults or [("document", text)])
    field, message = faults[0] if faults else (problem.get("field") or "job", text)
    error = kind.__new__(kind)  # its own constructor composes a message that has arrived complete
    InputError.__init__(error, field, message.removeprefix(f"{field}: "))
    if isinstance(error, FrameNotFoundError):
        error.choices = list(problem.get("choices") or [])
    return error


def _faults(problem: Mapping[str, Any]) -> list[tuple[str, str]]:
    """(field, message) of every fault that a problem lists under ``errors``."""
    faults = problem.get("errors")
    return [
        (_field(str(fault.get("pointer") or "")), str(fault.get("detail") or "is not allowed"))
        for fault in (faults if isinstance(faults, list) else [])
        if isinstance(fault, dict)
    ]


def _field(pointer: str) -> str:
    """Dotted path of a JSON pointer, with or without its leading ``#``."""
    parts = pointer.removeprefix("#").split("/")
    names = [part.replace("~1", "/").replace("~0", "~") for part in parts if part]
    return ".".join(names) or "document"


def _text(problem: Mapping[str, Any]) -> str:
    return str(problem.get("detail") or problem.get("title") or f"status {problem.get('status')}")
