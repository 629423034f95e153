"""Who asks, and what they may: API keys with scopes, or one local user where no key exists."""

import asyncio
import hashlib
from collections.abc import Awaitable, Callable, Coroutine
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Annotated, Any, Literal, Never, TypeVar

from fastapi import Depends, Request, Security
from fastapi.security import HTTPAuthorizationCredentials, HTTPBasic, HTTPBasicCredentials, HTTPBearer
from starlette.concurrency import run_in_threadpool
from starlette.requests import HTTPConnection

from wsrender.errors import InputError
from wsrender_server.hosts import host_of, is_loopback
from wsrender_server.jobs.faults import StoreUnavailable
from wsrender_server.jobs.store import JobStore
from wsrender_server.problems import HttpProblem
from wsrender_server.settings import Settings

Scope = Literal["read", "submit", "priority", "admin"]
# What a key with a scope may do; the right "admin" is that to manage keys, "priority" that to go before others' jobs.
GRANTS: dict[str, frozenset[str]] = {
    "read": frozenset({"read"}),
    "submit": frozenset({"read", "submit"}),
    "priority": frozenset({"read", "submit", "priority"}),
    "admin": frozenset({"read", "submit", "priority", "admin"}),
}
SHORTEST_SECRET = 16  # characters
Found = TypeVar("Found")


@dataclass(frozen=True)
class Principal:
    """Who asks: whose jobs they see, and their rights."""

    owner: str
    rights: frozenset[str]


LOCAL_USER = Principal("local", GRANTS["priority"])  # the first key is made by the command line
LOOK_AGAIN_S = 0.5  # for the first key
REVOKED_S = 1.0  # between looks whether a stream's key was revoked


class Authenticator:
    """Knows the keys of the key file and of the database. Raises InputError for a malformed key file."""

    def __init__(self, settings: Settings, store: JobStore):
        self._store = store
        self._file_keys = {} if settings.api_key_file is None else read_key_file(settings.api_key_file)
        self._required = bool(self._file_keys)
        self._looked = -LOOK_AGAIN_S
        self._looking: asyncio.Task[bool] | None = None
        self._admitted: dict[str, tuple[float, bool]] = {}  # keys that streams asked about, and when

    @property
    def required(self) -> bool:
        """Whether a key is needed: half a second after there is one, and then for as long as the server runs.

        Revoking the last key does not open a running server to everyone.
        """
        now = monotonic()
        if not self._required and now - self._looked >= LOOK_AGAIN_S:
            self._required, self._looked = self._store.has_key(), now
        return self._required

    async def is_required(self) -> bool:
        """`required` for a coroutine: whoever asks while the database is asked in a thread shares that answer."""
        if self._required or monotonic() - self._looked < LOOK_AGAIN_S:
            return self._required
        if self._looking is None or self._looking.done():
            self._looking = asyncio.create_task(run_in_threadpool(lambda: self.required))
            self._looking.add_done_callback(lambda task: task.cancelled() or task.exception())  # told to who asked
        return await asyncio.shield(self._looking)

    def principal(self, secret: str) -> Principal | None:
        """Whose secret it is; None for an unknown or revoked key."""
        # Looking up the hash of a secret tells nothing about other secrets, whatever time it takes.
        known = self._file_keys.get(_digest(secret))
        if known is not None:
            return known
        key = self._store.find_key(secret)
        return None if key is None else Principal(key.id, _rights(key.scopes))

    def admits(self, principal: Principal) -> bool:
        """Whether whoever was let in would be let in again: their key may have been revoked half a second ago."""
        if principal is LOCAL_USER:
            return not self.required
        if principal in self._file_keys.values():
            return True
        looked, admitted = self._admitted.get(principal.owner, (-LOOK_AGAIN_S, True))
        if monotonic() - looked >= LOOK_AGAIN_S:
            looked, admitted = monotonic(), self._store.is_live(principal.owner)
            self._admitted[principal.owner] = looked, admitted
        return admitted


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
                f"a name and scopes from {','.join(GRANTS)}",
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


def needs(right: Scope) -> Callable[..., Awaitable[Principal]]:
    """The dependency of a route that needs a right."""

    async def principal(
        request: Request,
        bearer: Annotated[HTTPAuthorizationCredentials | None, Security(_bearer)],
        basic: Annotated[HTTPBasicCredentials | None, Security(_basic)],
    ) -> Principal:
        secret = basic.password if basic else bearer and bearer.credentials
        if await request.app.state.authenticator.is_required():  # which key it is, the database knows
            asking = await run_in_threadpool(entitled, request, secret, right, True)
        else:
            asking = entitled(request, secret, right, False)
        request.state.owner = asking.owner
        return asking

    return principal


