"""The loopback server of a view: whom it lets in, and what it answers."""

import http.client
import json
import struct
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import pytest

from wsrender.errors import InputError
from wsrender.results.view.container import message
from wsrender.results.view.interactive import ReplacedError
from wsrender.window.local import LONGEST_QUESTION, LocalView


class Shown:
    manifest: Mapping[str, Any] = {"title": "<b>arm</b>", "format": 1}

    blobs: Mapping[str, bytes] = {"count of voxels/0": b"\x01\x02"}


class Answers:
    def answer(
        self, request: Mapping[str, Any], wanted: Callable[[], bool] = lambda: True
    ) -> tuple[dict[str, Any], Mapping[str, bytes]]:
        if request.get("ask") == "volume" and not request.get("soon"):
            for _ in range(1000):
                if not wanted():
                    raise ReplacedError
                time.sleep(0.01)
        if request.get("ask") == "fault":
            raise RuntimeError("odd")
        if request.get("ask") == "volume":
            return {"samples": 5}, {}
        if request.get("ask") != "voxel":
            raise InputError("ask", "must be voxel")
        return {"count": 3}, {"a": b"xyz", "b": b""}


@pytest.fixture
def shown() -> Iterator[LocalView]:
    local = LocalView(Shown(), Answers())
    yield local
    local.close()


def ask(
    local: LocalView, method: str, path: str, body: bytes | None = None, **headers: str
) -> tuple[int, http.client.HTTPMessage, bytes]:
    connection = http.client.HTTPConnection("127.0.0.1", local.port, timeout=10)
    try:
        connection.request(method, path, body, {key.replace("_", "-"): value for key, value in headers.items()})
        answer = connection.getresponse()
        return answer.status, answer.headers, answer.read()
    finally:
        connection.close()


def let_in(local: LocalView) -> str:
    status, headers, _ = ask(local, "GET", f"/?token={local.token}")
    assert status == 303
    return headers["Set-Cookie"].split(";")[0]


def test_the_link_lets_one_in_once(shown: LocalView) -> None:
    link = shown.url.partition("?")[2]
    cookie = let_in(shown)
    assert ask(shown, "GET", f"/?{link}")[0] == 403
    assert ask(shown, "GET", "/manifest")[0] == 403
    assert ask(shown, "GET", "/manifest", Cookie="wsrender=x")[0] == 403
    assert ask(shown, "GET", "/manifest", Cookie=cookie[:-1])[0] == 403
    status, _, data = ask(shown, "GET", "/manifest", Cookie=cookie)
    assert status == 200
    assert json.loads(data) == {"title": "<b>arm</b>", "format": 1}


def test_a_wrong_token_does_not_use_up_the_link(shown: LocalView) -> None:
    assert ask(shown, "GET", "/?token=wrong")[0] == 403
    assert ask(shown, "GET", "/?token=%C3%A4")[0] == 403
    let_in(shown)


def test_the_cookie_is_not_for_scripts_nor_for_other_sites(shown: LocalView) -> None:
    _, headers, _ = ask(shown, "GET", f"/?token={shown.token}")
    assert {"HttpOnly", "SameSite=Strict", "Path=/"} <= {part.strip() for part in headers["Set-Cookie"].split(";")}


def test_other_hosts_are_refused(shown: LocalView) -> None:
    cookie = let_in(shown)
    for host in ("evil.example", f"evil.example:{shown.port}", "127.0.0.1", f"localhost:{shown.port + 1}"):
        assert ask(shown, "GET", "/manifest", Cookie=cookie, Host=host)[0] == 421
        assert ask(shown, "POST", "/ask", b"{}", Cookie=cookie, Host=host, Origin=f"http://{host}")[0] == 421
    assert ask(shown, "GET", "/manifest", Cookie=cookie, Host=f"localhost:{shown.port}")[0] == 200


