"""JSON pointers (RFC 6901): places in a document."""

from collections.abc import Iterator
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


def _entries(node: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(node, dict):
        yield from node.items()
    elif isinstance(node, list):
        yield from ((str(k), item) for k, item in enumerate(node))
