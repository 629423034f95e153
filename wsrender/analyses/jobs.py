"""Job documents in and out: parsed, written canonically, described by a schema."""

import json
import re
from collections.abc import Collection, Mapping
from functools import cache
from typing import Annotated, Any, Union

from pydantic import BeforeValidator, Discriminator, TypeAdapter

from wsrender.analyses.registry import EXTENSIONS, job_classes
from wsrender.documents.document import Document
from wsrender.documents.problems import tagged
from wsrender.documents.quantities import quoted
from wsrender.documents.reading import read_document
from wsrender.errors import InputError
from wsrender.extensions import left_out

_NEGATIVE_ZERO = re.compile(r"-0\.0[,}\]]")


def parse_job(document: Mapping[str, Any] | str | bytes | Document, without: Collection[str] = ()) -> Any:
    """The job of a document: a dict, JSON text, or a job already parsed (returned as it is).

    ``without``: names of analyses that are not meant. Raises DocumentError listing every problem as (dotted path, what
    is allowed and what was found).
    """
    if isinstance(document, tuple(job_classes().values())):
        return document
    return read_document(document, _adapter(frozenset(without)))


def canonical_json(job: Document) -> str:
    """The job as JSON text with sorted keys and all defaults: equal jobs, and only they, have equal text."""
    return canonical_text(job.model_dump(mode="json"))


def canonical_text(document: dict[str, Any]) -> str:
    """The JSON text of a job dumped with all defaults, as `canonical_json` gives it."""
    text = _dumped(document)
    return _dumped(_positive_zeros(document)) if _NEGATIVE_ZERO.search(text) else text


def _dumped(document: Any) -> str:
    return json.dumps(document, sort_keys=True, separators=(",", ":"), allow_nan=False)


def job_schema(analysis: str | None = None) -> dict[str, Any]:
    """JSON Schema (2020-12) of all job documents, or of those of one analysis.

    Raises InputError for an analysis that does not exist.
    """
    if analysis is None:
        return _adapter().json_schema()
    if (job := job_classes().get(analysis)) is None:
        raise InputError("analysis", f'must be one of {quoted(job_classes())}, not "{analysis}"{left_out(EXTENSIONS)}')
    return job.model_json_schema()


@cache
def _adapter(without: frozenset[str] = frozenset()) -> TypeAdapter[Any]:
    """One discriminated union on ``analysis``."""
    jobs = {name: job for name, job in job_classes().items() if name not in without}
    union = Union[tuple(jobs.values())]  # noqa: UP007
    known = tagged("analysis", jobs, left_out(EXTENSIONS))
    kinds: Any = Annotated[union, Discriminator("analysis"), BeforeValidator(known)]  # type: ignore[valid-type]
    return TypeAdapter(kinds)


def _positive_zeros(value: Any) -> Any:
    """-0.0 equals 0.0 but is written differently."""
    if isinstance(value, float):
        return value + 0.0
    if isinstance(value, dict):
        return {key: _positive_zeros(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_positive_zeros(item) for item in value]
    return value
