"""Work beside the requests: a thread for as long as a block lasts."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def in_background(name: str, loop: Callable[[threading.Event], None]) -> Iterator[None]:
    """Run ``loop`` in a thread of this name; it returns soon after the event that it gets is set, as the block ends."""
    end = threading.Event()
    thread = threading.Thread(target=loop, args=(end,), name=name, daemon=True)
    thread.start()
    try:
        yield
    finally:
        end.set()
        thread.join()
