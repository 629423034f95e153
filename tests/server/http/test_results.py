"""Results over HTTP: document, files with ranges and entity tags, conversions, slices, plots."""

import hashlib
import io
import json
import os
import time
import tracemalloc

import numpy as np
import pytest
from sqlalchemy import update
from wsrender_server import conversions
from wsrender_server.jobs.tables import ArtifactFile, Computation

import wsrender
from tests.results.export.sample_data import random_volume
from tests.server.http.idle_server import problem_of
from wsrender.results import export
from wsrender.results.drawing import png
from wsrender.results.result import Result


@pytest.fixture
def volume(result):
    return result.volume


def test_the_document_is_that_of_the_run(client, finished, result):
    assert client.get(f"{finished}/result").json() == result.document


def test_the_document_goes_out_as_the_file_that_it_is(client, finished, result_folder, monkeypatch):
    """Nobody in the server's process reads it: it may hold as many numbers as a job document."""
    content = (result_folder / "result.json").read_bytes()
    for module in ("wsrender_server.jobs.results", "wsrender_server.conversions"):
        monkeypatch.setattr(f"{module}.json.loads", lambda *_: pytest.fail("the document was read"))
    response = client.get(f"{finished}/result")
    monkeypatch.undo()
    assert response.content == content and response.headers["content-type"] == "application/json"
    etag = response.headers["etag"]
    assert etag == f'"{hashlib.sha256(content).hexdigest()}"' and "content-disposition" not in response.headers
    assert client.get(f"{finished}/result", headers={"If-None-Match": etag}).status_code == 304
    part = client.get(f"{finished}/result", headers={"Range": "bytes=2-9"})
    assert (part.status_code, part.content) == (206, content[2:10])


@pytest.mark.parametrize("version", [wsrender.__version__, "0.5.0"])
def test_a_long_document_takes_no_memory_of_the_server(client, jobs, finished, version):
    """That of an earlier version is brought into today's form by another process."""
    numbers = [[0.125] * 4] * 250_000  # a dozen bytes of JSON for each becomes a hundred of objects
    stored_document(jobs, finished, lambda document: document.update(numbers=numbers), version)
    client.get(f"{finished}/volume/slice")  # the side process is there
    tracemalloc.start()
    with client.stream("GET", f"{finished}/result") as response:
        length = sum(map(len, response.iter_bytes()))
        most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert response.status_code == 200 and length > 7_000_000
    assert most < 20 << 20, f"{most / 2**20:.1f} MiB"


def test_no_result_yet(client, submit):
    path = f"/v1/jobs/{submit()['id']}"
    files = ("/result", "/artifacts", "/artifacts/result.json", "/plots/robot")
    for rest in (*files, "/volume", "/volume/slice", "/tables/sample", "/histogram"):
        assert problem_of(client.get(path + rest), 409, "no_result")["retryable"]


def test_every_file_is_listed_and_arrives_unchanged(client, finished, result_folder):
    items = client.get(f"{finished}/artifacts").json()["items"]
    names = {path.relative_to(result_folder).as_posix() for path in result_folder.rglob("*") if path.is_file()}
    assert {item["name"] for item in items} == names
    for item in items:
        response = client.get(item["href"])
        assert response.content == (result_folder / item["name"]).read_bytes()
        assert hashlib.sha256(response.content).hexdigest() == item["sha256"]
        assert response.headers["etag"] == f'"{item["sha256"]}"'
        assert response.headers["content-type"].startswith(item["media_type"])
        assert response.headers["content-disposition"].startswith("attachment")
        head = client.head(item["href"])
        assert (head.content, head.headers["content-length"]) == (b"", str(item["bytes"]))


@pytest.mark.parametrize(
    ("asked", "expected"),
    [
        ("bytes=0-9", slice(0, 10)),
        ("bytes=10-", slice(10, None)),
        ("bytes=-5", slice(-5, None)),
        ("bytes=5-999999999", slice(5, None)),
        ("bytes=0-1,4-5", None),
        ("bytes = 3 - 7", slice(3, 8)),
        ("bytes=3-" + "9" * 5000, slice(3, None)),
        ("bytes=0-1, 4-", None),
        ("lines=1-2", None),
    ],
)
def test_ranges(client, finished, result_folder, asked, expected):
    content = (result_folder / "map.parquet").read_bytes()
    response = client.get(f"{finished}/artifacts/map.parquet", headers={"Range": asked})
    assert response.status_code == (200 if expected is None else 206)
    assert response.content == (content if expected is None else content[expected])
    if expected is not None:
        start, stop, _ = expected.indices(len(content))
        assert response.headers["content-range"] == f"bytes {start}-{stop - 1}/{len(content)}"


