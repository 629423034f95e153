"""Types and defaults of job fields as source text: what a field takes, and not only what it becomes."""

from collections.abc import Iterator
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from wsrender.documents.document import Document

_NUMBERS = {"bool", "int", "float", "None"}


def type_of(annotation: Any) -> str:
    """A type as it is written: lists for tuples, arrays for numbers, documents or their mappings."""
    return " | ".join(dict.fromkeys(_members(annotation)))


def _members(annotation: Any) -> list[str]:
    origin, args = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _members(args[0])
    if origin is Literal:
        return [f"Literal[{', '.join(map(default_of, args))}]"]
    if origin in (Union, UnionType):
        members = [member for each in args for member in _members(each)]
        return sorted(dict.fromkeys(members), key=lambda member: (member == "None", member.startswith("Mapping")))
    if origin is tuple:
        return _of_items(" | ".join(dict.fromkeys(m for each in args if each is not ... for m in _members(each))))
    if origin is dict:
        return [f"Mapping[{type_of(args[0])}, {type_of(args[1])}]"]
    if isinstance(annotation, type) and issubclass(annotation, Document):
        return [annotation.__name__, "Mapping[str, Any]"]
    return ["None" if annotation is NoneType else annotation.__name__]


def _of_items(item: str) -> list[str]:
    """Lists of items; text is none of text, though Python takes it for a sequence."""
    if item == "str":
        return ["list[str]", "tuple[str, ...]"]
    numbers = "np.ndarray" in item or set(item.split(" | ")) <= _NUMBERS
    return [f"Sequence[{item}]", *(["np.ndarray"] if numbers else [])]


def default_of(value: Any) -> str:
    """A default as it is written."""
    if isinstance(value, str):
        return '"' + value.replace('"', '\\"') + '"'
    if isinstance(value, int) and not isinstance(value, bool) and value >= 10_000:
        return f"{value:_}"
    if isinstance(value, tuple):
        return f"({', '.join(map(default_of, value))}{',' if len(value) == 1 else ''})"
    if isinstance(value, Document):
        fields = type(value).model_fields
        changed = {name: each for name, each in value if each != fields[name].default}
        return f"{type(value).__name__}({', '.join(f'{name}={default_of(each)}' for name, each in changed.items())})"
    return repr(value)


def documents_in(annotation: Any) -> Iterator[type[Document]]:
    """The classes of documents that a type names."""
    if isinstance(annotation, type) and issubclass(annotation, Document):
        yield annotation
    for each in get_args(annotation):
        yield from documents_in(each)
