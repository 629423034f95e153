"""Short texts of objects for a prompt: arrays by type and shape, long collections by their first items."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING, fields
from typing import Any

LONGEST = 64  # characters of one value
MOST_ITEMS = 4  # of a collection
LONGEST_REPR = 240  # characters of all values


def short_repr(self: Any) -> str:
    """``Name(field=value, …)`` of a dataclass, without fields that hold their defaults, or nothing."""
    return f"{type(self).__name__}({listed(_told(self))})"


def listed(values: Iterator[tuple[str, Any]]) -> str:
    """``name=value, …``, as far as a line goes."""
    text = ""
    for name, value in values:
        piece = f"{name}={short_value(value)}"
        if len(text) + len(piece) > LONGEST_REPR:
            return f"{text}, …" if text else "…"
        text = f"{text}, {piece}" if text else piece
    return text


def short_value(value: Any) -> str:
    """One value; what would be long by the kinds of its items, or its own."""
    for text in (_text(value), _kinds(value)):
        if len(text) <= LONGEST and " at 0x" not in text:
            return text
    return f"{value[: LONGEST - 1]!r}…" if isinstance(value, str) else _name(value)


def _kinds(value: Any) -> str:
    if isinstance(value, Mapping):
        return f"{{{', '.join(_items(value, str))}}}"
    return f"[{', '.join(_items(value, _name))}]" if isinstance(value, list | tuple) else _name(value)


def _name(value: Any) -> str:
    return getattr(value, "__name__", type(value).__name__)


def _text(value: Any) -> str:
    shape, dtype = getattr(value, "shape", None), getattr(value, "dtype", None)
    if shape == () and dtype is not None:
        return repr(value.item())
    if isinstance(shape, tuple) and dtype is not None:
        kind = "text" if dtype.kind in "UO" else str(dtype)
        return f"{kind} ({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''})"
    if isinstance(value, Mapping):
        return f"{{{', '.join(_items(value, lambda key: f'{key}: {short_value(value[key])}'))}}}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(_items(value, short_value))}]"
    return repr(value)


def short_names(names: Iterable[str], units: Mapping[str, str]) -> str:
    """``manipulability [m²], …`` of the first few names."""
    said = [f"{name}{_unit(units.get(name))}" for name in names]
    return ", ".join(_items(said, str))


def _unit(unit: str | None) -> str:
    return "" if unit in (None, "", "1") else f" [{unit}]"


def _items(values: Mapping[Any, Any] | Sequence[Any], text: Any) -> Iterator[str]:
    for k, value in enumerate(values):
        if k == MOST_ITEMS:
            yield f"… {len(values) - k} more"
            return
        yield text(value)


def _told(what: Any) -> Iterator[tuple[str, Any]]:
    for field in fields(what):
        value = getattr(what, field.name)
        default = field.default if field.default_factory is MISSING else field.default_factory()
        if field.repr and not field.name.startswith("_") and not is_default(value, default):
            yield field.name, value


def is_default(value: Any, default: Any) -> bool:
    """Whether a value is its default; arrays are not compared."""
    if value is default:
        return True
    plain = int | float | str | bool | tuple | list | dict | None
    return (
        isinstance(value, plain)
        and isinstance(default, plain)
        and not (isinstance(value, list | tuple) and any(hasattr(each, "shape") for each in value))
        and (value == default or (value != value and isinstance(default, float) and math.isnan(default)))
    )