def test_a_range_beyond_the_file(client, finished, result_folder):
    size = (result_folder / "map.parquet").stat().st_size
    for asked in (f"bytes={size}-", "bytes=-0", "bytes=" + "9" * 100 + "-", "bytes=" + "9" * 5000 + "-"):
        response = client.get(f"{finished}/artifacts/map.parquet", headers={"Range": asked})
        problem = problem_of(response, 416, "range_not_satisfiable")
        assert response.headers["content-range"] == f"bytes */{size}"
        assert problem["errors"][0]["pointer"] == "Range" and f"there are {size} bytes" in problem["detail"]


@pytest.mark.parametrize("asked", ["bytes=9-5", "bytes=-", "bytes=", "bytes", "nonsense", "bytes=a-b", "bytes=1--2"])
def test_a_range_that_is_none_is_told(client, finished, asked):
    for path in ("artifacts/map.parquet", "result", "volume", "volume/slice", "plots/slice", "view"):
        problem = problem_of(client.get(f"{finished}/{path}", headers={"Range": asked}), 416, "range_not_satisfiable")
        (fault,) = problem["errors"]
        assert fault["pointer"] == "Range" and asked in fault["detail"] and "bytes=0-99" in fault["detail"]
    whole = client.get(f"{finished}/artifacts/map.parquet", headers={"Range": asked, "If-Range": '"another"'})
    assert whole.status_code == 200


def test_a_download_goes_on_only_with_the_same_file(client, finished):
    path = f"{finished}/artifacts/map.parquet"
    etag = client.get(path).headers["etag"]
    assert client.get(path, headers={"Range": "bytes=5-", "If-Range": etag}).status_code == 206
    assert client.get(path, headers={"Range": "bytes=5-", "If-Range": '"other"'}).status_code == 200
    for tags in (etag, f'"x", {etag}', f"W/{etag}", "*"):
        response = client.get(path, headers={"If-None-Match": tags})
        assert (response.status_code, response.content, response.headers["etag"]) == (304, b"", etag)
    assert client.get(path, headers={"If-None-Match": '"other"'}).status_code == 200


@pytest.mark.parametrize(
    "name", ["nope", "../result.json", "..%2f..%2fwsrender.db", "plots", "%00", "a/" * 500, "C:\\x"]
)
def test_names_that_are_no_files(client, finished, name):
    problem_of(client.get(f"{finished}/artifacts/{name}"), 404)


def test_converted_files_hold_the_same(client, finished, result, tmp_path):
    def fetched(name, format):
        response = client.get(f"{finished}/artifacts/{name}", params={"format": format})
        assert response.status_code == 200, response.text
        assert response.headers["etag"] == f'"{hashlib.sha256(response.content).hexdigest()}"'
        path = tmp_path / f"{name}.{format}"
        path.write_bytes(response.content)
        return path

    samples = export.read_table_npz(fetched("map.parquet", "npz"))
    np.testing.assert_array_equal(samples.position, result.map.position)
    np.testing.assert_array_equal(samples.indices["manipulability"], result.map.indices["manipulability"])
    assert export.read_volume_npz(fetched("volume.vtkhdf", "npz")).count.sum() == 4**4
    assert fetched("sample.parquet", "csv").read_text().splitlines()[0].endswith('"joint4","manipulability"')
    assert fetched("volume.vtkhdf", "mat").read_bytes().startswith(b"MATLAB")
    assert len(fetched("surface.glb", "stl").read_bytes()) > 84
    again = client.get(f"{finished}/artifacts/map.parquet", params={"format": "npz"}, headers={"Range": "bytes=0-3"})
    assert (again.status_code, again.content) == (206, b"PK\x03\x04")
    problem_of(client.get(f"{finished}/artifacts/map.parquet", params={"format": "vti"}), 404, "format_not_available")
    problem_of(client.get(f"{finished}/artifacts/map.parquet", params={"format": "exe"}), 422, "invalid_request")


