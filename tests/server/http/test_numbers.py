"""Numbers of results over HTTP: planes and tables as JSON and CSV, volumes in any format, histograms."""

import csv
import io
import json

import numpy as np
import pytest
from wsrender_server import extracts

import wsrender as ws
from tests.golden.files import job_of
from tests.results.export.sample_data import random_map, random_volume
from tests.server.http.answers import broken, validator_of
from tests.server.http.idle_server import problem_of
from wsrender.results.result import Result
from wsrender.volume.table import CellGrid, Table


@pytest.fixture
def volume(result):
    return result.volume


def rows_of(response):
    """The header and the rows, as text, of CSV."""
    assert response.headers["content-type"].startswith("text/csv"), response.text
    header, *rows = csv.reader(io.StringIO(response.text))
    return header, rows


@pytest.fixture
def kept(client, submit, jobs, tmp_path):
    """The path of a job that succeeded with a result of odd names, empty voxels and numbers that are not finite."""
    samples = random_map(1000)
    volume = random_volume((5, 4, 3), vectors=("force",))
    found = Result({"analysis": "workspace", "warnings": []}, sample=samples, volume=volume)
    found.volumes["left arm"] = random_volume((2, 3, 4))
    columns = {"value": np.array([1.5, np.nan, np.inf, -2]), "served": np.array([True, False, True, True])}
    columns |= {"name": np.array(["a", "b, c", "", "µ"]), "cell": np.arange(8).reshape(4, 2)}
    found.tables["odd things"] = Table(columns, {"value": "m"})
    found.save(tmp_path / "out")
    job = submit()
    jobs.complete(job["id"], tmp_path / "out")
    return f"/v1/jobs/{job['id']}", found


@pytest.mark.parametrize("axis", "xyz")
def test_planes_are_text_too(client, kept, axis):
    """Each voxel's value stands at its centre; empty voxels are null in JSON, and no rows of CSV."""
    path, found = kept
    normal = "xyz".index(axis)
    for k, at in enumerate(found.volume.centers(normal)):
        query = {"axis": axis, "at": at, "index": "manipulability", "statistic": "mean"}
        plane = client.get(f"{path}/volume/slice", params=query | {"format": "json"}).json()
        expected = found.volume.statistics["mean"]["manipulability"].take(k, normal)
        np.testing.assert_array_equal(np.array(plane["values"], float), expected.astype(float))
        assert np.isnan(expected).any() and plane["shape"] == list(expected.shape)
        assert (plane["name"], plane["unit"], plane["axis"]) == ("mean_manipulability", "m³", axis)
        assert plane["at_m"] == pytest.approx(at) and plane["axes"] == [each for each in "xyz" if each != axis]
        header, rows = rows_of(client.get(f"{path}/volume/slice", params=query | {"format": "csv"}))
        assert header == ["x", "y", "z", "mean_manipulability"]
        values = np.full(found.volume.shape, np.nan)
        for *center, value in np.array(rows, float):
            values[tuple(np.round((center - found.volume.origin_m) / 0.05 - 0.5).astype(int))] = value
        np.testing.assert_allclose(values.take(k, normal), expected, rtol=1e-6)
        assert np.isfinite(values).sum() == np.isfinite(expected).sum()


def test_counts_of_planes_are_whole_numbers(client, kept):
    path, found = kept
    plane = client.get(f"{path}/volume/slice", params={"statistic": "count"}, headers={"Accept": "application/json"})
    layer = round((plane.json()["at_m"] - found.volume.origin_m[2]) / 0.05 - 0.5)
    counts = found.volume.count[:, :, layer]
    assert plane.json()["values"] == [[int(n) or None for n in row] for row in counts]
    assert plane.json()["unit"] == "samples"


def test_planes_of_another_volume(client, kept):
    path, _ = kept
    plane = client.get(f"{path}/volume/slice", params={"volume": "left arm", "format": "json", "axis": "x"}).json()
    assert plane["shape"] == [3, 4]
    problem = problem_of(client.get(f"{path}/volume/slice", params={"volume": "right"}), 404, "artifact_not_found")
    assert problem["errors"][0]["pointer"] == "volume" and problem["choices"] == ["left arm", "volume"]


