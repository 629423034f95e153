"""Requests as values, and when they are sent again: what waiting clients and asyncio ones share.

A `Steps` is a generator that yields what has to be done next, `Request` or `Pause`, is sent the response, and returns
what came of it; a lost connection is thrown into it as httpx2.TransportError. `wsrender.client.connection` runs it,
by waiting or by asyncio.
"""

import time
from collections.abc import Callable, Generator, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from typing import Any, TypeAlias, TypeVar

import httpx2

from wsrender.client.problems import error_of_response, problem_in, retry_after
from wsrender.client.records import not_understood
from wsrender.errors import DocumentError, InputError, ServerConnectionError, WsrenderError
from wsrender.version import __version__

FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.1, 5.0
# A proxy without its server, and a server that starts, stops, or waits for its database or disk.
TRY_AGAIN = (502, 503, 504)
# Problems whose cause may be that one side is older than the other.
OF_VERSIONS = ("invalid_request", "not_found", "method_not_allowed")

T = TypeVar("T")
OnLoss = Callable[[str], None]
TakeBytes = Callable[[bytes], object]


@dataclass(frozen=True)
class Request:
    """One request to a server.

    ``content`` or ``json`` is its body, ``timeout_s`` bounds the wait for the answer (None: as the client has it).
    ``into`` is told the head of an answer that is no error, and what it gives takes the body piece by piece.
    """

    method: str
    path: str
    params: Mapping[str, str | int | float] = field(default_factory=dict)
    headers: Mapping[str, str] = field(default_factory=dict)
    content: bytes | None = None
    json: Any = None
    timeout_s: float | None = None
    into: Callable[[httpx2.Response], AbstractContextManager[TakeBytes]] | None = None


@dataclass(frozen=True)
class Pause:
    """A time to wait [s]."""

    seconds: float


Steps: TypeAlias = Generator[Request | Pause, httpx2.Response | None, T]


class Server:
    """What is known of a server: its address, how long to wait for it [s], and whether it was ever reached."""

    def __init__(self, url: str, timeout_s: float, patience_s: float):
        if not url.startswith(("http://", "https://")):
            raise InputError("url", f'must start with http:// or https://, not "{url}"')
        try:
            if not httpx2.URL(url).host:
                raise InputError("url", f'must name a server, not "{url}"')
        except httpx2.InvalidURL as error:
            raise InputError("url", f"{url} is no address: {error}") from None
        self.url, self.timeout_s, self.patience_s = url.rstrip("/"), timeout_s, patience_s
        self.reached = False

    def pauses(self, patience_s: float | None = None, on_loss: OnLoss | None = None) -> "Pauses":
        """Growing pauses between attempts, until patience is lost."""
        return Pauses(self, self.patience_s if patience_s is None else patience_s, on_loss or (lambda reason: None))


def sent(request: Request) -> Steps[httpx2.Response]:
    """The response to one request, whatever it is; raises httpx2.TransportError where the connection is lost."""
    response = yield request
    assert response is not None
    return response


def asked(
    server: Server,
    request: Request,
    *,
    resend: bool = True,
    patience_s: float | None = None,
    on_loss: OnLoss | None = None,
) -> Steps[httpx2.Response]:
    """The answer to a request, sent again with growing pauses while the server is away.

    ``resend=False`` is for requests that must not arrive twice: they are repeated only where they cannot have
    arrived. ``on_loss`` is told why before each pause.

    Raises ServerConnectionError after ``patience_s``, or at once where this server was never reached; else what
    the server's problem document stands for.
    """
    pauses = server.pauses(patience_s, on_loss)
    while True:
        try:
            response = yield from sent(request)
        except httpx2.TransportError as error:
            never_arrived = isinstance(error, httpx2.ConnectError | httpx2.ConnectTimeout)
            yield pauses.after(error, give_up=not (resend or never_arrived))
            continue
        server.reached = True
        if worth_repeating(response) and (pause := pauses.after_refusal(response)):
            yield pause
            continue
        return (yield from checked(server, response))


