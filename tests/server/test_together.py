"""What comes at the same time shares a turn of a thread, and each gets its own answer."""

import asyncio
import contextvars
import threading

import pytest
from wsrender_server import together as module
from wsrender_server.together import Together


class Turns:
    """Answers twice a number, or by a ValueError where it is negative; each turn waits until it is let go."""

    def __init__(self):
        self.go, self.asked = threading.Semaphore(0), []

    def __call__(self, numbers):
        self.asked.append(list(numbers))
        assert self.go.acquire(timeout=60)
        return [ValueError(each) if each < 0 else 2 * each for each in numbers]


async def until(condition):
    """Wait for the tasks of the loop, and a thread."""
    async with asyncio.timeout(60):
        while not condition():
            await asyncio.sleep(0.001)


def test_who_comes_while_others_are_answered_is_answered_together_with_the_rest():
    async def ask():
        turns = Turns()
        together = Together(turns)
        first = asyncio.create_task(together.answer(1))
        await until(lambda: turns.asked)
        others = [asyncio.create_task(together.answer(number)) for number in (2, 3, -4, 5)]
        await until(lambda: len(together._waiting) == 4)
        others[1].cancel()  # whoever asked is gone; what was asked is answered
        turns.go.release(2)
        assert [await first, await others[0], await others[3]] == [2, 4, 10]
        assert others[1].cancelled()
        with pytest.raises(ValueError, match="-4"):
            await others[2]
        assert turns.asked == [[1], [2, 3, -4, 5]]
        turns.go.release()
        assert await together.answer(7) == 14  # and the next begins anew

    asyncio.run(ask())


def test_a_turn_takes_so_many_and_the_rest_has_the_next(monkeypatch):
    monkeypatch.setattr(module, "MOST", 3)

    async def ask():
        turns = Turns()
        turns.go.release(9)
        together = Together(turns)
        assert await asyncio.gather(*map(together.answer, range(8))) == [2 * number for number in range(8)]
        assert turns.asked == [[0, 1, 2], [3, 4, 5], [6, 7]]

    asyncio.run(ask())


def test_all_meet_what_meets_their_turn_and_the_next_goes_on():
    faults = [RuntimeError("gone")]

    def answer(asked):
        if faults:
            raise faults.pop()
        return asked

    async def ask():
        together = Together(answer)
        found = await asyncio.gather(together.answer(1), together.answer(2), return_exceptions=True)
        assert [str(each) for each in found] == ["gone", "gone"]
        assert await together.answer(3) == 3

    asyncio.run(ask())


def test_a_turn_is_in_no_requests_context():
    """What is logged in it would have the id of another request."""
    variable = contextvars.ContextVar("variable", default="nobody's")

    async def ask():
        variable.set("the first's")
        assert await Together(lambda asked: [variable.get()]).answer(1) == "nobody's"

    asyncio.run(ask())
