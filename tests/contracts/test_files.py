"""Of every analysis: each picture that its result offers is drawn, each format is written and read back."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import scipy.io
import trimesh
from matplotlib.image import imread

import wsrender as ws
from tests.golden.facts import bits_of
from tests.golden.files import UNSAVED, analyses, golden, saved_folder
from wsrender.indices import KINEMATIC
from wsrender.results.export import read_mesh, read_table_npz, read_volume_npz
from wsrender.results.export.cells import cell_arrays, cell_names, vector_names
from wsrender.results.export.columns import columns_of
from wsrender.volume.volume_data import VolumeData

MESH = ("/vertices", "/faces")
CHOSEN = {"surface"}  # the saved job asks for other surfaces than the golden one
ANALYSES = pytest.mark.parametrize("analysis", analyses())


@ANALYSES
def test_every_picture_is_drawn(analysis, saved):
    """As a file that is not empty paper."""
    offered = golden(analysis)["pictures"]
    drawn = {path.stem for path in (saved(analysis) / "plots").glob("*.png")}
    assert drawn == set(offered)
    for name in offered:
        assert np.ptp(imread(saved(analysis) / "plots" / f"{name}.png")[..., :3]) > 0.5
        assert (saved(analysis) / "plots" / f"{name}.svg").read_text(encoding="utf-8").rstrip().endswith("</svg>")


@ANALYSES
def test_a_saved_result_is_the_result(analysis, saved, local):
    """To the last bit, but for vertices, which PLY holds in float32; a result without meshes gains its surface."""
    result = ws.Result.load(saved(analysis))
    found, expected = bits_of(result), bits_of(local(analysis))
    assert found["document"] == expected["document"]
    for bits in (found, expected):
        bits["arrays"] = {name: each for name, each in bits["arrays"].items() if not name.endswith(MESH)}
    assert found["arrays"] == expected["arrays"]
    for name, mesh in local(analysis).meshes.items():
        np.testing.assert_array_equal(result.meshes[name].faces, mesh.faces)
        np.testing.assert_allclose(result.meshes[name].vertices, mesh.vertices, rtol=1e-7, atol=1e-7)
    assert set(result.meshes) - set(local(analysis).meshes) <= {"surface"}


@ANALYSES
def test_every_format_is_read_back(analysis, saved):
    """Each kind of data in all of its formats: the same numbers as in the one that a result is loaded from."""
    result = ws.Result.load(saved(analysis))
    named = {"map": result.map, "sample": result.sample, "volume": result.volume, **result.tables, **result.volumes}
    read = 0
    for record in result.document["artifacts"]:
        path = saved(analysis) / record["name"]
        data = named.get(path.stem)
        if path.parent == saved(analysis) and data is not None and path.suffix in READERS:
            READERS[path.suffix](path, data, isinstance(data, VolumeData))
            read += 1
        elif path.suffix in (".ply", ".glb", ".stl", ".obj"):
            assert len(trimesh.load_mesh(path).faces) == len(read_mesh(path.with_suffix(".ply")).faces) > 0
        else:
            assert path.suffix in (".png", ".svg", ".dxf", ".npy", ".csv", ".parquet", ".vtkhdf", ".vti"), path
    assert read == 3 * sum(data is not None for data in named.values())


def arrays_of(data, of_volume):
    """Arrays of a table or map by column, of a volume by the name in files; each vector is one."""
    if not of_volume:
        return columns_of(data).arrays(data)
    return dict(cell_arrays(data, cell_names(data, set()), vector_names(data, set())))


def npz(path, data, of_volume):
    found = arrays_of(read_volume_npz(path) if of_volume else read_table_npz(path), of_volume)
    expected = arrays_of(data, of_volume)
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        np.testing.assert_array_equal(found[name], values)


def table_csv(path, data, of_volume):
    """Of a volume a row for each voxel that holds something."""
    arrays = arrays_of(data, of_volume)
    if of_volume:
        held = {name: values[data.count > 0] for name, values in arrays.items()}
        arrays = dict(zip("ijk", (np.argwhere(data.count > 0) + data.first_voxel).T, strict=True))
        arrays |= {axis: (arrays[k] + 0.5) * data.voxel_size_m for k, axis in zip("ijk", "xyz", strict=True)}
        for name, values in held.items():
            parts = zip("xyz", values.T, strict=True) if values.ndim == 2 else ()
            arrays |= {f"{name}_{axis}": part for axis, part in parts} or {name: values}
    with path.open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    assert header == list(arrays)
    for written, values in zip(zip(*rows, strict=True), arrays.values(), strict=bool(rows)):
        if values.dtype.kind in "iuf":
            np.testing.assert_allclose([float(each or "nan") for each in written], values, rtol=1e-6, equal_nan=True)
        else:
            assert [each.lower() for each in written] == [str(value).lower() for value in values]
    assert len(rows) == len(next(iter(arrays.values())))


def mat(path, data, of_volume):
    found, arrays = scipy.io.loadmat(path), arrays_of(data, of_volume)
    about = {"units", "__header__", "__version__", "__globals__", "origin_m", "voxel_size_m"}
    assert found.keys() - about == arrays.keys()
    for name, values in arrays.items():
        if values.dtype.kind in "iuf":
            np.testing.assert_array_equal(found[name] if of_volume else found[name].ravel(), values)
    if of_volume:
        np.testing.assert_array_equal(found["origin_m"].ravel(), data.origin_m)


READERS = {".npz": npz, ".csv": table_csv, ".mat": mat}


@pytest.mark.parametrize("analysis", sorted(set(analyses()) - UNSAVED))
def test_files_are_called_and_described_as_in_0_2(analysis, saved, tmp_path):
    """Names, media types, units and frames of files are what other programs rely on; more may come."""
    before = json.loads((saved_folder("0.2.0", analysis, tmp_path) / "result.json").read_text(encoding="utf-8"))
    now = {record["name"]: record for record in ws.Result.load(saved(analysis)).document["artifacts"]}
    for record in before["artifacts"]:
        if Path(record["name"]).stem not in CHOSEN:
            found = now[record["name"]]
            assert (found["media_type"], found["frame"]) == (record["media_type"], record["frame"])
            assert record["units"].keys() <= found["units"].keys()
            differ = {name for name, unit in record["units"].items() if found["units"][name] != unit}
            assert not {name for name in differ if not _since_0_3(name, before["job"])}


def _since_0_3(name, job):
    """Whether a unit is another since 0.3: that of an index by its joints, of a design's parameter by its field."""
    parameters = {each["name"] for each in job.get("parameters", ())}
    return name in parameters or any(index in name for index in KINEMATIC)
