import csv
import io
import time

import h5py
import numpy as np
import pytest
import scipy.io

from tests.results.export.sample_data import assert_same_volume, random_volume
from wsrender.errors import InputError
from wsrender.results.export import (
    cells,
    read_volume_npz,
    read_volume_vtkhdf,
    write_volume_csv,
    write_volume_mat,
    write_volume_npz,
    write_volume_vtkhdf,
)
from wsrender.volume.volume_data import VolumeData

FORMATS = [
    pytest.param(write_volume_vtkhdf, read_volume_vtkhdf, ".vtkhdf", id="vtkhdf"),
    pytest.param(write_volume_npz, read_volume_npz, ".npz", id="npz"),
]
SHAPES = [(5, 4, 3), (6, 5, 1), (1, 7, 1), (1, 1, 1)]


@pytest.mark.parametrize(("write", "read", "suffix"), FORMATS)
@pytest.mark.parametrize("shape", SHAPES, ids=str)
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_volume_is_restored(tmp_path, write, read, suffix, shape, kind):
    volume = random_volume(shape, kind, statistics=("minimum", "maximum", "mean"))
    write(volume, tmp_path / f"volume{suffix}")
    assert_same_volume(volume, read(tmp_path / f"volume{suffix}"))


@pytest.mark.parametrize(("write", "read", "suffix"), FORMATS)
@pytest.mark.parametrize("shape", [(4, 3, 2), (0, 0, 0)], ids=str)
def test_count_alone_is_restored(tmp_path, write, read, suffix, shape):
    volume = VolumeData(0.1, (0, 0, 0), np.ones(shape, np.int64))
    write(volume, tmp_path / f"volume{suffix}")
    assert_same_volume(volume, read(tmp_path / f"volume{suffix}"))


def test_equal_volumes_give_equal_bytes(tmp_path):
    writers = [write_volume_vtkhdf, write_volume_npz, write_volume_csv, write_volume_mat]
    for write in writers:
        write(random_volume((5, 4, 3)), tmp_path / f"a_{write.__name__}")
    time.sleep(2.1)  # HDF5 and MAT files would carry whole seconds, zip files every other
    for write in writers:
        write(random_volume((5, 4, 3)), tmp_path / f"b_{write.__name__}")
        earlier = (tmp_path / f"a_{write.__name__}").read_bytes()
        assert (tmp_path / f"b_{write.__name__}").read_bytes() == earlier


@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_vtk_reads_dimensions_place_and_values(tmp_path, shape):
    vtk = pytest.importorskip("vtk")
    from vtk.util.numpy_support import vtk_to_numpy

    volume = random_volume(shape)
    path = tmp_path / "volume.vtkhdf"
    write_volume_vtkhdf(volume, path)
    reader = vtk.vtkHDFReader()
    assert reader.CanReadFile(str(path))
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    assert image.GetClassName() == "vtkImageData"
    assert image.GetDimensions() == tuple(size + 1 for size in shape)
    np.testing.assert_allclose(image.GetOrigin(), volume.origin_m, rtol=1e-15)
    assert image.GetSpacing() == (volume.voxel_size_m,) * 3
    cells = image.GetCellData()
    assert cells.GetNumberOfArrays() == 1 + 2 * 5
    for (i, j, k), count in np.ndenumerate(volume.count):
        center = [volume.centers(axis)[cell] for axis, cell in enumerate((i, j, k))]
        cell = image.FindCell(center, None, 0, 1e-9, vtk.reference(0), [0] * 3, [0] * 8)
        assert cells.GetArray("count").GetTuple1(cell) == count
    for name, statistic, index in [("mean_x", "mean", "x"), ('maximum_a_b "c", d', "maximum", 'a/b "c", d')]:
        values = vtk_to_numpy(cells.GetArray(name)).reshape(shape[::-1]).T
        np.testing.assert_array_equal(values, volume.statistics[statistic][index])


def test_large_volume_is_written_in_several_chunks(tmp_path, monkeypatch):
    monkeypatch.setattr(cells, "CHUNK_BYTES", 5 * 4 * 8 * 2)
    volume = random_volume((5, 4, 7))
    write_volume_vtkhdf(volume, tmp_path / "volume.vtkhdf")
    with h5py.File(tmp_path / "volume.vtkhdf") as file:
        assert file["VTKHDF/CellData/count"].chunks == (2, 4, 5)
        np.testing.assert_array_equal(file["VTKHDF/CellData/count"][:].T, volume.count)
    assert_same_volume(volume, read_volume_vtkhdf(tmp_path / "volume.vtkhdf"))


