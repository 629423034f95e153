"""A document of one of several kinds, read and validated."""

from collections.abc import Mapping
from typing import Any

from pydantic import TypeAdapter, ValidationError

from wsrender.documents.json_text import check_depth, read_json
from wsrender.documents.problems import listed
from wsrender.errors import DocumentError


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