def test_converted_files_are_few_and_take_no_more_than_their_bytes(client, finished, settings, monkeypatch):
    """Those not asked for the longest go first; the newest stays, however large, and so does what is being written."""
    folder = settings.data_dir / "converted"

    def fetched(format):
        assert client.get(f"{finished}/artifacts/map.parquet", params={"format": format}).status_code == 200
        return {path.name.rpartition(".")[2] for path in folder.iterdir()}

    assert fetched("npz") == {"npz"}
    for name, age in (("npz", 3000), ("left", 2000), ("written", 0)):
        path = next(folder.glob("*.npz")) if name == "npz" else folder / f".a.{name}"
        path.touch()
        os.utime(path, (time.time() - age,) * 2)
    assert fetched("csv") == {"npz", "csv", "left", "written"}
    monkeypatch.setattr(conversions, "MOST_KEPT", 3)
    assert fetched("mat") == {"mat", "csv", "left", "written"}
    monkeypatch.setattr(conversions, "MOST_KEPT_BYTES", 1)
    assert fetched("npz") == {"npz", "written"}


def test_vti_is_what_vtk_reads(client, finished, volume, tmp_path):
    vtk = pytest.importorskip("vtk")
    from vtk.util.numpy_support import vtk_to_numpy

    path = tmp_path / "volume.vti"
    path.write_bytes(client.get(f"{finished}/artifacts/volume.vtkhdf", params={"format": "vti"}).content)
    reader = vtk.vtkXMLImageDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    np.testing.assert_allclose(image.GetOrigin(), volume.origin_m, rtol=1e-15)
    assert image.GetSpacing() == (volume.voxel_size_m,) * 3
    cells = image.GetCellData()
    shape = volume.count.shape[::-1]
    np.testing.assert_array_equal(vtk_to_numpy(cells.GetArray("count")).reshape(shape).T, volume.count)
    values = vtk_to_numpy(cells.GetArray("maximum_manipulability")).reshape(shape).T
    np.testing.assert_array_equal(values, volume.statistics["maximum"]["manipulability"])


def test_vti_has_the_vectors_of_a_field(client, submit, jobs, tmp_path):
    pytest.importorskip("vtk")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader

    volume = random_volume((5, 4, 3), vectors=("force",))
    document = {"analysis": "workspace", "warnings": []}
    Result(document, volume=volume).save(tmp_path / "out")
    job = submit()["id"]
    jobs.complete(job, tmp_path / "out")
    response = client.get(f"/v1/jobs/{job}/artifacts/volume.vtkhdf", params={"format": "vti"})
    assert response.headers["content-type"] == "application/vnd.vtk.vti"
    (tmp_path / "volume.vti").write_bytes(response.content)
    reader = vtkXMLImageDataReader()
    reader.SetFileName(str(tmp_path / "volume.vti"))
    reader.Update()
    force = vtk_to_numpy(reader.GetOutput().GetCellData().GetArray("force")).reshape(3, 4, 5, 3)
    np.testing.assert_array_equal(force.transpose(2, 1, 0, 3), volume.vectors["force"])


@pytest.mark.parametrize("axis", "xyz")
def test_slices_are_planes_of_the_volume(client, finished, volume, axis):
    normal = "xyz".index(axis)
    layer = volume.count.shape[normal] // 2
    at = float(volume.centers(normal)[layer])
    response = client.get(f"{finished}/volume/slice", params={"axis": axis, "at": at})
    assert response.headers["content-type"] == "application/x-npy"
    plane = np.load(io.BytesIO(response.content), allow_pickle=False)
    expected = volume.statistics["maximum"]["manipulability"].take(layer, normal).astype(np.float32)
    np.testing.assert_array_equal(plane, expected)
    across = [k for k in range(3) if k != normal]
    origin = [float(value) for value in response.headers["x-origin-m"].split(",")]
    np.testing.assert_allclose(origin, volume.origin_m[across], atol=1e-12)
    assert float(response.headers["x-at-m"]) == pytest.approx(at)
    accept = {"Accept": "application/octet-stream"}
    raw = client.get(f"{finished}/volume/slice", params={"axis": axis, "at": at, "statistic": "count"}, headers=accept)
    shape = tuple(int(value) for value in raw.headers["x-shape"].split(","))
    counts = volume.count.take(layer, normal)
    np.testing.assert_array_equal(np.nan_to_num(np.frombuffer(raw.content, "<f4").reshape(shape)), counts)


