"""Requests: lost connections, busy servers, problem documents."""

import asyncio
import io
import json

import httpx2
import numpy as np
import pytest

import wsrender as ws
from tests.server.client.recorded_server import refuses, says
from wsrender.documents.arm import local_paths
from wsrender.robots import archives

JOB = {"id": "j1", "state": "queued", "analysis": "workspace", "labels": {}, "progress": None, "error": None}
DOCUMENT = {"analysis": "workspace", "robot": {"library": "ur5e"}}
LOST = httpx2.ReadError("connection reset by peer")
REFUSED = httpx2.ConnectError("[Errno 111] Connection refused")


def test_submit_sends_document_options_and_key(server, client):
    server.answer("POST", "/v1/jobs", says(JOB, 202))
    job = client.submit(DOCUMENT, labels={"arm": "left"}, priority=3, timeout_s=60.0)
    (request,) = server.requests
    assert (job.id, job.state, job.finished) == ("j1", "queued", False)
    assert request.headers["Authorization"] == "Bearer secret"
    assert len(request.headers["Idempotency-Key"]) >= 32
    assert json.loads(request.content) == {**DOCUMENT, "labels": {"arm": "left"}, "priority": 3, "timeout_s": 60.0}
    client.submit(DOCUMENT, idempotency_key="night 12")
    assert server.requests[-1].headers["Idempotency-Key"] == "night 12"


def test_a_batch_sends_what_a_submission_does(server):
    options = {"labels": {"arm": "left"}, "priority": 3, "timeout_s": 60.0}
    server.answer("POST", "/v1/jobs", says({**JOB, "state": "succeeded"}, 202))
    server.answer("GET", "/v1/jobs/j1/result", says({"artifacts": []}))

    async def with_asyncio():
        async with ws.AsyncClient("http://lab:8000", transport=server) as client, client.batch() as batch:
            batch.submit(DOCUMENT, **options, idempotency_key="night 12")

    with ws.Client("http://lab:8000", transport=server) as client, client.batch() as batch:
        batch.submit(DOCUMENT, **options, idempotency_key="night 12")
    asyncio.run(with_asyncio())
    sent = server.sent("POST", "/v1/jobs")
    assert [json.loads(each.content) for each in sent] == [{**DOCUMENT, **options}] * 2
    assert [each.headers["Idempotency-Key"] for each in sent] == ["night 12"] * 2


def test_submit_takes_typed_jobs(server, client):
    from wsrender.analyses.jobs import parse_job

    server.answer("POST", "/v1/jobs", says(JOB, 202))
    job = parse_job({**DOCUMENT, "sampling": {"method": "grid", "per_joint": 3}})
    client.submit(job)
    assert parse_job(json.loads(server.requests[0].content)) == job


def test_submit_takes_numpy_values(server, client):
    server.answer("POST", "/v1/jobs", says(JOB, 202))
    job = {**DOCUMENT, "voxel_size_m": np.float32(0.5), "points_m": np.zeros((2, 3)), "locked": {"a": np.int64(1)}}
    client.submit(job)
    sent = json.loads(server.requests[0].content)
    assert sent == {**DOCUMENT, "voxel_size_m": 0.5, "points_m": [[0, 0, 0], [0, 0, 0]], "locked": {"a": 1}}


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"sampling": {"count": float("nan")}}, "sampling.count: must be a finite number, not nan"),
        ({"points_m": np.array([[0.0, np.inf]])}, "points_m.0.1: must be a finite number, not inf"),
        ({"robot": object()}, "robot: must be plain data, not object"),
    ],
)
def test_what_json_cannot_say_is_refused(client, fields, message):
    with pytest.raises(ws.DocumentError, match=message):
        client.submit({**DOCUMENT, **fields})


@pytest.mark.parametrize("value", [None, "ur5e", 3])
def test_what_is_no_job_is_refused(client, value):
    with pytest.raises(ws.InputError, match="job: must be a job document"):
        client.submit(value)


def test_lost_answer_is_asked_again_with_the_same_key(server, client):
    busy = refuses(409, "idempotency_key_in_flight", retryable=True, headers={"Retry-After": "1"})
    server.answer("POST", "/v1/jobs", LOST, REFUSED, busy, says(JOB, 202))
    server.answer("GET", "/v1/jobs/j1", says(JOB))
    client._connection.server.reached = True
    assert client.submit(DOCUMENT).id == "j1"
    keys = {request.headers["Idempotency-Key"] for request in server.requests}
    assert (len(server.requests), len(keys)) == (4, 1)
    client.submit(DOCUMENT)
    assert server.requests[-1].headers["Idempotency-Key"] not in keys


