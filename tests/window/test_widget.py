"""What a notebook's view answers to the page."""

from collections.abc import Mapping
from typing import Any

import pytest

from wsrender.errors import InputError
from wsrender.window.widget import reply


class Shown:
    manifest: Mapping[str, Any] = {"title": "arm"}
    blobs: Mapping[str, bytes] = {"volume0/count": b"\x01\x02"}


class Answers:
    def answer(self, request: Mapping[str, Any]) -> tuple[dict[str, Any], Mapping[str, bytes]]:
        if request.get("ask") == "fault":
            raise RuntimeError("odd")
        if request != {"ask": "voxel", "cell": [0, 1, 2]}:
            raise InputError("cell", "must be three whole numbers")
        return {"count": 3}, {"a": b"xyz"}


def test_messages_are_answered_by_their_ids() -> None:
    def answered(**content: Any) -> tuple[dict[str, Any], Mapping[str, bytes]]:
        return reply(Shown(), Answers(), {"id": "7:1", **content})

    assert answered(ask="manifest") == ({"id": "7:1", "answer": {"title": "arm"}}, {})
    assert answered(ask="blob", name="volume0/count") == ({"id": "7:1", "answer": {}}, {"volume0/count": b"\x01\x02"})
    assert answered(ask="voxel", cell=[0, 1, 2]) == ({"id": "7:1", "answer": {"count": 3}}, {"a": b"xyz"})


def test_what_is_wrong_is_said_with_its_field() -> None:
    for content, field in (({"ask": "blob", "name": "../x"}, "name"), ({"ask": "voxel"}, "cell"), ({}, "cell")):
        header, blobs = reply(Shown(), Answers(), {"id": 3, **content})
        assert header["id"] == 3
        assert header["refused"]["field"] == field
        assert not blobs


def test_a_fault_is_answered(capsys: pytest.CaptureFixture[str]) -> None:
    header, _ = reply(Shown(), Answers(), {"id": 3, "ask": "fault"})
    assert (header["id"], header["refused"]["code"]) == (3, "internal")
    assert "odd" in capsys.readouterr().err
