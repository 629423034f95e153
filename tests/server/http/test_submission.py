"""Submitting jobs: answers, caching, replay, quotas; wrong documents with pointers to what is wrong."""

import json
import time

import pytest
from wsrender_server.jobs.documents import CanonicalDocument
from wsrender_server.routes.kinetostatic_stream import _admitted

from tests.golden.files import golden_names, job_of
from tests.server.http.idle_server import DOCUMENT, problem_of
from wsrender import run
from wsrender.analyses.jobs import canonical_json, parse_job
from wsrender.errors import DocumentError, InputError

BOMB = '<!DOCTYPE m [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;">]><mujoco>&b;</mujoco>'
OUTSIDE = '<!DOCTYPE m [<!ENTITY a SYSTEM "file:///etc/passwd">]><mujoco>&a;</mujoco>'


def test_a_new_job_is_queued(client, jobs):
    response = client.post("/v1/jobs", json=DOCUMENT)
    assert response.status_code == 202 and int(response.headers["retry-after"]) > 0
    job = response.json()
    assert response.headers["location"] == job["links"]["self"] == f"/v1/jobs/{job['id']}"
    assert (job["state"], job["analysis"], job["attempt"], job["error"]) == ("queued", "workspace", 1, None)
    assert jobs.store.document("local", job["id"]) == json.loads(canonical_json(parse_job(DOCUMENT)))
    assert client.get(job["links"]["self"]).json() == job


@pytest.mark.parametrize("wrapped", [True, False])
def test_options_stand_beside_the_document(client, wrapped):
    options = {"labels": {"study": "wrist-1 \u0096 Ē"}, "priority": 3, "timeout_s": 60}
    body = {"job": DOCUMENT, **options} if wrapped else DOCUMENT | options
    job = client.post("/v1/jobs", json=body).json()
    assert {name: job[name] for name in options} == options


def test_an_equal_job_is_answered_from_the_cache(client, submit, jobs, result_folder):
    jobs.complete(submit()["id"], result_folder)
    response = client.post("/v1/jobs", json=DOCUMENT | {"labels": {"again": "1"}})
    assert response.status_code == 200 and response.json()["state"] == "succeeded"


def test_a_key_makes_a_request_repeatable(client):
    key = {"Idempotency-Key": "abc-1"}
    first = client.post("/v1/jobs", json=DOCUMENT, headers=key)
    again = client.post("/v1/jobs", json={"job": DOCUMENT}, headers=key)
    assert (first.status_code, again.status_code) == (202, 200)
    assert first.json()["id"] == again.json()["id"]
    other = client.post("/v1/jobs", json=DOCUMENT | {"priority": 1}, headers=key)
    problem_of(other, 422, "idempotency_key_reused")


def test_a_key_at_work_is_refused(client):
    client.app.state.keys_at_work["local", "abc-1"] = object()
    problem = problem_of(client.post("/v1/jobs", json=DOCUMENT, headers={"Idempotency-Key": "abc-1"}), 409, "in_flight")
    assert problem["retryable"]


def test_a_key_is_free_again_when_its_request_was_refused(client, submit):
    paths = [f"/v1/jobs/{submit(voxel_size_m=0.1 + seed)['id']}" for seed in range(5)]
    key = {"Idempotency-Key": "abc-1"}
    problem_of(client.post("/v1/jobs", json=DOCUMENT, headers=key), 429, "queue_full")
    client.post(f"{paths[0]}:cancel")
    assert client.post("/v1/jobs", json=DOCUMENT, headers=key).status_code == 202


def test_an_odd_key_is_refused(client):
    problem_of(client.post("/v1/jobs", json=DOCUMENT, headers={"Idempotency-Key": "x" * 256}), 422, "invalid_request")


def test_more_unfinished_jobs_than_allowed(client, submit):
    for seed in range(5):
        submit(voxel_size_m=0.1 + seed)
    response = client.post("/v1/jobs", json=DOCUMENT | {"voxel_size_m": 9.0})
    assert problem_of(response, 429, "queue_full")["retryable"]
    assert int(response.headers["retry-after"]) > 0


