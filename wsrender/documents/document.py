"""What all parts of a job document share: strict, frozen, and with problems told in plain words."""

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Self

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic.functional_validators import ModelWrapValidatorHandler
from pydantic_core import InitErrorDetails

from wsrender.documents.problems import listed, located, worded
from wsrender.documents.signatures import DocumentType
from wsrender.errors import DocumentError
from wsrender.short_repr import is_default, short_value

MOST_ITEMS = 20_000  # of a list or an object: to tell what is wrong with each takes time and memory
MOST_COLUMNS = 1_000  # of a row in a longer list


class Document(BaseModel, metaclass=DocumentType):
    """A part of a job document. Unknown fields, NaN, infinities and numbers in strings are refused."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, validate_default=False, use_attribute_docstrings=True, protected_namespaces=()
    )

    long_fields: ClassVar[tuple[str, ...]] = ()
    """Fields whose lists may be longer than MOST_ITEMS."""

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

    def __repr_args__(self) -> Iterator[tuple[str, Any]]:
        """What is not at its default; long values are told by their kind."""
        for name, field in type(self).model_fields.items():
            value = self.__dict__.get(name)  # there is none before it is validated
            if field.is_required() or not is_default(value, field.get_default(call_default_factory=True)):
                yield name, _Said(short_value(value))

    @classmethod
    def _excess(cls, data: Any) -> Iterator[InitErrorDetails]:
        """What has too many items even to look at."""
        if not isinstance(data, Mapping):
            return
        if len(data) > MOST_ITEMS:
            yield located((), f"must have at most {MOST_ITEMS} fields, not {len(data)}")
            return
        for field, value in data.items():
            many = isinstance(value, list | tuple | Mapping) and len(value) > MOST_ITEMS
            if many and field not in cls.long_fields:
                yield located((str(field),), f"must have at most {MOST_ITEMS} items, not {len(value)}")
            rows = isinstance(value, list | tuple) and field in cls.long_fields and {list, tuple} >= {*map(type, value)}
            if rows and (widest := max(map(len, value), default=0)) > MOST_COLUMNS:
                yield located((str(field),), f"must hold rows of at most {MOST_COLUMNS} numbers, not {widest}")

    @model_validator(mode="wrap")
    @classmethod
    def _in_plain_words(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        if excess := [*cls._excess(data)]:
            raise ValidationError.from_exception_data(cls.__name__, excess)
        try:
            document = handler(data)
        except ValidationError as error:
            raise worded(error, cls) from None
        problems = [located(field, message) for field, message in document.conflicts()]
        if problems:
            raise ValidationError.from_exception_data(cls.__name__, problems)
        return document


class _Said(str):
    """A text that is shown without quotes."""

    def __repr__(self) -> str:
        return str(self)
