"""The time by which ages count."""

import time
from datetime import UTC, datetime, timedelta


class Clock:
    """A wall clock that, jumping ahead while this runs, makes nothing old."""

    def __init__(self):
        self._made = datetime.now(UTC), time.monotonic()

    def now(self) -> datetime:
        """The wall clock's time, at most what has passed since this was made."""
        time_then, seconds_then = self._made
        return min(datetime.now(UTC), time_then + timedelta(seconds=time.monotonic() - seconds_then))