def test_units_and_frame_stand_in_the_file(tmp_path):
    write_volume_vtkhdf(random_volume((2, 2, 2)), tmp_path / "volume.vtkhdf")
    with h5py.File(tmp_path / "volume.vtkhdf") as file:
        assert file["VTKHDF"].attrs["frame"] == "world"
        assert file["VTKHDF/CellData/mean_manipulability"].attrs["unit"] == "m³"


def test_csv_lists_the_occupied_voxels(tmp_path):
    volume = random_volume((5, 4, 3))
    write_volume_csv(volume, tmp_path / "volume.csv")
    header, *rows = csv.reader(io.StringIO((tmp_path / "volume.csv").read_text()))
    assert header[:8] == ["i", "j", "k", "x", "y", "z", "count", "maximum_manipulability"]
    assert len(rows) == volume.occupied.sum()
    for row in rows:
        cell = tuple(int(row[axis]) - volume.first_voxel[axis] for axis in range(3))
        assert int(row[6]) == volume.count[cell]
        assert float(row[4]) == pytest.approx(volume.centers(1)[cell[1]])
        assert np.float32(row[7]) == volume.statistics["maximum"]["manipulability"][cell]


def test_mat_holds_arrays_and_place(tmp_path):
    volume = random_volume((5, 4, 3))
    write_volume_mat(volume, tmp_path / "volume.mat")
    content = scipy.io.loadmat(tmp_path / "volume.mat")
    np.testing.assert_array_equal(content["count"], volume.count)
    np.testing.assert_array_equal(content["mean_manipulability"], volume.statistics["mean"]["manipulability"])
    np.testing.assert_allclose(content["origin_m"][:, 0], volume.origin_m)


@pytest.mark.parametrize(("write", "read", "suffix"), FORMATS)
def test_damaged_or_foreign_files_are_refused(tmp_path, write, read, suffix):
    path = tmp_path / f"volume{suffix}"
    write(random_volume((5, 4, 3)), path)
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(InputError, match=path.name):
        read(path)
    path.write_bytes(b"")
    with pytest.raises(InputError, match=path.name):
        read(path)
    with pytest.raises(InputError, match="absent"):
        read(tmp_path / "absent")


def test_foreign_hdf5_is_refused(tmp_path):
    with h5py.File(tmp_path / "volume.vtkhdf", "w") as file:
        file["data"] = 1
    with pytest.raises(InputError, match="cannot be read as volume data"):
        read_volume_vtkhdf(tmp_path / "volume.vtkhdf")


@pytest.mark.parametrize("shape", [(1, 1, 1), (3, 4, 4), (2, 4, 5), (3,), (9, 4, 5), (3, 4, 5, 3)], ids=str)
def test_a_file_whose_arrays_differ_in_shape_is_refused(tmp_path, shape):
    path = tmp_path / "volume.vtkhdf"
    write_volume_vtkhdf(random_volume((5, 4, 3)), path)
    with h5py.File(path, "a") as file:
        cells = file["VTKHDF/CellData"]
        attributes = dict(cells["mean_x"].attrs)
        del cells["mean_x"]
        cells.create_dataset("mean_x", data=np.ones(shape, np.float32)).attrs.update(attributes)
    with pytest.raises(InputError, match=r"volume\.vtkhdf: array 'mean_x' has shape \(.*\), not \(3, 4, 5\)"):
        read_volume_vtkhdf(path)


def test_npz_is_compressed(tmp_path):
    write_volume_npz(VolumeData(0.1, (0, 0, 0), np.zeros((50, 50, 50), np.int64)), tmp_path / "volume.npz")
    assert (tmp_path / "volume.npz").stat().st_size < 20_000  # of a million


def test_arrays_of_another_shape_are_refused():
    count = np.ones((2, 2, 2), int)
    with pytest.raises(InputError, match=r"statistics\.mean\.w: has shape \(2, 2, 1\); the volume has \(2, 2, 2\)"):
        VolumeData(0.1, (0, 0, 0), count, {"mean": {"w": np.zeros((2, 2, 1))}})
    with pytest.raises(InputError, match=r"vectors\.v: has shape"):
        VolumeData(0.1, (0, 0, 0), count, vectors={"v": np.zeros((2, 2, 2))})
