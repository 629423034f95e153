"""The server as a process: binds, says where it is, and stops cleanly."""

import gc
import signal
import socket
from collections.abc import Awaitable, Callable
from functools import partial
from typing import Any

import uvicorn

from wsrender.errors import ServerConnectionError, WsrenderError
from wsrender_server.connections import Connection, ConnectionLimits, WebSocketConnection
from wsrender_server.settings import Settings

Application = Callable[[Any, Any, Any], Awaitable[None]]  # ASGI

STOP_S = 3  # for answers under way


def listen(settings: Settings) -> socket.socket:
    """A socket bound to the settings' address; port 0 takes a free one. Raises ServerConnectionError."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    # The protocol is said: without it asyncio leaves TCP_NODELAY off, and answers on kept connections wait 40 ms.
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((settings.host, settings.port))
    except OSError as error:
        listener.close()
        raise ServerConnectionError(f"cannot listen on {settings.host}:{settings.port}: {error.strerror}") from None
    return listener


def address(listener: socket.socket) -> str:
    """The URL of a bound socket."""
    host, port = listener.getsockname()[:2]
    return f"http://[{host}]:{port}" if ":" in host else f"http://{host}:{port}"


def serve_until_stopped(
    app: Application,
    settings: Settings,
    listener: socket.socket,
    on_ready: Callable[[str], None],
    on_stop: Callable[[], None],
) -> None:
    """Answer requests until SIGTERM or SIGINT; ``on_ready`` gets the URL once requests are answered.

    ``on_stop`` is called at the signal, before answers under way are waited for. Raises what the application raised
    where it did not start.
    """
    url = address(listener)
    # Uvicorn repeats the signal that stopped it, for whoever handled it before: nobody, the process ends by returning.
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda number, frame: None)
    guarded, limits = _FaultsAtStart(app), ConnectionLimits(settings)
    config = uvicorn.Config(
        guarded,
        loop="asyncio",  # whatever others have installed: streams hang with uvloop, on which nothing here is tested
        http=partial(Connection, limits=limits),  # pyright: ignore[reportArgumentType]
        ws=partial(WebSocketConnection, limits=limits),  # pyright: ignore[reportArgumentType]
        proxy_headers=False,  # the settings say which proxies are trusted
        log_config=None,
        access_log=False,
        timeout_graceful_shutdown=STOP_S,
        server_header=False,
        ws_per_message_deflate=False,  # messages are small, and must be quick
    )
    try:
        _Announced(config, lambda: on_ready(url), on_stop).run(sockets=[listener])
    except SystemExit:
        if guarded.fault is None:
            raise
        raise guarded.fault from None


class _FaultsAtStart:
    """The application; faults of its start are kept in ``fault`` rather than logged."""

    def __init__(self, app: Application):
        self._app = app
        self.fault: Exception | None = None

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        if scope["type"] != "lifespan":
            await self._app(scope, receive, send)
            return

        async def send_without_traceback(message: dict[str, Any]) -> None:
            await send({**message, "message": ""} if message["type"] == "lifespan.startup.failed" else message)

        try:
            await self._app(scope, receive, send_without_traceback)
        except WsrenderError as fault:
            self.fault = fault


class _Announced(uvicorn.Server):
    """Uvicorn that says when it is ready, and when it stops."""

    def __init__(self, config: uvicorn.Config, on_ready: Callable[[], None], on_stop: Callable[[], None]):
        super().__init__(config)
        self._on_ready, self._on_stop = on_ready, on_stop

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started:
            # What is there by now stays: looking for garbage in it would hold up requests for a tenth of a second.
            gc.collect()
            gc.freeze()
            self._on_ready()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        self._on_stop()
        await super().shutdown(sockets)
