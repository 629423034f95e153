"""The server as a process: binds, says where it is, and stops cleanly."""

import signal
import socket
from collections.abc import Callable

import uvicorn

from wsrender.errors import ServerConnectionError
from wsrender_server.settings import Settings

STOP_S = 3  # for answers under way; event streams never end by themselves


def listen(settings: Settings) -> socket.socket:
    """A socket bound to the settings' address; port 0 takes a free one. Raises ServerConnectionError."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
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


def serve_until_stopped(app: Callable, listener: socket.socket, on_ready: Callable[[str], None]) -> None:
    """Answer requests until SIGTERM or SIGINT; ``on_ready`` gets the URL once requests are answered."""
    url = address(listener)
    # Uvicorn repeats the signal that stopped it, for whoever handled it before: nobody, the process ends by returning.
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda number, frame: None)
    config = uvicorn.Config(
        app,
        log_config=None,
        access_log=False,
        timeout_graceful_shutdown=STOP_S,
        server_header=False,
        proxy_headers=False,
    )
    _Announced(config, lambda: on_ready(url)).run(sockets=[listener])


class _Announced(uvicorn.Server):
    """Uvicorn that says when it is ready."""

    def __init__(self, config: uvicorn.Config, on_ready: Callable[[], None]):
        super().__init__(config)
        self._on_ready = on_ready

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started:
            self._on_ready()
