"""Views over HTTP: manifests, blobs with the numbers of the result's files, voxels, robots, and the page itself."""

import io
import json
import re
import struct

import numpy as np
import pytest
import trimesh
from fastapi.testclient import TestClient
from jsonschema import Draft202012Validator
from wsrender_server import admission, views
from wsrender_server.app import create_app
from wsrender_server.job_body import LONGEST_HERE, MOST_CONTAINERS
from wsrender_server.jobs.store import open_store
from wsrender_server.settings import Settings

from tests.server.http.idle_server import DOCUMENT, HOST, IdleJobs, problem_of
from wsrender.results.view.manifest import MANIFEST

JSON_BODY = {"Content-Type": "application/json"}
SCHEMA = Draft202012Validator(MANIFEST.json_schema())


@pytest.fixture(scope="module")
def settings(tmp_path_factory):
    return Settings(data_dir=tmp_path_factory.mktemp("view") / "data", min_free_disk_bytes=0)


@pytest.fixture(scope="module")
def jobs(settings):
    jobs = IdleJobs(open_store(settings))
    yield jobs
    jobs.store.close()


@pytest.fixture(scope="module")
def client(settings, jobs):
    """One for all tests: its side process is slow to start."""
    with TestClient(create_app(settings, jobs), base_url=HOST) as client:
        yield client


@pytest.fixture(scope="module")
def finished(client, jobs, result_folder):
    """Path of a job that succeeded."""
    job = client.post("/v1/jobs", json=DOCUMENT).json()
    jobs.complete(job["id"], result_folder)
    return f"/v1/jobs/{job['id']}"


@pytest.fixture(scope="module")
def manifest(client, finished):
    return client.get(f"{finished}/view").json()


def numbers(client, path, data):
    content = client.get(f"{path}/view/blobs/{data['blob']}").content
    return np.frombuffer(content, data["type"])


def test_a_result_has_a_view(client, finished, manifest, result):
    assert list(SCHEMA.iter_errors(manifest)) == [] and manifest["omitted"] == []
    assert [robot["name"] for robot in manifest["robots"]] == ["scara"]
    response = client.get(f"{finished}/view")
    etag = response.headers["etag"]
    assert response.headers["content-type"] == "application/json"
    assert response.headers["cache-control"] == "private, no-cache"
    assert client.get(f"{finished}/view", headers={"If-None-Match": etag}).status_code == 304
    picture = manifest["pictures"][0]["url"]
    assert client.get(f"{finished}/{picture}").headers["content-type"] == "image/png"


@pytest.mark.parametrize("encoding", ["float16", "float32"])
def test_blobs_hold_the_numbers_of_the_file(client, finished, result, encoding):
    manifest = client.get(f"{finished}/view", params={"channels": encoding}).json()
    (shown,) = manifest["volumes"]
    volume = result.volume
    assert shown["shape"] == list(volume.shape) and shown["first_voxel"] == list(volume.first_voxel)
    assert shown["voxel_size_m"] == volume.voxel_size_m
    occupancy = numbers(client, finished, shown["occupancy"])
    assert np.array_equal(occupancy, volume.occupied.ravel(order="F"))
    known = {f"{each['statistic']}:{each['name']}": each for each in shown["channels"]}
    channel = known["maximum:manipulability"]
    values = volume.statistics["maximum"]["manipulability"].ravel(order="F")
    assert channel["data"]["type"] == encoding
    assert np.array_equal(numbers(client, finished, channel["data"]), values.astype(encoding), equal_nan=True)
    assert channel["minimum"] == np.nanmin(values) and channel["maximum"] == np.nanmax(values)


def test_every_blob_of_a_manifest_is_there_and_as_long_as_it_says(client, finished, manifest):
    for data in views.data_in(manifest):
        response = client.get(f"{finished}/view/blobs/{data['blob']}")
        assert response.status_code == 200 and len(response.content) == views.size_of(data)
        glb = data["type"] == "glb"
        assert response.headers["content-type"] == ("model/gltf-binary" if glb else "application/octet-stream")
        again = client.get(response.url.path, headers={"If-None-Match": response.headers["etag"]})
        assert again.status_code == 304 and not again.content


