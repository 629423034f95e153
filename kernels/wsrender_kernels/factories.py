"""Factories of types, device functions and kernels: each makes a thing once, one thing at a time.

Warp registers what it is given in tables that all threads share. Two threads that made the same kernel at the same time
could mix their types in it, and it would no longer compile.
"""

import threading
from collections.abc import Callable
from functools import cache, wraps
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")
_making = threading.RLock()  # one for all, since factories call each other


def factory(make: Callable[P, T]) -> Callable[P, T]:
    """Decorator: ``make`` runs once for equal arguments, on one thread at a time; they must be hashable."""
    made = cache(make)

    @wraps(make)
    def once(*args: P.args, **kwargs: P.kwargs) -> T:
        with _making:
            return made(*args, **kwargs)

    return once
