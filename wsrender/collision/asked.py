"""Programs that a plan asks for: who listens hears of each, and of how far one is that is made.

Both hold in the thread that plans, which is where programs are made: those of other threads are none of its job's.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

Item = TypeVar("Item")
Told = Callable[[int, int, str], None]
"""Called with what is done, of how much, and what is going on."""

_LISTS: ContextVar[tuple[dict[str, Any], ...]] = ContextVar("lists", default=())
_TOLD: ContextVar[Told | None] = ContextVar("told", default=None)


@contextmanager
def noted() -> Iterator[dict[str, Any]]:
    """Programs, by key, that are asked for within."""
    found: dict[str, Any] = {}
    token = _LISTS.set((*_LISTS.get(), found))
    try:
        yield found
    finally:
        _LISTS.reset(token)


def note(key: str, program: Any) -> None:
    """That a program was asked for."""
    for found in _LISTS.get():
        found[key] = program


@contextmanager
def told_to(told: Told | None) -> Iterator[None]:
    """Whoever makes a program within tells how far it is."""
    token = _TOLD.set(told)
    try:
        yield
    finally:
        _TOLD.reset(token)


def counted(items: Sequence[Item]) -> Iterator[Item]:
    """What tables, or grids of distances, are made of in turn; how many are done is told."""
    told = _TOLD.get()
    for number, item in enumerate(items):
        if told:
            told(number, len(items), "collision tables")
        yield item
