"""The process of one session of questions about a view: one answer at a time, by the engine, behind everything else.

What comes and goes over its link are frames: four bytes of a length, little-endian, and as many bytes. A question is
JSON, ``{id, ask, …}``; an answer is a message of `wsrender.results.view.interactive`. The first frame says that the
session is ready, or why it is not.
"""

import contextlib
import json
import os
import socket
import struct
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import structlog
from pydantic import TypeAdapter

from wsrender.documents.reading import read_document, read_json
from wsrender.documents.view_requests import REQUESTS
from wsrender.errors import InputError, WsrenderError
from wsrender.results.view.container import message
from wsrender.results.view.interactive import Interactive, ReplacedError
from wsrender.robots.uploaded import MODELS_VARIABLE
from wsrender_server.jobs.child_process import settle_in
from wsrender_server.problems import problem_of_error

NICE = 19  # behind jobs, which stand behind the server
LARGEST_FRAME = 1 << 30

log = structlog.get_logger("wsrender.views")


def run_session(link: socket.socket, subject: Mapping[str, Any], models: Path, threads: int | None) -> None:
    """Answer questions about a ``subject`` until the link closes: {"robot": library name}, {"edited": text}, a result.

    The text is that of an admitted `Edited`; of a result: {"result": path of its document, "files": paths by name}.
    """
    settle_in()
    if hasattr(os, "nice"):  # not on Windows
        os.nice(NICE)
    os.environ[MODELS_VARIABLE] = str(models)
    link.setblocking(True)
    try:
        interactive = _opened(subject, threads)
    except WsrenderError as error:
        send_frame(link, message({"id": None, "refused": refused(error)}, {}))
        return
    send_frame(link, message({"id": None, "answer": {"robots": [robot.name for robot in interactive.robots]}}, {}))
    questions = _Questions(link)
    threading.Thread(target=questions.read, daemon=True).start()
    with contextlib.suppress(OSError):  # nobody listens any more
        _answer(link, questions, interactive)


def refused(error: Exception) -> dict[str, Any]:
    """What a page is told of an error: message, field and code."""
    problem = problem_of_error(error)
    field, said = (error.field, error.message) if isinstance(error, InputError) else ("", problem["detail"])
    return {"message": said, "field": field, "code": problem["code"]}


def send_frame(link: socket.socket, content: bytes) -> None:
    """Send a frame, however long that takes."""
    link.sendall(struct.pack("<I", len(content)))
    link.sendall(content)


def _opened(subject: Mapping[str, Any], threads: int | None) -> Interactive:
    from wsrender.results.result import Result
    from wsrender.results.view import Edited
    from wsrender.robot import load_robot
    from wsrender_server.conversions import result_document

    if "edited" in subject:
        return Interactive.of_edited(read_document(subject["edited"], TypeAdapter(Edited)), threads=threads)
    if "robot" in subject:
        return Interactive({}, [load_robot(subject["robot"])], threads=threads)
    files = {name: Path(path) for name, path in subject["files"].items()}
    return Interactive.of_result(Result.of_files(result_document(subject["result"]), files), threads=threads)


class _Questions:
    """Questions that have come and are not answered: of each kind the last, which replaces the one before."""

    def __init__(self, link: socket.socket):
        self._link = link
        self._waiting: dict[str, tuple[Any, Any]] = {}
        self._replaced: list[Any] = []
        self._news = threading.Condition()
        self._running: str | None = None
        self.ended = False

    def read(self) -> None:
        """Take in questions until the link closes; a thread of its own."""
        with contextlib.suppress(OSError):
            while (text := self._frame()) is not None:
                number, kind, question = parsed(text)
                with self._news:
                    if kind in self._waiting:
                        self._replaced.append(self._waiting.pop(kind)[0])
                    self._waiting[kind] = number, question
                    self._news.notify()
        with self._news:
            self.ended = True
            self._news.notify()

    def next(self) -> tuple[str, Any, Any, list[Any]] | None:
        """Kind, id and content of the question that has waited longest, and ids of replaced ones; None at the end."""
        with self._news:
            self._running = None
            self._news.wait_for(lambda: self._waiting or self.ended)
            if self.ended:
                return None
            kind = self._running = next(iter(self._waiting))
            replaced, self._replaced = self._replaced, []
            return kind, *self._waiting.pop(kind), replaced

    def wanted(self) -> bool:
        """Whether the answer that is being computed is: no later question of its kind has come, and somebody waits."""
        return not self.ended and self._running not in self._waiting

    def _frame(self) -> bytes | None:
        head = self._bytes(4)
        return None if head is None else self._bytes(min(struct.unpack("<I", head)[0], LARGEST_FRAME))

    def _bytes(self, count: int) -> bytes | None:
        content = b""
        while len(content) < count:
            if not (more := self._link.recv(count - len(content))):
                return None
            content += more
        return content


def parsed(text: bytes) -> tuple[Any, str, Any]:
    """Id, kind and content of a question; of one that is wrong the error, which is told in its turn."""
    number = None
    try:
        question = read_json(text)
        if not isinstance(question, dict):
            raise InputError("request", f"must be an object, not {type(question).__name__}")
        number = question.pop("id", None)
        if isinstance(number, bool) or not isinstance(number, int | str):
            number = None
            raise InputError("id", "must be a whole number or a text, by which the answer names the question")
    except InputError as error:
        return number, f"wrong {number}", error
    kind = question.get("ask")
    return number, kind if isinstance(kind, str) and kind in REQUESTS else f"wrong {number}", question


def _answer(link: socket.socket, questions: _Questions, interactive: Interactive) -> None:
    while (asked := questions.next()) is not None:
        _kind, number, question, replaced = asked
        for each in replaced:
            send_frame(link, _replaced(each))
        send_frame(link, _answered(number, question, interactive, questions.wanted))


def _answered(number: Any, question: Any, interactive: Interactive, wanted: Callable[[], bool]) -> bytes:
    try:
        if isinstance(question, InputError):
            raise question
        header, blobs = interactive.answer(question, wanted)
        return message({"id": number, "answer": header}, blobs)
    except ReplacedError:
        return _replaced(number)
    except WsrenderError as error:
        return message({"id": number, "refused": refused(error)}, {})
    except Exception as error:
        log.exception("question failed", question=json.dumps(question)[:500])
        return message({"id": number, "refused": refused(error)}, {})


def _replaced(number: Any) -> bytes:
    said = {"message": "a later question of this kind has come", "field": "", "code": "replaced"}
    return message({"id": number, "refused": said}, {})