def entitled(connection: HTTPConnection, secret: str | None, right: Scope, required: bool | None = None) -> Principal:
    """Who asks by a secret, if they have a right; raises HttpProblem 401 or 403.

    ``required`` is whether a key is needed, None where whoever calls has not asked: then the database may be.
    """
    asking = _asking(connection, secret, required)
    if right not in asking.rights:
        who = "a server without keys" if asking is LOCAL_USER else "this key"
        raise HttpProblem(403, f"{who} lacks the scope {right!r}", "insufficient_scope")
    return asking


async def until_revoked(connection: HTTPConnection, principal: Principal) -> Never:
    """Wait beside a stream, for as long as its key is one; raises HttpProblem 401 then."""
    authenticator: Authenticator = connection.app.state.authenticator
    while True:
        with suppress(StoreUnavailable):  # which says nothing of the key
            if not await run_in_threadpool(authenticator.admits, principal):
                raise _unauthorized("the API key was revoked", 'Bearer error="invalid_token"')
        await asyncio.sleep(REVOKED_S)


async def unless_revoked(connection: HTTPConnection, principal: Principal, asked: Coroutine[Any, Any, Found]) -> Found:
    """What ``asked`` gives, however long it takes, while the key is one; raises HttpProblem 401 once it is none."""
    answer, revoked = asyncio.create_task(asked), asyncio.create_task(until_revoked(connection, principal))
    try:
        await asyncio.wait((answer, revoked), return_when=asyncio.FIRST_COMPLETED)
        return await (revoked if revoked.done() else answer)
    finally:
        answer.cancel()
        revoked.cancel()
        await asyncio.gather(answer, revoked, return_exceptions=True)


def check_priority(principal: Principal, priority: int, pointer: str) -> None:
    """Raise HttpProblem 403 for a priority above the usual 0 where the key has no such scope."""
    if priority > 0 and "priority" not in principal.rights:
        detail = f"a priority of {priority} needs a key with the scope 'priority'; without it 0 is the highest"
        raise HttpProblem(403, detail, "insufficient_scope", errors=[(pointer, detail)])


_bearer = HTTPBearer(scheme_name="api_key", description="An API key (`wsrender keys create`).", auto_error=False)
_basic = HTTPBasic(
    scheme_name="api_key_as_password",
    description="An API key as the password, for programs that know no other way; the name does not matter.",
    auto_error=False,
)
Reader = Annotated[Principal, Depends(needs("read"))]
Submitter = Annotated[Principal, Depends(needs("submit"))]
Administrator = Annotated[Principal, Depends(needs("admin"))]


def _asking(connection: HTTPConnection, secret: str | None, required: bool | None) -> Principal:
    authenticator: Authenticator = connection.app.state.authenticator
    if not (authenticator.required if required is None else required):
        _check_host(connection)
        return LOCAL_USER
    if secret is None:
        raise _unauthorized("an API key is needed: Authorization: Bearer <key>", "Bearer")
    principal = authenticator.principal(secret)
    if principal is None:
        scheme = connection.headers.get("authorization", "").partition(" ")[0].lower()
        challenge = 'Basic realm="wsrender"' if scheme == "basic" else 'Bearer error="invalid_token"'
        raise _unauthorized("the API key is unknown or was revoked", challenge)
    return principal


def _check_host(connection: HTTPConnection) -> None:
    """Without a key only names of this machine count: a web page must not reach it by a name of its own."""
    host = host_of(connection.headers)
    if not is_loopback(host) and host.lower() not in connection.app.state.parts.settings.allowed_hosts:
        given = connection.headers.get("host", "")
        raise HttpProblem(403, f"without an API key the server answers to localhost only, not {given}", "wrong_host")


def _unauthorized(detail: str, challenge: str) -> HttpProblem:
    return HttpProblem(401, detail, "unauthorized", headers={"WWW-Authenticate": challenge})


def _rights(scopes) -> frozenset[str]:
    return frozenset().union(*(GRANTS[scope] for scope in scopes))


def _digest(secret: str) -> str:
    return hashlib.sha256(secret.encode()).hexdigest()
