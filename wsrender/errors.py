"""Every exception that wsrender raises on purpose.

::

    WsrenderError
    ├── InputError (ValueError)        a value given by the user is not allowed; names the field
    │   ├── DocumentError              a job document does not follow its schema
    │   ├── ModelError                 a robot model is malformed, hostile or unsupported
    │   │   └── FrameNotFoundError     a base or tip that the model does not have; lists the choices
    │   ├── MissingInertiaError        a dynamic quantity of a robot without published inertias
    │   └── ResourceError              the request needs more memory or samples than allowed
    ├── NotConvergedError              an iteration reached its limit before its tolerance
    ├── NumericalError                 a kernel reported a value that it must not produce
    ├── RenderError                    a 3-D picture cannot be drawn: no OpenGL, a crash, too slow
    ├── MissingExtraError (ImportError) an optional dependency is not installed
    ├── ServerError                    a server refused a request or failed; keeps its problem document
    │   ├── AccessError                no key, an unknown key, or one without the right
    │   ├── NotFoundError              the server has no such job, model or artifact, or not for this key
    │   ├── QuotaError                 too many jobs or requests; says when to try again
    │   └── JobFailedError             a job ended without a result: failed, canceled, timed out
    ├── ServerConnectionError (ConnectionError) a server cannot be reached, or was lost for too long
    └── WaitTimeoutError (TimeoutError) a job has not finished in the time that its caller would wait

>>> arm = ws.load_robot("ur5e")
>>> try:
...     arm.forward_kinematics([0.0, 0.5])
... except ws.InputError as error:
...     print(error.field, "|", error.message)
q | has shape (2,); (6,) or (N, 6) is needed
"""

from collections.abc import Iterable
from typing import Any

from wsrender.version import __version__


class WsrenderError(Exception):
    """Base of all errors raised on purpose; ``code`` is stable and machine-readable."""

    code = "error"

    def __reduce__(self) -> tuple[Any, ...]:
        # Errors travel between processes; their constructors take other arguments than Exception keeps.
        return _restored, (type(self), self.args, self.__dict__)


def _restored(kind: type[WsrenderError], args: tuple[Any, ...], members: dict[str, Any]) -> WsrenderError:
    error = kind.__new__(kind, *args)
    error.__dict__.update(members)
    return error


class InputError(WsrenderError, ValueError):
    """A value given by the user is not allowed.

    ``field`` is the dotted path of the value in the job document or the name of the argument.
    """

    code = "invalid_input"

    def __init__(self, field: str, message: str):
        self.field = field
        self.message = message
        super().__init__(f"{field}: {message}")

    def within(self, path: str) -> "InputError":
        """The same error, its field below ``path`` of the job document."""
        return self.at(f"{path}.{self.field}" if path else self.field)

    def at(self, field: str) -> "InputError":
        """The same error, of another field."""
        self.field = field
        self.args = (f"{self.field}: {self.message}",)
        return self


class DocumentError(InputError):
    """A job document does not follow its schema; ``problems`` holds (field, message) of every fault."""

    code = "invalid_document"

    def __init__(self, problems: Iterable[tuple[str, str]]):
        self.problems = list(problems)
        field, message = self.problems[0]
        if len(self.problems) > 1:
            message += "".join(f"\n{f}: {m}" for f, m in self.problems[1:])
        super().__init__(field, message)


class ModelError(InputError):
    """A robot model is malformed, hostile or unsupported."""

    code = "invalid_model"


class FrameNotFoundError(ModelError):
    """A base or tip that the model does not have, or that must be chosen; lists the choices."""

    code = "frame_not_found"

    def __init__(self, field: str, message: str, choices: Iterable[str]):
        self.choices = list(choices)
        super().__init__(field, f"{message}; choose one of: {', '.join(self.choices)}")


class MissingInertiaError(InputError):
    """A dynamic quantity was asked of a robot whose model has no inertias."""

    code = "missing_inertia"


class ResourceError(InputError):
    """The request needs more memory, samples or disk than is there or allowed."""

    code = "resource_limit"


class NotConvergedError(WsrenderError):
    """An iteration reached its limit before its tolerance; ``sequence`` holds what it computed."""

    code = "not_converged"

    def __init__(self, message: str, sequence: list):
        self.sequence = sequence
        super().__init__(message)


class NumericalError(WsrenderError):
    """A kernel reported a value that it must not produce: not finite, or beyond its stated bound."""

    code = "numerical_fault"


class RenderError(WsrenderError):
    """A 3-D picture cannot be drawn: OpenGL is missing, or the process that drew it crashed or was too slow."""

    code = "render_failed"


class RenderWarning(UserWarning):
    """3-D pictures were left out of a report."""


class MissingExtraError(WsrenderError, ImportError):
    """An optional dependency is not installed; the message holds the pip commands that install it.

    wsrender is on no package index: it is installed from its clone or a wheel.
    """

    code = "missing_extra"

    def __init__(self, package: str, extra: str):
        wheel = f"wsrender-{__version__}-py3-none-any.whl"
        super().__init__(
            f'{package} is not installed; in the clone of wsrender run: pip install ".[{extra}]", or beside its wheel: '
            f'pip install "{wheel}[{extra}]"'
        )


class ServerError(WsrenderError):
    """A server refused a request or failed; ``problem`` is its problem document (RFC 9457), or empty.

    ``code`` is the problem's, ``status`` the HTTP status (0: none), ``retryable`` whether the same request may
    succeed later.
    """

    code = "server_error"

    def __init__(self, message: str, problem: dict[str, Any] | None = None):
        self.problem = problem or {}
        self.code = str(self.problem.get("code") or self.code)
        self.status = int(self.problem.get("status") or 0)
        self.retryable = bool(self.problem.get("retryable"))
        super().__init__(message)


class AccessError(ServerError):
    """The server asks for an API key, does not know the one given, or the key lacks the right."""

    code = "access_denied"


class NotFoundError(ServerError):
    """The server has no such job, model or artifact, or it belongs to somebody else."""

    code = "not_found"


class QuotaError(ServerError):
    """Too many jobs or requests of one key; ``retry_after_s`` says when to try again [s], None: unknown."""

    code = "too_many_requests"

    def __init__(self, message: str, problem: dict[str, Any] | None = None, retry_after_s: float | None = None):
        self.retry_after_s = retry_after_s
        super().__init__(message, problem)


class JobFailedError(ServerError):
    """A job ended without a result: failed, canceled or timed out."""

    code = "job_failed"


class ServerConnectionError(WsrenderError, ConnectionError):
    """A server cannot be reached, or was lost for longer than the client would wait."""

    code = "connection_failed"


class WaitTimeoutError(WsrenderError, TimeoutError):
    """A job has not finished in the time that its caller would wait; it goes on."""

    code = "wait_timeout"