@pytest.mark.parametrize(
    ("body", "status", "code", "pointer"),
    [
        (b"{", 400, "malformed_json", "#"),
        (b"\xff\xfe", 400, "malformed_json", "#"),
        (b'{"analysis": NaN}', 400, "malformed_json", "#"),
        (b'{"analysis": "workspace", "analysis": "workspace"}', 400, "malformed_json", "#"),
        (b'{"analysis": "\\ud800"}', 400, "malformed_json", None),
        (b"[" * 100_000, 400, "malformed_json", "#"),
        (b"[" * 40 + b"]" * 40, 422, "invalid_document", "#"),
        (b'{"a":' * 40 + b"1" + b"}" * 40, 422, "invalid_document", "#"),
        (b"[]", 422, "invalid_document", "#"),
        (b"{}", 422, "invalid_document", "#/analysis"),
        (b'{"job": 1}', 422, "invalid_document", "#/job"),
        (b'{"job": {}, "what": 1}', 422, "invalid_document", "#/what"),
        (b'{"job": {"analysis": "workspace"}}', 422, "invalid_document", "#/job/robot"),
        (b'{"analysis": "workspace", "robot": "scara", "labels": {"a b": "x"}}', 422, "invalid_document", "#/labels"),
        (b'{"analysis": "workspace", "robot": "scara", "priority": 1e9}', 422, "invalid_document", "#/priority"),
        (b'{"analysis": "workspace", "robot": "scara", "timeout_s": 1e999}', 422, "invalid_document", "#/timeout_s"),
    ],
)
def test_wrong_bodies(client, body, status, code, pointer):
    response = client.post("/v1/jobs", content=body, headers={"Content-Type": "application/json"})
    problem = problem_of(response, status, code)
    if pointer is not None:
        assert problem["errors"][0]["pointer"].startswith(pointer)
    assert not problem["retryable"]


def _around(**item):
    return {"environment": {"items": [item]}}


ITEM = "#/environment/items/0"


@pytest.mark.parametrize(
    ("fields", "status", "code", "pointer"),
    [
        ({"robot": {"library": "../../etc/passwd"}}, 422, "invalid_document", "#/robot/library"),
        ({"robot": {"path": "/etc/passwd"}}, 422, "invalid_document", "#/robot/path"),
        ({"robot": {"model": "0" * 64}}, 404, "model_not_found", "#/robot/model"),
        ({"robot": {"mjcf": BOMB}}, 422, "invalid_model", "#/robot/mjcf"),
        ({"robot": {"urdf": OUTSIDE}}, 422, "invalid_model", "#/robot/urdf"),
        ({"robot": {"mjcf": "<a>" * 300 + "</a>" * 300}}, 422, "invalid_model", "#/robot/mjcf"),
        ({"robot": {"mjcf": "<mujoco>"}}, 409, "invalid_model", "#/robot/mjcf"),
        ({"robot": {"mjcf": " "}}, 409, "invalid_model", "#/robot/mjcf"),
        ({"robot": {"mjcf": "<other/>"}}, 409, "invalid_model", "#/robot/mjcf"),
        (_around(robot={"path": "/etc/passwd"}, configuration=[0]), 422, "invalid_document", f"{ITEM}/robot/path"),
        (_around(robot={"model": "0" * 64}, configuration=[0]), 404, "model_not_found", f"{ITEM}/robot/model"),
        (_around(robot={"urdf": OUTSIDE}, configuration=[0]), 422, "invalid_model", f"{ITEM}/robot/urdf"),
        (_around(shape="mesh", path="/etc/part.stl"), 422, "invalid_document", f"{ITEM}/path"),
        (_around(shape="mesh", model="0" * 64), 404, "model_not_found", f"{ITEM}/model"),
        (
            {"robot": {"library": "scara", "tool_shapes": [{"shape": "mesh", "model": "0" * 64}]}},
            404,
            "model_not_found",
            "#/robot/tool_shapes/0/model",
        ),
        (_around(shape="scene", path="/etc/passwd"), 422, "invalid_document", f"{ITEM}/path"),
        (_around(shape="scene", model="0" * 64), 404, "model_not_found", f"{ITEM}/model"),
        (_around(shape="scene", mjcf=BOMB), 422, "invalid_model", f"{ITEM}/mjcf"),
        ({"constraints": {"robot": {"mjcf": 5}}}, 422, "invalid_document", "#/constraints/robot"),
        ({"constraints": {"robot": {"model": 5}}}, 422, "invalid_document", "#/constraints/robot"),
        ({"indices": ["beauty"]}, 422, "invalid_document", "#/indices"),
        ({"sampling": {"method": "random", "count": 10**15}}, 409, "resource_limit", "#/sampling"),
        ({"sampling": {"method": "random", "count": 10**16}}, 422, "invalid_document", "#/sampling/count"),
        ({"sampling": {"method": "grid", "per_joint": 10**15}}, 409, "resource_limit", "#/sampling"),
        ({"sampling": {"method": "grid", "per_joint": [10**15] * 5000}}, 409, "resource_limit", "#/sampling"),
        ({"sampling": {"method": "sobol", "count": 101}, "max_samples": 100}, 409, "resource_limit", "#/sampling"),
        ({"convention": "wsrender_code"}, 409, "invalid_document", "#/precision"),
        ({"what": 1}, 422, "invalid_document", "#/what"),
        ({"keep_map": "yes"}, 422, "invalid_document", "#/keep_map"),
    ],
)
def test_wrong_documents(client, jobs, fields, status, code, pointer):
    problem = problem_of(client.post("/v1/jobs", json=DOCUMENT | fields), status, code)
    assert [error["pointer"] for error in problem["errors"]] == [pointer]
    assert problem_of(client.post("/v1/jobs:validate", json=DOCUMENT | fields), status, code)["errors"]
    assert jobs.store.list("local") == ([], None)


