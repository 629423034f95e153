"""Keys, scopes, owners, and what listens where."""

import asyncio
import base64
import json
import time

import httpx2
import pytest
from fastapi.testclient import TestClient
from wsrender_server.app import create_app
from wsrender_server.auth import LOOK_AGAIN_S, check_binding, read_key_file
from wsrender_server.jobs.faults import StoreUnavailable
from wsrender_server.openapi import openapi_document

from tests.server.http.idle_server import DOCUMENT, HOST, problem_of
from wsrender.errors import InputError

PUBLIC = ("/healthz", "/readyz", "/v1/version", "/openapi.json", "/docs", "/docs/files/swagger-ui-bundle.js")
PRIVATE = ("/v1/jobs", "/v1/analyses", "/v1/robots", "/v1/queue", "/v1/workers", "/metrics")


@pytest.fixture
def keys(jobs):
    """Secrets by name."""
    names = {"ann": ("read", "submit"), "bob": ("read", "submit"), "eve": ("read",), "root": ("admin",)}
    names["urgent"] = ("priority",)
    return {name: jobs.store.create_key(name, scopes)[1] for name, scopes in names.items()}


@pytest.fixture
def keyed(keys, settings, jobs):
    """A server that asks for keys."""
    with TestClient(create_app(settings, jobs), base_url="http://lab:8000") as client:
        yield client


def bearer(secret):
    return {"Authorization": f"Bearer {secret}"}


def test_without_a_key_nothing_private(keyed, keys):
    for path in PRIVATE:
        for headers in ({}, bearer("wrong"), bearer(""), {"Authorization": "Basic YTpi"}, bearer("é" * 40)):
            response = keyed.get(path, headers={name: value.encode() for name, value in headers.items()})
            problem_of(response, 401, "unauthorized")
            scheme = "Basic" if headers.get("Authorization", "").startswith("Basic") else "Bearer"
            assert response.headers["www-authenticate"].startswith(scheme)
        assert keyed.get(path, headers=bearer(keys["eve"])).status_code == 200
    for path in PUBLIC:
        assert keyed.get(path).status_code == 200


def test_scopes(keyed, keys):
    problem_of(keyed.post("/v1/jobs", json=DOCUMENT, headers=bearer(keys["eve"])), 403, "insufficient_scope")
    model = {"Content-Type": "application/xml"}
    refused = keyed.post("/v1/models", content="<mujoco/>", headers=model | bearer(keys["eve"]))
    problem_of(refused, 403, "insufficient_scope")
    assert keyed.post("/v1/jobs", json=DOCUMENT, headers=bearer(keys["root"])).status_code == 202


def test_going_before_others_is_a_scope(keyed, keys):
    for name, priority, status in (
        ("ann", 1, 403), ("ann", 0, 202), ("ann", -1000, 202), ("urgent", 1000, 202), ("root", 1, 202),
    ):  # fmt: skip
        for path in ("/v1/jobs", "/v1/jobs:validate"):
            document = DOCUMENT | {"priority": priority, "voxel_size_m": 0.1 + priority / 1e5}
            answer = keyed.post(path, json=document, headers=bearer(keys[name]))
            if status == 403:
                (error,) = problem_of(answer, 403, "insufficient_scope")["errors"]
                assert error["pointer"] == "#/priority" and "0 is the highest" in error["detail"]
            elif path == "/v1/jobs":
                assert answer.status_code == status and answer.json()["priority"] == priority


def test_ids_that_are_none_are_those_of_nothing(keyed, keys):
    root = bearer(keys["root"])
    for odd in ("x", "0" * 31, "0" * 33, "A" * 32, "%00" * 32, "0" * 32 + "%0A", "é"):
        for method, path, code in (
            ("GET", f"/v1/jobs/{odd}", "job_not_found"), ("DELETE", f"/v1/jobs/{odd}", "job_not_found"),
            ("POST", f"/v1/jobs/{odd}:cancel", "job_not_found"), ("GET", f"/v1/jobs/{odd}/events", "job_not_found"),
            ("GET", f"/v1/jobs/{odd}/result", "job_not_found"), ("GET", f"/v1/models/{odd}", "model_not_found"),
            ("POST", f"/v1/keys/{odd}:revoke", "key_not_found"),
        ):  # fmt: skip
            problem_of(keyed.request(method, path, headers=root), 404, code)
            problem_of(keyed.request(method, path), 401)