def test_text_of_large_planes_and_tables_is_refused_and_says_what_to_take(client, kept, monkeypatch):
    """What is allowed is looked at where it is made."""
    path, _ = kept
    hashes = {each["name"]: each["sha256"] for each in client.get(f"{path}/artifacts").json()["items"]}
    root = client.app.state.parts.store.files.root
    volume, table = (str(next(root.rglob(hashes[name]))) for name in ("volume.vtkhdf", "sample.parquet"))
    monkeypatch.setattr(extracts, "MOST_VALUES", 10)
    with pytest.raises(ws.ResourceError, match=r"format: the plane has 20 voxels, as text 10 at most; take it as npy"):
        extracts.slice_content(volume, "z", None, None, None, "json")
    with pytest.raises(ws.ResourceError, match=r"limit: must be at most 5 with 2 columns, of 1000 rows"):
        extracts.table_content(table, "sample", "x,y", 0, None, "json")
    assert extracts.table_content(table, "sample", "x,y", 0, 5, "json")


def test_more_rows_than_come_at_a_time(client, jobs, tmp_path, submit):
    rows = np.arange(400_000.0)
    table = Table({"a": rows, "b": rows, "c": rows})
    Result({"analysis": "workspace", "warnings": []}, tables={"long": table}).save(tmp_path / "out")
    job = submit()["id"]
    jobs.complete(job, tmp_path / "out")
    path = f"/v1/jobs/{job}/tables/long"
    for query in ({}, {"limit": 333_334}, {"format": "csv", "offset": 66_666}):
        problem = problem_of(client.get(path, params=query), 409, "resource_limit")
        assert problem["errors"][0]["pointer"] == "limit" and "at most 333333" in problem["detail"]
    last = client.get(path, params={"offset": 66_667, "columns": "b"}).json()
    assert (last["rows"], last["columns"][0]["values"][-1]) == (400_000, 399_999)


def test_a_table_part_by_part(client, kept):
    path, found = kept
    whole = client.get(f"{path}/tables/sample").json()
    assert (whole["name"], whole["rows"], whole["offset"]) == ("sample", 1000, 0)
    columns = {each["name"]: each for each in whole["columns"]}
    for column, wanted in (
        ("manipulability", found.sample.indices["manipulability"]),
        ("index.x", found.sample.indices["x"]),
        ("y", found.sample.position[:, 1]),
        ("wrist, 'roll'", found.sample.configuration[:, 2]),
    ):
        np.testing.assert_array_equal(columns[column]["values"], wanted.astype(float), column)
    assert (columns["manipulability"]["unit"], columns["y"]["unit"]) == ("m³", "m")
    query = {"offset": 990, "limit": 4, "columns": "\"wrist, 'roll'\",y,index.x"}
    part = client.get(f"{path}/tables/sample", params=query).json()
    assert [each["name"] for each in part["columns"]] == ["wrist, 'roll'", "y", "index.x"] and part["offset"] == 990
    assert part["columns"][1]["values"] == columns["y"]["values"][990:994]
    assert client.get(f"{path}/tables/sample", params={"offset": 10**9}).json()["columns"][0]["values"] == []
    header, rows = rows_of(client.get(f"{path}/tables/sample", params={"format": "csv", "limit": 2, "offset": 1}))
    assert header == list(columns) and len(rows) == 2
    np.testing.assert_array_equal(np.array([row[1] for row in rows], np.float32), found.sample.position[1:3, 1])