@pytest.mark.parametrize(
    "fields",
    [
        {"tip": "link2", "sampling": {"method": "grid", "per_joint": 1000}},
        {"sampling": {"method": "grid", "per_joint": [10**4, 1, 10**4, 10**4], "locked": {"joint1": 0, "joint4": 0}}},
    ],
)
def test_only_joints_that_are_sampled_count_against_limits(client, fields):
    """Those between the ends that a document names, and none that it locks."""
    response = client.post("/v1/jobs", json=DOCUMENT | fields | {"max_samples": 10**6})
    assert response.status_code == 202, response.text


@pytest.mark.parametrize("upload", [False, True])
def test_a_model_that_includes_files_is_refused_with_how_to_inline_them(client, upload):
    """Nothing beside a model is opened: neither of text nor of an uploaded file."""
    scene = '<mujoco><worldbody><include file="arm.xml"/></worldbody></mujoco>'
    if upload:
        response = client.post("/v1/models", content=scene, headers={"Content-Type": "application/xml"})
    else:
        response = client.post("/v1/jobs", json=DOCUMENT | {"robot": {"mjcf": scene}})
    (error,) = problem_of(response, 422, "invalid_model")["errors"]
    assert error["pointer"] == ("#" if upload else "#/robot/mjcf")
    assert "inline the file, by putting what is inside its <mujoco> element in the place of <include>" in str(error)


def test_configurations_must_be_given(client):
    document = {"analysis": "indices_at", "robot": {"library": "scara"}}
    problem = problem_of(client.post("/v1/jobs", json=document), 422, "invalid_document")
    assert problem["errors"][0]["pointer"] == "#/configurations"


def test_only_json_is_read(client):
    for media_type in ("text/plain", "application/x-www-form-urlencoded", ""):
        response = client.post("/v1/jobs", content=json.dumps(DOCUMENT), headers={"Content-Type": media_type})
        problem_of(response, 415, "unsupported_media_type")


def test_a_large_body_is_refused_while_it_arrives(client):
    sent = 0

    def rows():
        nonlocal sent
        yield b'{"analysis": "indices_at", "robot": "scara", "configurations": ['
        for _ in range(10_000):
            sent += 1
            yield b"[0, 0, 0, 0]," * 1000

    response = client.post("/v1/jobs", content=rows(), headers={"Content-Type": "application/json"})
    problem_of(response, 413, "body_too_large")
    announced = client.post("/v1/jobs", content=b" " * 2_000_000, headers={"Content-Type": "application/json"})
    problem_of(announced, 413, "body_too_large")


