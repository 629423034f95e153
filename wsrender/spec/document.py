"""What all parts of a job document share: strict, frozen, and with problems told in plain words."""

from collections.abc import Iterator
from typing import Any, Self

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic.functional_validators import ModelWrapValidatorHandler

from wsrender.errors import DocumentError
from wsrender.spec.problems import listed, located, worded


class Document(BaseModel):
    """A part of a job document. Unknown fields, NaN, infinities and numbers in strings are refused."""

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        validate_default=False,
        use_attribute_docstrings=True,
        protected_namespaces=(),
    )

    def __init__(self, /, **values: Any):
        """Build from keyword arguments; raises DocumentError listing every problem."""
        try:
            super().__init__(**values)
        except ValidationError as error:
            raise DocumentError(listed(error, values)) from None

    # Marks the constructor as one that pydantic need not call when it validates nested documents.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from ()

    @model_validator(mode="wrap")
    @classmethod
    def _in_plain_words(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        try:
            document = handler(data)
        except ValidationError as error:
            raise worded(error, cls) from None
        problems = [located(field, message) for field, message in document.conflicts()]
        if problems:
            raise ValidationError.from_exception_data(cls.__name__, problems)
        return document