def checked(server: Server, response: httpx2.Response) -> Steps[httpx2.Response]:
    """The response itself, if it is no error; what one version has and the other lacks is told with both versions."""
    if response.is_success:
        return response
    error, problem = error_of_response(response, server.url), problem_in(response)
    if isinstance(error, DocumentError) or (problem is not None and problem.get("code") in OF_VERSIONS):
        yield from _versions_noted(server, error)
    raise error


def _versions_noted(server: Server, error: WsrenderError) -> Steps[None]:
    try:
        said = yield from sent(Request("GET", "/v1/version"))
        version = said.json().get("wsrender") if said.is_success else None
    except (httpx2.TransportError, ValueError, AttributeError):
        return  # the error is told without
    if isinstance(version, str) and version != __version__:
        note = f"the server has wsrender {version}, this client {__version__}: what one knows the other may lack"
        error.add_note(note)


def answer(server: Server, request: Request, **options: Any) -> Steps[dict[str, Any]]:
    """The JSON object that answers a request. Raises ServerError where something else does; what `asked` raises."""
    response = yield from asked(server, request, **options)
    try:
        found = response.json()
    except ValueError:
        found = None
    if not isinstance(found, dict):
        kind = response.headers.get("Content-Type", "nothing").partition(";")[0]
        raise not_understood(server.url, f"{kind} at {request.path}")
    return found


def member(server: Server, request: Request, found: Mapping[str, Any], name: str, kind: type[T]) -> T:
    """A member of an answer. Raises ServerError where it is missing or of another kind."""
    value = found.get(name)
    if not isinstance(value, kind):
        raise not_understood(server.url, f"no {name!r} at {request.path}", found.get("version"))
    return value


def worth_repeating(response: httpx2.Response) -> bool:
    """Whether the same request may succeed soon: the server is busy, or still at work on its first copy."""
    problem = problem_in(response) if response.is_error else None
    if response.status_code in TRY_AGAIN:
        return (problem or {}).get("retryable", True)
    if response.status_code == 429:  # of a queue that is full, when its own jobs end
        return (problem or {}).get("code") == "busy"
    return response.status_code == 409 and (problem or {}).get("retryable") is True


class Pauses:
    """Growing pauses between the attempts of one request."""

    def __init__(self, server: Server, patience_s: float, on_loss: OnLoss):
        self._server, self._patience_s, self._on_loss = server, patience_s, on_loss
        self._end = time.monotonic() + patience_s
        self._pause = FIRST_PAUSE_S

    def after(self, error: Exception, give_up: bool = False) -> Pause:
        """The pause after a lost connection; ServerConnectionError where there is no use in another attempt."""
        reason, url = str(error) or type(error).__name__, self._server.url
        if isinstance(error, httpx2.UnsupportedProtocol | httpx2.LocalProtocolError):
            raise ServerConnectionError(f"{url}: {reason}") from None
        if isinstance(error, httpx2.ConnectError) and not self._server.reached:
            raise ServerConnectionError(f"no server answers at {url}: {reason}") from None
        if give_up:
            raise ServerConnectionError(f"lost the server at {url} during a request: {reason}") from None
        if pause := self._next(self._pause, reason):
            return pause
        raise ServerConnectionError(f"lost the server at {url} for {self._patience_s:.0f} s: {reason}") from None

    def after_refusal(self, response: httpx2.Response) -> Pause | None:
        """The pause that a server asks for that cannot answer now; None where patience ends before."""
        return self._next(retry_after(response) or self._pause, f"status {response.status_code}")

    def again(self) -> None:
        """Start anew: the server answered."""
        self._end = time.monotonic() + self._patience_s
        self._pause = FIRST_PAUSE_S

    def _next(self, seconds: float, reason: str) -> Pause | None:
        if time.monotonic() + seconds > self._end:
            return None
        self._on_loss(reason)
        self._pause = min(2 * self._pause, LONGEST_PAUSE_S)
        return Pause(seconds)
