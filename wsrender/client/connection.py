"""HTTP connections to one server: they run the steps of `wsrender.client.requests`, by waiting or by asyncio."""

import asyncio
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from typing import Any

import httpx2

from wsrender.client.requests import Pause, Request, Server, Steps, T
from wsrender.errors import ServerConnectionError, ServerError
from wsrender.version import __version__


class Connection:
    """An HTTP connection to one server, which several threads may use.

    ``timeout_s`` bounds the wait for an answer [s], ``patience_s`` for how long a lost connection is tried again [s].
    """

    def __init__(
        self,
        url: str,
        token: str | None,
        timeout_s: float,
        patience_s: float,
        transport: httpx2.BaseTransport | None = None,
    ):
        self.server = Server(url, timeout_s, patience_s)
        self._http = httpx2.Client(base_url=url, headers=_headers(token), timeout=timeout_s, transport=transport)

    def close(self) -> None:
        """Close all sockets."""
        self._http.close()

    def run(self, steps: Steps[T]) -> T:
        """What comes of the steps."""
        try:
            step = next(steps)
            while True:
                if isinstance(step, Pause):
                    time.sleep(step.seconds)
                    step = steps.send(None)
                    continue
                try:
                    response = self._answer(step)
                except httpx2.TransportError as error:
                    step = steps.throw(error)
                except (httpx2.RequestError, httpx2.InvalidURL) as error:
                    raise unreadable(self.server, step, error) from None
                else:
                    step = steps.send(response)
        except StopIteration as end:
            return end.value

    def _answer(self, request: Request) -> httpx2.Response:
        if self._http.is_closed:
            raise closed(self.server)
        if request.into is None:
            return self._http.request(request.method, request.path, **_options(request))
        with self.stream(request) as response:
            if response.is_success:
                with request.into(response) as take:
                    for piece in response.iter_raw():
                        take(piece)
            return response

    @contextmanager
    def stream(self, request: Request) -> Iterator[httpx2.Response]:
        """The answer to a request, whose body is still to be read; that of what is no success has been."""
        with self._http.stream(request.method, request.path, **_options(request)) as response:
            if not response.is_success:
                response.read()
            yield response


class AsyncConnection:
    """The same for asyncio."""

    def __init__(
        self,
        url: str,
        token: str | None,
        timeout_s: float,
        patience_s: float,
        transport: httpx2.AsyncBaseTransport | None = None,
    ):
        self.server = Server(url, timeout_s, patience_s)
        self._token, self._transport = token, transport
        self._http = httpx2.AsyncClient(base_url=url, headers=_headers(token), timeout=timeout_s, transport=transport)

    async def close(self) -> None:
        """Close all sockets."""
        await self._http.aclose()

    def waiting(self) -> Connection:
        """A connection to the same server that is run by waiting, for files that are read when they are used."""
        transport = self._transport if isinstance(self._transport, httpx2.BaseTransport) else None
        server = self.server
        connection = Connection(server.url, self._token, server.timeout_s, server.patience_s, transport)
        connection.server = server
        return connection

    async def run(self, steps: Steps[T]) -> T:
        """What comes of the steps."""
        try:
            step = next(steps)
            while True:
                if isinstance(step, Pause):
                    await asyncio.sleep(step.seconds)
                    step = steps.send(None)
                    continue
                try:
                    response = await self._answer(step)
                except httpx2.TransportError as error:
                    step = steps.throw(error)
                except (httpx2.RequestError, httpx2.InvalidURL) as error:
                    raise unreadable(self.server, step, error) from None
                else:
                    step = steps.send(response)
        except StopIteration as end:
            return end.value

    async def _answer(self, request: Request) -> httpx2.Response:
        if self._http.is_closed:
            raise closed(self.server)
        if request.into is None:
            return await self._http.request(request.method, request.path, **_options(request))
        async with self.stream(request) as response:
            if response.is_success:
                with request.into(response) as take:
                    async for piece in response.aiter_raw():
                        take(piece)
            return response

    @asynccontextmanager
    async def stream(self, request: Request) -> AsyncIterator[httpx2.Response]:
        """The answer to a request, whose body is still to be read; that of what is no success has been."""
        async with self._http.stream(request.method, request.path, **_options(request)) as response:
            if not response.is_success:
                await response.aread()
            yield response


def closed(server: Server) -> ServerConnectionError:
    """The error of a request after the client was closed."""
    return ServerConnectionError(f"the client of {server.url} is closed: what needs the server stands before that")


def unreadable(server: Server, request: Request, error: Exception) -> ServerError:
    """The error of an answer that is no HTTP as it should be, or of an address that is none."""
    return ServerError(f"{server.url}: {request.method} {request.path}: {error or type(error).__name__}")


def _headers(token: str | None) -> dict[str, str]:
    named = {"User-Agent": f"wsrender/{__version__}"}
    return named | ({"Authorization": f"Bearer {token}"} if token else {})


def _options(request: Request) -> dict[str, Any]:
    """The request as httpx2 takes it."""
    options: dict[str, Any] = {"params": dict(request.params), "headers": dict(request.headers)}
    if request.content is not None:
        options["content"] = request.content
    if request.json is not None:
        options["json"] = request.json
    if request.timeout_s is not None:
        options["timeout"] = request.timeout_s
    return options
