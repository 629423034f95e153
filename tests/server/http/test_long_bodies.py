"""Long bodies: counted before they are read, read in a process of their own, few at a time."""

import json

import pytest
from wsrender_server import admission, job_body
from wsrender_server.job_body import LONGEST_HERE, MOST_CONTAINERS, MOST_HELD_OF_OWNER, MOST_VALUES, Places
from wsrender_server.routes import kinetostatic_stream

from tests.server.http.idle_server import DOCUMENT, problem_of
from tests.server.jobs.documents import indices_at

ROWS = [[k / 65536, 0.5, 0.1, 0.2] for k in range(16_384)]
LONG = {"analysis": "indices_at", "robot": {"library": "scara"}, "configurations": ROWS}


@pytest.fixture
def not_here(monkeypatch):
    """Nothing is read in this process."""

    def refuse(*_):
        raise AssertionError("read in the process that answers")

    monkeypatch.setattr(admission, "admit", refuse)


@pytest.fixture(autouse=True)
def nothing_left(settings):
    yield
    assert [*(settings.data_dir / "scratch").glob("*")] == []


def test_a_long_body_is_read_elsewhere_and_gives_the_same_job(client, jobs, not_here):
    headers = {"Idempotency-Key": "k"}
    response = client.post("/v1/jobs", json={"job": LONG, "labels": {"a": "b"}, "priority": -1}, headers=headers)
    job = response.json()
    assert response.status_code == 202 and (job["labels"], job["priority"]) == ({"a": "b"}, -1)
    assert jobs.store.document("local", job["id"]) == indices_at(configurations=ROWS)
    again = client.post("/v1/jobs", json={"job": LONG, "labels": {"a": "b"}, "priority": -1}, headers=headers)
    assert again.status_code == 200 and again.json()["id"] == job["id"]
    assert len([*(jobs.store.files.root / "documents").iterdir()]) == 1


WRONG = [
    {"indices": ["manipulability", "nonsense"]},
    {"robot": {"model": "0" * 64}},
    {"robot": {"mjcf": "<mujoco"}},
    {"priority": 10**6},
    {"indices": [], "labels": {"a\n": "b"}},
]


def test_wrong_long_bodies_are_answered_as_short_ones(client):
    texts = [[json.dumps(LONG | {"configurations": rows} | wrong) for rows in (ROWS[:1], ROWS)] for wrong in WRONG]
    for pair in [*texts, ["[", "[" + "1," * LONGEST_HERE], ["{} {}", "{} " + " " * LONGEST_HERE + "{}"]]:
        headers = {"Content-Type": "application/json"}
        answers = [client.post("/v1/jobs", content=text, headers=headers) for text in pair]
        short, long = (problem_of(answer, answers[0].status_code) for answer in answers)
        for each in (short, long):
            each |= {"request_id": None, "detail": each["detail"].split(" (line")[0], "errors": len(each["errors"])}
        assert short == long


def test_a_long_job_is_planned_for_an_estimate(client):
    answer = client.post("/v1/jobs:validate", json=LONG)
    while answer.status_code == 409 and answer.json()["code"] == "planning":
        answer = client.post("/v1/jobs:validate", json=LONG)
    assert answer.json()["samples"] == len(ROWS), answer.text


@pytest.mark.parametrize(
    ("piece", "count", "what"),
    [(b"[]", MOST_CONTAINERS, "lists"), (b"{}", MOST_CONTAINERS, "lists and objects"), (b"0", MOST_VALUES, "values")],
)
def test_bodies_of_too_many_values_are_refused_unread(piece, count, what, monkeypatch):
    monkeypatch.setattr(job_body, "read_json", None)
    body = b'{"configurations":[' + b",".join([piece] * count) + b"]}"
    with pytest.raises(job_body.HttpProblem, match=f"may hold {count:,} {what}") as refused:
        admission.admit(body, 10**9)
    assert (refused.value.status, refused.value.code) == (413, "too_many_values")


def test_few_long_bodies_are_held_at_a_time(client, not_here, monkeypatch):
    places = Places(1)
    monkeypatch.setattr(client.app.state.parts, "long_bodies", places)
    assert places.take("somebody")
    problem = problem_of(client.post("/v1/jobs", json=LONG), 429, "busy")
    assert problem["retryable"]
    places.give_back("somebody")
    for expected in (202, 200):  # each gives its place back, whatever becomes of it
        problem_of(client.post("/v1/jobs", json=LONG | {"indices": []}), 422)
        assert client.post("/v1/jobs", json=LONG, headers={"Idempotency-Key": "k"}).status_code == expected
    assert not places.taken


def test_no_owner_has_all_places_of_long_bodies(client, not_here, monkeypatch):
    places = Places()
    monkeypatch.setattr(client.app.state.parts, "long_bodies", places)
    while places.take("ann"):
        pass
    assert client.post("/v1/jobs", json=LONG).status_code == 202
    while places.take("local"):
        pass
    problem_of(client.post("/v1/jobs", json=LONG), 429, "busy")
    places.give_back("local")
    assert client.post("/v1/jobs", json=LONG).status_code == 202 and places.taken["ann"] == MOST_HELD_OF_OWNER


def test_few_uploads_are_held_at_a_time(client, monkeypatch):
    """A place is given back with the answer, whatever it is; short ones need none, nor do submissions."""
    places = Places(1)
    monkeypatch.setattr(client.app.state.parts, "uploads", places)
    headers = {"Content-Type": "text/csv"}
    long = b"1,2,3\n" * LONGEST_HERE
    for content, kind, status in ((long, headers, 201), (long, {"Content-Type": "application/zip"}, 409)):
        assert client.post("/v1/models", content=content, headers=kind).status_code == status
    assert not places.taken and places.take("somebody")
    assert problem_of(client.post("/v1/models", content=long, headers=headers), 429, "busy")["retryable"]
    assert client.post("/v1/models", content=b"1,2,3\n", headers=headers).status_code == 201
    assert client.post("/v1/jobs", json=LONG).status_code == 202


def test_short_bodies_need_no_place(client, monkeypatch):
    monkeypatch.setattr(client.app.state.parts, "long_bodies", Places(0))
    assert client.post("/v1/jobs", json=DOCUMENT).status_code == 202


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ('{"type": "nothing"}' + " " * LONGEST_HERE, "invalid_document"),
        ('{"robot": [' + "[]," * MOST_CONTAINERS + "[]]}", "too_many_values"),
    ],
)
def test_the_first_message_of_a_live_stream_is_read_as_bodies_are(client, settings, monkeypatch, text, code):
    monkeypatch.setattr(settings, "max_body_bytes", 2**24)
    monkeypatch.setattr(kinetostatic_stream, "read_json", None)  # not here
    with client.websocket_connect("/v1/kinetostatic-stream", headers={"Host": "localhost"}) as socket:
        socket.send_text(text)
        assert socket.receive_json()["code"] == code