def test_other_pages_may_not_ask(shown: LocalView) -> None:
    cookie, own = let_in(shown), f"http://127.0.0.1:{shown.port}"
    question = json.dumps({"ask": "voxel"}).encode()
    for origin in ({}, {"Origin": "null"}, {"Origin": "http://evil.example"}, {"Origin": f"https{own[4:]}"}):
        assert ask(shown, "POST", "/ask", question, Cookie=cookie, **origin)[0] == 403
    assert ask(shown, "POST", "/ask", question, Origin=own)[0] == 403
    status, _, data = ask(shown, "POST", "/ask", question, Cookie=cookie, Origin=own)
    assert status == 200
    assert data == message({"answer": {"count": 3}}, {"a": b"xyz", "b": b""})


def test_a_message_is_header_and_blobs() -> None:
    data = message({"answer": {"π": 1}}, {"a": b"xyz", "b": b"", "c": b"w"})
    (length,) = struct.unpack("<I", data[:4])
    assert length % 4 == 0
    header = json.loads(data[4 : 4 + length])
    assert header["blobs"] == [{"name": "a", "bytes": 3}, {"name": "b", "bytes": 0}, {"name": "c", "bytes": 1}]
    assert data[4 + length :] == b"xyzw"


def test_what_is_wrong_is_said(shown: LocalView) -> None:
    cookie, own = let_in(shown), f"http://127.0.0.1:{shown.port}"
    for body, field in ((b'{"ask": "pose"}', "ask"), (b"[]", "request"), (b"{", "")):
        status, _, data = ask(shown, "POST", "/ask", body, Cookie=cookie, Origin=own)
        (length,) = struct.unpack("<I", data[:4])
        refused = json.loads(data[4 : 4 + length])["refused"]
        assert status == 200
        assert refused["field"] == field
        assert refused["message"]
    assert ask(shown, "GET", "/blobs/other", Cookie=cookie)[0] == 404
    assert ask(shown, "GET", "/../../etc/passwd", Cookie=cookie)[0] == 404
    assert ask(shown, "POST", "/manifest", b"{}", Cookie=cookie, Origin=own)[0] == 404
    assert ask(shown, "POST", "/ask", b"x" * (LONGEST_QUESTION + 1), Cookie=cookie, Origin=own)[0] == 413


def test_blobs_and_the_page_come_with_a_policy(shown: LocalView) -> None:
    cookie = let_in(shown)
    status, headers, data = ask(shown, "GET", "/blobs/count%20of%20voxels/0", Cookie=cookie)
    assert (status, data) == (200, b"\x01\x02")
    assert headers["X-Content-Type-Options"] == "nosniff"
    status, headers, page = ask(shown, "GET", "/", Cookie=cookie)
    assert "script-src 'self';" in headers["Content-Security-Policy"]
    assert b"<b>" not in page
    assert b"&lt;b&gt;arm" in page
    assert ask(shown, "GET", "/viewer.js", Cookie=cookie)[0] == 200


def test_a_port_in_use_is_named(shown: LocalView) -> None:
    for port in (shown.port, 70_000):
        with pytest.raises(InputError, match=f"port.*{port}"):
            LocalView(Shown(), Answers(), port)


def asked(local: LocalView, cookie: str, question: Mapping[str, Any]) -> dict[str, Any]:
    own = f"http://127.0.0.1:{local.port}"
    _, _, data = ask(local, "POST", "/ask", json.dumps(question).encode(), Cookie=cookie, Origin=own)
    (length,) = struct.unpack("<I", data[:4])
    return json.loads(data[4 : 4 + length])


def test_a_later_question_stops_those_of_its_kind_before(shown: LocalView) -> None:
    cookie, first = let_in(shown), []
    waiting = threading.Thread(target=lambda: first.append(asked(shown, cookie, {"ask": "volume"})))
    waiting.start()
    while not shown.asked["volume"]:
        time.sleep(0.01)
    assert asked(shown, cookie, {"ask": "volume", "soon": True})["answer"] == {"samples": 5}
    waiting.join(5)
    assert first[0]["refused"]["code"] == "replaced"


def test_a_fault_is_answered(shown: LocalView, capsys: pytest.CaptureFixture[str]) -> None:
    assert asked(shown, let_in(shown), {"ask": "fault"})["refused"]["code"] == "internal"
    assert "odd" in capsys.readouterr().err
