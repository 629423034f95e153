"""The table of formats: every row is written and read back, by a program of others where wsrender has no reader."""

import csv
import io
import json
import pickle
import re
from xml.etree import ElementTree

import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.results.export.sample_data import assert_same_map, assert_same_volume, random_map, random_volume
from wsrender.results.export import formats
from wsrender.results.export.cells import cell_arrays, cell_names, cell_units, vector_names
from wsrender.results.export.columns import columns_of
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

POINTS = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]])
MESH = trimesh.creation.box((1, 2, 4)).apply_translation((0.25, 3, -5))
SKELETON = np.cumsum(np.ones((2, 5, 3)), axis=1) * (1, 2, 3)
VOLUME = random_volume((5, 4, 3), vectors=("force", "mean", "mean_x", "torque/2"))
FREE = {"mean_x": "mean_x", "torque/2": "torque_2"}  # how columns of a vector start
MAP = random_map(50)


def triangle():
    ends = np.roll(POINTS, -1, axis=0)
    columns = {"loop": np.zeros(3, int), "kind": np.array(["line"] * 3)}
    columns |= {"x_s": POINTS[:, 0], "y_s": POINTS[:, 1], "x_e": ends[:, 0], "y_e": ends[:, 1]}
    return Table(columns | {name: np.full(3, np.nan) for name in ("x_o", "y_o", "R", "sweep")})


def figure():
    from wsrender.results import drawing

    return drawing.scatter(random_map(5, names=("manipulability",)))


DATA = {
    "table": lambda: MAP,
    "volume": lambda: VOLUME,
    "mesh": lambda: MESH,
    "skeleton": lambda: SKELETON,
    "drawing": triangle,
    "picture": figure,
    "document": lambda: {"analysis": "workspace", "units": {"μ": "m³"}, "values": [1, 0.1, None]},
}


def arrays_and_units(taken):
    """Names, arrays and units of VOLUME as files have them where some names are taken."""
    names, vectors = cell_names(VOLUME, taken), vector_names(VOLUME, taken)
    return dict(cell_arrays(VOLUME, names, vectors)), cell_units(VOLUME, names, vectors)


def same_csv_table(path):
    arrays = columns_of(MAP).arrays(MAP)
    header, *rows = csv.reader(io.StringIO(path.read_text()))
    assert header == list(arrays)
    for name, column in zip(header, zip(*rows, strict=True), strict=True):
        np.testing.assert_array_equal(np.array(column).astype(arrays[name].dtype), arrays[name])


def identifier(name):
    """How MATLAB calls an array: letters, digits and _, not first a digit or _."""
    plain = re.sub(r"[^A-Za-z0-9_]", "_", name)
    return plain if plain[0].isalpha() else f"v_{plain}"


def same_mat(path, arrays, units):
    import scipy.io

    read = scipy.io.loadmat(path)
    for name, array in arrays.items():
        stored = read[identifier(name)]
        assert stored.dtype == array.dtype
        np.testing.assert_array_equal(stored.reshape(array.shape, order="F"), array)
    kept = {field: str(read["units"][field].item()[0]) for field in read["units"].dtype.names}
    assert kept == {identifier(name): unit for name, unit in units.items()}


def same_mat_table(path):
    columns = columns_of(MAP)
    same_mat(path, columns.arrays(MAP), columns.column_units())


def same_mat_volume(path):
    import scipy.io

    same_mat(path, *arrays_and_units({"count", "origin_m", "voxel_size_m"}))
    np.testing.assert_array_equal(scipy.io.loadmat(path)["origin_m"][:, 0], VOLUME.origin_m)


def same_csv_volume(path):
    header, *rows = csv.reader(io.StringIO(path.read_text()))
    same_voxels(header, np.array(rows, dtype=object).T)