def test_tables_hold_text_and_what_is_not_finite(client, kept):
    path, _ = kept
    columns = {each["name"]: each for each in client.get(f"{path}/tables/odd things").json()["columns"]}
    assert {name: each["values"] for name, each in columns.items()} == {
        "value": [1.5, None, None, -2],
        "served": [True, False, True, True],
        "name": ["a", "b, c", "", "µ"],
        "cell_0": [0, 2, 4, 6],
        "cell_1": [1, 3, 5, 7],
    }
    assert columns["value"]["unit"] == "m" and columns["cell_1"]["unit"] == "1"
    header, rows = rows_of(client.get(f"{path}/tables/odd things", params={"format": "csv", "columns": "name,value"}))
    assert (header, rows) == (["name", "value"], [["a", "1.5"], ["b, c", "nan"], ["", "inf"], ["µ", "-2"]])


def test_rows_of_later_row_groups(tmp_path, monkeypatch):
    """Of row groups that are asked for alone."""
    import pyarrow.parquet

    from wsrender.results.export import parquet

    monkeypatch.setattr(parquet, "ROWS_PER_GROUP", 7)
    samples = random_map(50)
    parquet.write_table_parquet(samples, tmp_path / "map.parquet")
    assert pyarrow.parquet.ParquetFile(tmp_path / "map.parquet").num_row_groups == 8
    for start, stop in ((0, 50), (0, 7), (6, 8), (13, 30), (49, 50), (20, 20), (50, 60)):
        rows = parquet.read_rows(tmp_path / "map.parquet", ["z", "x"], start, stop)
        assert rows.column_names == ["z", "x"]
        np.testing.assert_array_equal(rows["z"].to_numpy(), samples.position[start:stop, 2])


def test_what_a_table_does_not_hold(client, kept):
    path, _ = kept
    problem = problem_of(client.get(f"{path}/tables/targets"), 404, "artifact_not_found")
    assert problem["errors"][0]["pointer"] == "table" and sorted(problem["choices"]) == ["odd things", "sample"]
    for columns in ("depth", "", 'x,"y', "x,,y"):
        problem = problem_of(client.get(f"{path}/tables/sample", params={"columns": columns}), 404, "invalid_input")
        assert problem["errors"][0]["pointer"] == "columns"
    for name, query in (
        ("format", {"format": "xml"}),
        ("limit", {"limit": 0}),
        ("limit", {"limit": "many"}),
        ("offset", {"offset": -1}),
    ):
        problem = problem_of(client.get(f"{path}/tables/sample", params=query), 422, "invalid_request")
        assert problem["errors"][0]["pointer"] == name
    problem = problem_of(client.get(f"{path}/volume/slice", params={"index": "isotropy"}), 404, "invalid_input")
    assert problem["errors"][0]["pointer"] == "index"


def test_targets_are_a_table(client, jobs, tmp_path):
    from wsrender.run import execute

    document = job_of("reachability")
    found = execute(document)
    found.save(tmp_path / "out")
    job = client.post("/v1/jobs", json=document).json()
    jobs.complete(job["id"], tmp_path / "out")
    table = client.get(f"/v1/jobs/{job['id']}/tables/targets").json()
    columns = {each["name"]: each["values"] for each in table["columns"]}
    targets = found.tables["targets"]
    assert table["rows"] == len(targets) and len(columns) > 3
    np.testing.assert_allclose(columns["position_2"], targets["position"][:, 2], rtol=1e-6)
    assert columns["label"] == targets["label"].tolist()
    header, rows = rows_of(client.get(f"/v1/jobs/{job['id']}/tables/targets", params={"format": "csv"}))
    assert header == list(columns) and len(rows) == table["rows"]


