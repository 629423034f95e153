"""Result documents of earlier versions in today's form.

Those of 0.1 and 0.2 have no ``format``; their provenance tells them apart. What they hold beside the fields that every
result has is read where it is used.
"""

from collections.abc import Mapping
from typing import Any

from wsrender.documents.format import FORMAT, format_problem
from wsrender.documents.problems import shown
from wsrender.errors import InputError

_WITHOUT = ("0.1.", "0.2.")  # versions that wrote no format
_ABSENT = "missing, as in results of wsrender 0.1 and 0.2"


def current_document(document: Mapping[str, Any]) -> dict[str, Any]:
    """A result document with the fields that every result has today; nothing else of it is changed.

    Raises InputError for a format that this version does not read, and for a document without one that is neither of
    0.1 nor 0.2.
    """
    if "format" in document:
        if problem := format_problem(document["format"], _ABSENT):
            raise InputError("format", problem)
        return dict(document)
    version = _version(document)
    if not version.startswith(_WITHOUT):
        raise InputError("format", f"is missing, and provenance.wsrender is {shown(version)}; must be {_ABSENT}")
    return {"format": FORMAT, **document, **_missing(document, version)}


def _version(document: Mapping[str, Any]) -> str:
    """The version that wrote a document without a format; one that was made by hand says none, as 0.1 allowed."""
    origin = document.get("provenance")
    return str(origin.get("wsrender", "0.1.0")) if isinstance(origin, Mapping) else "0.1.0"


def _missing(document: Mapping[str, Any], version: str) -> dict[str, Any]:
    """What came with 0.2."""
    none = {"quantity": "volume", "value": None, "ci95": None, "unit": "m3"}
    later = {"headline": none | {"reason": f"results of wsrender {version} have no headline"}, "warnings": []}
    return {name: value for name, value in later.items() if name not in document}
