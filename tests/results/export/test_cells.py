"""Maps over coordinates as VTKHDF: VTK's own reader finds every cell where it stands, with its values and units."""

import h5py
import numpy as np
import pytest

from wsrender.results.export.vtkhdf import write_cells_vtkhdf
from wsrender.volume.table import CellGrid, Table

GRIDS = {
    "plan": (("x_m", "y_m"), (-1.0, 0.5), (0.1, 0.25), (4, 3)),
    "elevation": (("x_m", "z_m"), (2.0, -0.5), (0.5, 0.2), (2, 5)),
    "turned": (("y_m", "yaw_deg"), (0.0, -15.0), (0.3, 30.0), (3, 4)),
    "one": (("yaw_deg",), (10.0,), (5.0,), (6,)),
    "space": (("x_m", "y_m", "z_m"), (0.0, 1.0, 2.0), (0.1, 0.2, 0.3), (2, 3, 4)),
}
AT = {"plan": (0, 1), "elevation": (0, 2), "turned": (1, 0), "one": (0,), "space": (0, 1, 2)}


@pytest.mark.parametrize("name", GRIDS)
def test_cells_stand_where_the_table_has_them(name, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    axes, origin, step, shape = GRIDS[name]
    numbers = np.indices(shape).reshape(len(shape), -1)
    centers = np.array(origin)[:, None] + (numbers + 0.5) * np.array(step)[:, None]
    served, wide = np.arange(numbers.shape[1]), np.arange(2 * numbers.shape[1]).reshape(-1, 2) / 7
    columns = dict(zip(axes, centers, strict=True)) | {"served": served, "wide": wide, "name": served.astype(str)}
    path = tmp_path / "map.vtkhdf"
    write_cells_vtkhdf(Table(columns, {"served": "m", "x_m": "m"}, CellGrid(axes, origin, step, shape)), path)
    grid = pyvista.read(path)
    assert grid.n_cells == len(served) and set(grid.cell_data.keys()) == {"served", "wide"}
    found = grid.cell_centers().points
    expected = np.zeros((len(served), 3))
    expected[:, AT[name]] = centers.T
    order = grid.cell_data["served"]
    assert sorted(order) == served.tolist()
    np.testing.assert_allclose(found, expected[order], atol=1e-6)
    np.testing.assert_allclose(grid.cell_data["wide"], wide[order])
    with h5py.File(path) as file:
        assert file["VTKHDF/CellData/served"].attrs["unit"] == "m" and file["VTKHDF"].attrs["frame"] == "world"


def test_equal_maps_are_equal_files(tmp_path):
    table = Table({"x_m": np.arange(3.0), "served": np.arange(3)}, {}, CellGrid(("x_m",), (0.0,), (1.0,), (3,)))
    for name in "ab":
        write_cells_vtkhdf(table, tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
