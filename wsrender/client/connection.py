"""Requests to a server that are sent again when the connection is lost.

Problem documents (RFC 9457) are raised as the exceptions of wsrender.errors.
"""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
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
    ServerConnectionError,
    ServerError,
    WsrenderError,
)

_INPUT_ERRORS: dict[str, type[InputError]] = {
    error.code: error
    for error in (InputError, DocumentError, ModelError, FrameNotFoundError, MissingInertiaError, ResourceError)
}
FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.1, 5.0
# A proxy without its server, and a server that starts, stops, or waits for its database or disk.
TRY_AGAIN = (502, 503, 504)

OnLoss = Callable[[str], None]


def error_of_response(response: httpx2.Response) -> WsrenderError:
    """The exception that a response with status 4xx or 5xx stands for; its body must have been read."""
    problem = problem_of_response(response)
    if response.status_code in (401, 403):
        return AccessError(_text(problem), problem)
    if response.status_code == 404:
        return NotFoundError(_text(problem), problem)
    if response.status_code == 429:
        return QuotaError(_text(problem), problem, retry_after(response))
    return error_of_problem(problem)


def problem_of_response(response: httpx2.Response) -> dict[str, Any]:
    """The problem document of a response; made up from its status where a proxy sent something else."""
    try:
        problem = response.json()
    except ValueError:
        problem = None
    if not isinstance(problem, dict):
        problem = {"title": response.reason_phrase or "error"}
    return {**problem, "status": response.status_code}


def error_of_problem(problem: dict[str, Any], default: type[ServerError] = ServerError) -> WsrenderError:
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
    return default(text, problem)


def retry_after(response: httpx2.Response) -> float | None:
    """Seconds of the header Retry-After, None where there are none."""
    try:
        return max(0.0, float(response.headers["Retry-After"]))
    except (KeyError, ValueError):
        return None


def _input_error(kind: type[InputError], problem: dict[str, Any], text: str) -> InputError:
    faults = _faults(problem)
    if kind is DocumentError:
        return DocumentError(faults or [("document", text)])
    field, message = faults[0] if faults else (problem.get("field") or "job", text)
    error = kind.__new__(kind)  # its own constructor composes a message that has arrived complete
    InputError.__init__(error, field, message.removeprefix(f"{field}: "))
    if isinstance(error, FrameNotFoundError):
        error.choices = list(problem.get("choices") or [])
    return error


def _faults(problem: dict[str, Any]) -> list[tuple[str, str]]:
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


def _text(problem: dict[str, Any]) -> str:
    return str(problem.get("detail") or problem.get("title") or f"status {problem.get('status')}")


class Connection:
    """An HTTP connection to one server.

    ``timeout_s`` bounds the wait for an answer [s], ``patience_s`` for how long a lost connection is tried again [s].
    """

    def __init__(
        self,
        url: str,
        token: str | None,
        timeout_s: float,
        patience_s: float,
        transport: httpx2.BaseTransport | None = None,
    ):
        if not url.startswith(("http://", "https://")):
            raise InputError("url", f'must start with http:// or https://, not "{url}"')
        self.timeout_s = timeout_s
        self.patience_s = patience_s
        self._reached = False
        self._http = httpx2.Client(
            base_url=url,
            headers={"Authorization": f"Bearer {token}"} if token else {},
            timeout=timeout_s,
            transport=transport,
        )

    def close(self) -> None:
        """Close all sockets."""
        self._http.close()

    def request(
        self,
        method: str,
        path: str,
        *,
        resend: bool = True,
        patience_s: float | None = None,
        on_loss: OnLoss | None = None,
        **content: Any,
    ) -> httpx2.Response:
        """The answer to a request, sent again with growing pauses while the server is away.

        ``resend=False`` is for requests that must not arrive twice: they are repeated only where they cannot have
        arrived. ``on_loss`` is told why before each pause. ``content`` goes to httpx2.

        Raises ServerConnectionError after ``patience_s``, or at once where this server was never reached; else what
        the server's problem document stands for.
        """
        pauses = self.pauses(patience_s, on_loss)
        while True:
            try:
                response = self._http.request(method, path, **content)
            except httpx2.TransportError as error:
                never_arrived = isinstance(error, httpx2.ConnectError | httpx2.ConnectTimeout)
                pauses.after(error, give_up=not (resend or never_arrived))
                continue
            self._reached = True
            if not worth_repeating(response) or not pauses.after_refusal(response):
                return self.checked(response)

    @contextmanager
    def stream(self, path: str, **content: Any) -> Iterator[httpx2.Response]:
        """The answer to one GET whose body is read piece by piece; raises httpx2.TransportError where it is lost."""
        with self._http.stream("GET", path, **content) as response:
            self._reached = True
            if response.is_error:
                response.read()
            yield response

    def checked(self, response: httpx2.Response) -> httpx2.Response:
        """The response itself, if it is no error."""
        if response.is_error:
            raise error_of_response(response)
        return response

    def pauses(self, patience_s: float | None = None, on_loss: OnLoss | None = None) -> "Pauses":
        """Growing pauses between attempts, until patience is lost."""
        return Pauses(
            str(self._http.base_url).rstrip("/"),
            self.patience_s if patience_s is None else patience_s,
            on_loss or (lambda reason: None),
            lambda: self._reached,
        )


def worth_repeating(response: httpx2.Response) -> bool:
    """Whether the same request may succeed soon: the server is busy, or still at work on its first copy."""
    if response.status_code in TRY_AGAIN:
        return problem_of_response(response).get("retryable", True)
    if response.status_code == 429:  # of a queue that is full, when its own jobs end
        return problem_of_response(response).get("code") == "busy"
    return response.status_code == 409 and problem_of_response(response).get("retryable") is True


class Pauses:
    """Growing pauses between the attempts of one request."""

    def __init__(self, url: str, patience_s: float, on_loss: OnLoss, reached: Callable[[], bool]):
        self._url, self._on_loss, self._reached = url, on_loss, reached
        self._patience_s = patience_s
        self._end = time.monotonic() + patience_s
        self._pause = FIRST_PAUSE_S

    def after(self, error: Exception, give_up: bool = False) -> None:
        """Pause after a lost connection; ServerConnectionError where there is no use in another attempt."""
        reason = str(error) or type(error).__name__
        if isinstance(error, httpx2.UnsupportedProtocol | httpx2.LocalProtocolError):
            raise ServerConnectionError(f"{self._url}: {reason}") from None
        if isinstance(error, httpx2.ConnectError) and not self._reached():
            raise ServerConnectionError(f"no server answers at {self._url}: {reason}") from None
        if give_up:
            raise ServerConnectionError(f"lost the server at {self._url} during a request: {reason}") from None
        if not self._sleep(self._pause, reason):
            raise ServerConnectionError(
                f"lost the server at {self._url} for {self._patience_s:.0f} s: {reason}"
            ) from None

    def after_refusal(self, response: httpx2.Response) -> bool:
        """Pause for as long as a server asks that cannot answer now; False where patience ends before."""
        return self._sleep(retry_after(response) or self._pause, f"status {response.status_code}")

    def again(self) -> None:
        """Start anew: the server answered."""
        self._end = time.monotonic() + self._patience_s
        self._pause = FIRST_PAUSE_S

    def _sleep(self, seconds: float, reason: str) -> bool:
        if time.monotonic() + seconds > self._end:
            return False
        self._on_loss(reason)
        time.sleep(seconds)
        self._pause = min(2 * self._pause, LONGEST_PAUSE_S)
        return True