def test_a_histogram_is_that_of_the_samples(client, kept):
    path, found = kept
    values = found.sample.indices["manipulability"]
    values = values.astype(float)
    got = client.get(f"{path}/histogram").json()
    assert (got["index"], got["unit"], got["samples"]) == ("manipulability", "m³", 1000)
    assert got["mean"] == pytest.approx(values.mean()) and len(got["share"]) == 50
    inside = [((values >= a) & (values < b)).mean() for a, b in zip(got["edges"], got["edges"][1:], strict=False)]
    inside[-1] += (values == got["edges"][-1]).mean()
    np.testing.assert_allclose(got["share"], inside, atol=2e-3)  # values at edges
    assert sum(got["share"]) == pytest.approx(1) and got["below"] == got["above"] == 0
    query = {"index": "x", "bins": 4, "lower": 0.25, "upper": 0.5}
    got = client.get(f"{path}/histogram", params=query).json()
    values = found.sample.indices["x"].astype(float)
    assert got["edges"] == [0.25, 0.3125, 0.375, 0.4375, 0.5]
    assert got["share"] == pytest.approx([((values >= a) & (values < a + 0.0625)).mean() for a in got["edges"][:4]])
    assert (got["below"], got["above"]) == (pytest.approx((values < 0.25).mean()), pytest.approx((values > 0.5).mean()))
    header, rows = rows_of(client.get(f"{path}/histogram", params=query | {"format": "csv"}))
    assert header == ["index", "unit", "lower", "upper", "share"]
    assert [float(row[4]) for row in rows] == got["share"] and rows[0][:4] == ["x", "rad", "0.25", "0.3125"]


def test_the_numbers_of_the_picture(client, finished, result):
    """Those that are saved beside it."""
    header, rows = rows_of(client.get(f"{finished}/histogram", params={"format": "csv"}))
    saved = client.get(f"{finished}/artifacts/plots/histogram.csv")
    assert [header, *rows] == list(csv.reader(io.StringIO(saved.text)))


def test_limits_between_which_nothing_can_be(client, kept):
    path, _ = kept
    for name, query in (("lower", {"lower": 2.0, "upper": 1.0}), ("lower", {"lower": 5.0}), ("upper", {"upper": -5.0})):
        problem = problem_of(client.get(f"{path}/histogram", params=query), 404, "invalid_input")
        assert problem["errors"][0]["pointer"] == name and str(query[name])[:2].strip(".") in problem["detail"]
    problem_of(client.get(f"{path}/histogram", params={"index": "isotropy"}), 404, "invalid_input")
    problem_of(client.get(f"{path}/histogram", params={"bins": 0}), 422, "invalid_request")
    got = client.get(f"{path}/histogram", params={"index": "x", "lower": 0.5, "upper": 0.5}).json()
    assert (got["edges"], got["share"]) == ([0.5, 0.5], [0])


def npz(content):
    return np.load(io.BytesIO(content))["count"]


def mat(content):
    import scipy.io

    return scipy.io.loadmat(io.BytesIO(content))["count"]


def vtkhdf(content):
    import h5py

    with h5py.File(io.BytesIO(content)) as file:
        return file["VTKHDF"]["CellData"]["count"][...].transpose(2, 1, 0)


def vti(content):
    head, _, data = content.partition(b'encoding="raw">_')
    shape = [int(n) for n in head.partition(b'WholeExtent="')[2].partition(b'"')[0].split()[1::2]]
    counts = np.frombuffer(data[8 : 8 + 8 * int(np.prod(shape))], "<i8")
    return counts.reshape(shape, order="F")


def of_rows(table):
    counts = np.zeros((5, 4, 3), int)
    cells = [np.array(table[name], int) - first for name, first in zip("ijk", (-7, 3, 11), strict=True)]
    counts[tuple(cells)] = np.array(table["count"], int)
    centers = [(np.array(table[name], int) + 0.5) * 0.05 for name in "ijk"]
    np.testing.assert_allclose(np.array([table[name] for name in "xyz"], float), centers)
    return counts


def from_csv(content):
    header, *rows = csv.reader(io.StringIO(content.decode()))
    return of_rows(dict(zip(header, zip(*rows, strict=True), strict=True)))


def from_parquet(content):
    import pyarrow.parquet

    return of_rows(pyarrow.parquet.read_table(io.BytesIO(content)).to_pydict())


READ = {"npz": npz, "mat": mat, "vtkhdf": vtkhdf, "vti": vti, "csv": from_csv, "parquet": from_parquet}


