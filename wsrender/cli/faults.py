"""Errors and warnings as one readable line on standard error, with an exit code."""

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import typer
from rich.console import Console
from rich.text import Text

from wsrender.errors import InputError, MissingExtraError, WsrenderError

WRONG_INPUT = 2
OTHER_FAULT = 1
NOT_PASSED = 3
INTERRUPTED = 130


@contextmanager
def one_line_warnings() -> Iterator[None]:
    """Turn warnings into yellow lines."""
    with warnings.catch_warnings():
        warnings.showwarning = _show_warning
        yield


@contextmanager
def one_line_faults(traceback: bool = False) -> Iterator[None]:
    """Turn exceptions into a red line and an exit code, warnings into yellow lines; Ctrl-C says what was kept.

    With ``traceback`` exceptions pass through untouched.
    """
    with one_line_warnings():
        try:
            yield
        except (typer.Exit, typer.Abort):
            raise
        except KeyboardInterrupt as error:
            _print("stopped: ", "bold yellow", "; ".join(getattr(error, "__notes__", ())) or "nothing was kept")
            raise typer.Exit(INTERRUPTED) from None
        except Exception as error:
            if traceback:
                raise
            _print("error: ", "bold red", _message(error))
            raise typer.Exit(WRONG_INPUT if isinstance(error, InputError) else OTHER_FAULT) from None


def _message(error: Exception) -> str:
    if isinstance(error, WsrenderError):
        return str(error)
    if isinstance(error, ModuleNotFoundError) and error.name and not error.name.startswith("wsrender"):
        return str(MissingExtraError(error.name, "engine"))
    if isinstance(error, OSError):
        return str(error)
    return f"{type(error).__name__}: {error} (--traceback shows where)"


def _show_warning(message: Warning | str, *_: object) -> None:
    _print("warning: ", "yellow", str(message))


def _print(label: str, style: str, message: str) -> None:
    Console(file=sys.stderr, soft_wrap=True, highlight=False).print(Text.assemble((label + message, style)))