def test_what_is_not_there(client, finished):
    problem_of(client.get(f"{finished}/view/blobs/volume9.occupancy"), 404, "invalid_input")
    for name in ("..%2fsecret", "A", "a" * 101, ".hidden", "%00"):
        assert client.get(f"{finished}/view/blobs/{name}").status_code in (404, 422)
    problem_of(client.get(f"{finished}/view", params={"channels": "float64"}), 422)
    waiting = client.post("/v1/jobs", json=DOCUMENT | {"voxel_size_m": 0.1}).json()["id"]
    problem_of(client.get(f"/v1/jobs/{waiting}/view"), 409, "no_result")
    problem_of(client.get(f"/v1/jobs/{'0' * 32}/view"), 404, "job_not_found")
    problem_of(client.get("/v1/robots/nothing/view"), 404, "robot_not_found")
    problem_of(client.get("/v1/robots/..%2f..%2fetc/view"), 404)
    problem_of(client.get("/v1/robots/scara/view/blobs/robot9.link9"), 404, "invalid_input")


def test_the_exact_values_of_a_voxel(client, finished, result):
    volume = result.volume
    for i, j, k in np.argwhere(volume.occupied)[::7].tolist():
        center = (np.array(volume.first_voxel) + (i, j, k) + 0.5) * volume.voxel_size_m
        voxel = client.get(f"{finished}/volume/voxel", params=dict(zip("xyz", center, strict=True))).json()
        assert voxel["cell"] == [i, j, k] and voxel["count"] == volume.count[i, j, k]
        assert np.allclose(voxel["center_m"], center, atol=1e-12)
        (value,) = voxel["values"]
        assert value == {
            "name": "manipulability",
            "statistic": "maximum",
            "unit": volume.units["manipulability"],
            "value": volume.statistics["maximum"]["manipulability"][i, j, k],
        }
    problem = problem_of(client.get(f"{finished}/volume/voxel", params={"x": 9, "y": 0, "z": 0}), 404, "invalid_input")
    assert "is outside the volume" in problem["detail"]
    problem_of(client.get(f"{finished}/volume/voxel", params={"x": "nan", "y": 0, "z": 0}), 422)


def test_a_library_robot(client):
    manifest = client.get("/v1/robots/scara/view").json()
    (robot,) = manifest["robots"]
    assert list(SCHEMA.iter_errors(manifest)) == [] and robot["name"] == "scara" and robot["links"]
    for link in robot["links"]:
        content = client.get(f"/v1/robots/scara/view/blobs/{link['geometry']['blob']}").content
        assert len(trimesh.load(io.BytesIO(content), file_type="glb", force="mesh").faces) > 0


def read_message(content):
    (length,) = struct.unpack("<I", content[:4])
    header, at = json.loads(content[4 : 4 + length]), 4 + length
    blobs = {}
    for entry in header["blobs"]:
        blobs[entry["name"]] = content[at : at + entry["bytes"]]
        at += entry["bytes"]
    assert at == len(content)
    return header["manifest"], blobs


def test_what_is_edited_is_shown(client):
    floor = {"shape": "half_space", "name": "<b>floor</b>"}
    edited = {"robot": {"library": "scara", "placement": {"position_m": [1, 2, 3]}}, "environment": {"items": [floor]}}
    manifest, blobs = read_message(client.post("/v1/robots:view", json=edited).content)
    assert list(SCHEMA.iter_errors(manifest)) == []
    assert np.reshape(manifest["robots"][0]["chain"]["T_base"], (4, 4))[:3, 3].tolist() == [1, 2, 3]
    assert {data["blob"] for data in views.data_in(manifest)} == set(blobs)
    alone, _ = read_message(client.post("/v1/robots:view", json={"environment": {"items": [floor]}}).content)
    assert alone["robots"] == [] and alone["meshes"][0]["role"] == "environment"
    for wrong, status in (
        ({"robot": {"path": "/etc/passwd"}}, 422),
        ({"environment": {"items": [{"shape": "scene", "path": "/etc/passwd"}]}}, 422),
        ({"robot": {"library": "nothing"}}, 422),
        ({"robot": {"model": "0" * 64}}, 404),
        ({"robot": {"mjcf": "<mujoco><worldbody/></mujoco>"}}, 409),
        ({"robot": {"mjcf": "<!DOCTYPE a [<!ENTITY b 'c'>]><mujoco>&b;</mujoco>"}}, 422),
        ({"more": 1}, 422),
    ):
        problem_of(client.post("/v1/robots:view", json=wrong), status)


def test_files_are_made_once_and_the_oldest_are_removed(client, finished, manifest, settings, monkeypatch):
    folder = settings.data_dir / "views"
    client.get(f"{finished}/view")
    made = max(folder.iterdir(), key=lambda each: each.stat().st_mtime_ns)
    before = {file.name: file.stat().st_mtime_ns for file in made.iterdir()}
    assert len(before) > 3
    client.get(f"{finished}/view")
    assert {file.name: file.stat().st_mtime_ns for file in made.iterdir()} == before
    monkeypatch.setattr(views, "MOST_KEPT", 1)
    monkeypatch.setattr(views, "_last_used", lambda folder: float(folder == made))  # as if asked for just now
    client.get("/v1/robots/spherical/view")
    assert [each != made for each in folder.iterdir()] == [True]
    assert client.get(f"{finished}/view").json() == manifest


