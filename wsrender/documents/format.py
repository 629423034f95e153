"""The format of job and result documents: a number that both carry, and that every reader looks at first."""

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, ConfigDict, Field, ValidationError, model_validator

from wsrender.documents.document import Document
from wsrender.documents.problems import located, shown
from wsrender.documents.quantities import integer

FORMAT = 2


def format_problem(value: Any, absent: str = "left out") -> str | None:
    """Why this version does not read documents whose ``format`` is the value; None where it does.

    ``absent`` says what else than the number is allowed.
    """
    try:
        number = integer(value)
    except ValueError:
        number = None
    if number == FORMAT:
        return None
    newer = number is not None and number > FORMAT
    return f"must be {FORMAT} or {absent}, not {shown(value)}" + (": a newer wsrender has written it" if newer else "")


class JobDocument(Document):
    """What every job document has; one of another format is refused before anything else is looked at."""

    constraints_elsewhere: ClassVar[str] = ""
    """Of a job without constraints or surroundings: what takes them, jobs and fields in quotation marks."""

    format: Annotated[int, Field(json_schema_extra={"const": FORMAT}), BeforeValidator(integer)] = FORMAT
    """Format of the document. Without it a job takes the defaults of the version that runs it, and fields that had
    another name are converted."""

    @model_validator(mode="before")
    @classmethod
    def _of_this_format(cls, data: Any) -> Any:
        problem = format_problem(data["format"]) if isinstance(data, Mapping) and "format" in data else None
        if problem:
            raise ValidationError.from_exception_data(cls.__name__, [located("format", problem)])
        return data


def example(**fields: Any) -> ConfigDict:
    """What a class of jobs says in its schema: a document of a few seconds, which can be run as it is."""
    return ConfigDict(json_schema_extra={"examples": [fields]})
