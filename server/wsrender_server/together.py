"""One turn of a thread for all who come at the same time: turns, and commits, take as long for one as for many."""

import asyncio
from collections.abc import Callable, Sequence
from contextvars import Context
from typing import Any, Generic, TypeVar

from starlette.concurrency import run_in_threadpool

Asked = TypeVar("Asked")
Answer = TypeVar("Answer")
MOST = 64  # at a turn: the first of many need not wait for the last


class Together(Generic[Asked, Answer]):
    """Coroutines that ask while others are being answered are answered together, after them.

    ``answer_all``, called in a thread, gives an answer for each, or the exception that this one meets; whatever it
    raises, all of them meet.
    """

    def __init__(self, answer_all: Callable[[Sequence[Asked]], Sequence[Answer | Exception]]):
        self._answer_all = answer_all
        self._waiting: list[tuple[Asked, asyncio.Future[Answer]]] = []
        self._turns: asyncio.Task[None] | None = None

    async def answer(self, asked: Asked) -> Answer:
        """The answer; what was asked is not taken back where whoever asks is canceled."""
        mine: asyncio.Future[Answer] = asyncio.get_running_loop().create_future()
        self._waiting.append((asked, mine))
        if self._turns is None:  # in no request's context: it is that of all
            self._turns = asyncio.create_task(self._take_turns(), context=Context())
        return await mine

    async def _take_turns(self) -> None:
        try:
            while self._waiting:
                together, self._waiting = self._waiting[:MOST], self._waiting[MOST:]
                answers = await run_in_threadpool(self._answers, [asked for asked, _ in together])
                for (_, future), answer in zip(together, answers, strict=True):
                    if future.done():  # whoever asked is gone
                        continue
                    if isinstance(answer, BaseException):
                        future.set_exception(answer)
                    else:
                        future.set_result(answer)
        finally:
            self._turns = None

    def _answers(self, asked: list[Asked]) -> Sequence[Any]:
        try:
            return self._answer_all(asked)
        except Exception as error:
            return [error] * len(asked)
