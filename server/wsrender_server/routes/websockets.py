"""Who opens a WebSocket, and from which page: API keys by subprotocol, since browsers cannot set headers."""

import base64
import binascii
from collections.abc import Iterator

from fastapi import WebSocket

from wsrender_server.auth import Principal, Scope, entitled
from wsrender_server.hosts import check_names
from wsrender_server.query import check_parameters

PROTOCOL = "wsrender.v1"  # the WebSocket subprotocol, where a client offers any
KEY_PREFIX = "wsrender.key."  # of a subprotocol that carries an API key as it is
KEY64_PREFIX = "wsrender.key64."  # in base64url without =, since subprotocols may not hold every character
POLICY, TOO_BIG, INTERNAL, NORMAL = 1008, 1009, 1011, 1000  # close codes (RFC 6455)


def principal_of(websocket: WebSocket, right: Scope) -> Principal:
    """Who connects: by the header Authorization, or by a subprotocol.

    Raises HttpProblem, for pages of another host too.
    """
    check_parameters(websocket)
    check_names(websocket, websocket.app.state.parts.settings)
    return entitled(websocket, next(_secrets(websocket), None), right)


def protocol_of(websocket: WebSocket) -> str | None:
    """The subprotocol that is answered with."""
    return PROTOCOL if PROTOCOL in websocket.scope.get("subprotocols", []) else None


def _secrets(websocket: WebSocket) -> Iterator[str]:
    scheme, _, secret = websocket.headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer":
        yield secret
    for name in websocket.scope.get("subprotocols", []):
        if name.startswith(KEY_PREFIX):
            yield name.removeprefix(KEY_PREFIX)
        elif name.startswith(KEY64_PREFIX):
            text = name.removeprefix(KEY64_PREFIX)
            try:
                yield base64.b64decode(text + "=" * (-len(text) % 4), altchars=b"-_", validate=True).decode()
            except (binascii.Error, UnicodeDecodeError):
                yield ""
