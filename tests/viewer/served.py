"""The built page on a loopback port, under a policy as strict as the server's, with blobs by path."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import wsrender_server

BUILT = Path(wsrender_server.__file__).parent / "static" / "viewer"
PAGE = (
    b'<!doctype html><meta charset="utf-8"><title>test</title><link rel="icon" href="data:,">'
    b'<link rel="stylesheet" href="/page.css"><div id="here"></div>'
)
FILES = {
    "/": ("text/html", PAGE),
    "/page.css": ("text/css", b"html,body{margin:0}#here{width:100vw;height:100vh}"),
}
POLICY = "default-src 'self'; img-src 'self' data: blob:; connect-src 'self' blob:"


@contextmanager
def serving() -> Iterator[tuple[str, dict[str, bytes]]]:
    """Its address, and the blobs that it serves, which may be added to."""
    blobs: dict[str, bytes] = {}

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):
            kind, data = FILES.get(self.path, ("application/octet-stream", blobs.get(self.path)))
            if self.path.startswith("/viewer/"):
                kind, data = "text/javascript", (BUILT / Path(self.path).name).read_bytes()
            self.send_response(404 if data is None else 200)
            for name, value in (("Content-Type", kind), ("Content-Security-Policy", POLICY)):
                self.send_header(name, value)
            self.send_header("Content-Length", str(len(data or b"")))
            self.end_headers()
            self.wfile.write(data or b"")

        def log_message(self, format, *args):
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/", blobs
    finally:
        server.shutdown()
        server.server_close()