def test_a_revoked_key_is_refused_at_once(keyed, keys, jobs):
    assert keyed.get("/v1/jobs", headers=bearer(keys["eve"])).status_code == 200
    (key,) = [key for key in jobs.store.list_keys() if key.name == "eve"]
    jobs.store.revoke_key(key.id)
    problem_of(keyed.get("/v1/jobs", headers=bearer(keys["eve"])), 401, "unauthorized")


def test_the_first_key_guards_a_running_server(client, jobs):
    assert client.get("/v1/jobs").status_code == 200
    assert {} in client.get("/openapi.json").json()["paths"]["/v1/jobs"]["get"]["security"]
    key, secret = jobs.store.create_key("ann")
    time.sleep(LOOK_AGAIN_S)
    problem_of(client.get("/v1/jobs"), 401, "unauthorized")
    assert client.get("/v1/jobs", headers=bearer(secret)).status_code == 200
    assert {} not in client.get("/openapi.json").json()["paths"]["/v1/jobs"]["get"]["security"]
    jobs.store.revoke_key(key.id)
    time.sleep(LOOK_AGAIN_S)
    problem_of(client.get("/v1/jobs"), 401, "unauthorized")


def test_without_keys_the_database_is_not_asked_for_one_each_time(client, jobs, monkeypatch):
    asked = []
    monkeypatch.setattr(jobs.store, "has_key", lambda: bool(asked.append(1)))
    started = time.monotonic()
    for _ in range(50):
        assert client.get("/v1/robots").status_code == 200
    assert len(asked) <= 1 + (time.monotonic() - started) / LOOK_AGAIN_S


def test_without_keys_a_crowd_waits_for_one_look(client, jobs, monkeypatch):
    """Each in a thread of its own kept submissions that came at once from being answered; a fault is everyone's."""
    asked, faults = [], [StoreUnavailable("the database is locked")]

    def has_key():
        asked.append(1)
        time.sleep(0.5)  # all come meanwhile
        if faults:
            raise faults.pop()
        return False

    monkeypatch.setattr(jobs.store, "has_key", has_key)

    async def crowd():
        transport = httpx2.ASGITransport(client.app)
        async with httpx2.AsyncClient(transport=transport, base_url=HOST) as http:
            return [each.status_code for each in await asyncio.gather(*(http.get("/v1/jobs") for _ in range(50)))]

    for status in (503, 200):
        time.sleep(LOOK_AGAIN_S)
        asked.clear()
        assert client.portal.call(crowd) == [status] * 50 and asked == [1]


def test_an_administrator_manages_keys(keyed, keys):
    root = bearer(keys["root"])
    made = keyed.post("/v1/keys", json={"name": "dan", "scopes": ["read"]}, headers=root)
    assert made.status_code == 201 and made.headers["cache-control"] == "no-store"
    dan = bearer(made.json()["secret"])
    assert keyed.get("/v1/jobs", headers=dan).status_code == 200
    problem_of(keyed.post("/v1/jobs", json=DOCUMENT, headers=dan), 403, "insufficient_scope")
    listed = keyed.get("/v1/keys", headers=root)
    assert [key["name"] for key in listed.json()["items"]] == ["ann", "bob", "eve", "root", "urgent", "dan"]
    assert not any(secret in listed.text for secret in keys.values()) and "hash" not in listed.text
    path = f"/v1/keys/{made.json()['id']}:revoke"
    assert keyed.post(path, headers=root).json()["revoked_at"]
    problem_of(keyed.get("/v1/jobs", headers=dan), 401, "unauthorized")
    problem_of(keyed.post(f"/v1/keys/{'0' * 16}:revoke", headers=root), 404, "key_not_found")
    for body in ({"name": ""}, {"name": "a\x00"}, {"name": "a", "scopes": []}, {"name": "a", "scopes": ["all"]}, {}):
        problem_of(keyed.post("/v1/keys", json=body, headers=root), 422, "invalid_request")
    text = {**root, "Content-Type": "application/json"}
    assert problem_of(keyed.post("/v1/keys", content="{", headers=text), 400, "malformed_json")["errors"]


