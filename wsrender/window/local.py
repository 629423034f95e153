"""A view in a tab of the browser: a server of one page, on a loopback port, for whoever holds its link."""

import json
import secrets
import threading
import traceback
import webbrowser
from collections import Counter
from collections.abc import Callable, Mapping
from http import HTTPStatus
from http.cookies import SimpleCookie
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, Protocol
from urllib.parse import parse_qs, unquote, urlsplit

from wsrender.errors import InputError, WsrenderError
from wsrender.results.view.container import message
from wsrender.results.view.interactive import ReplacedError
from wsrender.results.view.page import LOCAL_SCRIPT, built, local_page

LONGEST_QUESTION = 1 << 20  # bytes of a request's body
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; "
    "connect-src 'self' blob:; worker-src blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_FILES = {"/viewer.js": "text/javascript", "/icon.svg": "image/svg+xml"}


def refused(error: Exception) -> dict[str, str]:
    """What a page is told of an error, so that it waits for no answer; a fault of the program is printed."""
    if isinstance(error, ReplacedError):
        return {"message": "a later question replaced this one", "code": "replaced"}
    if isinstance(error, ValueError | WsrenderError):
        return {"message": str(error), "field": getattr(error, "field", "")}
    traceback.print_exception(error)
    return {"message": f"a fault of wsrender: {error!r}", "code": "internal"}


class Viewed(Protocol):
    """What is shown: `wsrender.results.view.View`."""

    @property
    def manifest(self) -> Mapping[str, Any]:
        """What it is made of."""
        ...

    @property
    def blobs(self) -> Mapping[str, bytes]:
        """Its bulk data by name."""
        ...


class Answering(Protocol):
    """What answers questions of the page."""

    def answer(
        self, request: Mapping[str, Any], wanted: Callable[[], bool] = ...
    ) -> tuple[dict[str, Any], Mapping[str, bytes]]:
        """A header and blobs; raises WsrenderError, and ReplacedError where it is no longer ``wanted``."""
        ...


class LocalView:
    """A view that is served to the browser of this machine until `close`.

    ``url`` holds a token that opens it once: the browser that does gets a cookie instead, and nobody else gets in.
    Requests for another host's name, or from another page, are refused.
    """

    def __init__(self, view: Viewed, answering: Answering, port: int = 0):
        self.view, self.answering = view, answering
        self.token: str | None = secrets.token_urlsafe(24)
        self.secret = secrets.token_urlsafe(24)
        self.answers = threading.Lock()  # one computation at a time
        self.entrance = threading.Lock()
        self.asked = Counter[str]()  # questions of each kind: a later one replaces those before
        try:
            self._server = _Server(("127.0.0.1", port), self)
        except (OSError, OverflowError) as error:
            raise InputError("port", f"{port} cannot be listened at: {error}") from None
        self.port = self._server.server_address[1]
        self.url = f"http://127.0.0.1:{self.port}/?token={self.token}"
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.05,), daemon=True)
        self._thread.start()

    def open(self) -> None:
        """Open it in the browser."""
        webbrowser.open(self.url)

    def wait(self) -> None:
        """Return when it is closed, or by Ctrl-C."""
        try:
            while self._thread.is_alive():
                self._thread.join(0.5)
        except KeyboardInterrupt:
            pass
        finally:
            self.close()

    def close(self) -> None:
        """Stop serving."""
        self._server.shutdown()
        self._server.server_close()

    def __repr__(self) -> str:
        return f"<LocalView {self.url}>"