def same_parquet_volume(path):
    import pyarrow.parquet

    table = pyarrow.parquet.read_table(path)
    same_voxels(table.column_names, [column.to_numpy() for column in table.columns])
    units = {field.name: field.metadata[b"unit"].decode() for field in table.schema}
    assert (units["i"], units["x"], units["count"], units["force_y"]) == ("1", "m", "samples", "N")
    for (_, index), name in cell_names(VOLUME, {"i", "j", "k", "x", "y", "z", "count"}).items():
        assert units[name] == VOLUME.units.get(index, "1")


def same_voxels(header, columns):
    assert len(set(header)) == len(header) and len(columns[0]) == VOLUME.n_occupied
    read = dict(zip(header, columns, strict=True))
    cells = tuple(read[axis].astype(int) - first for axis, first in zip("ijk", VOLUME.first_voxel, strict=True))
    for axis, name in enumerate("xyz"):
        np.testing.assert_allclose(read[name].astype(float), VOLUME.centers(axis)[cells[axis]], rtol=1e-15)
    np.testing.assert_array_equal(read["count"].astype(int), VOLUME.count[cells])
    for (statistic, index), name in cell_names(VOLUME, set(header[:7])).items():
        array = VOLUME.statistics[statistic][index]
        np.testing.assert_array_equal(read[name].astype(array.dtype), array[cells])
    columns = {"force": ["force_x", "force_y", "force_z"]}
    columns["mean"] = ["array.mean_x", "mean_y", "mean_z"]  # mean_x is the mean of the index x
    columns |= {name: [f"{free}_{axis}" for axis in "xyz"] for name, free in FREE.items()}
    assert header[-12:] == [column for parts in columns.values() for column in parts]
    for vector, parts in columns.items():
        stored, array = np.stack([read[name] for name in parts], axis=1), VOLUME.vectors[vector]
        np.testing.assert_array_equal(stored.astype(array.dtype), array[cells])


def same_vti(path):
    vtk = pytest.importorskip("vtk")
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLImageDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    np.testing.assert_allclose(image.GetOrigin(), VOLUME.origin_m, rtol=1e-15)
    assert image.GetSpacing() == (VOLUME.voxel_size_m,) * 3
    cells = image.GetCellData()
    arrays, units = arrays_and_units({"count"})
    assert [cells.GetArrayName(k) for k in range(cells.GetNumberOfArrays())] == list(arrays)
    for name, array in arrays.items():
        stored = cells.GetArray(name)
        values = vtk_to_numpy(stored)
        assert values.dtype == array.dtype
        assert stored.GetInformation().Get(vtk.vtkDataArray.UNITS_LABEL()) == units[name]
        shape = (*VOLUME.shape[::-1], *array.shape[3:])
        np.testing.assert_array_equal(np.moveaxis(values.reshape(shape), [0, 1, 2], [2, 1, 0]), array)


def same_dxf(path):
    import ezdxf

    lines = ezdxf.readfile(path).modelspace().query("LINE")
    np.testing.assert_array_equal([tuple(line.dxf.start)[:2] for line in lines], POINTS)
    np.testing.assert_array_equal([tuple(line.dxf.end)[:2] for line in lines], np.roll(POINTS, -1, axis=0))


def same_svg_drawing(path):
    data = ElementTree.parse(path).getroot()[0].get("d")
    numbers = [float(number) for number in re.findall(r"-?[\d.]+", data)]
    np.testing.assert_array_equal(np.reshape(numbers, (-1, 2)), [*POINTS, POINTS[0]])


def same_png(path):
    import matplotlib.image

    from wsrender.results import drawing

    expected = matplotlib.image.imread(io.BytesIO(drawing.png(figure())), format="png")
    np.testing.assert_array_equal(matplotlib.image.imread(path), expected)


def same_svg_picture(path):
    root = ElementTree.parse(path).getroot()
    assert root.tag == "{http://www.w3.org/2000/svg}svg" and len(list(root.iter())) > 50


def same_table(read):
    assert_same_map(read, MAP)


