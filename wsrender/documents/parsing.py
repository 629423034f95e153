"""Job documents in and out: parsed, written canonically, described by a schema."""

import json
from collections.abc import Mapping
from functools import cache
from typing import Any

from pydantic import TypeAdapter

from wsrender.documents.document import Document
from wsrender.documents.jobs import ANALYSES, Job
from wsrender.documents.quantities import quoted
from wsrender.documents.reading import read_document
from wsrender.errors import InputError


def parse_job(document: Mapping[str, Any] | str | bytes | Document) -> Any:
    """The job of a document: a dict, JSON text, or a job already parsed (returned as it is).

    Raises DocumentError listing every problem as (dotted path, what is allowed and what was found).
    """
    if isinstance(document, tuple(ANALYSES.values())):
        return document
    return read_document(document, _adapter())


def canonical_json(job: Document) -> str:
    """The job as JSON text with sorted keys and all defaults: equal jobs, and only they, have equal text."""
    document = _positive_zeros(job.model_dump(mode="json"))
    return json.dumps(document, sort_keys=True, separators=(",", ":"), allow_nan=False)


def job_schema(analysis: str | None = None) -> dict[str, Any]:
    """JSON Schema (2020-12) of all job documents, or of those of one analysis.

    Raises InputError for an analysis that does not exist.
    """
    if analysis is None:
        return _adapter().json_schema()
    if analysis not in ANALYSES:
        raise InputError("analysis", f'must be one of {quoted(ANALYSES)}, not "{analysis}"')
    return ANALYSES[analysis].model_json_schema()


@cache
def _adapter() -> TypeAdapter[Any]:
    return TypeAdapter(Job)


def _positive_zeros(value: Any) -> Any:
    """-0.0 equals 0.0 but is written differently."""
    if isinstance(value, float):
        return value + 0.0
    if isinstance(value, dict):
        return {key: _positive_zeros(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_positive_zeros(item) for item in value]
    return value