def test_nobody_else_manages_keys(keyed, keys):
    requests = (("GET", "/v1/keys"), ("POST", "/v1/keys"), ("POST", f"/v1/keys/{'0' * 16}:revoke"))
    for method, path in requests:
        problem_of(keyed.request(method, path, json={"name": "x"}, headers=bearer(keys["ann"])), 403)
        problem_of(keyed.request(method, path, json={"name": "x"}), 401)


def test_without_keys_the_first_is_made_by_the_command_line(client):
    problem_of(client.post("/v1/keys", json={"name": "x"}), 403, "insufficient_scope")


def test_owners_see_only_their_own(keyed, keys, jobs, result_folder):
    ann, bob = bearer(keys["ann"]), bearer(keys["bob"])
    key = {"Idempotency-Key": "same"}
    mine = keyed.post("/v1/jobs", json=DOCUMENT, headers=ann | key).json()
    jobs.complete(mine["id"], result_folder)
    theirs = keyed.post("/v1/jobs", json=DOCUMENT, headers=bob | key)
    assert theirs.status_code == 202 and theirs.json()["id"] != mine["id"]
    path = f"/v1/jobs/{mine['id']}"
    unknown = keyed.get(f"/v1/jobs/{'0' * 32}", headers=bob).json()
    for method, rest in (
        ("GET", ""), ("DELETE", ""), ("POST", ":cancel"), ("POST", ":retry"), ("GET", "/events"), ("GET", "/result"),
        ("GET", "/artifacts"), ("GET", "/artifacts/result.json"), ("GET", "/volume/slice"), ("GET", "/plots/robot"),
    ):  # fmt: skip
        problem = problem_of(keyed.request(method, path + rest, headers=bob), 404, "job_not_found")
        assert problem["detail"] == unknown["detail"]
    assert [job["id"] for job in keyed.get("/v1/jobs", headers=bob).json()["items"]] == [theirs.json()["id"]]
    assert keyed.get(path + "/result", headers=ann).status_code == 200


def test_models_belong_to_their_owner(keyed, keys):
    ann, bob = bearer(keys["ann"]), bearer(keys["bob"])
    model = keyed.post("/v1/models", content="<mujoco/>", headers=ann | {"Content-Type": "application/xml"}).json()
    assert keyed.get(model["href"], headers=ann).text == "<mujoco/>"
    problem_of(keyed.get(model["href"], headers=bob), 404, "model_not_found")
    job = DOCUMENT | {"robot": {"model": model["sha256"]}}
    problem_of(keyed.post("/v1/jobs", json=job, headers=bob), 404, "model_not_found")
    assert keyed.post("/v1/jobs", json=job, headers=ann).status_code == 202


def test_arrays_belong_to_their_owner_and_stay_while_a_job_needs_them(keyed, keys):
    """By whatever field they are named; a job of what was deleted is refused as one of what never was there."""
    ann, bob = bearer(keys["ann"]), bearer(keys["bob"])
    points = {"analysis": "collaborative_volume", "right": {"points": [[0, 0, 0]]}, "seeds": 1}
    mapping = {"analysis": "master_slave_mapping", "master": {"points": [[0, 0, 0]]}}
    rows = {"analysis": "indices_at", "robot": "scara"}
    for field, document in (("left", points), ("slave", mapping), ("configurations", rows)):
        kind = {"Content-Type": "application/x-npy"}
        model = keyed.post("/v1/models", content=f"{field}".encode(), headers=ann | kind).json()
        body = document | {field: {"model": model["sha256"]}}
        for way in ("/v1/jobs", "/v1/jobs:validate"):
            problem = problem_of(keyed.post(way, json=body, headers=bob), 404, "model_not_found")
            assert problem["errors"][0]["pointer"] == f"#/{field}/model"
        job = keyed.post("/v1/jobs", json=body, headers=ann)
        assert job.status_code == 202, job.text
        assert "unfinished job" in problem_of(keyed.delete(model["href"], headers=ann), 409)["detail"]
        keyed.post(f"/v1/jobs/{job.json()['id']}:cancel", headers=ann)
        assert keyed.delete(model["href"], headers=ann).status_code == 204
        problem_of(keyed.post("/v1/jobs", json=body, headers=ann), 404, "model_not_found")
        local = keyed.post("/v1/jobs", json=document | {field: {"path": "/etc/passwd.npy"}}, headers=ann)
        (error,) = problem_of(local, 422, "invalid_document")["errors"]
        assert error["pointer"] == f"#/{field}/path" and "is for local runs only" in error["detail"]


