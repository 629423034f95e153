import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.results.export.sample_data import random_volume
from wsrender.errors import InputError
from wsrender.geometry import surfaces
from wsrender.geometry.surfaces import level_surface, occupied_surface
from wsrender.results.export import read_mesh, write_mesh
from wsrender.volume.volume_data import VolumeData


def volume_of(occupied: np.ndarray, first=(3, -4, 10), size=0.02) -> VolumeData:
    return VolumeData(size, first, occupied.astype(np.int64))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.tuples(*[st.integers(1, 6)] * 3), st.floats(0.02, 0.98), st.integers(0, 1000))
def test_any_set_of_voxels_has_a_closed_outward_surface_on_its_bounds(shape, density, seed):
    occupied = np.random.default_rng(seed).random(shape) < density
    occupied.flat[0] = True
    volume = volume_of(occupied)
    mesh = occupied_surface(volume)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert 0 < mesh.volume < occupied.sum() * volume.voxel_size_m**3
    cells = np.argwhere(occupied)
    lower = (np.array(volume.first_voxel) + cells.min(axis=0)) * volume.voxel_size_m
    upper = (np.array(volume.first_voxel) + cells.max(axis=0) + 1) * volume.voxel_size_m
    np.testing.assert_allclose(mesh.bounds, [lower, upper], atol=1e-12)


def test_volume_of_a_ball_is_that_of_its_voxels():
    center = np.arange(-30, 30) + 0.5
    occupied = center[:, None, None] ** 2 + center[:, None] ** 2 + center**2 < 28**2
    mesh = occupied_surface(volume_of(occupied, first=(-30, -30, -30), size=1 / 28))
    assert mesh.volume == pytest.approx(4 / 3 * np.pi, rel=0.01)
    np.testing.assert_allclose(mesh.center_mass, 0, atol=1e-9)


def test_threshold_surface_encloses_the_voxels_near_the_maximum():
    volume = random_volume((6, 6, 6))
    values = volume.statistics["mean"]["x"]
    mesh = occupied_surface(volume, "x", statistic="mean", fraction=0.8)
    above = np.nan_to_num(values) >= 0.8 * np.nanmax(values)
    expected = occupied_surface(volume_of(above, volume.first_voxel, 0.05))
    np.testing.assert_array_equal(mesh.vertices, expected.vertices)


def test_index_that_is_zero_everywhere_has_the_occupied_surface():
    occupied = np.ones((2, 2, 2), bool)
    volume = VolumeData(0.1, (0, 0, 0), occupied.astype(int), {"maximum": {"w": np.zeros((2, 2, 2))}})
    np.testing.assert_array_equal(occupied_surface(volume, "w").vertices, occupied_surface(volume).vertices)


@pytest.mark.parametrize("suffix", ["ply", "glb", "stl"])
def test_files_are_deterministic_and_in_world_metres(tmp_path, suffix):
    mesh = occupied_surface(random_volume((4, 5, 3)))
    write_mesh(mesh, tmp_path / f"a.{suffix}")
    write_mesh(occupied_surface(random_volume((4, 5, 3))), tmp_path / f"b.{suffix}")
    assert (tmp_path / f"a.{suffix}").read_bytes() == (tmp_path / f"b.{suffix}").read_bytes()
    read = read_mesh(tmp_path / f"a.{suffix}")
    read.merge_vertices()  # STL has three for every triangle
    assert read.is_watertight
    np.testing.assert_allclose(read.bounds, mesh.bounds, rtol=1e-6)
    assert read.volume == pytest.approx(mesh.volume, rel=1e-5)


def test_surface_with_too_many_faces_is_coarsened_around_all_voxels(monkeypatch):
    monkeypatch.setattr(surfaces, "MAX_VOXEL_FACES", 200)
    volume = random_volume((9, 8, 7))
    mesh = occupied_surface(volume)
    assert mesh.is_watertight
    assert mesh.metadata["voxel_size_m"] in (0.1, 0.2, 0.4)
    cells = np.argwhere(volume.occupied)
    lower = volume.origin_m + cells.min(axis=0) * 0.05
    assert (mesh.bounds[0] <= lower + 1e-12).all()
    assert (mesh.bounds[1] >= volume.origin_m + (cells.max(axis=0) + 1) * 0.05 - 1e-12).all()


def test_errors_name_the_fault(tmp_path):
    volume = random_volume((3, 3, 3))
    with pytest.raises(InputError, match="no maximum of 'speed'; it holds"):
        occupied_surface(volume, "speed")
    with pytest.raises(InputError, match=r"fraction: is 1\.5"):
        occupied_surface(volume, "x", fraction=1.5)
    with pytest.raises(InputError, match="no occupied voxel"):
        occupied_surface(volume_of(np.zeros((2, 2, 2))))
    with pytest.raises(InputError, match=r"must end in \.glb, \.ply, \.stl or \.obj"):
        write_mesh(occupied_surface(volume), tmp_path / "mesh.off")


def ball_of_values(size=0.1, half=8):
    centers = (np.arange(-half, half) + 0.5) * size
    x, y, z = np.meshgrid(centers, centers, centers, indexing="ij")
    values = 1 - np.sqrt(x**2 + y**2 + z**2)
    return VolumeData(size, (-half,) * 3, np.ones(values.shape, int)), values


def test_a_level_lies_where_values_have_it_not_on_the_steps_of_voxels():
    volume, values = ball_of_values()
    mesh = level_surface(volume, values, 0.5)
    assert mesh.is_watertight and mesh.volume > 0
    assert np.abs(np.linalg.norm(mesh.vertices, axis=1) - 0.5).max() < 0.08 * volume.voxel_size_m


def test_a_level_ends_on_the_faces_of_voxels_beside_empty_ones():
    volume, values = ball_of_values()
    values[8:] = np.nan  # cut at x = 0
    mesh = level_surface(volume, values, 0.5)
    assert mesh.is_watertight and mesh.bounds[1, 0] == pytest.approx(0, abs=1e-12)
    alone = np.full((3, 3, 3), 0.1)
    alone[1, 1, 1] = 1.0
    (extent,) = {round(each, 9) for each in level_surface(VolumeData(0.1, (0, 0, 0), alone > 0), alone, 1.0).extents}
    assert extent > 0.1 * 0.02  # the largest value is in sight
    with pytest.raises(InputError, match="level: is 2, above every value"):
        level_surface(volume, values, 2.0)
