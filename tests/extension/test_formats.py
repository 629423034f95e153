"""A format that another package adds in one file: from Python, the command line and a server."""

import json
import subprocess
import sys

import httpx2

import wsrender as ws
from tests.results.export.sample_data import assert_same_volume, random_volume
from tests.server.end_to_end.acceptance import PATIENCE_S
from tests.server.http.idle_server import DOCUMENT, problem_of
from wsrender.results.export import formats

UNCHANGED = ["npz", "csv", "mat", "vti", "stl", "obj", "svg"]


def voxels():
    return next(row for row in formats.table() if row.suffix == "voxels")


def test_from_python(package, tmp_path):
    volume = random_volume((5, 4, 3), vectors=("force",))
    result = ws.Result({"analysis": "workspace"}, volume=volume)
    result.save(tmp_path / "out", formats=["voxels"])
    assert_same_volume(voxels().read(tmp_path / "out" / "volume.voxels"), volume)
    record = next(each for each in result.document["artifacts"] if each["name"] == "volume.voxels")
    assert (record["media_type"], record["frame"]) == ("application/x-voxel-list", "world")
    assert_same_volume(ws.Result.load(tmp_path / "out").volume, volume)


def test_from_the_command_line(package, wsrender, tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(DOCUMENT))
    code, out, _ = wsrender("run", tmp_path / "job.json", "-o", tmp_path / "out", "--format", "voxels")
    assert code == 0 and "volume.voxels" in out
    saved = ws.Result.load(tmp_path / "out")
    assert_same_volume(voxels().read(tmp_path / "out" / "volume.voxels"), saved.volume)
    allowed = ", ".join([*UNCHANGED, "voxels"])
    error = f"error: --format: 'odd' is not a format that can be added; allowed: {allowed}\n"
    assert wsrender("run", tmp_path / "job.json", "-o", tmp_path / "out", "--format", "odd") == (2, "", error)


def test_from_a_live_server(package, live, tmp_path):
    job = live.submit(DOCUMENT).wait(timeout=PATIENCE_S)
    path = f"{live.url}/v1/jobs/{job.id}/artifacts/volume.vtkhdf"
    answer = httpx2.get(path, params={"format": "voxels"}, timeout=PATIENCE_S).raise_for_status()
    (tmp_path / "volume").write_bytes(answer.content)
    assert_same_volume(voxels().read(tmp_path / "volume"), job.result().volume)


def test_from_a_server(package, client, finished, result, tmp_path):
    response = client.get(f"{finished}/artifacts/volume.vtkhdf", params={"format": "voxels"})
    assert response.status_code == 200, response.text
    assert response.headers["content-type"] == "application/x-voxel-list"
    assert "volume.voxels" in response.headers["content-disposition"]
    (tmp_path / "volume").write_bytes(response.content)
    assert_same_volume(voxels().read(tmp_path / "volume"), result.volume)
    path = f"{finished}/artifacts/map.parquet"
    problem = problem_of(client.get(path, params={"format": "voxels"}), 404, "format_not_available")
    assert problem["detail"] == "map.parquet does not come as voxels; other formats: npz, csv, mat"
    problem = problem_of(client.get(path, params={"format": "odd"}), 422, "invalid_request")
    assert (
        "should be 'csv', 'glb', 'mat', 'npz', 'obj', 'parquet', 'ply', 'stl', 'voxels' or 'vti'" in problem["detail"]
    )
    parameters = client.get("/openapi.json").json()["paths"]["/v1/jobs/{job_id}/artifacts/{name}"]["get"]["parameters"]
    (schema,) = (each["schema"] for each in parameters if each["name"] == "format")
    assert "voxels" in json.dumps(schema) and "vti" in json.dumps(schema)


def test_packages_are_loaded_when_the_table_is_read(package):
    script = f"""
import sys
sys.path[:0] = {sys.path!r}
import wsrender.results.result, wsrender.cli
assert "voxel_list" not in sys.modules
from wsrender.results.export import formats
assert "voxels" in formats.asked() and "voxel_list" in sys.modules
"""
    subprocess.run([sys.executable, "-c", script], check=True)
