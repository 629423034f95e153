"""Webhooks over HTTP: made, looked at, tested and deleted by their owners; what is wrong is a problem that names it."""

import pytest
from fastapi.testclient import TestClient
from standardwebhooks import Webhook as Verifier
from wsrender_server.app import create_app
from wsrender_server.jobs.webhooks.deliveries import Deliveries
from wsrender_server.settings import Settings

from tests.server.http.idle_server import DOCUMENT, problem_of
from tests.server.jobs.receiver import receiver
from tests.server.jobs.waiting import wait_until

URL = "https://hooks.example.org/wsrender"


@pytest.fixture
def settings(settings):
    return settings.model_copy(update={"webhook_targets": ("https://hooks.example.org", "https://127.0.0.1")})


def test_a_webhook_is_made_looked_at_and_deleted(client):
    answer = client.post("/v1/webhooks", json={"url": URL})
    made = answer.json()
    assert answer.status_code == 201 and answer.headers["cache-control"] == "no-store"
    secret = made.pop("secret")
    assert Verifier(secret) and made["states"] == ["succeeded", "failed", "canceled", "timed_out", "expired"]
    assert client.get("/v1/webhooks").json()["items"] == [made]
    shown = client.get(f"/v1/webhooks/{made['id']}")
    assert shown.json() == made and secret not in shown.text
    assert (made["waiting"], made["delivered"], made["given_up"], made["last_error"]) == (0, 0, 0, None)
    tested = client.post(f"/v1/webhooks/{made['id']}:test")
    assert tested.status_code == 202 and tested.json()["message"].startswith("msg_")
    assert client.get(f"/v1/webhooks/{made['id']}").json()["waiting"] == 1
    assert client.delete(f"/v1/webhooks/{made['id']}").status_code == 204
    assert client.get("/v1/webhooks").json()["items"] == []
    for method, path in (("GET", ""), ("DELETE", ""), ("POST", ":test")):
        problem_of(client.request(method, f"/v1/webhooks/{made['id']}{path}"), 404, "webhook_not_found")
        problem_of(client.request(method, f"/v1/webhooks/odd{path}"), 404, "webhook_not_found")


@pytest.mark.parametrize(
    ("body", "field", "said"),
    [
        ({}, "#/url", "required"),
        ({"url": 5}, "#/url", "string"),
        ({"url": "https://hooks.example.org/" + "x" * 2048}, "#/url", "2048"),
        ({"url": "hooks.example.org"}, "#/url", "should match pattern"),
        ({"url": "ftp://hooks.example.org"}, "#/url", "should match pattern"),
        ({"url": "https://hooks.example.org/#a"}, "#/url", "should match pattern"),
        ({"url": "https://hooks.example.org/ a"}, "#/url", "should match pattern"),
        ({"url": URL, "states": []}, "#/states", "at least 1"),
        ({"url": URL, "states": ["done"]}, "#/states/0", "'succeeded'"),
        ({"url": URL, "states": "failed"}, "#/states", "list"),
        ({"url": URL, "secret": "whsec_mine"}, "#/secret", "not permitted"),
    ],
)
def test_a_malformed_webhook_is_a_problem_that_names_the_field(client, body, field, said):
    (error,) = problem_of(client.post("/v1/webhooks", json=body), 422)["errors"]
    assert error["pointer"] == field and said in error["detail"]
    assert client.get("/v1/webhooks").json()["items"] == []


@pytest.mark.parametrize(
    ("url", "said"),
    [
        ("http://hooks.example.org", "WSRENDER_WEBHOOK_TARGETS names, which is https://hooks"),
        ("https://127.0.0.1", "not public"),
        ("https://[::1", "must be a URL"),
        ("https://ann@hooks.example.org", "neither a user"),
    ],
)
def test_where_the_server_sends_nothing_is_a_problem_that_says_so(client, url, said):
    (error,) = problem_of(client.post("/v1/webhooks", json={"url": url}), 409, "target_not_allowed")["errors"]
    assert error["pointer"] == "#/url" and said in error["detail"]
    assert client.get("/v1/webhooks").json()["items"] == []


def test_what_is_no_json_and_too_many_are_problems(client):
    text = {"Content-Type": "application/json"}
    problem_of(client.post("/v1/webhooks", content="{", headers=text), 400, "malformed_json")
    problem_of(client.get("/v1/webhooks?limit=5"), 422, "invalid_request")
    for _ in range(8):
        assert client.post("/v1/webhooks", json={"url": URL}).status_code == 201
    problem_of(client.post("/v1/webhooks", json={"url": URL}), 409, "quota_exceeded")


def test_owners_see_only_their_own_webhooks(settings, jobs):
    names = {"ann": ("read", "submit"), "bob": ("read", "submit"), "eve": ("read",)}
    ann, bob, eve = (
        {"Authorization": f"Bearer {jobs.store.create_key(name, scopes)[1]}"} for name, scopes in names.items()
    )
    with TestClient(create_app(settings, jobs), base_url="http://lab:8000") as client:
        path = f"/v1/webhooks/{client.post('/v1/webhooks', json={'url': URL}, headers=ann).json()['id']}"
        assert client.get(path, headers=ann).status_code == 200
        assert client.get("/v1/webhooks", headers=bob).json()["items"] == []
        for method, at in (("GET", path), ("POST", f"{path}:test"), ("DELETE", path)):
            problem_of(client.request(method, at, headers=bob), 404, "webhook_not_found")
            problem_of(client.request(method, at), 401)
        for method, at in (("POST", "/v1/webhooks"), ("POST", f"{path}:test"), ("DELETE", path)):
            problem_of(client.request(method, at, json={"url": URL}, headers=eve), 403, "insufficient_scope")
        client.post("/v1/jobs", json=DOCUMENT, headers=bob)
        assert client.get(path, headers=ann).json()["waiting"] == 0


def test_jobs_are_told_and_counted(client, jobs, settings, result_folder):
    answers = iter([500])
    with receiver(lambda: next(answers, 200)) as here:
        allowed = {"webhook_targets": here.url, "webhook_networks": "127.0.0.1", "webhook_retry_s": 0.05}
        settings = Settings(data_dir=settings.data_dir, min_free_disk_bytes=0, **allowed)
        with TestClient(create_app(settings, jobs), base_url="http://127.0.0.1") as allowing:
            made = allowing.post("/v1/webhooks", json={"url": here.url, "states": ["queued", "succeeded"]}).json()
        job = client.post("/v1/jobs", json=DOCUMENT).json()
        jobs.complete(job["id"], result_folder)
        assert "wsrender_webhook_deliveries_waiting 2.0" in client.get("/metrics").text
        with Deliveries(jobs.store, settings).running():
            wait_until(lambda: client.get(f"/v1/webhooks/{made['id']}").json()["delivered"] == 2)
        bodies = [Verifier(made["secret"]).verify(body, headers) for headers, body in here.got]
    assert {body["type"] for body in bodies} == {"job.queued", "job.succeeded"} and len(bodies) == 3
    assert {body["data"]["id"] for body in bodies} == {job["id"]}
    text = client.get("/metrics").text
    for line in ('{outcome="delivered"} 2.0', '{outcome="failed"} 1.0', '{outcome="given_up"} 0.0', "_waiting 0.0"):
        assert any(each.startswith("wsrender_webhook") and each.endswith(line) for each in text.splitlines()), line
    shown = client.get(f"/v1/webhooks/{made['id']}").json()
    assert shown["last_error"] == "the receiver answered 500" and shown["last_delivered_at"] and shown["waiting"] == 0