def test_slices_are_drawn_normal_to_their_axis(client, finished, result, volume):
    """Without a coordinate too."""
    for normal, axis in enumerate("xyz"):
        for at in (None, float(volume.centers(normal)[0])):
            expected = png(result.plot.slice(axis=axis, **({} if at is None else {axis: at})))
            query = {"axis": axis} | ({} if at is None else {"at": at})
            for path in ("volume/slice", "plots/slice"):
                response = client.get(f"{finished}/{path}", params=query, headers={"Accept": "image/png"})
                assert response.content == expected, (path, query)


def test_slices_of_what_is_not_there(client, finished):
    path = f"{finished}/volume/slice"
    for query in ({"index": "isotropy"}, {"statistic": "mean"}, {"at": 1e6}, {"at": 1e300}):
        problem_of(client.get(path, params=query), 404, "invalid_input")
    for query in ({"axis": "w"}, {"at": "here"}, {"at": "nan"}, {"at": "inf"}):
        problem_of(client.get(path, params=query), 422, "invalid_request")
    for accept in ("text/html", "*/*;q=0", "text/html, */*;q=0.0", "image/*;q=0"):
        problem_of(client.get(path, headers={"Accept": accept}), 406, "not_acceptable")
    for accept, media_type in (("text/*, */*;q=0.1", "text/csv"), ("image/png;q=0.2, */*;q=0.3", "application/x-npy")):
        assert client.get(path, headers={"Accept": accept}).headers["content-type"].startswith(media_type)


def test_pictures(client, finished):
    png = b"\x89PNG\r\n"
    picture = client.get(f"{finished}/volume/slice", headers={"Accept": "text/html;q=0.5, image/png"})
    assert picture.headers["content-type"] == "image/png" and picture.content.startswith(png)
    assert picture.headers["vary"] == client.get(f"{finished}/volume/slice").headers["vary"] == "Accept"
    for plot in ("robot", "slices", "slice"):
        assert client.get(f"{finished}/plots/{plot}").content.startswith(png)
    svg = client.get(f"{finished}/plots/histogram", params={"format": "svg"})
    assert svg.headers["content-type"].startswith("image/svg+xml") and b"<svg" in svg.content
    problem_of(client.get(f"{finished}/plots/histogram", params={"index": "isotropy"}), 404, "invalid_input")
    problem_of(client.get(f"{finished}/plots/sunset"), 422, "invalid_request")


def test_a_result_without_a_volume(client, jobs, tmp_path):
    from wsrender.run import execute

    document = {
        "analysis": "indices_at",
        "robot": {"library": "scara"},
        "configurations": [[0, 0, 0, 0]],
        "device": "cpu",
    }
    execute(document).save(tmp_path / "out")
    job = client.post("/v1/jobs", json=document).json()
    jobs.complete(job["id"], tmp_path / "out")
    problem_of(client.get(f"/v1/jobs/{job['id']}/volume/slice"), 404, "artifact_not_found")
    problem_of(client.get(f"/v1/jobs/{job['id']}/plots/robot"), 404, "invalid_input")


def stored_document(jobs, finished, change, version):
    """Change the result document of a finished job in the data folder, as an earlier version may have written it."""
    job = finished.rpartition("/")[2]
    path = jobs.store.artifact_path("local", job, "result.json")
    document = json.loads(path.read_text())
    change(document)
    content = json.dumps(document).encode()
    sha256 = hashlib.sha256(content).hexdigest()
    (path.parent / sha256).write_bytes(content)
    with jobs.store.transactions.write() as session:
        session.execute(update(ArtifactFile).where(ArtifactFile.name == "result.json").values(sha256=sha256))
        session.execute(update(Computation).values(version=version))


def test_results_of_0_1_are_answered_in_todays_form(client, jobs, finished):
    def of_0_1(document):
        del document["format"], document["headline"], document["warnings"]
        document["provenance"]["wsrender"] = "0.1.0"

    stored_document(jobs, finished, of_0_1, "0.1.0")
    document = client.get(f"{finished}/result").json()
    assert (document["format"], document["headline"]["value"]) == (2, None)
    assert [each["code"] for each in document["warnings"]] == ["other_version"]
    assert client.get(f"{finished}/plots/robot").status_code == 200


def test_a_result_of_another_format_is_a_problem(client, jobs, finished):
    stored_document(jobs, finished, lambda document: document.update(format=3), "99.0.0")
    for path in ("result", "plots/robot"):
        problem = problem_of(client.get(f"{finished}/{path}"), 422, "invalid_input")
        assert "must be 2 or missing" in problem["detail"]
