"""Results as objects of pandas, xarray, PyVista and trimesh: the same numbers at the same places, units with them."""

import sys

import numpy as np
import pytest

import wsrender as ws
from wsrender.volume.table import CellGrid, Table
from wsrender.volume.volume_data import VolumeData


@pytest.fixture(scope="module")
def result() -> ws.Result:
    return ws.analyze("ur5e", ws.Sobol(1 << 12), indices=["manipulability"], voxel_size_m=0.2, keep_map=True)


def test_pandas_has_the_columns_with_units(result):
    frame = result.to_pandas()
    assert list(frame)[:3] == ["x", "y", "z"] and len(frame) == len(result.map)
    np.testing.assert_array_equal(frame["manipulability"], result.map.indices["manipulability"])
    assert frame.attrs["units"]["manipulability"] == "m^3" and frame.attrs["units"]["x"] == "m"
    assert "(95 %" in frame.attrs["headline"] and frame.attrs["frame"] == "world"
    assert len(result.to_pandas("sample")) == len(result.sample)


def test_xarray_finds_a_sample_in_its_voxel(result):
    found = result.to_xarray()
    assert found["maximum_manipulability"].attrs == {"units": "m^3", "long_name": "Maximum manipulability"}
    assert {axis: found[axis].attrs["units"] for axis in "xyz"} == {"x": "m", "y": "m", "z": "m"}
    where = found["maximum_manipulability"].argmax(...)
    x, y, z = (float(found[axis][where[axis]]) for axis in "xyz")
    best = np.argmax(result.map.indices["manipulability"])
    np.testing.assert_allclose((x, y, z), result.map.position[best], atol=0.1 + 1e-6)
    assert int(found["count"].sum()) == 1 << 12
    # A sample where nothing is, and one on a voxel's centre.
    place = dict(zip("xyz", result.map.position[7], strict=True))
    assert int(found["count"].sel(place, method="nearest")) > 0


def test_vectors_have_an_axis_of_their_own():
    pushes = np.zeros((2, 3, 4, 3))
    pushes[1, 2, 3] = 1, 2, 3
    volume = VolumeData(0.5, (1, 0, -4), np.ones((2, 3, 4), int), {}, {"force": "N"}, {"force": pushes})
    found = ws.Result({"analysis": "odd"}, volume=volume).to_xarray()
    there = found["force"].sel(x=1.25, y=1.25, z=-0.25)
    assert there.sel(component="z") == 3 and found["force"].attrs["units"] == "N"


def test_a_map_of_cells_has_its_axes():
    y, x = (each.ravel() for each in np.meshgrid([10.5, 11.5, 12.5], [0.1, 0.3], indexing="xy"))
    table = Table(
        {"x_m": x, "yaw_deg": y, "score": 100 * x + y}, {"x_m": "m", "yaw_deg": "deg"},
        CellGrid(("x_m", "yaw_deg"), (0.0, 10.0), (0.2, 1.0), (2, 3)),
    )  # fmt: skip
    result = ws.Result({"analysis": "odd"}, tables={"placements": table, "plain": Table({"x": x})})
    found = result.to_xarray()
    assert found["score"].dims == ("x_m", "yaw_deg") and found["yaw_deg"].attrs["units"] == "deg"
    np.testing.assert_allclose(found["score"], 100 * found["x_m"] + found["yaw_deg"])
    with pytest.raises(ws.InputError, match="no volume or map plain; it holds placements"):
        result.to_xarray("plain")


def test_pyvista_finds_a_sample_in_its_cell(result):
    pytest.importorskip("pyvista", reason="needs PyVista")
    image = result.to_pyvista()
    cells = image.find_containing_cell(result.map.position)
    counts = np.bincount(cells, minlength=image.n_cells)
    np.testing.assert_array_equal(image.cell_data["count"], counts)
    best = np.argmax(result.map.indices["manipulability"])
    assert image.cell_data["maximum_manipulability"][cells[best]] == np.float32(
        result.map.indices["manipulability"][best]
    )
    assert image.user_dict["units"]["maximum_manipulability"] == "m^3"
    surface = result.to_pyvista("surface")
    assert surface.volume == pytest.approx(result.to_trimesh().volume)


def test_trimesh_is_the_surface_of_the_voxels(result):
    mesh = result.to_trimesh()
    assert mesh.is_watertight and mesh.units == "m"
    low, high = result.volume.origin_m, result.volume.origin_m + 0.2 * np.array(result.volume.shape)
    np.testing.assert_allclose(mesh.bounds, [low, high], atol=0.2)


def test_what_is_not_there_is_said(result, monkeypatch):
    with pytest.raises(ws.InputError, match="no table scan; it holds map, sample"):
        result.to_pandas("scan")
    with pytest.raises(ws.InputError, match="no mesh; it holds none"):
        ws.Result({"analysis": "odd"}).to_trimesh()
    for library in ("pandas", "xarray"):
        monkeypatch.setitem(sys.modules, library, None)
        with pytest.raises(ws.MissingExtraError, match=rf"{library} is not installed.*\[data\]"):
            getattr(result, f"to_{library}")()