def test_views_of_another_version_are_made_again(client, finished, manifest, settings, monkeypatch):
    """Their files are never read: an older program may have shown results otherwise."""
    folder = settings.data_dir / "views"
    client.get(f"{finished}/view")
    made = max(folder.iterdir(), key=lambda each: each.stat().st_mtime_ns)
    (made / "manifest.float16.json").write_text('{"title": "of an older version"}')
    assert client.get(f"{finished}/view").json() != manifest
    monkeypatch.setattr(views, "__version__", "next")
    assert client.get(f"{finished}/view").json() == manifest


def test_who_opens_the_page_finds_what_makes_views_loaded(settings, jobs):
    """By the side process; a server whose page nobody opens starts none."""
    with TestClient(create_app(settings, jobs), base_url=HOST) as client:
        process = client.app.state.parts.side_process
        client.get("/healthz")
        assert process._pid[0] == 0
        client.get("/")
        asked = "'wsrender.results.view.view' in __import__('sys').modules and 'trimesh' in __import__('sys').modules"
        assert client.portal.call(process.run, eval, asked)


def test_keys_are_needed_where_there_are_any(settings, jobs, tmp_path):
    file = tmp_path / "keys"
    file.write_text("0123456789abcdef0123456789abcdef\n")
    with TestClient(create_app(settings.model_copy(update={"api_key_file": file}), jobs), base_url=HOST) as client:
        for path in ("/v1/robots/scara/view", "/v1/robots/scara/view/blobs/a", f"/v1/jobs/{'0' * 32}/view"):
            problem_of(client.get(path), 401, "unauthorized")
        problem_of(client.post("/v1/robots:view", json={}), 401, "unauthorized")
        assert client.get("/").status_code == 200


def test_the_page_is_served_with_a_strict_policy(client):
    page = client.get("/")
    files = re.findall(r'(?:href|src)="(viewer/[^"]+)"', page.text)
    assert "viewer/served.js" in files
    for response in (page, *(client.get(f"/{file}") for file in files)):
        assert response.status_code == 200
        policy = dict(part.split(" ", 1) for part in response.headers["content-security-policy"].split("; "))
        assert (
            policy["default-src"]
            == policy["frame-ancestors"]
            == policy["base-uri"]
            == policy["form-action"]
            == "'none'"
        )
        assert policy["script-src"] == policy["style-src"] == policy["connect-src"] == "'self'"
        assert policy["img-src"] == "'self' blob: data:"
        assert response.headers["x-content-type-options"] == "nosniff"
    assert not re.search(r"<script(?![^>]*src=)|<style|\son\w+=|style=", page.text)
    problem_of(client.get("/viewer/../app.py"), 404)
    problem_of(client.get("/viewer/%2e%2e/%2e%2e/app.py"), 404)


def test_the_page_works_behind_a_prefix(settings, jobs):
    """Its addresses are relative: to where a proxy has put it."""
    with TestClient(create_app(settings, jobs), base_url=HOST, root_path="/robots/here") as client:
        page = client.get("/robots/here/")
        assert page.status_code == 200
        for file in re.findall(r'(?:href|src)="([^"]+)"', page.text):
            assert not file.startswith(("/", "http"))
            assert client.get(f"/robots/here/{file}").status_code == 200


def test_long_edits_are_counted_and_read_elsewhere(client, monkeypatch):
    """As submissions: a body of 15 MB may become a gigabyte of lists, and holds Python's lock for seconds."""
    text = json.dumps({"environment": {"items": [{"shape": "half_space"}]}}) + " " * LONGEST_HERE
    with monkeypatch.context() as patch:
        patch.setattr(admission, "read_document", None)
        manifest, _ = read_message(client.post("/v1/robots:view", content=text, headers=JSON_BODY).content)
        assert manifest["meshes"][0]["role"] == "environment"
        wrong = text.replace("half_space", "nothing")
        problem_of(client.post("/v1/robots:view", content=wrong, headers=JSON_BODY), 422, "invalid_document")
    many = '{"environment": {"items": [' + "[]," * MOST_CONTAINERS + "[]]}}"
    problem_of(client.post("/v1/robots:view", content=many, headers=JSON_BODY), 413, "too_many_values")
