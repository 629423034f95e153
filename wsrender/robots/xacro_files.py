"""Xacro files of the user's own, expanded by the package xacro.

It evaluates expressions and reads other files: no stranger's file comes here.
"""

import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

from wsrender.errors import InputError, MissingExtraError, ModelError
from wsrender.robots import packages as ros_packages
from wsrender.robots.packages import Packages

SUFFIX = ".xacro"
_IDLE = ("xacro:property", "xacro:arg")  # which alone leave a model as it is
_LOCK = threading.Lock()  # xacro keeps its state in its module


def is_xacro(path: Path, root: Element) -> bool:
    """Whether a file must be expanded: by its name, or by what is in its ``<robot>``."""
    return path.suffix.lower() == SUFFIX or unexpanded(root) is not None


def unexpanded(robot: Element) -> str | None:
    """The tag of an element that only xacro knows; None where there is none."""
    return next((each.tag for each in robot if each.tag.startswith("xacro:") and each.tag not in _IDLE), None)


def expanded(path: Path, arguments: Mapping[str, Any], packages: Packages, field: str) -> bytes:
    """The text of a xacro file with its macros written out, for ``arguments`` by name.

    ``$(find …)`` finds what ``package://`` does. Raises ModelError for what xacro refuses, InputError for an argument
    that nothing in the file asks for, MissingExtraError without the package.
    """
    try:
        import xacro
    except ImportError as error:
        raise MissingExtraError("xacro", "xacro") from error
    given = _Asked({name: str(value) for name, value in arguments.items()})

    def find(package: str) -> str:
        return str(ros_packages.find(package, path.parent.absolute(), packages, field))

    with _LOCK, _finding(find):
        try:
            document: Any = xacro.process_file(str(path), mappings=given)
        except Exception as error:  # its readers raise whatever they stumble over
            raise _refusal(error, path, field) from error
    if unknown := sorted(arguments.keys() - given.asked):
        allowed = ", ".join(sorted(given.asked)) or "none"
        raise InputError(f"xacro.{unknown[0]}", f"is no argument that {path.name} asks for; it asks for: {allowed}")
    return document.toxml(encoding="utf-8")


class _Asked(dict):
    """Arguments, and the names of those that were asked for."""

    def __init__(self, values: Mapping[str, str]):
        super().__init__(values)
        self.asked: set[str] = set()

    def __getitem__(self, name: str) -> str:
        self.asked.add(name)
        return super().__getitem__(name)

    def __contains__(self, name: object) -> bool:
        self.asked.add(str(name))
        return super().__contains__(name)


@contextmanager
def _finding(find: Callable[[str], str]) -> Iterator[None]:
    """Replaces, for the while, the function of xacro's own module that finds packages: it has no other door."""
    from xacro import substitution_args

    before = substitution_args._eval_find
    substitution_args._eval_find = substitution_args._eval_dict["find"] = find
    try:
        yield
    finally:
        substitution_args._eval_find = substitution_args._eval_dict["find"] = before


def _refusal(error: Exception, path: Path, field: str) -> ModelError:
    """What was wrong with a file: a package that is not there, or what xacro says."""
    cause: BaseException | None = error
    while cause is not None and not isinstance(cause, ModelError):
        cause = getattr(cause, "exc", None) or cause.__cause__
    if isinstance(cause, ModelError):
        return cause
    said = " ".join(str(error).split()) or type(error).__name__
    return ModelError(field, f"xacro refuses {path.name}: {said}")
