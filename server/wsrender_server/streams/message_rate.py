"""How fast the messages of a client come."""


class MessageRate:
    """Counts the messages of every second [s], of which ``most`` are allowed."""

    def __init__(self, most: int):
        self._most = most
        self._second = self._count = 0

    def exceeded(self, now: float) -> bool:
        """Take in a message at a time [s]; whether it is one too many."""
        if int(now) != self._second:
            self._second, self._count = int(now), 0
        self._count += 1
        return self._count > self._most
