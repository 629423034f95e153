"""A receiver of webhooks, which checks nothing and keeps everything."""

import ssl
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer


class Receiver:
    """What came, in order: headers by lower-case name, and body.

    ``answer()`` is the status of the next answer, or raises where there shall be none.
    """

    def __init__(self, url: str, answer: Callable[[], int]):
        self.url, self.answer = url, answer
        self.got: list[tuple[dict[str, str], bytes]] = []
        self.accepted: set[str] = set()
        """Ids of those that were answered by success."""


@contextmanager
def receiver(
    answer: Callable[[], int] = lambda: 204,
    address: str = "127.0.0.1",
    port: int = 0,
    tls: ssl.SSLContext | None = None,
) -> Iterator[Receiver]:
    """A receiver that listens for as long as the block lasts."""

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self):
            body = self.rfile.read(int(self.headers["content-length"]))
            here.got.append(({name.lower(): value for name, value in self.headers.items()}, body))
            status = here.answer()
            if 200 <= status < 300:
                here.accepted.add(self.headers["webhook-id"])
            self.send_response(status)
            self.send_header("Location", f"{here.url}/elsewhere")
            self.send_header("Content-Length", "0")
            self.end_headers()

        def log_message(self, *_):
            pass

    class Server(ThreadingHTTPServer):
        request_queue_size = 128

        def handle_error(self, *_):  # a client that was killed, or that trusts nobody
            pass

    server = Server((address, port), Handler)
    if tls is not None:
        server.socket = tls.wrap_socket(server.socket, server_side=True, do_handshake_on_connect=False)
    scheme = "http" if tls is None else "https"
    here = Receiver(f"{scheme}://{address}:{server.server_address[1]}", answer)
    thread = threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True)
    thread.start()
    try:
        yield here
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
