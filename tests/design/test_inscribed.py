import numpy as np
import pytest

from wsrender.design.inscribed import inscribed_cube_edge, inscribed_sphere_radius
from wsrender.volume.volume_data import VolumeData


def volume(occupied: np.ndarray, size: float = 0.1) -> VolumeData:
    return VolumeData(size, (0, 0, 0), occupied.astype(np.int64), {})


def ball(cells: int, radius: float) -> np.ndarray:
    middles = np.arange(cells) + 0.5 - cells / 2
    x, y, z = np.meshgrid(middles, middles, middles, indexing="ij")
    return x * x + y * y + z * z <= radius**2


def test_the_ball_in_a_ball_of_voxels_is_that_ball():
    """To half a voxel's diagonal."""
    found = inscribed_sphere_radius(volume(ball(41, 18.0)))
    assert found == pytest.approx(1.8, abs=0.1 * np.sqrt(3) / 2)


@pytest.mark.parametrize("edges", [(4, 7, 9), (5, 5, 5), (1, 8, 8)])
def test_the_cube_in_a_box_has_its_least_edge(edges):
    full = np.pad(np.ones(edges, bool), 2)
    assert inscribed_cube_edge(volume(full)) == pytest.approx(0.1 * min(edges))


def test_the_cube_in_random_voxels_is_that_of_a_search_by_hand():
    random = np.random.default_rng(0)
    for share in (0.7, 0.9, 0.97):
        occupied = random.random((9, 10, 11)) < share
        largest = max(
            n
            for n in range(1, 10)
            for i, j, k in np.ndindex(*(np.array(occupied.shape) - n + 1))
            if occupied[i : i + n, j : j + n, k : k + n].all()
        )
        assert inscribed_cube_edge(volume(occupied)) == pytest.approx(0.1 * largest)


def test_nothing_fits_into_an_empty_volume():
    for empty in (None, volume(np.zeros((2, 2, 2)))):
        assert inscribed_sphere_radius(empty) == 0 == inscribed_cube_edge(empty)