def test_server_that_was_never_reached_is_told_at_once(server, client, clock):
    server.answer("GET", "/v1/robots", REFUSED)
    with pytest.raises(ws.ServerConnectionError, match=r"no server answers at http://lab:8000: .*refused"):
        client.robots()
    assert clock.pauses == []


def test_patience_ends(server, clock):
    server.answer("GET", "/v1/robots", says({"items": []}), REFUSED)
    with ws.Client("http://lab:8000", transport=server, patience_s=20.0) as client:
        assert client.robots() == []
        with pytest.raises(ConnectionError, match="lost the server at http://lab:8000 for 20 s"):
            client.robots()
    assert clock.pauses == pytest.approx([0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 5.0, 5.0])  # doubled, 20 s at most together


@pytest.mark.parametrize("verb", ["cancel", "retry", "delete"])
def test_what_changes_a_job_is_not_sent_twice(verb, server, client):
    method, path = ("DELETE", "/v1/jobs/j1") if verb == "delete" else ("POST", f"/v1/jobs/j1:{verb}")
    server.answer("GET", "/v1/jobs/j1", says(JOB))
    server.answer(method, path, LOST)
    job = client.job("j1")
    with pytest.raises(ws.ServerConnectionError, match="during a request"):
        getattr(job, verb)()
    assert len(server.sent(method, path)) == 1
    server.answer(method, path, REFUSED, says({**JOB, "state": "canceling"}))  # what cannot have arrived is sent again
    getattr(job, verb)()
    assert len(server.sent(method, path)) == 3


def test_a_server_that_reads_other_long_bodies_is_asked_again(server, client, clock):
    busy = refuses(429, "busy", retryable=True, headers={"Retry-After": "5"})
    server.answer("POST", "/v1/jobs", busy, busy, says(JOB, 202))
    assert client.submit(DOCUMENT).id == "j1" and len(server.requests) == 3
    assert len({request.headers["Idempotency-Key"] for request in server.requests}) == 1


def test_busy_server_is_asked_again_when_it_says(server, client, clock):
    busy = refuses(503, "database_unavailable", retryable=True, headers={"Retry-After": "7"})
    server.answer(
        "GET", "/v1/robots", busy, (502, {}, b"<html>bad gateway</html>"), says({"items": [{"name": "ur5e"}]})
    )
    assert client.robots() == [{"name": "ur5e"}]
    assert clock.pauses[0] == 7


def test_refusal_that_will_not_pass_is_told_at_once(server, client, clock):
    server.answer("GET", "/v1/robots", refuses(503, "broken", retryable=False, detail="out of order"))
    with pytest.raises(ws.ServerError, match="out of order") as caught:
        client.robots()
    assert (caught.value.code, caught.value.status, caught.value.retryable) == ("broken", 503, False)
    assert clock.pauses == []


@pytest.mark.parametrize(
    ("answer", "error", "message"),
    [
        (refuses(401, "unauthorized", detail="an API key is needed"), ws.AccessError, "an API key is needed"),
        (refuses(403, "forbidden", detail="the key may only read"), ws.AccessError, "the key may only read"),
        (refuses(404, "not_found", detail="no job j1"), ws.NotFoundError, "no job j1"),
        (refuses(422, "invalid_model", errors=[{"pointer": "#/robot/mjcf", "detail": "has no joints"}]),
         ws.ModelError, r"robot\.mjcf: has no joints"),
        (refuses(422, "missing_inertia", detail="needs inertias"), ws.MissingInertiaError, "job: needs inertias"),
        (refuses(422, "frame_not_found", errors=[{"pointer": "/tip", "detail": "no site; choose one of: a, b"}]),
         ws.FrameNotFoundError, "tip: no site; choose one of: a, b"),
        (refuses(413, "resource_limit", detail="too many samples"), ws.ResourceError, "too many samples"),
        (refuses(422, "idempotency_key_reused", detail="another body"), ws.ServerError, "another body"),
        ((500, {}, b"oops"), ws.ServerError, "Internal Server Error"),
        ((418, {"Content-Type": "application/json"}, b"[1]"), ws.ServerError, "teapot"),
    ],
)  # fmt: skip
def test_problem_documents_become_exceptions(server, client, answer, error, message):
    server.answer("GET", "/v1/jobs/j1", answer)
    with pytest.raises(error, match=message) as caught:
        client.job("j1")
    assert type(caught.value) is error


def test_every_fault_of_a_document_is_told(server, client):
    faults = [
        {"pointer": "/sampling/per_joint", "detail": "must be at least 1, not 0"},
        {"pointer": "#/robot/a~1b", "detail": "is unknown"},
    ]
    server.answer("POST", "/v1/jobs", refuses(422, "invalid_document", errors=faults))
    with pytest.raises(ws.DocumentError) as caught:
        client.submit(DOCUMENT)
    assert caught.value.problems == [
        ("sampling.per_joint", "must be at least 1, not 0"),
        ("robot.a/b", "is unknown"),
    ]