class _Server(ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self, address: tuple[str, int], shown: LocalView):
        self.shown = shown
        super().__init__(address, _Handler)


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    timeout = 60.0  # s that a connection may be silent

    @property
    def shown(self) -> LocalView:
        """What the server shows."""
        assert isinstance(self.server, _Server)
        return self.server.shown

    def do_GET(self) -> None:
        path, query = self._asked()
        if not self._is_own_host():
            return
        if path == "/" and (token := query.get("token")):
            self._let_in(token[0])
        elif not self._is_known():
            self._refuse(HTTPStatus.FORBIDDEN, "open the link that wsrender printed; it opens the view once")
        else:
            self._answer_path(path)

    def do_POST(self) -> None:
        path, _ = self._asked()
        if not self._is_own_host():
            return
        body = self._body()
        if body is None:
            return
        origin = self.headers.get("Origin")
        if not self._is_known() or origin not in self._origins():
            self._refuse(HTTPStatus.FORBIDDEN, "only the page itself may ask")
        elif path != "/ask":
            self._refuse(HTTPStatus.NOT_FOUND, f"there is nothing at {path}")
        else:
            self._answer_question(body)

    def _answer_path(self, path: str) -> None:
        view = self.shown.view
        if path == "/":
            self._send(local_page(str(view.manifest.get("title", "wsrender"))), "text/html; charset=utf-8")
        elif path == "/local.js":
            self._send(LOCAL_SCRIPT.encode(), "text/javascript")
        elif path in _FILES:
            self._send(built(path[1:]), _FILES[path])
        elif path == "/manifest":
            self._send(json.dumps(view.manifest, allow_nan=False).encode(), "application/json")
        elif path.startswith("/blobs/"):
            try:
                self._send(view.blobs[unquote(path.removeprefix("/blobs/"))], "application/octet-stream")
            except KeyError:
                self._refuse(HTTPStatus.NOT_FOUND, "there is no such part of the view")
        else:
            self._refuse(HTTPStatus.NOT_FOUND, f"there is nothing at {path}")

    def _answer_question(self, body: bytes) -> None:
        blobs: Mapping[str, bytes] = {}
        try:
            request = json.loads(body)
            if not isinstance(request, dict):
                raise InputError("request", "must be a JSON object")
            shown, kind = self.shown, str(request.get("ask"))
            with shown.entrance:
                shown.asked[kind] += 1
                number = shown.asked[kind]
            with shown.answers:
                header, blobs = shown.answering.answer(request, lambda: shown.asked[kind] == number)
            reply: dict[str, Any] = {"answer": header}
        except Exception as error:
            reply = {"refused": refused(error)}
        self._send(message(reply, blobs), "application/octet-stream")

    def _asked(self) -> tuple[str, dict[str, list[str]]]:
        parts = urlsplit(self.path)
        return parts.path, parse_qs(parts.query)

    def _body(self) -> bytes | None:
        """Of a request; None after it was refused."""
        length = self.headers.get("Content-Length", "")
        if not length.isdecimal() or int(length) > LONGEST_QUESTION:
            if length.isdecimal():
                self.rfile.read(min(int(length), 2 * LONGEST_QUESTION))  # who still sends does not see an answer
            self._refuse(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"at most {LONGEST_QUESTION} bytes, with their length")
            self.close_connection = True
            return None
        return self.rfile.read(int(length))

    def _origins(self) -> list[str]:
        return [f"http://{host}" for host in self._hosts()]

    def _hosts(self) -> list[str]:
        return [f"{name}:{self.shown.port}" for name in ("127.0.0.1", "localhost")]

    def _is_own_host(self) -> bool:
        """Whether the name asked for is this machine's: another's may be one that was made to point here."""
        if self.headers.get("Host") in self._hosts():
            return True
        self._refuse(HTTPStatus.MISDIRECTED_REQUEST, "this is not the host that was asked for")
        return False

    @property
    def _cookie(self) -> str:
        return f"wsrender-{self.shown.port}"  # cookies are common to the ports of a host

    def _is_known(self) -> bool:
        own = SimpleCookie(self.headers.get("Cookie", "")).get(self._cookie)
        return own is not None and secrets.compare_digest(own.value, self.shown.secret)

    def _let_in(self, token: str) -> None:
        shown = self.shown
        with shown.entrance:
            known = shown.token is not None and secrets.compare_digest(token.encode(), shown.token.encode())
            shown.token = None if known else shown.token
        if not known and not self._is_known():
            self._refuse(HTTPStatus.FORBIDDEN, "this link has been used, or was never one")
            return
        self.send_response(HTTPStatus.SEE_OTHER)
        self.send_header("Location", "/")
        self.send_header("Set-Cookie", f"{self._cookie}={shown.secret}; HttpOnly; SameSite=Strict; Path=/")
        self.send_header("Content-Length", "0")
        self.end_headers()

    def _refuse(self, status: HTTPStatus, text: str) -> None:
        self._send(text.encode(), "text/plain; charset=utf-8", status)

    def _send(self, data: bytes, kind: str, status: HTTPStatus = HTTPStatus.OK) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(data)))
        self.send_header("Content-Security-Policy", POLICY)
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Referrer-Policy", "no-referrer")
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.wfile.write(data)

    def log_message(self, format: str, *args: Any) -> None:
        """Nothing: a tab's requests are no one's news."""
