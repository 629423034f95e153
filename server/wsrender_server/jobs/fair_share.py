"""Fair shares of the queue: the jobs of owners take turns, however many one of them has submitted."""


class FairShare:
    """Turns of computations of one priority, the lowest first.

    Start-time fair queueing (Goyal, Vin and Cheng 1996), all costs equal.

    The next turn of an owner is one after the last, or that of what has begun last: who comes late waits for nobody's
    backlog, and who was away has nothing saved up.
    """

    def __init__(self):
        self._now = 0  # turn of what has begun last
        self._last: dict[str, int] = {}

    def turn(self, owner: str) -> int:
        """The turn of an owner's next computation."""
        turn = max(self._now, self._last.get(owner, 0)) + 1
        self._last[owner] = turn
        return turn

    def begun(self, turn: int) -> None:
        """A computation has begun."""
        self._now = max(self._now, turn)
        self._last = {owner: last for owner, last in self._last.items() if last > self._now}
