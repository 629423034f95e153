"""Who asks, and what they may: API keys with scopes, or one local user where no key exists."""

import hashlib
import ipaddress
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Annotated, Literal

from fastapi import Depends, Request, Security
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer
from starlette.requests import HTTPConnection

from wsrender.errors import InputError
from wsrender_server.jobs.store import JobStore
from wsrender_server.problems import HttpProblem
from wsrender_server.settings import Settings

Scope = Literal["read", "submit", "admin"]
# What a key with a scope may do; the right "admin" is that to manage keys.
GRANTS: dict[str, frozenset[str]] = {
    "read": frozenset({"read"}),
    "submit": frozenset({"read", "submit"}),
    "admin": frozenset({"read", "submit", "admin"}),
}
LOCAL_NAMES = ("localhost", "ip6-localhost")
SHORTEST_SECRET = 16  # characters
_HOST = re.compile(r"(\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9._-]+)(?::[0-9]{1,5})?")  # of a header: name or address, port


@dataclass(frozen=True)
class Principal:
    """Who asks: whose jobs they see, and their rights."""

    owner: str
    rights: frozenset[str]


LOCAL_USER = Principal("local", GRANTS["submit"])  # the first key is made by the command line
LOOK_AGAIN_S = 0.5  # for the first key


class Authenticator:
    """Knows the keys of the key file and of the database. Raises InputError for a malformed key file."""

    def __init__(self, settings: Settings, store: JobStore):
        self._store = store
        self._file_keys = {} if settings.api_key_file is None else read_key_file(settings.api_key_file)
        self._required = bool(self._file_keys)
        self._looked = -LOOK_AGAIN_S

    @property
    def required(self) -> bool:
        """Whether a key is needed: half a second after there is one, and then for as long as the server runs.

        Revoking the last key does not open a running server to everyone.
        """
        now = monotonic()
        if not self._required and now - self._looked >= LOOK_AGAIN_S:
            self._required, self._looked = self._store.has_key(), now
        return self._required

    def principal(self, secret: str) -> Principal | None:
        """Whose secret it is; None for an unknown or revoked key."""
        # Looking up the hash of a secret tells nothing about other secrets, whatever time it takes.
        known = self._file_keys.get(_digest(secret))
        if known is not None:
            return known
        key = self._store.find_key(secret)
        return None if key is None else Principal(key.id, _rights(key.scopes))


def read_key_file(path: Path) -> dict[str, Principal]:
    """Who each key of a file is, by the SHA-256 of its secret.

    A line is ``secret``, ``secret name`` or ``secret name scope,scope`` (default: submit); # starts a comment. Keys of
    one name share their jobs. Raises InputError naming the line.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError("api_key_file", f"{path} cannot be read: {error}") from error
    principals = {}
    for number, line in enumerate(lines, start=1):
        words = line.partition("#")[0].split()
        if not words:
            continue
        secret, name, scopes = (*words, *["", "submit"][len(words) - 1 :])[:3] if len(words) <= 3 else ("", "", "")
        if len(secret) < SHORTEST_SECRET or not set(scopes.split(",")) <= set(GRANTS):
            raise InputError(
                "api_key_file",
                f"{path}, line {number}: must be a secret of at least {SHORTEST_SECRET} characters, then if you like "
                "a name and scopes from read,submit,admin",
            )
        digest = _digest(secret)
        principals[digest] = Principal(f"file:{name or digest[:16]}", _rights(scopes.split(",")))
    if not principals:
        raise InputError("api_key_file", f"{path} holds no key")
    return principals


def check_binding(host: str, has_keys: bool) -> None:
    """Refuse to listen on anything but loopback where there is no key; raises InputError."""
    if has_keys or is_loopback(host):
        return
    raise InputError(
        "host",
        f"{host} can be reached from other machines, and there is no API key; make one (wsrender keys create) or give "
        "--api-key-file, or listen on 127.0.0.1",
    )


def is_loopback(host: str) -> bool:
    """Whether an address or name can only be reached from this machine."""
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host.lower().rstrip(".") in LOCAL_NAMES


def needs(right: Scope) -> Callable[..., Principal]:
    """The dependency of a route that needs a right."""

    def principal(
        request: Request, credentials: Annotated[HTTPAuthorizationCredentials | None, Security(_bearer)]
    ) -> Principal:
        asking = entitled(request, credentials and credentials.credentials, right)
        request.state.owner = asking.owner
        return asking

    return principal


def entitled(connection: HTTPConnection, secret: str | None, right: Scope) -> Principal:
    """Who asks by a secret, if they have a right; raises HttpProblem 401 or 403."""
    asking = _asking(connection, secret)
    if right not in asking.rights:
        who = "a server without keys" if asking is LOCAL_USER else "this key"
        raise HttpProblem(403, f"{who} lacks the scope {right!r}", "insufficient_scope")
    return asking


_bearer = HTTPBearer(scheme_name="api_key", description="An API key (`wsrender keys create`).", auto_error=False)
Reader = Annotated[Principal, Depends(needs("read"))]
Submitter = Annotated[Principal, Depends(needs("submit"))]
Administrator = Annotated[Principal, Depends(needs("admin"))]


def _asking(connection: HTTPConnection, secret: str | None) -> Principal:
    authenticator: Authenticator = connection.app.state.authenticator
    if not authenticator.required:
        _check_host(connection)
        return LOCAL_USER
    if secret is None:
        raise _unauthorized("an API key is needed: Authorization: Bearer <key>", "Bearer")
    principal = authenticator.principal(secret)
    if principal is None:
        raise _unauthorized("the API key is unknown or was revoked", 'Bearer error="invalid_token"')
    return principal


def _check_host(connection: HTTPConnection) -> None:
    """Without a key only names of this machine count: a web page must not reach it by a name of its own."""
    host = connection.headers.get("host", "")
    name = _HOST.fullmatch(host)
    if name is None or not is_loopback(name[1]):
        raise HttpProblem(403, f"without an API key the server answers to localhost only, not {host}", "wrong_host")


def _unauthorized(detail: str, challenge: str) -> HttpProblem:
    return HttpProblem(401, detail, "unauthorized", headers={"WWW-Authenticate": challenge})


def _rights(scopes) -> frozenset[str]:
    return frozenset().union(*(GRANTS[scope] for scope in scopes))


def _digest(secret: str) -> str:
    return hashlib.sha256(secret.encode()).hexdigest()
