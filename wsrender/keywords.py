"""Unknown keyword arguments, refused with the one that may be meant."""

from collections.abc import Callable, Iterable
from difflib import get_close_matches
from functools import wraps
from inspect import Parameter, isclass, isfunction, signature
from typing import Any, TypeVar

Called = TypeVar("Called", bound=Callable[..., Any])


def unknown(name: str, keyword: str, allowed: Iterable[str]) -> TypeError:
    """The error of a call of the function ``name`` with a keyword that it does not take."""
    allowed = list(allowed)
    close = get_close_matches(keyword, allowed, n=1)
    hint = f"did you mean {close[0]}? " if close else ""
    return TypeError(f"{name}() has no parameter {keyword}; {hint}allowed: {', '.join(allowed) or 'none'}")


def keywords(what: Called) -> Called:
    """A function that refuses an unknown keyword with the one that may be meant; of a class all that it offers."""
    if not isclass(what):
        return _checked(what)
    kind: Any = what
    for name, member in vars(kind).copy().items():
        if isfunction(member) and (name == "__init__" or not name.startswith("_")):
            setattr(kind, name, _checked(member))
    return kind


def _checked(function: Any) -> Any:
    name = function.__qualname__.removesuffix(".__init__").rpartition(".")[2]
    parameters = signature(function).parameters.values()
    named = [each.name for each in parameters if each.kind in (Parameter.KEYWORD_ONLY, Parameter.POSITIONAL_OR_KEYWORD)]
    named = [each for each in named if each != "self"]
    if any(each.kind is Parameter.VAR_KEYWORD for each in parameters):
        return function
    known = frozenset(named)

    @wraps(function)
    def call(*args: Any, **given: Any) -> Any:
        if not known.issuperset(given):
            raise unknown(name, next(each for each in given if each not in known), named)
        return function(*args, **given)

    return call