def test_quota_says_when_to_try_again(server, client):
    server.answer("POST", "/v1/jobs", refuses(429, "queue_full", detail="1000 jobs", headers={"Retry-After": "30"}))
    with pytest.raises(ws.QuotaError, match="1000 jobs") as caught:
        client.submit(DOCUMENT)
    assert caught.value.retry_after_s == 30


def test_jobs_are_listed_page_by_page(server, client):
    pages = [[{**JOB, "id": str(100 * page + row)} for row in range(100)] for page in range(2)]
    server.answer(
        "GET",
        "/v1/jobs",
        says({"items": pages[0], "next_cursor": "c1"}),
        says({"items": pages[1], "next_cursor": None}),
    )
    jobs = list(client.jobs(state="queued", label=("arm", "left")))
    assert [job.id for job in jobs] == [str(row) for row in range(200)]
    first, second = (dict(request.url.params) for request in server.requests)
    assert (first["state"], first["limit"], "cursor" in first) == ("queued", "100", False)
    assert second["cursor"] == "c1"
    server.answer("GET", "/v1/jobs", says({"items": pages[0], "next_cursor": "c1"}))
    assert len(list(client.jobs(limit=7))) == 7


def test_robot_files_are_uploaded(server, client, tmp_path):
    arm = tmp_path / "arm.urdf"
    arm.write_text("<robot name='arm'/>")
    server.answer("POST", "/v1/models", says({"sha256": "ab" * 32}, 201))
    server.answer("POST", "/v1/jobs", says(JOB, 202))
    document = {**DOCUMENT, "robot": {"path": str(arm), "placement": {"position_m": [1, 0, 0]}}}
    client.submit(document)
    upload, submission = server.requests
    assert upload.content == arm.read_bytes()
    assert json.loads(submission.content)["robot"] == {
        "model": "ab" * 32, "placement": {"position_m": [1, 0, 0]},
    }  # fmt: skip
    assert document["robot"]["path"] == str(arm)
    with pytest.raises(ws.InputError, match=r"robot\.path: .*missing\.urdf cannot be read: No such file"):
        client.submit({**DOCUMENT, "robot": {"path": str(tmp_path / "missing.urdf")}})


def test_files_of_what_stands_around_are_uploaded(server, client, tmp_path):
    arm, scene = tmp_path / "arm.urdf", tmp_path / "scene.xml"
    arm.write_text("<robot name='arm'/>")
    scene.write_text("<mujoco/>")
    mesh = tmp_path / "part.STL"
    mesh.write_bytes(b"solid part")
    hashes = [pair * 32 for pair in ("ab", "cd", "ef", "01")]
    server.answer("POST", "/v1/models", *(says({"sha256": each}, 201) for each in hashes))
    server.answer("POST", "/v1/jobs", says(JOB, 202))
    items = [ws.OtherRobot(robot={"path": str(arm)}, configuration=[0]), ws.Scene(scene), ws.Mesh(mesh)]
    robot = {"library": "scara", "tool_shapes": [{"shape": "mesh", "path": str(mesh)}]}
    client.submit({**DOCUMENT, "environment": ws.Environment(items), "robot": robot})
    *uploads, submission = server.requests
    types = {upload.content: upload.headers["content-type"] for upload in uploads}
    assert types == {
        arm.read_bytes(): "application/xml", scene.read_bytes(): "application/xml", b"solid part": "model/stl",
    }  # fmt: skip
    sent = json.loads(submission.content)
    robot, cell, part = sent["environment"]["items"]
    models = [robot["robot"]["model"], cell["model"], part["model"], sent["robot"]["tool_shapes"][0]["model"]]
    assert sorted(models) == sorted(hashes)
    assert not list(local_paths(sent))


@pytest.mark.parametrize("given", [str, ws.TargetTable, lambda path: {"path": str(path)}])
def test_tables_of_targets_are_uploaded(given, server, client, tmp_path):
    table = tmp_path / "holes.csv"
    table.write_text("x_m,y_m,z_m\n0,0,0\n")
    server.answer("POST", "/v1/models", says({"sha256": "ab" * 32}, 201))
    server.answer("POST", "/v1/jobs", says(JOB, 202))
    client.submit({"analysis": "reachability", "robot": "ur5e", "targets": given(table)})
    upload, submission = server.requests
    assert (upload.content, upload.headers["content-type"]) == (table.read_bytes(), "text/csv")
    sent = json.loads(submission.content)
    assert sent["targets"]["model"] == "ab" * 32 and not list(local_paths(sent))


