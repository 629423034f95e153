"""What is said where the other side is another version, no wsrender, or gone: a message of wsrender's own, always."""

import httpx2
import pytest

import wsrender as ws
from tests.server.client.recorded_server import refuses, says
from tests.server.client.test_requests import DOCUMENT, JOB

PAGE = {"Content-Type": "text/html; charset=utf-8"}, b"<html><title>Router</title></html>"
HTML = (200, *PAGE)
OLDER = "0.3.0"


@pytest.mark.parametrize(
    ("method", "path", "call"),
    [
        ("GET", "/v1/jobs/j1", lambda client: client.job("j1")),
        ("GET", "/v1/jobs", lambda client: list(client.jobs())),
        ("GET", "/v1/robots", lambda client: client.robots()),
        ("POST", "/v1/jobs", lambda client: client.submit(DOCUMENT)),
        ("POST", "/v1/jobs:validate", lambda client: client.estimate(DOCUMENT)),
        ("POST", "/v1/models", lambda client: client.upload_model(b"<mujoco/>")),
    ],
)
@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (HTML, "answers with text/html at {path}, which this client .* does not know"),
        ((200, {}, b""), "answers with nothing at {path}"),
        (says([1, 2]), "answers with application/json at {path}"),
        ((302, {"Location": "/login"}, b""), "answers 302 Found with no text"),
        ((404, *PAGE), "http://lab:8000 answers 404 Not Found with text/html; that is a proxy, or another server"),
        ((403, *PAGE), "http://lab:8000 answers 403 Forbidden with text/html"),
    ],
)  # fmt: skip
def test_what_is_no_wsrender_is_named(method, path, call, answer, message, server, client):
    server.answer(method, path, answer)
    with pytest.raises(ws.ServerError, match=message.format(path=path)):
        call(client)


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (
            says({**JOB, "state": "sleeping", "version": "9.1.0"}),
            r"wsrender 9\.1\.0\) answers with a job in .* 'sleeping'",
        ),
        (says({"state": "queued"}), "a job in the state 'queued' without an id"),
        (says({"id": "j1"}), "a job in the state None"),
    ],
)
def test_a_job_that_is_none_here_says_both_versions(answer, message, server, client):
    server.answer("GET", "/v1/jobs/j1", answer)
    with pytest.raises(ws.ServerError, match=message) as caught:
        client.job("j1")
    assert f"this client (wsrender {ws.__version__})" in str(caught.value)


@pytest.mark.parametrize(
    ("path", "call"),
    [
        ("/v1/jobs", lambda client: list(client.jobs())),
        ("/v1/robots", lambda client: client.robots()),
        ("/v1/models", lambda client: client.upload_model(b"<mujoco/>")),
        ("/v1/jobs:validate", lambda client: client.estimate(DOCUMENT)),
    ],
)
def test_a_member_that_is_missing_is_named(path, call, server, client):
    for method in ("GET", "POST"):
        server.answer(method, path, says({"more": 1}))
    with pytest.raises(ws.ServerError, match=rf"no '\w+' at {path}"):
        call(client)


def test_a_result_of_a_later_format_is_refused(server, client):
    server.answer("GET", "/v1/jobs/j1", says({**JOB, "state": "succeeded"}))
    server.answer("GET", "/v1/jobs/j1/result", says({"format": 99}))
    with pytest.raises(ws.InputError, match="format: "):
        client.job("j1").result()


@pytest.mark.parametrize("answer", [HTML, (200, {}, b""), says([1, 2])])
def test_a_result_that_is_none_is_named(answer, server, client):
    server.answer("GET", "/v1/jobs/j1", says({**JOB, "state": "succeeded"}))
    server.answer("GET", "/v1/jobs/j1/result", answer)
    with pytest.raises(ws.ServerError, match="answers with no JSON object at /v1/jobs/j1/result, which this client"):
        client.job("j1").result()


def test_an_older_server_that_does_not_know_a_field_says_so(server, client):
    unknown = refuses(422, "invalid_document", errors=[{"pointer": "#/refined_volume", "detail": "is unknown"}])
    server.answer("POST", "/v1/jobs", unknown)
    server.answer("GET", "/v1/version", says({"wsrender": OLDER}))
    with pytest.raises(ws.DocumentError, match="refined_volume: is unknown") as caught:
        client.submit(DOCUMENT)
    (note,) = caught.value.__notes__
    assert f"the server has wsrender {OLDER}, this client {ws.__version__}" in note


@pytest.mark.parametrize("version", [says({"wsrender": ws.__version__}), HTML, httpx2.ReadError("reset"), says([])])
def test_of_the_same_or_no_version_nothing_is_said(version, server, client):
    server.answer("POST", "/v1/jobs", refuses(422, "invalid_document", errors=[{"pointer": "#/a", "detail": "is bad"}]))
    server.answer("GET", "/v1/version", version)
    with pytest.raises(ws.DocumentError, match="a: is bad") as caught:
        client.submit(DOCUMENT)
    assert not hasattr(caught.value, "__notes__")


def test_a_proxy_without_its_server_is_waited_for_and_named(server, client, clock):
    server.answer("GET", "/v1/robots", (502, *PAGE))
    with pytest.raises(ws.ServerError, match="http://lab:8000 answers 502 Bad Gateway with text/html") as caught:
        client.robots()
    assert caught.value.status == 502 and 50 < sum(clock.pauses) <= 60


def test_a_page_instead_of_events_ends_them(server, client, clock):
    server.answer("GET", "/v1/jobs/j1", says(JOB))
    server.answer("GET", "/v1/jobs/j1/events", HTML)
    job = client.job("j1")
    with pytest.raises(ws.ServerError, match="text/html instead of events"):
        list(job.events())
    assert clock.pauses == []


def test_a_body_that_is_not_what_it_says_is_no_stack_trace(server, client):
    server.answer("GET", "/v1/robots", (200, {"Content-Encoding": "gzip"}, b"no gzip"))
    with pytest.raises(ws.ServerError, match="http://lab:8000: GET /v1/robots: "):
        client.robots()


def test_a_closed_client_says_so(server, client):
    server.answer("GET", "/v1/jobs/j1", says(JOB))
    job = client.job("j1")
    client.close()
    for call in (client.robots, job.refresh, job.wait, lambda: list(job.events()), lambda: client.submit(DOCUMENT)):
        with pytest.raises(ws.ServerConnectionError, match="the client of http://lab:8000 is closed"):
            call()


@pytest.mark.parametrize("kind", [ws.Client, ws.AsyncClient])
@pytest.mark.parametrize("url", ["http://lab:port", "http://", "http://\n"])
def test_an_address_that_is_none_is_named(kind, url):
    with pytest.raises(ws.InputError, match="url: "):
        kind(url)
