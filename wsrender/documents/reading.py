"""Documents read strictly from JSON text: one value per key, finite numbers, bounded size and depth; and validated."""

import json
from collections.abc import Mapping
from itertools import chain
from typing import Any

from pydantic import TypeAdapter, ValidationError

from wsrender.documents.problems import listed, path_text
from wsrender.errors import DocumentError

LARGEST_DOCUMENT = 16 * 1024**2  # bytes; robot models travel inside, meshes do not
DEEPEST_NESTING = 32  # a job needs 8


def read_json(text: str | bytes) -> Any:
    """The value of a JSON text; raises DocumentError with field "document" for anything malformed.

    Duplicate keys, NaN and Infinity, more than 32 levels of nesting and more than 16 MB are refused.
    """
    size = len(text) if isinstance(text, bytes) else len(text.encode("utf-8", "surrogatepass"))
    if size > LARGEST_DOCUMENT:
        raise _refused(f"must have at most {LARGEST_DOCUMENT} bytes, not {size}")
    try:
        decoded = text.decode("utf-8-sig") if isinstance(text, bytes) else text.removeprefix("\ufeff")
        value = json.loads(decoded, object_pairs_hook=_unique_keys, parse_constant=_no_constant)
    except UnicodeDecodeError as error:
        raise _refused(f"must be UTF-8 text; byte {error.start} is not") from None
    except json.JSONDecodeError as error:
        raise _refused(f"is not JSON: {error.msg} (line {error.lineno}, column {error.colno})") from None
    except RecursionError:
        raise _too_deep() from None
    except ValueError as error:  # an integer of thousands of digits
        if isinstance(error, DocumentError):
            raise
        raise _refused(f"is not JSON: {error}") from None
    return value


def check_depth(document: Any) -> None:
    """Raise DocumentError where objects and lists are nested deeper than 32 levels."""
    level, kinds = [document], {type(document)}
    for _ in range(DEEPEST_NESTING):
        if any(issubclass(kind, dict) for kind in kinds):
            level = [node.values() if isinstance(node, dict) else node for node in level]
        # There may be millions of numbers.
        kinds = {kind for kind in set(map(type, chain.from_iterable(level))) if issubclass(kind, dict | list | tuple)}
        if not kinds:
            return
        level = [child for child in chain.from_iterable(level) if type(child) in kinds]
    raise _too_deep()


def _unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    document: dict[str, Any] = {}
    for key, value in pairs:
        if key in document:
            raise DocumentError([(path_text(key), "must be given only once in its object")])
        document[key] = value
    return document


def _no_constant(literal: str) -> None:
    raise _refused(f"must hold finite numbers only, not {literal}")


def _too_deep() -> DocumentError:
    return _refused(f"must not be nested deeper than {DEEPEST_NESTING} levels")


def _refused(message: str) -> DocumentError:
    return DocumentError([("document", message)])


def read_document(document: Any, kinds: TypeAdapter[Any]) -> Any:
    """What a dict or JSON text holds, of the kinds of a union; DocumentError for anything else.

    Raises DocumentError listing every problem as (dotted path, what is allowed and what was found).
    """
    value = read_json(document) if isinstance(document, str | bytes) else document
    if not isinstance(value, Mapping):
        raise DocumentError([("document", f"must be an object, not {type(value).__name__}")])
    value = dict(value)
    check_depth(value)
    try:
        return kinds.validate_python(value)
    except ValidationError as error:
        raise DocumentError(listed(error, value)) from None
