"""What a client may hold open: so many connections, and requests only as long as they keep coming."""

import asyncio
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from time import monotonic
from typing import Any

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.auto import AutoWebSocketsProtocol

from wsrender_server.problems import HttpProblem
from wsrender_server.settings import Settings

SLOWEST = 1 << 14  # bytes/s of a body, beside the time that silence may last
TOO_SLOW = b"HTTP/1.1 408 Request Timeout\r\nconnection: close\r\ncontent-length: 0\r\n\r\n"
TOO_MANY = b"HTTP/1.1 429 Too Many Requests\r\nconnection: close\r\nretry-after: 5\r\ncontent-length: 0\r\n\r\n"


class ConnectionLimits:
    """The limits of the settings, and how many connections each address has."""

    def __init__(self, settings: Settings):
        self.settings = settings
        self.open: Counter[str] = Counter()

    def take(self, host: str) -> bool:
        """Whether an address may have one more connection, which counts from now on; those of proxies do not."""
        if self.settings.trusts(host):
            return True
        if self.open[host] >= self.settings.max_connections_per_client:
            return False
        self.open[host] += 1
        return True

    def give_back(self, host: str) -> None:
        """Forget a connection that counted."""
        self.open -= Counter([host])


class Connection(H11Protocol):
    """A connection that is closed where the head of a request does not come in time, or its client has too many."""

    def __init__(self, *, limits: ConnectionLimits, **options: Any):
        super().__init__(**options)
        self._limits = limits
        self._counted: str | None = None
        self._silence: asyncio.TimerHandle | None = None
        self._spoke = False

    def connection_made(self, transport: asyncio.Transport) -> None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Count the connection; one too many is refused."""
        super().connection_made(transport)
        host = _host(self.client)
        if not self._limits.take(host):
            self._end(TOO_MANY)
            return
        self._counted = host
        self._expect_head()

    def data_received(self, data: bytes) -> None:
        """Take in data; what is no whole head yet must become one in time."""
        self._spoke = True
        super().data_received(data)
        if self.transport.get_protocol() is not self:  # a WebSocket's from now on
            return
        if self.cycle is not None and not self.cycle.response_complete:
            self._head_is_here()
        elif self._silence is None:
            self._expect_head()

    def handle_websocket_upgrade(self, event: Any) -> None:
        """Hand the connection over to the WebSocket, as which it counts."""
        self._forget()
        super().handle_websocket_upgrade(event)

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the connection."""
        self._forget()
        super().connection_lost(exc)

    def _expect_head(self) -> None:
        self._silence = self.loop.call_later(self._limits.settings.read_timeout_s, self._too_slow)

    def _too_slow(self) -> None:
        self._end(TOO_SLOW if self._spoke else b"")

    def _head_is_here(self) -> None:
        if self._silence is not None:
            self._silence.cancel()
            self._silence = None

    def _end(self, answer: bytes) -> None:
        if not self.transport.is_closing():
            self.transport.write(answer)
            self.transport.close()

    def _forget(self) -> None:
        self._head_is_here()
        host, self._counted = self._counted, None
        if host is not None:
            self._limits.give_back(host)


class WebSocketConnection(AutoWebSocketsProtocol):  # pyright: ignore[reportGeneralTypeIssues, reportUntypedBaseClass]
    """A WebSocket, which counts among the connections of its client until it ends."""

    def __init__(self, *, limits: ConnectionLimits, **options: Any):
        super().__init__(**options)
        self._limits = limits

    def connection_made(self, transport: asyncio.Transport) -> None:
        """Count the connection, which has just been given back."""
        super().connection_made(transport)
        self._limits.take(_host(self.client))

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the connection."""
        self._limits.give_back(_host(self.client))
        super().connection_lost(exc)


def _host(client: tuple[str, int] | None) -> str:
    return client[0] if client else ""


class BodyLayer:
    """Around all other layers: a body that does not come in time is answered with 408, and no answer overtakes a body.

    What answers unread, a refusal mostly, has the body read for it: proxies written in Go (Caddy) break off an answer
    that overtakes the request's body. A client that waits to be asked (``Expect: 100-continue``) is not asked for it.
    """

    def __init__(self, app: ASGIApp, settings: Settings):
        self.app = app
        self._timeout_s = settings.read_timeout_s
        self._most_discarded = settings.max_upload_bytes

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request (ASGI)."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        ends: float | None = None  # counted from when somebody asks: a server may be slow to come to it
        complete = headers.get("content-length", "0") == "0" and "transfer-encoding" not in headers
        waits = headers.get("expect", "").lower() == "100-continue"

        async def receive_in_time() -> Message:
            nonlocal ends, complete, waits
            if complete:
                return await receive()
            waits = False
            ends = monotonic() + self._timeout_s if ends is None else ends
            try:
                async with asyncio.timeout(ends - monotonic()):
                    message = await receive()
            except TimeoutError:
                raise HttpProblem(408, f"the body did not come within {self._timeout_s:g} s and 16 KiB/s") from None
            ends += len(message.get("body", b"")) / SLOWEST
            complete = not message.get("more_body", False)
            return message

        async def send_after_body(message: Message) -> None:
            if message["type"] == "http.response.start" and not (complete or waits):
                await self._discard(receive_in_time, lambda: complete)
            await send(message)

        await self.app(scope, receive_in_time, send_after_body)

    async def _discard(self, receive: Receive, complete: Callable[[], bool]) -> None:
        """Read what is left of a body, as much as any may have; one that is too slow or too long is left alone."""
        discarded = 0
        with suppress(HttpProblem):
            while not complete() and discarded <= self._most_discarded:
                discarded += len((await receive()).get("body", b""))
