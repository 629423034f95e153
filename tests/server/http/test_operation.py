"""Operation: health, readiness, metrics, logs, documentation, catalogue, and answers to faults."""

import codecs
import errno
import hashlib
import io
import re
import sqlite3
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
import structlog
import trimesh
from pyarrow import parquet
from wsrender_server.jobs.database import Transactions, open_database
from wsrender_server.jobs.faults import DiskFull, StoreUnavailable
from wsrender_server.jobs.retention import Retention
from wsrender_server.settings import Settings

from tests.server.hostile.cases import zipped
from tests.server.http.idle_server import DOCUMENT, problem_of
from wsrender import __version__
from wsrender.analyses.jobs import job_schema
from wsrender.analyses.registry import job_classes
from wsrender.documents.array_files import TABLE_TYPES
from wsrender.robots import library

MODEL = {"content": "<mujoco/>", "headers": {"Content-Type": "application/xml"}}


def test_health_and_version(client):
    assert client.get("/healthz").json() == {"status": "ok"}
    assert client.get("/v1/version").json()["wsrender"] == __version__


def test_readiness_names_what_is_missing(client, jobs, monkeypatch):
    assert set(client.get("/readyz").json()["checks"].values()) == {"ok"}
    jobs.scheduler_ready = jobs.worker_ready = False
    monkeypatch.setattr(jobs.store.files, "reserve_bytes", 2**62)
    monkeypatch.setattr(jobs.store, "ping", _raises(StoreUnavailable("the database is locked")))
    problem = problem_of(client.get("/readyz"), 503, "not_ready")
    assert "ok" not in problem["checks"].values()
    assert set(problem["checks"]) == {"database", "scheduler", "workers", "disk"}
    assert client.get("/healthz").status_code == 200


def test_nobody_is_told_where_the_database_is(client, jobs):
    """A store of a PostgreSQL that does not answer: probes, and whoever asks without a key."""
    jobs.store.transactions = Transactions(open_database("postgresql+psycopg://me:pw@127.0.0.1:1/secret_name"))
    with structlog.testing.capture_logs() as logs:
        for path, code in (("/readyz", "not_ready"), ("/v1/jobs", "database_unavailable")):
            answer = client.get(path)
            assert "the database does not answer" in problem_of(answer, 503, code)["detail"]
            assert not re.search("127.0.0.1|secret_name|port|me:", answer.text)
    assert any("127.0.0.1" in entry.get("error", "") for entry in logs)


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (StoreUnavailable("the database is locked"), "database_unavailable"),
        (DiskFull("1 MiB is free"), "disk_full"),
        (OSError(errno.ENOSPC, "No space left on device"), "disk_full"),
    ],
)
def test_a_full_disk_or_locked_database_loses_nothing(client, jobs, monkeypatch, error, code):
    with monkeypatch.context() as patch:
        patch.setattr(jobs.store, "submit_all", _raises(error))
        response = client.post("/v1/jobs", json=DOCUMENT)
    assert problem_of(response, 503, code)["retryable"] and int(response.headers["retry-after"]) > 0
    assert client.post("/v1/jobs", json=DOCUMENT).status_code == 202


