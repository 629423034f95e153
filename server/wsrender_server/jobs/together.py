"""One transaction for all who come at the same time: a commit waits for the disk, however much is in it."""

import threading
from collections.abc import Callable, Sequence
from queue import SimpleQueue
from typing import Any, Generic, TypeVar

Asked = TypeVar("Asked")
Answer = TypeVar("Answer")
_LEAD = object()


class Together(Generic[Asked, Answer]):
    """Threads that ask while others are being answered are answered together, by the first of them.

    ``answer_all`` gives an answer for each, or the exception that this one meets; whatever it raises, all of them meet.
    """

    def __init__(self, answer_all: Callable[[Sequence[Asked]], Sequence[Answer | Exception]]):
        self._answer_all = answer_all
        self._lock = threading.Lock()
        self._waiting: list[tuple[Asked, SimpleQueue[Any]]] = []
        self._led = False

    def answer(self, asked: Asked) -> Answer:
        """The answer; blocks until it is there."""
        mine: SimpleQueue[Any] = SimpleQueue()
        with self._lock:
            self._waiting.append((asked, mine))
            if not self._led:
                self._led = True
                mine.put(_LEAD)
        told = mine.get()
        if told is _LEAD:
            self._lead()
            told = mine.get()
        if isinstance(told, BaseException):
            raise told
        return told

    def _lead(self) -> None:
        """Answer all that wait; who has come meanwhile leads next, so that nobody works for others for long."""
        with self._lock:
            together, self._waiting = self._waiting, []
        try:
            answers: Sequence[Any] = self._answer_all([asked for asked, _ in together])
        except BaseException as error:
            answers = [error] * len(together)
        for (_, waiting), answer in zip(together, answers, strict=True):
            waiting.put(answer)
        with self._lock:
            self._led = bool(self._waiting)
            if self._waiting:
                self._waiting[0][1].put(_LEAD)
