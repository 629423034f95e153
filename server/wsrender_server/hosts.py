"""Which names the server answers to, whose pages may ask it, and the prefix under which a proxy shows it."""

import ipaddress
import platform
import re
from contextvars import ContextVar
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.requests import HTTPConnection
from starlette.types import ASGIApp, Receive, Scope, Send

from wsrender_server.problems import HttpProblem, problem_of_error, response_of_problem
from wsrender_server.settings import Settings

LOCAL_NAMES = ("localhost", "ip6-localhost")
# Of a header: name or address, which may have a zone, and a port.
_HOST = re.compile(r"(\[[0-9A-Fa-f:.]+(?:%[A-Za-z0-9._~-]+)?\]|[A-Za-z0-9._-]+)(?::[0-9]{1,5})?")
_PREFIX = re.compile(r"(/[A-Za-z0-9._~-]+)+")
_shown_under: ContextVar[str] = ContextVar("shown_under", default="")


def address(path: str) -> str:
    """Where whoever asks now finds a path of the server: a proxy may show it under a prefix."""
    return _shown_under.get() + path


def is_loopback(host: str) -> bool:
    """Whether an address or name can only be reached from this machine."""
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host.lower().rstrip(".") in LOCAL_NAMES


def host_of(headers: Headers) -> str:
    """The name or address by which the server is asked, without its port; empty where the header is none."""
    name = _HOST.fullmatch(headers.get("host", ""))
    return "" if name is None else name[1]


def check_names(connection: HTTPConnection, settings: Settings) -> None:
    """Refuse what comes by a name of somebody else's (DNS rebinding), or from pages of another host (CSRF).

    Raises HttpProblem 403.
    """
    host, origin = host_of(connection.headers), connection.headers.get("origin")
    if not _may_be_ours(host, settings):
        given = connection.headers.get("host", "")
        detail = f"the server does not know that it is {given!r}; if so, WSRENDER_ALLOWED_HOSTS must name it"
        raise HttpProblem(403, detail, "wrong_host")
    if origin is None or origin.lower() in settings.cors_origins:
        return
    if (page := _host_of_origin(origin)) != host.lower() and page not in settings.allowed_hosts:
        detail = f"pages of {origin} may not ask {host}: WSRENDER_CORS_ORIGINS names those that may"
        raise HttpProblem(403, detail, "wrong_origin")


def _may_be_ours(host: str, settings: Settings) -> bool:
    """Addresses, and names that nobody can register on the internet, are; other names must be the machine's or set."""
    name = host.lower().rstrip(".")
    if name in (*settings.allowed_hosts, platform.node().lower(), settings.host.lower()) or host.startswith("["):
        return True
    labels = name.split(".")
    return bool(name) and (len(labels) == 1 or labels[-1] in ("local", "localhost") or _is_address(name))


def _is_address(name: str) -> bool:
    try:
        return bool(ipaddress.ip_address(name))
    except ValueError:
        return False


def _host_of_origin(origin: str) -> str | None:
    try:
        name = urlsplit(origin).hostname
    except ValueError:
        return None
    return f"[{name.lower()}]" if name is not None and ":" in name else name


class HostLayer:
    """Around every route: answers by the server's names only, and under the prefix of a proxy that is trusted."""

    def __init__(self, app: ASGIApp, settings: Settings):
        self.app = app
        self._settings = settings

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request (ASGI); WebSockets are checked by their routes, which can say why they refuse."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        try:
            if scope["type"] == "http":
                check_names(HTTPConnection(scope), self._settings)
        except HttpProblem as problem:
            response = response_of_problem(problem_of_error(problem), scope["state"].get("request_id"))
            await response(scope, receive, send)
            return
        prefix = self._prefix(scope)
        if prefix and scope["path"].startswith(f"{prefix}/"):  # of a proxy that leaves it in place
            scope = {**scope, "path": scope["path"].removeprefix(prefix)}
        token = _shown_under.set(prefix)
        try:
            await self.app(scope, receive, send)
        finally:
            _shown_under.reset(token)

    def _prefix(self, scope: Scope) -> str:
        asking, forwarded = scope.get("client"), Headers(scope=scope).get("x-forwarded-prefix", "").rstrip("/")
        if asking and self._settings.trusts(asking[0]) and _PREFIX.fullmatch(forwarded):
            return forwarded
        return self._settings.root_path
