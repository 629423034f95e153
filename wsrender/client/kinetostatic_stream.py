"""A live stream of forces, as seen from the program that drives a haptic device."""

import json
import time
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self, cast

import numpy as np

from wsrender.client.problems import error_of_problem
from wsrender.client.stream_records import Force, Opened, Scale, Statistics
from wsrender.errors import AccessError, MissingExtraError, QuotaError, ServerConnectionError, WaitTimeoutError

if TYPE_CHECKING:
    from websockets.sync.client import ClientConnection

PATH = "/v1/kinetostatic-stream"
STALE_AFTER_S = 0.05


class KinetostaticStream:
    """One session; a context manager that opens and closes it. `Client.kinetostatic_stream` makes it.

    A device's loop calls ``send`` with where the device is and renders ``force()``, which is zero whenever the answers
    stop: on a lost connection, a server that hangs, or a late network. ``opened`` is the server's first message and
    ``statistics`` its last, after the block.
    """

    def __init__(self, url: str, token: str | None, document: Mapping[str, object], timeout_s: float):
        self._url = url.rstrip("/").replace("http", "ws", 1) + PATH
        self._headers = {"Authorization": f"Bearer {token}"} if token else {}
        self._open = {"type": "open", **document}
        self._timeout_s = max(timeout_s, 30.0)  # for a process that starts
        self._patience_s = float(cast(float, document.get("stale_after_s", STALE_AFTER_S)))
        self._connection = ExitStack()
        self._socket: ClientConnection | None = None
        self._sequence = 0
        self._received_at = -np.inf
        self.opened = cast(Opened, {})
        self.statistics = cast(Statistics, {})
        self.last = cast(Force, {})
        """The newest message ``force``, or empty."""

    def __repr__(self) -> str:
        return f"<KinetostaticStream {self._url}: {self._state}>"

    @property
    def _state(self) -> str:
        return "closed" if self.statistics else "open" if self.opened else "not open"

    def __enter__(self) -> Self:
        self._socket = self._connected()
        try:
            self._send(self._open)
            self.opened = cast(Opened, self._next("opened", self._timeout_s))
        except BaseException:
            self._connection.close()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            if kind is None:
                self._send({"type": "close"})
                self.statistics = cast(Statistics, self._next("closed", 5.0))
        except (ServerConnectionError, WaitTimeoutError):
            pass  # the session ends with its connection, too
        finally:
            self._connection.close()

    def send(
        self,
        configuration: Sequence[float] | np.ndarray | None = None,
        *,
        position_m: Sequence[float] | np.ndarray | None = None,
        quat_wxyz: Sequence[float] | np.ndarray | None = None,
        scale: Scale = "medium",
        clutch: bool = False,
    ) -> int:
        """Say where the device is: a configuration, or its pose; the number of this sample.

        Raises ServerConnectionError where the connection is lost.
        """
        self._sequence += 1
        sample = {"type": "sample", "sequence": self._sequence, "scale": scale, "clutch": clutch}
        values = {"configuration": configuration, "position_m": position_m, "quat_wxyz": quat_wxyz}
        sample |= {name: np.asarray(value).tolist() for name, value in values.items() if value is not None}
        self._send(sample)
        return self._sequence

    def receive(self, timeout_s: float | None = None) -> Force:
        """The next message ``force``, with all its fields; WaitTimeoutError where none comes in time.

        Raises ServerConnectionError where the connection is lost, and what a ``fault`` of the server stands for.
        """
        return cast(Force, self._next("force", timeout_s))

    def exchange(
        self,
        configuration: Sequence[float] | np.ndarray | None = None,
        *,
        position_m: Sequence[float] | np.ndarray | None = None,
        quat_wxyz: Sequence[float] | np.ndarray | None = None,
        scale: Scale = "medium",
        clutch: bool = False,
        timeout_s: float = 1.0,
    ) -> Force:
        """``send``, and the first force that answers this sample; WaitTimeoutError where none comes in time."""
        sequence = self.send(configuration, position_m=position_m, quat_wxyz=quat_wxyz, scale=scale, clutch=clutch)
        end = time.monotonic() + timeout_s
        while True:
            message = self.receive(max(end - time.monotonic(), 0.0))
            if (message["sequence"] or 0) >= sequence:
                return message

    def force(self) -> np.ndarray:
        """The force (3,) [N] to render now; zero where the newest answer is stale or the connection lost."""
        try:
            while True:
                self.receive(0.0)
        except WaitTimeoutError:
            fresh = time.monotonic() - self._received_at <= self._patience_s
        except ServerConnectionError:
            fresh = False
        return np.array(self.last["force_n"]) if fresh and self.last else np.zeros(3)

    def ask_statistics(self, timeout_s: float = 5.0) -> Statistics:
        """How well the loop keeps its time."""
        self._send({"type": "statistics"})
        return cast(Statistics, self._next("statistics", timeout_s))

    def _connected(self) -> "ClientConnection":
        try:
            from websockets.exceptions import InvalidHandshake, InvalidStatus
            from websockets.sync.client import connect
        except ModuleNotFoundError as error:
            raise MissingExtraError("websockets", "stream") from error
        try:
            options = {"additional_headers": self._headers, "compression": None, "open_timeout": self._timeout_s}
            return self._connection.enter_context(connect(self._url, **options))
        except InvalidStatus as error:
            raise _refusal(error.response.status_code, bytes(error.response.body or b"{}")) from None
        except (OSError, InvalidHandshake) as error:
            raise ServerConnectionError(f"no server answers at {self._url}: {error}") from None

    def _send(self, message: dict[str, Any]) -> None:
        from websockets.exceptions import ConnectionClosed

        assert self._socket is not None, "the stream is a context manager: use it in a with block"
        try:
            self._socket.send(json.dumps(message))
        except ConnectionClosed as error:
            raise ServerConnectionError(f"lost the stream at {self._url}: {error}") from None

    def _next(self, kind: str, timeout_s: float | None) -> dict[str, Any]:
        """The next message of a kind; forces are kept on the way."""
        from websockets.exceptions import ConnectionClosed

        assert self._socket is not None, "the stream is a context manager: use it in a with block"
        end = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            try:
                left = None if end is None else max(end - time.monotonic(), 0.0)
                message = json.loads(self._socket.recv(left))
            except TimeoutError:
                raise WaitTimeoutError(f"no message {kind!r} came within {timeout_s:g} s") from None
            except ConnectionClosed as error:
                raise ServerConnectionError(f"lost the stream at {self._url}: {error}") from None
            if message["type"] == "force":
                self.last, self._received_at = message, time.monotonic()
            elif message["type"] == "fault":
                raise _fault(message)
            if message["type"] == kind:
                return message


def _fault(message: dict[str, Any]) -> Exception:
    """The exception of a message ``fault``."""
    if message["code"] == "too_many_streams":
        return QuotaError(message["detail"], message)
    return error_of_problem(message)


def _refusal(status: int, body: bytes) -> Exception:
    """The exception of a connection that was not accepted."""
    try:
        problem = json.loads(body)
    except ValueError:
        problem = {}
    text = str(problem.get("detail") or f"the server refused the stream with status {status}")
    return AccessError(text, problem) if status in (401, 403) else error_of_problem({"detail": text, **problem})