def same_volume(read):
    assert_same_volume(read, VOLUME)


def same_mesh(read):
    np.testing.assert_array_equal(read.triangles, MESH.triangles)


def same_skeleton(read):
    np.testing.assert_array_equal(read, SKELETON)


SAME = {"table": same_table, "volume": same_volume, "mesh": same_mesh, "skeleton": same_skeleton}
# How formats are read that wsrender does not read itself.
READ_ELSEWHERE = {
    ("table", "csv"): same_csv_table,  # without units: those stand in the result document
    ("table", "mat"): same_mat_table,
    ("volume", "csv"): same_csv_volume,
    ("volume", "mat"): same_mat_volume,
    ("volume", "parquet"): same_parquet_volume,
    ("volume", "vti"): same_vti,
    ("drawing", "dxf"): same_dxf,
    ("drawing", "svg"): same_svg_drawing,
    ("picture", "png"): same_png,
    ("picture", "svg"): same_svg_picture,
    ("document", "json"): lambda path: json.loads(path.read_text()) == DATA["document"](),
}


@pytest.mark.parametrize("row", formats.table(own=True), ids=lambda row: f"{row.kind}-{row.suffix}")
def test_every_format_is_written_and_read_back(row, tmp_path):
    path = tmp_path / row.file("thing")
    row.write(DATA[row.kind](), path)
    if row.reader is None:
        assert READ_ELSEWHERE[row.kind, row.suffix](path) is not False
        with pytest.raises(ws.InputError, match=rf"thing\.{row.suffix}: wsrender writes .* but does not read them"):
            row.read(path)
        return
    SAME[row.kind](row.read(path))
    nameless = path.rename(tmp_path / "0f3a")  # as a server keeps files
    SAME[row.kind](row.read(nameless))


@pytest.mark.parametrize("shape", [(1, 1, 1), (6, 5, 1), (1, 7, 1), (0, 0, 0)], ids=str)
def test_vti_of_any_shape_has_as_many_bytes_as_it_says(tmp_path, shape, monkeypatch):
    monkeypatch.setattr("wsrender.results.export.cells.CHUNK_BYTES", 64)  # several layers at a time, and a rest
    empty = VolumeData(0.1, (0, 0, 0), np.zeros(shape, np.int64))
    volume = random_volume(shape, vectors=("force",)) if all(shape) else empty
    formats.by_ending("volume", "v.vti").write(volume, tmp_path / "v.vti")
    data = (tmp_path / "v.vti").read_bytes().partition(b'encoding="raw">_')[2]
    for array in (volume.count, *(v for s in volume.statistics.values() for v in s.values()), *volume.vectors.values()):
        size = int(np.frombuffer(data[:8], "<u8")[0])
        assert size == array.nbytes
        axes = (2, 1, 0, 3)[: array.ndim]
        assert data[8 : 8 + size] == np.ascontiguousarray(array.transpose(axes)).tobytes()
        data = data[8 + size :]
    assert data == b"</AppendedData></VTKFile>\n"


def test_volumes_with_their_best_samples_are_rows_too(tmp_path):
    import pyarrow.csv
    import pyarrow.parquet

    best = {"x": np.arange(60).reshape(5, 4, 3)}
    volume = VolumeData(0.1, (0, 0, 0), VOLUME.count, {}, {"x": "m"}, best=best)
    for suffix, read in (("csv", pyarrow.csv.read_csv), ("parquet", pyarrow.parquet.read_table)):
        formats.by_ending("volume", f"v.{suffix}").write(volume, tmp_path / f"v.{suffix}")
        column = read(tmp_path / f"v.{suffix}")["best_sample_x"].to_numpy()
        np.testing.assert_array_equal(column, best["x"][VOLUME.count > 0])