def test_volumes_in_every_format_have_the_axes_that_the_description_says(client, kept):
    """Read by programs of others; all axes differ in length, and half of the voxels are empty."""
    path, found = kept
    parameters = client.get("/openapi.json").json()["paths"]["/v1/jobs/{job_id}/volume"]["get"]["parameters"]
    (schema,) = (each["schema"] for each in parameters if each["name"] == "format")
    assert set(schema["enum"]) == set(READ) and schema["default"] == "vtkhdf"
    for format, read in READ.items():
        response = client.get(f"{path}/volume", params={"format": format})
        assert response.status_code == 200, response.text
        assert f"volume.{format}" in response.headers["content-disposition"]
        np.testing.assert_array_equal(read(response.content), found.volume.count, format)
    assert client.get(f"{path}/volume").content == client.get(f"{path}/artifacts/volume.vtkhdf").content
    other = client.get(f"{path}/volume", params={"volume": "left arm", "format": "npz"})
    np.testing.assert_array_equal(npz(other.content), found.volumes["left arm"].count)
    assert other.headers["content-disposition"] == "attachment; filename*=utf-8''left%20arm.npz"  # RFC 6266


def test_formats_that_volumes_do_not_have(client, kept):
    path, _ = kept
    for format in ("stl", "exe", "", "NPZ", "vtk"):
        problem = problem_of(client.get(f"{path}/volume", params={"format": format}), 422, "invalid_request")
        (fault,) = problem["errors"]
        assert fault["pointer"] == "format" and "'mat', 'npz', 'parquet', 'vti' or 'vtkhdf'" in fault["detail"]


def test_cells_of_a_map_are_no_volume(client, jobs, tmp_path, submit):
    """They are VTK files too, of other axes."""
    grid = CellGrid(("x", "y"), (0.0, 0.0), (1.0, 1.0), (2, 2))
    cells = Table({"x": np.zeros(4), "y": np.zeros(4), "value": np.arange(4.0)}, {}, grid)
    Result({"analysis": "workspace", "warnings": []}, tables={"places": cells}).save(tmp_path / "out")
    job = submit()["id"]
    jobs.complete(job, tmp_path / "out")
    assert client.get(f"/v1/jobs/{job}/artifacts/maps/places.vtkhdf").status_code == 200
    for rest in ("volume", "volume/slice", "volume/voxel?x=0&y=0&z=0"):
        path = f"/v1/jobs/{job}/{rest}{'&' if '?' in rest else '?'}volume=maps/places"
        assert problem_of(client.get(path), 404, "artifact_not_found")["errors"][0]["pointer"] == "volume"


LARGE = (
    *("result", "artifacts/sample.parquet", "artifacts/sample.parquet?format=csv", "volume", "volume?format=npz"),
    *("volume/slice", "volume/slice?format=json", "volume/slice?format=csv", "plots/slice", "plots/slice?format=svg"),
    *("tables/sample", "tables/sample?format=csv", "histogram", "view", "view/blobs/volume0.channel0.float16"),
)