def test_openapi_names_keys_whether_or_not_the_server_asks(client):
    must, may = (openapi_document(client.app, needed) for needed in (True, False))
    assert must["components"] == may["components"] and must["components"]["securitySchemes"]
    assert "/v1/keys" in must["paths"] and must["paths"].keys() == may["paths"].keys()
    needed, allowed = (each["paths"]["/v1/jobs"]["post"]["security"] for each in (must, may))
    assert {} not in needed and allowed == [*needed, {}]
    assert "security" not in must["paths"]["/healthz"]["get"]
    assert client.get("/openapi.json").json() == json.loads(json.dumps(may))


def test_a_key_is_a_password_too(keyed, keys):
    """For programs that know names and passwords only; the name does not matter."""
    for name in ("", "ann"):
        assert keyed.get("/v1/jobs", auth=(name, keys["ann"])).status_code == 200
    for name, password in ((keys["ann"], ""), ("ann", "wrong"), ("ann", keys["ann"] + "\n")):
        refused = keyed.get("/v1/jobs", auth=(name, password))
        problem_of(refused, 401, "unauthorized")
        assert refused.headers["WWW-Authenticate"].startswith("Basic")
    for header in ("Basic", "Basic =", "Basic " + base64.b64encode(b"no colon").decode(), "Basic \xff"):
        problem_of(keyed.get("/v1/jobs", headers={"Authorization": header.encode("latin-1")}), 401, "unauthorized")
    asked = keyed.get("/v1/jobs").headers["WWW-Authenticate"]
    assert asked == "Bearer"  # a browser would ask people for a password


WRONG_HOSTS = ("evil.example", "127.0.0.1.evil.example", "192.168.1.2", "localhost.evil.example")


def test_without_keys_only_this_machine_by_name(client):
    for host in (*WRONG_HOSTS, "evil.example:", "evil.example:80:80", "evil.example@localhost", "[abc", "localhost/x"):
        problem_of(client.get("/v1/jobs", headers={"Host": host}), 403, "wrong_host")
    for host in ("localhost:8000", "127.0.0.1:1", "[::1]:8000", "127.9.9.9"):
        assert client.get("/v1/jobs", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.2", "lab", "", "127.0.0.1.nip.io"])
def test_other_addresses_need_a_key(host, settings, jobs, tmp_path):
    check_binding(host, has_keys=True)
    with pytest.raises(InputError, match="no API key"):
        check_binding(host, has_keys=False)
    with pytest.raises(InputError, match="host"):
        create_app(settings.model_copy(update={"host": host}), jobs)


@pytest.mark.parametrize("host", ["127.0.0.1", "127.0.0.2", "::1", "localhost", "LOCALHOST"])
def test_loopback_needs_none(host):
    check_binding(host, has_keys=False)


def test_a_key_file(settings, jobs, tmp_path):
    path = tmp_path / "keys"
    path.write_text(
        "# keys of the lab\nfirst-secret-123456 ann submit\nsecond-secret-12345 ann\nthird-secret-123456 eve read\n\n"
    )
    app = create_app(settings.model_copy(update={"api_key_file": path, "host": "0.0.0.0"}), jobs)
    with TestClient(app, base_url=HOST) as client:
        problem_of(client.get("/v1/jobs"), 401)
        job = client.post("/v1/jobs", json=DOCUMENT, headers=bearer("first-secret-123456")).json()
        assert client.get(job["links"]["self"], headers=bearer("second-secret-12345")).status_code == 200
        problem_of(client.get(job["links"]["self"], headers=bearer("third-secret-123456")), 404)


@pytest.mark.parametrize("text", ["", "# nothing\n", "short\n", "long-enough-secret ann everything\n", "a b c d\n"])
def test_wrong_key_files(text, tmp_path):
    path = tmp_path / "keys"
    path.write_text(text)
    with pytest.raises(InputError, match="api_key_file"):
        read_key_file(path)
    with pytest.raises(InputError, match="cannot be read"):
        read_key_file(tmp_path / "missing")