def test_uploads_have_a_limit_of_their_own(client, settings):
    """Which its refusal names, whether the length is announced or not; other bodies keep theirs."""
    text = b"<mujoco>" + b" " * (2 << 20) + b"</mujoco>"
    headers = {"Content-Type": "application/octet-stream"}
    assert client.post("/v1/models", content=text, headers=headers).status_code == 201
    for content in (b"0" * ((3 << 20) + 1), iter([b"0" * (1 << 20)] * 4)):
        said = problem_of(client.post("/v1/models", content=content, headers=headers), 413, "body_too_large")["detail"]
        assert "3,145,728 bytes" in said and "WSRENDER_MAX_UPLOAD_BYTES" in said
    announced = client.post("/v1/jobs", content=b" " * (2 << 20), headers={"Content-Type": "application/json"})
    said = problem_of(announced, 413, "body_too_large")["detail"]
    assert "1,048,576 bytes" in said and "WSRENDER_MAX_BODY_BYTES" in said


def validated(client, document):
    """The answer once the job is planned: the first answers may say that this takes a while."""
    response = client.post("/v1/jobs:validate", json=document)
    while response.status_code == 409 and response.json()["code"] == "planning":
        response = client.post("/v1/jobs:validate", json=document)
    return response


def test_validation_plans_the_job(client, jobs):
    response = validated(client, DOCUMENT)
    estimate = response.json()
    assert response.status_code == 200 and estimate["valid"] and estimate["samples"] == 4**4
    assert estimate["seconds"] > 0 and jobs.store.list("local") == ([], None)
    expected = run.plan(DOCUMENT).estimate
    for name in ("seconds", "bytes", "memory_bytes", "file_bytes"):
        assert estimate[name] == float(f"{estimate[name]:.3g}") == pytest.approx(expected[name], rel=6e-3)
    rows = {"analysis": "indices_at", "robot": "scara", "configurations": [[0, 0, 0, 0]] * 3}
    assert client.post("/v1/jobs:validate", json=rows).json()["samples"] == 3
    problem = problem_of(client.post("/v1/jobs:validate", json=DOCUMENT | {"tip": "hand"}), 409, "frame_not_found")
    assert "tool" in problem["choices"] and problem["errors"][0]["pointer"] == "#/tip"


@pytest.mark.parametrize(
    ("length", "slide", "code", "pointer"),
    [
        (0.4, "", "invalid_input", "#/robot/limits"),
        (0.4, 'range="-1e16 1e16"', "invalid_input", "#/robot/limits"),
        (400, 'range="0 1"', "resource_limit", "#/robot/length_unit_m"),
    ],
)
def test_robots_without_usable_limits_or_in_millimetres(client, length, slide, code, pointer):
    mjcf = f"""<mujoco><worldbody><body><joint name="rail" type="slide" {slide}/><geom size=".1"/><body><joint/>
      <geom size=".1"/><site name="tool" pos="{length} 0 0"/></body></body></worldbody></mujoco>"""
    document = {"analysis": "workspace", "robot": {"mjcf": mjcf}, "sampling": {"method": "grid", "per_joint": 3}}
    problem = problem_of(validated(client, document), 409, code)
    assert [error["pointer"] for error in problem["errors"]] == [pointer]
    document["robot"] |= {"limits": {"rail": [0, 1]}, "length_unit_m": 1}
    assert validated(client, document).json()["samples"] == 9


@pytest.mark.parametrize("path", ["/etc/passwd", "points.npy"])
def test_points_in_files_are_not_opened(client, jobs, path):
    document = {"analysis": "collaborative_volume", "left": {"path": path}, "right": {"points": [[0, 0, 0]]}}
    problem = problem_of(client.post("/v1/jobs", json=document), 422)
    assert problem["errors"][0]["pointer"] == "#/left/path"
    assert "is for local runs" in problem["errors"][0]["detail"]
    with pytest.raises(InputError, match=r"left\.path: is for local runs"):
        CanonicalDocument.of(json.loads(canonical_json(parse_job(document))))


def test_the_answer_to_a_body_full_of_faults_is_short(client):
    robot = {"dh": {"rows": [1] * 3000}}
    for fields in ({f"k{i}": 1 for i in range(5000)}, {"indices": [f"f{i}" for i in range(5000)]}, {"robot": robot}):
        response = client.post("/v1/jobs", json={**DOCUMENT, **fields})
        problem_of(response, 422)
        assert len(response.content) < 100_000
    labels = {f"{i}!": "x" for i in range(5000)}
    assert len(client.post("/v1/jobs", json={**DOCUMENT, "labels": labels}).content) < 100_000
    many = client.post("/v1/jobs", json={**DOCUMENT, "indices": [f"f{i}" for i in range(20_001)]})
    assert "must have at most 20000 items, not 20001" in problem_of(many, 422)["detail"]