def test_what_files_are_converted_to_is_no_part_of_a_result(tmp_path):
    """A table of the voxels would be read back as one of the result's."""
    result = ws.Result({"analysis": "workspace"}, volume=VOLUME)
    result.save(tmp_path / "out", formats=["parquet"])
    assert not (tmp_path / "out" / "volume.parquet").exists() and not ws.Result.load(tmp_path / "out").tables


def test_the_table_is_one():
    rows = formats.table(own=True)
    assert len({(row.kind, row.suffix) for row in rows}) == len(rows)
    kept = [row.kind for row in rows if row.written == "kept"]
    assert sorted(kept) == ["mesh", "skeleton", "table", "volume"]
    assert len({(row.suffix, row.media_type) for row in rows}) == len(formats.suffixes(rows))
    written = [row.suffix for row in rows if row.written in formats.STORED]
    assert len(set(written)) == len(written)  # so that a file's ending says what it holds
    assert all(row.extra == "engine" for row in rows if row.packages)
    assert pickle.loads(pickle.dumps(rows)) == rows


def test_conversions_are_between_formats_of_one_kind():
    can = {row.suffix: list(formats.others(row)) for row in formats.table(own=True) if row.written in formats.STORED}
    assert can == {
        "parquet": ["npz", "csv", "mat"],
        "vtkhdf": ["npz", "csv", "parquet", "mat", "vti"],
        "glb": ["ply", "stl", "obj"],
        "ply": ["glb", "stl", "obj"],
        **{suffix: [] for suffix in ("npy", "dxf", "svg", "png", "json")},
    }


def row(**facts):
    return ws.Format(**{"suffix": "toy", "kind": "volume", "media_type": "text/x-toy", "writer": json.dump} | facts)


@pytest.mark.parametrize(
    ("facts", "message"),
    [
        ({"suffix": ".toy"}, r"suffix: '\.toy' is not allowed; 1 to 32 of a-z"),
        ({"suffix": "vti"}, "suffix: volumes have a format 'vti' already, wsrender's own"),
        ({"kind": "cloud"}, "kind: 'cloud' is not one of table, volume, mesh"),
        ({"media_type": "toy"}, "media_type: 'toy' is not one; it reads like application/x-npz"),
        ({"suffix": "stl"}, "media_type: .stl files are model/stl, not text/x-toy"),
        ({"written": "always"}, "written: 'always' is for wsrender's own formats"),
    ],
)
def test_rows_that_are_not_allowed_are_refused(facts, message):
    with pytest.raises(ws.InputError, match=message):
        ws.register_format(row(**facts))
    with pytest.raises(ws.InputError, match=r"format: must be a wsrender\.Format, not str"):
        ws.register_format("toy")


def test_a_registered_format_is_asked_for_by_name(tmp_path, monkeypatch):
    monkeypatch.setattr(formats, "_REGISTERED", {})
    result = ws.Result({"analysis": "workspace"}, volume=VOLUME)
    with pytest.raises(ws.InputError, match="formats: 'toy' is not a format that can be added; allowed: npz, csv, mat"):
        result.save(tmp_path / "out", formats=["toy"])
    toy = ws.register_format(row(writer=lambda volume, path: path.write_text(str(volume.shape))))
    result.save(tmp_path / "out", formats=["toy"])
    assert (tmp_path / "out" / "volume.toy").read_text() == "(5, 4, 3)"
    record = next(each for each in result.document["artifacts"] if each["name"] == "volume.toy")
    assert (record["media_type"], record["units"]["force"]) == ("text/x-toy", "N")
    assert not list((tmp_path / "out").glob("surface.toy")) and toy in formats.table()


def test_units_of_arrays_stand_under_the_names_of_the_arrays(tmp_path):
    result = ws.Result({"analysis": "workspace"}, volume=VOLUME)
    result.save(tmp_path / "out")
    (record,) = (each for each in result.document["artifacts"] if each["name"] == "volume.vtkhdf")
    _, units = arrays_and_units({"count"})
    assert record["units"] == units and units["array.mean_x"] == units["torque_2"] == "N"
