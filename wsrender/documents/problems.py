"""Problems of a document in plain words: where, what is allowed, what was found."""

import json
import re
from collections.abc import Callable, Collection, Mapping, Sized
from difflib import get_close_matches
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails, InitErrorDetails, PydanticCustomError

from wsrender.documents.quantities import quoted

MOST_PROBLEMS = 50  # that are told of a part of a document

# Error types of pydantic → what is allowed. {placeholders} come from the error's context.
_ALLOWED = {
    "bool_type": "must be true or false",
    "dict_type": "must be an object",
    "mapping_type": "must be an object",
    "float_type": "must be a number",
    "int_type": "must be a whole number",
    "finite_number": "must be a finite number",
    "greater_than": "must be greater than {gt:g}",
    "greater_than_equal": "must be at least {ge}",
    "less_than": "must be less than {lt:g}",
    "less_than_equal": "must be at most {le}",
    "list_type": "must be a list",
    "literal_error": "must be {expected}",
    "model_attributes_type": "must be an object",
    "model_type": "must be an object",
    "none_required": "must be null",
    "string_pattern_mismatch": "must match {pattern}",
    "string_too_long": "must have at most {max_length} characters",
    "string_too_short": "must not be empty",
    "string_type": "must be a string",
    "string_unicode": "must be valid Unicode text",
    "too_long": "must have at most {max_length} items",
    "too_short": "must have at least {min_length} items",
    "tuple_type": "must be a list",
}
_WORDED = "problem"  # type of the errors whose message is already in plain words
_LONGEST_VALUE = 60
_PLAIN_STEP = re.compile(r'[^."]+')
_CONSTRAINING = ("constraints", "environment")  # fields that most jobs have
_TAGS = ("analysis", "method", "shape")  # fields that tell the members of a union apart


def worded(error: ValidationError, model: type[BaseModel] | None = None) -> ValidationError:
    """The same error with every message in plain words; ``model`` is the document that was validated."""
    problems = [problem for problem in error.errors(include_url=False) if not _miscounted(problem)]
    details = [located(*_in_words(problem, model), problem["input"]) for problem in problems[:MOST_PROBLEMS]]
    if len(problems) > MOST_PROBLEMS:
        details.append(located((), f"has {len(problems) - MOST_PROBLEMS} more problems"))
    return ValidationError.from_exception_data(error.title, details)


def located(loc: str | tuple[int | str, ...], message: str, value: Any = None) -> InitErrorDetails:
    """One problem, already in plain words, at a dotted path or the steps of one."""
    return InitErrorDetails(
        type=PydanticCustomError(_WORDED, "{message}", {"message": message}),
        loc=tuple(loc.split(".")) if isinstance(loc, str) else loc,
        input=value,
    )


def listed(error: ValidationError, document: Any) -> list[tuple[str, str]]:
    """(dotted path, message) of every problem in a document, in the order of its fields."""
    problems = worded(error).errors(include_url=False)
    return [(_path(problem["loc"], document), problem["msg"]) for problem in problems]


def path_text(*steps: str | int) -> str:
    """A path of keys and positions as errors write it: ``robots.0.tip``; a key with dots in it as a JSON string."""
    texts = map(str, steps)
    return ".".join(text if _PLAIN_STEP.fullmatch(text) else json.dumps(text, ensure_ascii=False) for text in texts)


def tagged(field: str, tags: Collection[str], left_out: str = "") -> Callable[[Any], Any]:
    """A validator of discriminated unions: an object must name one of the tags in its ``field``, else ``left_out``."""
    tags = tuple(tags)
    allowed = f"must be one of {quoted(tags)}"

    def validate(value: Any) -> Any:
        said = dict(value) if isinstance(value, Mapping | BaseModel) else None
        if said is not None and said.get(field) not in tags:
            found = f", not {shown(said[field])}" if field in said else "; it is required"
            raise ValidationError.from_exception_data(field, [located(field, allowed + found + left_out)])
        return value

    return validate


def _miscounted(problem: ErrorDetails) -> bool:
    """Whether a list is called too short because pydantic does not count its items that have problems."""
    value, least = problem["input"], problem.get("ctx", {}).get("min_length", 0)
    return problem["type"] == "too_short" and isinstance(value, Sized) and len(value) >= least


def _in_words(problem: ErrorDetails, model: type[BaseModel] | None) -> tuple[tuple[int | str, ...], str]:
    kind, loc, value = problem["type"], problem["loc"], problem["input"]
    context = problem.get("ctx", {})
    if kind == _WORDED:
        return loc, context["message"]
    if kind == "missing":
        return loc, "is required"
    if kind == "extra_forbidden":
        return loc, _unknown_field(loc, model)
    if kind == "value_error":
        allowed = str(context["error"])
        if not loc:  # of the document as a whole, whose message tells what was found
            return loc, allowed
    elif kind in _ALLOWED:
        allowed = _ALLOWED[kind].format(**_json_style(context))
    else:
        allowed = problem["msg"]
    return loc, f"{allowed}, not {shown(value)}"


def _unknown_field(loc: tuple[int | str, ...], model: type[BaseModel] | None) -> str:
    if model is None or len(loc) != 1:
        return "is not a known field"
    if loc[0] in _CONSTRAINING and (elsewhere := getattr(model, "constraints_elsewhere", "")):
        return f"is not taken by this analysis: {elsewhere}"
    fields = list(model.model_fields)
    close = get_close_matches(str(loc[-1]), fields, n=1)
    hint = f"did you mean {close[0]}? " if close else ""
    return f"is not a known field; {hint}allowed: {', '.join(fields)}"


def _json_style(context: dict[str, Any]) -> dict[str, Any]:
    return {key: text.replace("'", '"') if isinstance(text, str) else text for key, text in context.items()}


def shown(value: Any) -> str:
    """A value as JSON would write it, or what kind of thing it is where that is long."""
    if isinstance(value, Mapping | list | tuple) and len(value) > _LONGEST_VALUE:
        return _kind(value)
    try:
        text = json.dumps(value, ensure_ascii=False)
    except (TypeError, ValueError):
        text = repr(value)
    text = text.encode("utf-8", "backslashreplace").decode()
    if len(text) <= _LONGEST_VALUE:
        return text
    return _kind(value) if isinstance(value, Mapping | list | tuple) else f"{text[:_LONGEST_VALUE]}…"


def _kind(value: Mapping[Any, Any] | list[Any] | tuple[Any, ...]) -> str:
    return "an object" if isinstance(value, Mapping) else f"a list of {len(value)}"


def _path(loc: tuple[int | str, ...], document: Any) -> str:
    """The dotted path of a location, without the union tags that pydantic puts in between."""
    steps, node, entered = [], document, False
    for step in loc:
        if step == "[key]" and step not in (node if isinstance(node, Mapping) else ()):
            continue  # pydantic's word for a key that is not allowed, which is the step before
        if not entered and isinstance(node, Mapping) and step in (*map(node.get, _TAGS), *_implied(steps)):
            entered = True
            continue
        steps.append(step)
        entered = False
        if isinstance(node, Mapping):
            node = node.get(step)
        elif isinstance(node, list | tuple) and isinstance(step, int) and step < len(node):
            node = node[step]
        else:
            node = None
    return path_text(*steps) or "document"


def _implied(steps: list[int | str]) -> tuple[str, ...]:
    """The tag that an item of an environment need not have."""
    return ("robot",) if steps[-2:-1] == ["items"] else ()
