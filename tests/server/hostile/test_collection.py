"""The hostile collection itself: as large as it must be, and not blind. `tests/long.py hostile` runs it."""

import json
from types import SimpleNamespace

import pytest

from tests.server.hostile import cases
from tests.server.hostile.cases import Case
from tests.server.hostile.collection import DIVIDED, MIB, MOST_ANSWERED, TOKEN, Attack, Server, of_kind, violations

SERVER = SimpleNamespace(secret="/secret.xml", private={"job": "0" * 32, "model": "0" * 64})
CASE = Case("a", b"{}", "#/robot")


def problem(status=422, code="invalid_document", pointer="#/robot/mjcf", detail="wrong"):
    errors = [{"pointer": pointer, "detail": detail}]
    return json.dumps({"status": status, "code": code, "detail": detail, "errors": errors}).encode()


def faults(status=422, media="application/problem+json", answer=None, case=CASE):
    return list(Server._wrong(SERVER, case, status, media, problem(status) if answer is None else answer))  # type: ignore


def test_there_are_so_many_cases_each_by_a_name():
    found = [case for kind in DIVIDED for case in of_kind(kind, SERVER)]  # type: ignore[arg-type]
    assert len(found) >= 500 and len({case.name for case in found}) == len(found)
    assert sum(case.pointer is not None for case in found) > 250


def test_an_answer_as_it_must_be_is_no_fault():
    assert faults() == []
    assert faults(409, answer=problem(409, "too_slow", "#")) == []
    assert faults(200, "application/json", b"{}", Case("a", allowed=cases.HARMLESS)) == []


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        ({"status": 200, "answer": b"{}"}, "answered with 200"),
        ({"status": 500, "answer": problem(500)}, "answered with 500"),
        ({"answer": problem(detail=TOKEN)}, "it shows what it must not"),
        ({"answer": problem(detail="root:x:0:0:root")}, "it shows what it must not"),
        ({"answer": problem(detail="solid private")}, "it shows what it must not"),
        ({"answer": problem(detail="x" * MOST_ANSWERED)}, "an answer of"),
        ({"media": "text/html"}, "no problem document but text/html"),
        ({"answer": problem(400)}, "an odd problem"),
        ({"answer": problem(detail="Traceback (most recent call last)")}, "an odd problem"),
        ({"answer": problem(code="crashed")}, "a process crashed"),
        ({"answer": problem(pointer="#/sampling")}, "does not name #/robot"),
    ],
)
def test_what_is_wrong_with_an_answer_is_noticed(answer, said):
    assert any(said in fault for fault in faults(**answer)), faults(**answer)


def test_memory_and_faults_are_violations():
    assert violations({"a": Attack(3)}) == []
    worse = {"a": Attack(grown_mib=500), "b": Attack(held_mib=2000), "c": Attack(faults=["c: bad"])}
    assert violations(worse) == ["c: bad", "a: the server grew by 500 MiB", "b: a process held 2000 MiB"]
    assert MIB == 2**20
