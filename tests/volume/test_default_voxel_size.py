"""The default edge of a voxel: sets of known size, and samples that leave no holes."""

import numpy as np
import pytest

import wsrender as ws
from tests.run.simple_robots import gantry, planar_arm
from wsrender.volume.lattice import default_voxel_size, round_to_digits, rounded_up

BOX = np.array([[x, y, z] for x in (0, 0.3) for y in (0, 0.4) for z in (0, 0.2)])
LINEAR = {"indices": ["manipulability", "inverse_condition_number"], "device": "cpu", "refined_volume": None}


@pytest.mark.parametrize(
    ("positions", "measure", "dimension"),
    [(BOX, 0.024, 3), (BOX * [1, 1, 0], 0.12, 2), (BOX * [0, 1, 0], 0.4, 1), (BOX * [1, 1, 1e-6], 0.12, 2)],
    ids=["volume", "area", "length", "nearly flat"],
)
def test_a_voxel_holds_48_samples_or_is_a_hundredth(positions, measure, dimension):
    edge = measure ** (1 / dimension)
    for samples in (1e3, 1e5, 1e12):
        expected = max((48 / samples) ** (1 / dimension), 0.01) * edge
        assert default_voxel_size(positions, samples) == rounded_up(expected, 2)
    assert default_voxel_size(positions) == rounded_up(0.01 * edge, 2)
    assert default_voxel_size(positions, divisions=20) == rounded_up(0.05 * edge, 2)
    assert default_voxel_size(positions, 1) == rounded_up(edge, 2)
    assert default_voxel_size(positions, least=0.123) == 0.13


def test_voxels_of_thin_sets_are_not_too_many():
    """A needle of .3 × .4e-3 × .2e-3 m counts as a cube of .075 m, a helix of no volume alike."""
    assert default_voxel_size(BOX * [1, 1e-3, 1e-3]) == rounded_up(0.25 * 0.3 / 100, 2)
    turn = np.linspace(0, 20, 1000)
    helix = np.stack([0.05 * np.cos(turn), 0.05 * np.sin(turn), turn / 20], axis=1)
    assert 0.0025 <= default_voxel_size(helix) <= 0.004


def test_a_point_counts_as_a_metre_and_has_no_holes():
    point = np.full((100, 3), 0.3)
    assert [default_voxel_size(point, samples) for samples in (10, 1e12)] == [0.01, 0.01]
    assert default_voxel_size(point, 10, divisions=np.inf) == 0.0


@pytest.mark.parametrize(
    ("value", "up", "nearest"),
    [(0.0221, 0.023, 0.022), (0.022, 0.022, 0.022), (0.0996, 0.1, 0.1), (3.01, 3.1, 3.0), (123.0, 130.0, 120.0)],
)
def test_sizes_are_rounded_up(value, up, nearest):
    assert (rounded_up(value, 2), round_to_digits(value, 2)) == (up, nearest)


def size_of(robot, sampling, **options):
    return ws.analyze(robot, sampling, **LINEAR, **options).document["voxel_size_m"]


def test_it_follows_from_the_number_of_samples():
    hull = 0.29 * 0.39 * 0.19
    for count in (1000, 20_000):
        expected = rounded_up((48 * hull / count) ** (1 / 3), 2)
        assert size_of(gantry(), ws.Sobol(count)) == pytest.approx(expected, rel=0.02)
        assert size_of(gantry(), ws.Random(count)) == size_of(gantry(), ws.Sobol(count))


def test_of_a_grid_the_distinct_positions_count():
    """The wrist of the spherical arm does not move the tip: its levels add no position."""
    few, more = (size_of("spherical", ws.Grid([12, 12, 12, wrist, 1, 1])) for wrist in (2, 30))
    assert few == more


def test_on_a_grid_a_voxel_is_no_smaller_than_a_step():
    """5 levels of .39 m are .0975 m apart, where the number of positions alone would give less."""
    assert size_of(gantry(), ws.Grid([200, 5, 200])) == 0.098
    # 2R: a level of the shoulder moves the tip along a chord of its distance from the base.
    q = ws.load_robot(planar_arm().spec.dh).chain
    elbow = np.linspace(q.lower_limits[1], q.upper_limits[1], 100_001)
    distance = np.sqrt(0.5**2 + 0.4**2 + 2 * 0.5 * 0.4 * np.cos(elbow))
    chord = float(np.median(distance)) * 2 * np.sin(2 * np.pi / 19 / 2)
    found = size_of(planar_arm(), ws.Grid([20, 3000]), task=["x", "y"])
    assert found == pytest.approx(chord, rel=0.03)


def test_a_converging_job_keeps_a_hundredth():
    """[WSR] Algorithm 1: the number of samples is not known beforehand."""
    sampling = ws.Converge("manipulability", 10.0, start=3, step=1)
    assert size_of(gantry(), sampling) == rounded_up((0.29 * 0.39 * 0.19) ** (1 / 3) / 100, 2)