@pytest.mark.parametrize("rest", LARGE)
def test_a_download_that_broke_off_goes_on(client, finished, rest):
    """By its entity tag, and only with the same bytes; who has it all is told so."""
    whole = client.get(f"{finished}/{rest}")
    assert whole.status_code == 200, whole.text
    etag, size = whole.headers["etag"], len(whole.content)
    assert whole.headers["accept-ranges"] == "bytes" and size > 60
    got = whole.content[: size // 3]
    for stop in (size // 2, size):
        headers = {"Range": f"bytes={len(got)}-{stop - 1}", "If-Range": etag}
        part = client.get(f"{finished}/{rest}", headers=headers)
        assert (part.status_code, part.headers["etag"]) == (206, etag)
        assert part.headers["content-range"] == f"bytes {len(got)}-{stop - 1}/{size}"
        got += part.content
    assert got == whole.content
    changed = client.get(f"{finished}/{rest}", headers={"Range": "bytes=5-", "If-Range": '"of another"'})
    assert (changed.status_code, changed.content) == (200, whole.content)
    known = client.get(f"{finished}/{rest}", headers={"If-None-Match": etag})
    assert (known.status_code, known.content, known.headers["etag"]) == (304, b"", etag)
    for name in ("cache-control", "vary"):  # RFC 9110, 15.4.5
        assert known.headers.get(name) == whole.headers.get(name)


def test_models_go_on_too(client):
    text = b"<mujoco><worldbody/></mujoco>" + b" " * 3000
    href = client.post("/v1/models", content=text, headers={"Content-Type": "application/xml"}).json()["href"]
    whole = client.get(href)
    assert whole.content == text and whole.headers["content-type"].startswith("application/xml")
    part = client.get(href, headers={"Range": "bytes=100-", "If-Range": whole.headers["etag"]})
    assert (part.status_code, part.content) == (206, text[100:])
    assert client.get(href, headers={"If-None-Match": whole.headers["etag"]}).status_code == 304


def test_answers_keep_to_their_schemas(client, kept):
    jsonschema = pytest.importorskip("jsonschema")
    path, _ = kept
    document = client.get("/openapi.json").json()
    for rest, schema in (
        ("volume/slice?format=json", "SliceView"),
        ("tables/sample", "TableView"),
        ("histogram", "HistogramView"),
    ):
        named = {"$ref": f"#/components/schemas/{schema}", "components": document["components"]}
        validator = jsonschema.Draft202012Validator(named)
        answer = client.get(f"{path}/{rest}").json()
        validator.validate(answer)
        assert set(answer) == set(document["components"]["schemas"][schema]["properties"])
        assert not validator.is_valid({name: value for name, value in answer.items() if name != list(answer)[-1]})
        assert json.loads(json.dumps(answer)) == answer


def test_answers_of_another_form_do_not(client, kept):
    document = client.get("/openapi.json").json()
    of = "/v1/jobs/{job_id}"
    job, found = kept
    x, y, z = (found.volume.origin_m + found.volume.voxel_size_m / 2).tolist()
    for path, table, query in (
        ("volume/slice", "", {"format": "json"}),
        ("volume/slice", "", {"format": "json", "statistic": "count", "axis": "x"}),
        ("tables/{table}", "sample", {}),
        ("tables/{table}", "odd things", {}),
        ("histogram", "", {}),
        ("volume/voxel", "", {"x": x, "y": y, "z": z}),
    ):
        answer = client.get(f"{job}/{path.format(table=table)}", params=query)
        assert answer.status_code == 200, answer.text
        validator = validator_of(document, f"{of}/{path}", "get", 200)
        assert [error.message for error in validator.iter_errors(answer.json())] == []
        for changed in broken(answer.json()):
            assert not validator.is_valid(changed), (path, {*changed})


def test_a_histogram_counts_finite_values(client, submit, jobs, tmp_path):
    samples = random_map(100)
    values = samples.indices["manipulability"]
    values[:40] = np.nan
    Result({"analysis": "workspace", "warnings": []}, sample=samples).save(tmp_path / "out")
    job = submit()
    jobs.complete(job["id"], tmp_path / "out")
    path = f"/v1/jobs/{job['id']}"
    got = client.get(f"{path}/histogram").json()
    assert got["samples"] == 60 and got["mean"] == pytest.approx(values[40:].mean(dtype=np.float64))
    assert sum(got["share"]) == pytest.approx(1) and got["edges"][0] == pytest.approx(values[40:].min())
    assert client.get(f"{path}/plots/histogram").status_code == 200
    values[:] = np.nan
    Result({"analysis": "workspace", "warnings": []}, sample=samples).save(tmp_path / "none")
    job = submit(voxel_size_m=0.06)
    jobs.complete(job["id"], tmp_path / "none")
    problem = problem_of(client.get(f"/v1/jobs/{job['id']}/histogram"), 404)
    assert "finite value of manipulability" in problem["detail"]
    assert client.get(f"/v1/jobs/{job['id']}/plots/histogram").status_code == 200
