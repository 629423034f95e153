"""Options of indices: what an entry of the catalogue declares, and the values of a job's ``index_options``."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from wsrender.documents.problems import shown
from wsrender.documents.quantities import integer, real, sequence
from wsrender.errors import InputError

Value = bool | int | float | tuple[float, ...]
_SCHEMAS: dict[str, dict[str, Any]] = {
    "number": {"type": "number"},
    "integer": {"type": "integer"},
    "boolean": {"type": "boolean"},
    "numbers": {"type": "array", "items": {"type": "number"}},
}


@dataclass(frozen=True)
class Option:
    """An option of an index, passed to its function by name.

    ``kind`` is "number", "integer", "boolean" or "numbers" (a list, of ``length`` numbers where that is given);
    ``range`` is that of every number, both ends allowed. Raises InputError for a default that it would not take.
    """

    name: str
    default: Value
    unit: str = "1"
    kind: Literal["number", "integer", "boolean", "numbers"] = "number"
    range: tuple[float, float] = (-math.inf, math.inf)
    length: int | None = None
    description: str = ""

    def __post_init__(self):
        if not self.name.isidentifier():
            raise InputError("options", f"{self.name!r} is not allowed; an identifier is")
        if self.kind not in _SCHEMAS:
            raise InputError("options", f"{self.kind!r} of {self.name} is not allowed; {', '.join(_SCHEMAS)} are")
        try:
            self.value(self.default)
        except ValueError as error:
            raise InputError("options", f"the default of {self.name} {error}") from None

    def value(self, given: Any) -> Value:
        """The value of a document; ValueError says what is allowed."""
        try:
            return self._converted(given)
        except ValueError as error:
            raise ValueError(f"{error}, not {shown(given)}") from None

    def _converted(self, given: Any) -> Value:
        if self.kind == "boolean":
            if not isinstance(given, bool):
                raise ValueError("must be true or false")
            return given
        if self.kind != "numbers":
            return self._within(integer(given) if self.kind == "integer" else real(given))
        numbers = tuple(self._within(real(item)) for item in sequence(given))
        if self.length is not None and len(numbers) != self.length:
            raise ValueError(f"must have {self.length} numbers")
        return numbers

    def _within(self, number: float) -> float:
        low, high = self.range
        if not low <= number <= high:
            unit = "" if self.unit == "1" else f" {self.unit}"
            if math.isinf(high):
                raise ValueError(f"must be at least {low:g}{unit}")
            raise ValueError(f"must be {low:g} … {high:g}{unit}" if math.isfinite(low) else f"must be at most {high:g}")
        return number

    def schema(self) -> dict[str, Any]:
        """JSON Schema of its values."""
        description = f"{self.description or self.name.replace('_', ' ')} [{self.unit}]"
        schema = {**_SCHEMAS[self.kind], "default": self.default, "description": description}
        ends = {name: end for name, end in zip(("minimum", "maximum"), self.range, strict=True) if math.isfinite(end)}
        if self.kind != "numbers":
            return schema | (ends if self.kind != "boolean" else {})
        lengths = {} if self.length is None else {"minItems": self.length, "maxItems": self.length}
        return schema | lengths | {"default": list(self.default), "items": {"type": "number"} | ends}  # type: ignore[arg-type]


def values(options: tuple[Option, ...], given: Mapping[str, Any]) -> dict[str, Value]:
    """The values of all options, defaults where none are given; InputError names the option, below the index."""
    known = {option.name: option for option in options}
    found = {name: option.default for name, option in known.items()}
    for name, value in given.items():
        if name not in known:
            allowed = f"allowed: {', '.join(known)}" if known else "it has none"
            raise InputError(name, f"is not an option of this index; {allowed}")
        try:
            found[name] = known[name].value(value)
        except ValueError as error:
            raise InputError(name, str(error)) from None
    return found