def test_a_locked_database_answers_503_and_loses_nothing(client, settings, submit):
    before = submit()
    with closing(sqlite3.connect(settings.data_dir / "wsrender.db", isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        response = client.post("/v1/jobs", json=DOCUMENT | {"voxel_size_m": 0.2})
        assert problem_of(response, 503, "database_unavailable")["retryable"]
        assert [job["id"] for job in client.get("/v1/jobs").json()["items"]] == [before["id"]]
    assert client.post("/v1/jobs", json=DOCUMENT | {"voxel_size_m": 0.2}).status_code == 202
    assert len(client.get("/v1/jobs").json()["items"]) == 2


def test_a_nearly_full_disk_answers_503_and_loses_nothing(client, jobs, submit, monkeypatch):
    before = submit()
    with monkeypatch.context() as patch:
        patch.setattr(jobs.store.files, "reserve_bytes", 2**60)
        for path, content in (("/v1/jobs", {"json": DOCUMENT}), ("/v1/models", MODEL)):
            assert problem_of(client.post(path, **content), 503, "disk_full")["retryable"]
        assert client.get(before["links"]["self"]).json() == before
    assert client.post("/v1/models", **MODEL).status_code == 201


def test_an_unforeseen_fault_is_logged_and_says_nothing(client, jobs, monkeypatch):
    monkeypatch.setattr(jobs.store, "list", _raises(RuntimeError("secret detail")))
    with structlog.testing.capture_logs() as logs:
        response = client.get("/v1/jobs", headers={"X-Request-Id": "my-request-1"})
    problem = problem_of(response, 500, "internal_error")
    assert "secret" not in response.text and problem["request_id"] == "my-request-1"
    assert any(entry["event"] == "request failed" for entry in logs)
    (line,) = [entry for entry in logs if entry["event"] == "request"]
    assert (line["status"], line["path"], line["owner"]) == (500, "/v1/jobs", "local")


def test_requests_are_logged_with_their_job(client, submit):
    with structlog.testing.capture_logs() as logs:
        job = submit()
        client.get(f"/v1/jobs/{job['id']}")
    assert [entry["job_id"] for entry in logs if entry["event"] == "request"] == [job["id"]] * 2


def test_states_of_jobs_are_logged(submit, jobs):
    with structlog.testing.capture_logs() as logs:
        job = submit()
        jobs.fail(job["id"], {"code": "frame_not_found", "message": "tip: no such", "retryable": False})
    lines = [entry for entry in logs if entry["event"] == "job"]
    assert [line["state"] for line in lines] == ["queued", "running", "failed"]
    assert {line["job_id"] for line in lines} == {job["id"]} and lines[-1]["code"] == "frame_not_found"


def test_request_ids_are_plain(client):
    given = client.get("/healthz", headers={"X-Request-Id": "abc-12345"}).headers["x-request-id"]
    assert given == "abc-12345"
    for odd in ("x", "a b c d e f g h", "<script>alert(1)</script>", "a" * 100):
        made = client.get("/healthz", headers={"X-Request-Id": odd}).headers["x-request-id"]
        assert re.fullmatch("[0-9a-f]{16}", made)


def test_metrics(client, submit):
    submit()
    text = client.get("/metrics").text
    assert 'wsrender_jobs{state="queued"} 1.0' in text and 'wsrender_workers{activity="idle"} 1.0' in text
    assert 'wsrender_submissions_total{outcome="queued"} 1.0' in text
    assert 'wsrender_http_requests_total{method="POST",route="/v1/jobs",status="202"} 1.0' in text
    client.get("/secret-path-1")
    client.get(f"/v1/jobs/{'0' * 32}")
    text = client.get("/metrics").text
    assert "secret-path" not in text and 'route="/v1/jobs/{job_id}"' in text and "0" * 32 not in text


def test_invented_methods_are_one_line_of_the_metrics(client):
    for number in range(50):
        problem_of(client.request(f"M{number}", "/v1/jobs"), 405)
    text = client.get("/metrics").text
    assert 'wsrender_http_requests_total{method="other",route="/v1/jobs",status="405"} 50.0' in text
    assert "M49" not in text


def test_workers(client):
    (worker,) = client.get("/v1/workers").json()["items"]
    assert worker["busy"] is False and worker["target"]


def test_methods_that_are_not_there(client, submit):
    path = f"/v1/jobs/{submit()['id']}"
    for method, where, allowed in (
        ("PUT", "/v1/jobs", "GET, POST"), ("OPTIONS", "/v1/jobs", "GET, POST"), ("PATCH", path, "DELETE, GET"),
        ("GET", f"{path}:cancel", "POST"), ("POST", f"{path}/result", "GET"), ("POST", "/readyz", "GET"),
        ("POST", "/docs", "GET, HEAD"), ("GET", "/v1/jobs:validate", "POST"),
        ("DELETE", f"{path}/artifacts/result.json", "GET, HEAD"),
    ):  # fmt: skip
        response = client.request(method, where)
        problem_of(response, 405, "method_not_allowed")
        assert response.headers["allow"] == allowed
    problem_of(client.get("/v1/nothing"), 404, "not_found")
    problem_of(client.get("/docs/files/../../app.py"), 404)
    problem_of(client.get("/docs/files/%2e%2e/%2e%2e/app.py"), 404)


def test_documentation_needs_no_internet(client):
    page = client.get("/docs").text
    files = re.findall(r'(?:href|src)="([^"]+)"', page)
    assert len(files) == 3
    for file in files:
        assert not file.startswith(("http", "//"))
        assert client.get(f"/{file}").status_code == 200
    assert 'href="docs"' in client.get("/").text


def test_analyses_carry_their_schema(client):
    items = {item["id"]: item for item in client.get("/v1/analyses").json()["items"]}
    assert set(items) == set(job_classes())
    for name, item in items.items():
        assert item["schema"] == job_schema(name) and item["description"]
        assert client.get(f"/v1/analyses/{name}").json() == item
    problem_of(client.get("/v1/analyses/nothing"), 404)


@pytest.mark.parametrize("path", ["/openapi.json", "/v1/analyses"])
def test_long_descriptions_go_on_and_are_not_sent_to_who_has_them(client, path):
    whole = client.get(path)
    etag, size = whole.headers["etag"], len(whole.content)
    assert etag == f'"{hashlib.sha256(whole.content).hexdigest()}"' and size > 500_000
    assert whole.headers["content-type"] == "application/json" and whole.headers["accept-ranges"] == "bytes"
    known = client.get(path, headers={"If-None-Match": etag})
    assert (known.status_code, known.content, known.headers["etag"]) == (304, b"", etag)
    part = client.get(path, headers={"Range": f"bytes={size // 2}-", "If-Range": etag})
    assert (part.status_code, part.content) == (206, whole.content[size // 2 :])
    changed = client.get(path, headers={"Range": "bytes=5-", "If-Range": '"of another"'})
    assert (changed.status_code, changed.content) == (200, whole.content)
    (fault,) = problem_of(client.get(path, headers={"Range": f"bytes={size}-"}), 416)["errors"]
    assert fault["pointer"] == "Range"


def test_robots_are_those_of_the_library(client):
    items = client.get("/v1/robots").json()["items"]
    assert [item["name"] for item in items] == library.names()
    assert all(item["joints"] > 0 and item["description"] and item["source"] for item in items)


@pytest.mark.parametrize(
    ("text", "status", "code"),
    [
        (b"<!DOCTYPE a [<!ENTITY b 'c'>]><mujoco>&b;</mujoco>", 422, "invalid_model"),
        (b"<a>" * 300, 422, "invalid_model"),
        (b"<mujoco>", 409, "invalid_model"),
        (b"", 409, "invalid_model"),
        (b"\x00\xff\xfe", 409, "invalid_model"),
        (b"PK\x03\x04zip", 409, "invalid_model"),
        (b"<html/>", 409, "invalid_model"),
    ],
)
def test_models_that_are_none(client, text, status, code):
    problem_of(client.post("/v1/models", content=text, headers={"Content-Type": "application/xml"}), status, code)


def test_models(client, submit, monkeypatch):
    text = "<mujoco><!-- é --><worldbody/></mujoco>".encode()
    response = client.post("/v1/models", content=text, headers={"Content-Type": "application/xml; charset=utf-8"})
    model = response.json()
    assert response.status_code == 201 and response.headers["location"] == model["href"]
    got = client.get(model["href"])
    assert got.content == text and got.headers["etag"] == f'"{model["sha256"]}"'
    with monkeypatch.context() as patch:
        patch.setattr(Path, "read_bytes", None)  # whoever has it costs no reading
        assert client.get(model["href"], headers={"If-None-Match": got.headers["etag"]}).status_code == 304
    assert submit(robot={"model": model["sha256"]})["state"] == "queued"
    problem_of(client.post("/v1/models", content=text), 415)
    problem_of(client.get(f"/v1/models/{'0' * 64}"), 404, "model_not_found")


def test_files_that_no_header_describes_are_known_by_their_first_bytes(client):
    headers = {"Content-Type": "application/octet-stream"}
    arm = b"<mujoco><worldbody/></mujoco>"
    table = io.BytesIO()
    np.save(table, np.zeros((2, 3)))
    for content in (
        arm,
        codecs.BOM_UTF8 + b"\n " + arm,
        zipped({"arm.xml": arm}),
        table.getvalue(),
        b"x_m,y_m,z_m\n0,0,0",
    ):
        response = client.post("/v1/models", content=content, headers=headers)
        assert response.status_code == 201 and client.get(response.json()["href"]).content == content
    refused = ((b"", "invalid_model"), (b" <html/>", "invalid_model"), (b"PK\x03\x04 no more", "invalid_model"))
    for content, code in refused:
        problem = client.post("/v1/models", content=content, headers=headers)
        assert problem.status_code in (409, 422) and problem.json()["code"] == code, problem.text


def test_zips_of_models(client, submit):
    """Checked by their directory when they arrive, read where jobs are planned."""
    arm = b"""<mujoco><worldbody><body><joint name="j" axis="0 0 1" range="-1 1"/><geom size=".1"/>
      <site name="tool" pos="1 0 0"/></body></worldbody></mujoco>"""
    content = zipped({"scene.xml": b'<mujoco><include file="arm.xml"/></mujoco>', "arm.xml": arm, "b.xml": arm})
    headers = {"Content-Type": "application/zip"}
    response = client.post("/v1/models", content=content, headers=headers)
    assert response.status_code == 201, response.text
    sha256 = response.json()["sha256"]
    assert client.get(f"/v1/models/{sha256}").content == content
    assert submit(robot={"model": sha256, "entry": "scene.xml"})["state"] == "queued"
    problem_of(client.post("/v1/models", content=zipped({"a.stl": b""}), headers=headers), 409, "invalid_model")
    found = []
    for fields in ({"entry": "scene.xml"}, {}, {"entry": "c.xml"}):
        document = {"analysis": "indices_at", "robot": {"model": sha256, **fields}, "configurations": [[0]]}
        found.append(client.post("/v1/jobs:validate", json=document))
        while found[-1].json().get("code") == "planning":
            found[-1] = client.post("/v1/jobs:validate", json=document)
    assert found[0].status_code == 200, found[0].text
    for answer, said in zip(found[1:], ("must name one of the models", "'c.xml' is not in the archive"), strict=True):
        (error,) = problem_of(answer, answer.status_code, "invalid_input")["errors"]
        assert error["pointer"] == "#/robot/entry" and said in error["detail"]
        assert answer.status_code in (409, 422)


@pytest.mark.parametrize(
    ("text", "missing"),
    [
        ('<mujoco><asset><mesh name="a" file="a.stl"/><mesh name="b" file="a.stl"/><mesh name="c" vertex="0 0 0"/>'
         '<hfield name="h" file="h.png"/><texture file="t.png"/></asset></mujoco>', ["a.stl", "h.png"]),
        ('<robot><link name="a"><visual><geometry><mesh filename="package://p/a.dae"/></geometry></visual></link></robot>',
         ["package://p/a.dae"]),
        ("<sdf><model><link><visual><geometry><mesh><uri> m.dae </uri></mesh></geometry></visual></link></model></sdf>",
         ["m.dae"]),
        ("<mujoco><asset>" + "".join(f'<mesh file="{k}{"x" * 600}"/>' for k in range(120)) + "</asset></mujoco>",
         [f"{k}{'x' * 600}"[:500] for k in range(100)]),
        ("<mujoco><worldbody/></mujoco>", []),
    ],
)  # fmt: skip
def test_an_upload_says_which_files_it_lacks(client, text, missing):
    response = client.post("/v1/models", content=text, headers={"Content-Type": "application/xml"})
    assert response.json()["missing_files"] == missing


@pytest.mark.parametrize("ending", ["stl", "obj", "ply"])
def test_meshes(client, submit, ending):
    content = trimesh.creation.box((0.1, 0.2, 0.3)).export(file_type=ending)
    content = content if isinstance(content, bytes) else content.encode()
    response = client.post("/v1/models", content=content, headers={"Content-Type": f"model/{ending}"})
    assert response.status_code == 201, response.text
    sha256 = response.json()["sha256"]
    got = client.get(f"/v1/models/{sha256}")
    assert got.content == content and got.headers["content-type"] == "application/octet-stream"
    item = {"shape": "mesh", "model": sha256, "position_m": [2, 0, 0]}
    assert submit(environment={"items": [item]})["state"] == "queued"
    robot = {"library": "scara", "tool_shapes": [item]}
    assert submit(robot=robot)["state"] == "queued"


def test_meshes_are_read_where_jobs_are_planned(client):
    """In the child process: what is none is refused there, by the field that names it."""
    document = {"analysis": "indices_at", "robot": "ur5e", "configurations": [[0] * 6]}
    found = []
    for content in (trimesh.creation.box((0.1, 0.2, 0.3)).export(file_type="stl"), b"no mesh"):
        answer = client.post("/v1/models", content=content, headers={"Content-Type": "model/stl"})
        item = {"shape": "mesh", "model": answer.json()["sha256"], "position_m": [2, 0, 0]}
        found.append(client.post("/v1/jobs:validate", json=document | {"environment": {"items": [item]}}))
        while found[-1].json().get("code") == "planning":
            found[-1] = client.post("/v1/jobs:validate", json=document | {"environment": {"items": [item]}})
    assert found[0].status_code == 200, found[0].text
    (error,) = problem_of(found[1], 409, "invalid_input")["errors"]
    assert error["pointer"] == "#/environment/items/0/model" and "cannot be read as a mesh" in error["detail"]
    problem_of(client.post("/v1/models", content=b"", headers={"Content-Type": "model/stl"}), 409, "invalid_model")


@pytest.mark.parametrize(("ending", "media_type"), TABLE_TYPES.items())
def test_tables_of_targets(client, ending, media_type, tmp_path):
    """Read where jobs are planned; what is wrong with one is said by row and column, and none is opened by its path."""
    path = tmp_path / f"t{ending}"
    if ending == ".npy":
        np.save(path, [[0.4, 0.2, 0.3], [0, np.nan, 0]])
    elif ending == ".csv":
        path.write_text("x_m,y_m,z_m\n0.4,0.2,0.3\n0,nan,0\n")
    else:
        parquet.write_table(pa.table({"x_m": [0.4, 0], "y_m": [0.2, np.nan], "z_m": [0.3, 0]}), path)
    document = {"analysis": "reachability", "robot": "ur5e"}
    wrong, right = path.read_bytes(), b"x_m,y_m,z_m,name\n0.4,0.2,0.3,a\n"
    found = []
    for content, kind in ((right, "text/csv"), (wrong, media_type)):
        answer = client.post("/v1/models", content=content, headers={"Content-Type": kind})
        assert answer.status_code == 201, answer.text
        job = document | {"targets": {"model": answer.json()["sha256"]}, "criteria": [{"least_share": 0.5}]}
        found.append(client.post("/v1/jobs:validate", json=job))
        while found[-1].json().get("code") == "planning":
            found[-1] = client.post("/v1/jobs:validate", json=job)
    assert found[0].status_code == 200 and found[0].json()["samples"] == 1, found[0].text
    (error,) = problem_of(found[1], 409, "invalid_input")["errors"]
    assert error["pointer"] == "#/targets/model"
    assert "row 2, column y_m: must be a finite number" in error["detail"]
    local = client.post("/v1/jobs", json=document | {"targets": {"path": str(path)}})
    (error,) = problem_of(local, 422, "invalid_document")["errors"]
    assert error["pointer"] == "#/targets/path" and "is for local runs only" in error["detail"]
    unknown = client.post("/v1/jobs", json=document | {"targets": {"model": "0" * 64}})
    assert problem_of(unknown, 404, "model_not_found")["errors"][0]["pointer"] == "#/targets/model"


def _raises(error):
    def raising(*_, **__):
        raise error

    return raising


def test_models_are_listed_and_deleted_by_their_owner(client, submit):
    text = (library.find("scara")).read_text()
    sent = client.post("/v1/models", content=text, headers=MODEL["headers"]).json()
    (kept,) = client.get("/v1/models").json()["items"]
    assert kept.pop("created_at") and kept | {"missing_files": []} == sent
    job = submit(robot={"model": sent["sha256"]})
    assert "unfinished job" in problem_of(client.delete(sent["href"]), 409, "invalid_transition")["detail"]
    client.post(f"/v1/jobs/{job['id']}:cancel")
    assert client.delete(sent["href"]).status_code == 204
    assert client.get("/v1/models").json()["items"] == []
    for method in (client.get, client.delete):
        problem_of(method(sent["href"]), 404, "model_not_found")


def test_metrics_tell_what_is_kept_and_what_was_removed(client, jobs, finished):
    def value(name):
        return next(
            float(line.split()[-1]) for line in client.get("/metrics").text.splitlines() if line.startswith(name)
        )

    size = sum(each["bytes"] for each in client.get(f"{finished}/artifacts").json()["items"])
    assert value('wsrender_kept_bytes{what="results"}') == size > 0
    later = datetime.now(UTC) + timedelta(hours=1)
    Retention(jobs.store, Settings(data_dir=jobs.store.files.root, keep_results_bytes=0)).sweep(later)
    for _ in range(2):
        assert value('wsrender_retention_removed_total{what="result"}') == 1
        assert value("wsrender_retention_freed_bytes_total") == size
    assert value('wsrender_kept_bytes{what="results"}') == 0 and value('wsrender_jobs{state="expired"}') == 1
