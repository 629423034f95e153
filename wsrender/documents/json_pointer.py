"""JSON pointers (RFC 6901): places in a document."""

from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from typing import Any


def steps_of(pointer: str) -> tuple[str, ...]:
    """Keys and numbers on the way; ValueError for text that is no pointer below the root."""
    if not pointer.startswith("/"):
        raise ValueError(f'must start with "/", such as "/robot/dh/rows/0/a"; "{pointer}" does not')
    return tuple(step.replace("~1", "/").replace("~0", "~") for step in pointer[1:].split("/"))


def found_at(document: Any, pointer: str) -> Any:
    """What a document holds there; ValueError, with the choices, where it holds nothing."""
    node = document
    for depth, step in enumerate(steps := steps_of(pointer)):
        choices = dict(_entries(node))
        if step not in choices:
            before = "/" + "/".join(steps[:depth]) if depth else "the document"
            listed = ", ".join(list(choices)[:20]) or "nothing"
            raise ValueError(f'points to nothing: {before} has no "{step}"; it has {listed}')
        node = choices[step]
    return node


def changed(document: Any, values: dict[str, Any]) -> Any:
    """A copy of a document with other values at pointers that exist."""
    copy = deepcopy(document)
    for pointer, value in values.items():
        *way, last = steps_of(pointer)
        node = copy
        for step in way:
            node = node[int(step)] if isinstance(node, list) else node[step]
        node[int(last) if isinstance(node, list) else last] = value
    return copy


def numbers_at(document: Any, pointer: str) -> Any:
    """The number or list of numbers that a document holds there; ValueError where it holds nothing or another thing."""
    found = found_at(document, pointer)
    if not all(_is_number(item) for item in (found if isinstance(found, list) else [found])):
        raise ValueError(f"must point to a number, or a list of numbers, not {found!r}"[:200])
    return found


def in_words_of(written: Any, canonical: Any, pointers: Sequence[str]) -> Any:
    """A canonical document in the words of the one that was ``written``, as far as pointers to numbers need them.

    The canonical document says ``limits`` where ``limits_deg`` was written: an object with an entry that only the
    written one has becomes the written object, with the canonical entries that other pointers need.
    """
    document, written = deepcopy(canonical), _plain(written)
    for pointer in pointers:
        if not _has_numbers(document, pointer) and _has_numbers(written, pointer):
            _take(document, written, steps_of(pointer), whole=True)
    for pointer in pointers:
        if not _has_numbers(document, pointer) and _has_numbers(canonical, pointer):
            _take(document, canonical, steps_of(pointer), whole=False)
    return document


def _take(document: Any, other: Any, steps: tuple[str, ...], whole: bool) -> None:
    """Take from another document the object (``whole``) or the entry at which the steps have nothing in this one."""
    parent: Any = None
    key: Any = None
    for step in steps:
        child, there = dict(_entries(document)).get(step), dict(_entries(other))[step]
        if child is None:
            if whole and parent is not None:
                parent[key] = deepcopy(other)
            else:
                document[step] = deepcopy(there)
            return
        parent, key = document, int(step) if isinstance(document, list) else step
        document, other = child, there


def _has_numbers(document: Any, pointer: str) -> bool:
    try:
        numbers_at(document, pointer)
    except ValueError:
        return False
    return True


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _plain(value: Any) -> Any:
    """Mappings as dicts and sequences as lists, as JSON has them."""
    if isinstance(value, Mapping):
        return {name: _plain(item) for name, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, list | tuple) else value


def _entries(node: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(node, dict):
        yield from node.items()
    elif isinstance(node, list):
        yield from ((str(k), item) for k, item in enumerate(node))
