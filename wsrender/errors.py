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
    └── MissingExtraError (ImportError) an optional dependency is not installed
"""

from collections.abc import Iterable


class WsrenderError(Exception):
    """Base of all errors raised on purpose; ``code`` is stable and machine-readable."""

    code = "error"


class InputError(WsrenderError, ValueError):
    """A value given by the user is not allowed.

    ``field`` is the dotted path of the value in the job document or the name of the argument.
    """

    code = "invalid_input"

    def __init__(self, field: str, message: str):
        self.field = field
        self.message = message
        super().__init__(f"{field}: {message}")


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


class MissingExtraError(WsrenderError, ImportError):
    """An optional dependency is not installed; the message is the pip command that installs it."""

    code = "missing_extra"

    def __init__(self, package: str, extra: str):
        super().__init__(f'{package} is not installed; run: pip install "wsrender[{extra}]"')
