"""How documents tell themselves to ``help`` and to completion: their fields, without what pydantic adds."""

from collections.abc import Iterator
from inspect import Parameter, Signature, signature
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, dataclass_transform, get_args, get_origin

from pydantic import BaseModel, Field
from pydantic._internal._model_construction import ModelMetaclass

from wsrender.short_repr import short_value

_SHOWN = ("__init__", "__doc__", "__module__")


@dataclass_transform(kw_only_default=True, field_specifiers=(Field,))  # as pydantic's: it is not inherited
class DocumentType(ModelMetaclass):
    """The class of `Document` classes: ``dir`` lists what they add to pydantic's, signatures their fields."""

    def __dir__(self) -> list[str]:
        known = {*dir(BaseModel), *super().__dir__()}
        own = {name for each in self.__mro__ if each not in BaseModel.__mro__ for name in vars(each)}
        return sorted(name for name in known & own if name in _SHOWN or not name.startswith(("_", "model_config")))

    @property
    def __signature__(self) -> Signature:
        parameters = [each for each in _given(self) if each.name != "self"]
        return Signature(parameters, return_annotation=Signature.empty)

    @__signature__.setter
    def __signature__(self, _: Any) -> None:
        """Not pydantic's own, in which every number is a page."""


def _given(cls: Any) -> Iterator[Parameter]:
    """The parameters of its constructor; where that takes any field, those."""
    named = signature(cls.__init__).parameters
    for each in named.values():
        if each.kind is not Parameter.VAR_KEYWORD:
            yield each.replace(
                annotation=_Text(_plain(each.annotation)) if each.annotation is not each.empty else each.empty
            )
        elif each.name == "values":
            fields = {name: field for name, field in cls.model_fields.items() if name not in named}
            yield from map(_of_field, fields, fields.values())


def _of_field(name: str, field: Any) -> Parameter:
    default = (
        Parameter.empty if field.is_required() else _Text(short_value(field.get_default(call_default_factory=True)))
    )
    return Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=_Text(_plain(field.annotation)))


def _plain(kind: Any) -> str:
    """A type as people write it, without its validators."""
    origin, parts = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return _plain(parts[0])
    if origin in (Union, UnionType):
        return " | ".join(dict.fromkeys(map(_plain, parts)))
    if origin is Literal:
        return f"Literal[{', '.join(map(repr, parts))}]"
    name = "None" if kind is NoneType else "…" if kind is ... else getattr(kind, "__name__", str(kind))
    return f"{name}[{', '.join(map(_plain, parts))}]" if parts else name


class _Text(str):
    """A text that signatures show without quotes."""

    def __repr__(self) -> str:
        return str(self)