def test_long_arrays_are_uploaded(server, client, monkeypatch):
    """Those of NumPy, in the fields that may be files; short ones, lists and what is no number stay in the document."""
    monkeypatch.setattr("wsrender.client.documents.LONGEST_SENT", 11)
    rows = np.arange(12.0).reshape(4, 3)
    server.answer("POST", "/v1/models", says({"sha256": "ab" * 32}, 201))
    server.answer("POST", "/v1/jobs", says(JOB, 202))

    def sent(**fields):
        """What was uploaded, and what stands in the document."""
        server.requests.clear()
        client.submit({**DOCUMENT, **fields})
        *uploads, submission = server.requests
        document = json.loads(submission.content)
        return uploads, {name: document[name] for name in fields}

    upload = {"model": "ab" * 32}
    for fields, document in (
        ({"configurations": rows}, {"configurations": upload}),
        ({"left": {"points": rows}, "slave": {"points": rows[:1]}}, {"left": upload, "slave": {"points": [[0, 1, 2]]}}),
    ):
        (one,), found = sent(**fields)
        assert found == document and one.headers["content-type"] == "application/x-npy"
        assert np.load(io.BytesIO(one.content)).tobytes() == rows.tobytes()
    for fields in ({"configurations": rows[:3]}, {"points_m": rows}, {"configurations": rows.tolist()}):
        ((name, value),) = fields.items()
        assert sent(**fields) == ([], {name: np.asarray(value).tolist()})
    rows[2, 1] = np.nan
    with pytest.raises(ws.DocumentError, match=r"configurations\.2\.1: must be a finite number, not nan"):
        client.submit({**DOCUMENT, "configurations": rows})


def test_files_of_several_robots_are_uploaded(server, client, tmp_path):
    """Wherever in the document they are; the document that was given stays as it is."""
    arms = [tmp_path / f"{name}.urdf" for name in ("left", "right")]
    for arm in arms:
        arm.write_text(f"<robot name='{arm.stem}'/>")
    server.answer("POST", "/v1/models", says({"sha256": "ab" * 32}, 201), says({"sha256": "cd" * 32}, 201))
    server.answer("POST", "/v1/jobs", says(JOB, 202))
    robots = [{"robot": {"path": str(arm)}} for arm in arms]
    document = {"analysis": "shared_workspace", "robots": [*robots, {"robot": "ur5e"}]}
    client.submit(document)
    *uploads, submission = server.requests
    assert [upload.content for upload in uploads] == [arm.read_bytes() for arm in arms]
    sent = json.loads(submission.content)["robots"]
    assert sent == [{"robot": {"model": "ab" * 32}}, {"robot": {"model": "cd" * 32}}, {"robot": "ur5e"}]
    assert robots == [{"robot": {"path": str(arm)}} for arm in arms]
    legs = [{"type": "serial", "robot": "ur5e"}, {"type": "serial", "robot": {"path": str(tmp_path / "missing.xml")}}]
    with pytest.raises(ws.InputError, match=r"^mechanism\.legs\.1\.robot\.path: .*missing\.xml cannot be read"):
        client.submit({"analysis": "parallel_workspace", "mechanism": {"legs": legs}})


def test_wrong_address():
    with pytest.raises(ws.InputError, match='url: must start with http:// or https://, not "lab:8000"'):
        ws.Client("lab:8000")


def test_folders_travel_as_zips_and_xacro_expanded(server, client, tmp_path):
    server.answer("POST", "/v1/models", *(says({"sha256": each * 32}, 201) for each in ("ab", "cd", "ef")))
    server.answer("POST", "/v1/jobs:validate", says({"valid": True}))
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "a.xml").write_text("<mujoco/>")
    (tmp_path / "arm.zip").write_bytes(archives.of_folder(tmp_path / "arm", "path"))
    xacro = '<robot name="{}" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n" default="a"/>{}</robot>'
    (tmp_path / "arm.xacro").write_text(xacro.format("x", '<link name="$(arg n)"/>'))
    robots = (
        {"path": str(tmp_path / "arm"), "entry": "a.xml"},
        {"path": tmp_path / "arm.zip"},
        {"path": str(tmp_path / "arm.xacro"), "xacro": {"n": "b"}, "packages": {"p": str(tmp_path)}},
    )
    for robot in robots:
        client.estimate({"analysis": "workspace", "robot": robot})
    sent = server.sent("POST", "/v1/models")
    assert [each.headers["content-type"] for each in sent] == ["application/zip"] * 2 + ["application/xml"]
    assert sent[0].content == sent[1].content == (tmp_path / "arm.zip").read_bytes()
    assert b'<link name="b"/>' in sent[2].content
    asked = [json.loads(each.content)["robot"] for each in server.sent("POST", "/v1/jobs:validate")]
    assert asked == [{"model": "ab" * 32, "entry": "a.xml"}, {"model": "cd" * 32}, {"model": "ef" * 32}]
