"""Requests to a server that are sent again when the connection is lost."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Any, Self

import httpx2

from wsrender.client.problems import error_of_response, problem_of_response, retry_after
from wsrender.errors import InputError, ServerConnectionError

FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.1, 5.0
# A proxy without its server, and a server that starts, stops, or waits for its database or disk.
TRY_AGAIN = (502, 503, 504)

OnLoss = Callable[[str], None]


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

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def worth_repeating(response: httpx2.Response) -> bool:
    """Whether the same request may succeed soon: the server is busy, or still at work on its first copy."""
    if response.status_code in TRY_AGAIN:
        return problem_of_response(response).get("retryable", True)
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
