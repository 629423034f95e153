"""Problem documents of all kinds of bad requests keep to the schema of problems."""

import pytest

from tests.server.http.answers import broken, validator_of
from tests.server.http.idle_server import DOCUMENT, problem_of

JSON = {"Content-Type": "application/json"}
NONE = "0" * 32
# Method, path as /openapi.json has it, what fills it in, status, and what is sent.
REQUESTS = [
    ("post", "/v1/jobs", {}, 400, {"content": "{", "headers": JSON}),
    ("post", "/v1/jobs", {}, 415, {"content": "a", "headers": {"Content-Type": "text/plain"}}),
    ("post", "/v1/jobs", {}, 413, {"content": "[" * 2_000_001, "headers": JSON}),
    ("post", "/v1/jobs", {}, 422, {"json": {}}),
    ("post", "/v1/jobs", {}, 422, {"json": DOCUMENT | {"robot": "ur5ee"}}),
    ("post", "/v1/jobs", {}, 422, {"json": DOCUMENT | {"colour": 1, "indices": ["nope"]}}),
    ("post", "/v1/jobs", {}, 422, {"json": DOCUMENT, "headers": {"Idempotency-Key": "ä".encode()}}),
    ("post", "/v1/jobs", {}, 422, {"json": DOCUMENT, "params": {"wait": 1000}}),
    ("post", "/v1/jobs", {}, 422, {"json": DOCUMENT | {"labels": {"-": "a"}}}),
    ("post", "/v1/jobs", {}, 422, {"json": DOCUMENT | {"timeout_s": "soon"}}),
    ("post", "/v1/jobs:validate", {}, 422, {"json": [1]}),
    ("post", "/v1/jobs:validate", {}, 409, {"json": DOCUMENT | {"robot": {"mjcf": "<mujoco"}}}),
    ("get", "/v1/jobs", {}, 422, {"params": {"limit": 0}}),
    ("get", "/v1/jobs", {}, 422, {"params": {"state": "odd"}}),
    ("get", "/v1/jobs", {}, 404, {"params": {"cursor": "odd"}}),
    ("get", "/v1/jobs/{job_id}", {"job_id": NONE}, 404, {}),
    ("get", "/v1/jobs/{job_id}", {"job_id": "odd"}, 404, {}),
    ("delete", "/v1/jobs/{job_id}", {"job_id": NONE}, 404, {}),
    ("post", "/v1/jobs/{job_id}:cancel", {"job_id": NONE}, 404, {}),
    ("get", "/v1/jobs/{job_id}/result", {"job_id": NONE}, 404, {}),
    ("get", "/v1/jobs/{job_id}/tables/{table}", {"job_id": NONE, "table": "targets"}, 404, {}),
    ("get", "/v1/analyses/{analysis}", {"analysis": "odd"}, 404, {}),
    ("get", "/v1/robots/{robot}/view", {"robot": "odd"}, 404, {}),
    ("post", "/v1/robots:view", {}, 422, {"json": {"robot": 5}}),
    ("post", "/v1/models", {}, 409, {"content": b"", "headers": {"Content-Type": "text/csv"}}),
    ("post", "/v1/models", {}, 415, {"content": b"a", "headers": {"Content-Type": "text/odd"}}),
    ("post", "/v1/models", {}, 409, {"content": b"<odd/>", "headers": {"Content-Type": "application/xml"}}),
    ("get", "/v1/models/{sha256}", {"sha256": "0" * 64}, 404, {}),
    ("post", "/v1/keys", {}, 403, {"json": {"name": "ann"}}),
    ("post", "/v1/webhooks", {}, 409, {"json": {"url": "https://hooks.example.org"}}),
    ("post", "/v1/webhooks", {}, 422, {"json": {"url": 5}}),
    ("delete", "/v1/webhooks/{webhook_id}", {"webhook_id": NONE}, 404, {}),
]


@pytest.mark.parametrize(("method", "path", "names", "status", "sent"), REQUESTS)
def test_a_problem_keeps_to_its_schema(client, method, path, names, status, sent):
    problem = problem_of(client.request(method, path.format(**names), **sent), status)
    document = client.get("/openapi.json").json()
    validator = validator_of(document, path, method, status, "application/problem+json")
    assert [error.message for error in validator.iter_errors(problem)] == []
    # An extension member may have any name (RFC 9457), so that one that may be absent may be renamed.
    optional = document["components"]["schemas"]["Problem"]["properties"].keys() - set(
        document["components"]["schemas"]["Problem"]["required"]
    )
    for changed in broken(problem):
        assert not validator.is_valid(changed) or set(problem) - set(changed) <= optional, changed


def test_problems_of_a_result_do_too(client, finished):
    document = client.get("/openapi.json").json()
    job_id = finished.rpartition("/")[2]
    for path, names, query, status in (
        ("/v1/jobs/{job_id}/volume/slice", {}, {"at": 99}, 404),
        ("/v1/jobs/{job_id}/volume/slice", {}, {"axis": "w"}, 422),
        ("/v1/jobs/{job_id}/histogram", {}, {"index": "odd"}, 404),
        ("/v1/jobs/{job_id}/histogram", {}, {"bins": 0}, 422),
        ("/v1/jobs/{job_id}/tables/{table}", {"table": "odd"}, {}, 404),
        ("/v1/jobs/{job_id}/plots/{plot}", {"plot": "odd"}, {}, 404),
        ("/v1/jobs/{job_id}/artifacts/{name}", {"name": "odd"}, {}, 404),
    ):
        problem = client.get(path.format(job_id=job_id, **names), params=query)
        validator = validator_of(document, path, "get", problem.status_code, "application/problem+json")
        assert problem.status_code in (status, 422) and validator.is_valid(problem.json()), problem.text
        assert not validator.is_valid({key: value for key, value in problem.json().items() if key != "code"})