@pytest.mark.parametrize(
    ("fields", "pointer"),
    [
        ({"labels": {"a.b/c": 1}}, "#/labels/a.b~1c"),
        ({"labels": {"a\n": "x"}}, "#/labels/a\n"),
        ({"labels": {"a": "x\n"}}, "#/labels/a"),
        ({"a.b": 1}, "#/a.b"),
        ({'"a': 1}, '#/"a'),
        ({"analysis": "indices_at", "sampling": None, "configurations": []}, "#/sampling"),
    ],
)
def test_pointers_point_at_keys_as_they_are(client, fields, pointer):
    problem = problem_of(client.post("/v1/jobs", json={**DOCUMENT, **fields}), 422)
    assert pointer in [each["pointer"] for each in problem["errors"]]


def test_configurations_must_be_there(client):
    body = {"analysis": "indices_at", "robot": "scara", "configurations": []}
    problem = problem_of(client.post("/v1/jobs", json=body), 422, "invalid_document")
    assert problem["errors"][0]["pointer"] == "#/configurations"


SPHERE = {"shape": "sphere", "radius_m": 0.1}


def felt(*items):
    """A job of a force field with obstacles."""
    return {"analysis": "kinetostatic_field", "robot": "scara", "field": {"obstacles": {"items": items}}}


def test_files_of_surroundings_are_not_opened(client):
    items = [{"shape": "mesh", "path": "/etc/part.stl"}]
    job = {"analysis": "workspace", "robot": "ur5e", "environment": {"items": items}}
    problem = problem_of(client.post("/v1/jobs", json=job), 422, "invalid_document")
    (error,) = problem["errors"]
    assert error["pointer"] == "#/environment/items/0/path" and "is for local runs only" in error["detail"]


def test_meshes_in_files_are_not_opened(client):
    job = felt({"shape": "mesh", "path": "/etc/part.stl"})
    problem = problem_of(client.post("/v1/jobs", json=job), 422, "invalid_document")
    (error,) = problem["errors"]
    assert error["pointer"] == "#/field/obstacles/items/0/path" and "is for local runs only" in error["detail"]
    with pytest.raises(DocumentError, match=r"field\.obstacles\.items\.0\.path: is for local runs only"):
        _admitted(json.dumps({"robot": "scara", "field": job["field"]}).encode())


def test_obstacles_of_earlier_documents_are_the_same_job(client):
    jobs = [felt(SPHERE | {name: [0.3, 0, 0]}) for name in ("center_m", "position_m")]
    jobs.append(jobs[1] | {"format": 2})
    for key, job in enumerate(jobs):
        headers = {"Idempotency-Key": "k"}  # the same body, so the same job
        assert client.post("/v1/jobs", json=job, headers=headers).status_code == (200 if key else 202)
    problem = problem_of(client.post("/v1/jobs", json=jobs[2] | {"format": 3}), 422, "invalid_document")
    assert [error["pointer"] for error in problem["errors"]] == ["#/format"]


@pytest.mark.parametrize("name", golden_names())
def test_every_golden_job_is_admitted(name, client):
    response = client.post("/v1/jobs", json=job_of(name))
    assert response.status_code == 202, response.text


def test_a_wrong_body_of_many_kinds_of_things_is_refused_soon(client):
    """A validator that looks at all of them, as each kind, and as parts of each analysis, took seconds a kilobyte."""
    before = time.process_time()
    response = client.post("/v1/jobs", json={**DOCUMENT, "environment": {"items": [{"x": 1}] * 7000}})
    problem_of(response, 422)
    assert time.process_time() - before < 10


@pytest.mark.parametrize("path", ["/v1/jobs", "/v1/robots:view"])
def test_half_of_a_character_is_refused(client, path):
    content = json.dumps({"robot": {"library": "\ud800"}, "wrong": 1})
    response = client.post(path, content=content, headers={"Content-Type": "application/json"})
    assert 400 <= response.status_code < 500, response.text
