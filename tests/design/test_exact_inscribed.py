import numpy as np
import pytest

from tests.mechanisms.ball_regions import moved, random_region, region, six_pus
from wsrender.design.inscribed import (
    CUBE_ERROR,
    SPHERE_ERROR,
    inscribed_cube_edge,
    inscribed_sphere_radius,
    largest_ball,
    largest_cube,
)
from wsrender.documents.robot import Transform
from wsrender.volume.volume_data import VolumeData

HERE = np.eye(4)
BOX = {"lower": (0, 0, 0), "upper": (1, 1, 1)}
FAR = [(9, 9, 9, 1)]


@pytest.mark.parametrize(
    ("area", "radius", "half_edge"),
    [
        (region([(1, 2, 3, 2)]), 2, 2 / np.sqrt(3)),
        (region([(0, 0, 0, 1)], [(0, 0, 0, 0.4)]), (1 - 0.4) / 2, None),
        (region(outside=FAR, lower=(0, 0, 0), upper=(1, 2, 3)), 0.5, 0.5),
        (region([(0, 0, 0, 1), (1, 0, 0, 1)]), 0.5, (np.sqrt(10) - 1) / 6),  # (1/2 + a)² + 2 a² = 1
        # A ball about a corner of a box: the cube in the opposite corner, its own corner on the sphere.
        (region(outside=[(0, 0, 0, 0.8)], **BOX), None, (1 - 0.8 / np.sqrt(3)) / 2),
        # About the middle of an edge: higher than half the box, so that its own edge is next: √2 (1 − e) = ρ.
        (region(outside=[(0, 0, 0.5, 0.6)], **BOX), None, (1 - 0.6 / np.sqrt(2)) / 2),
        # About the middle of a face: a cube before it, 1 − ρ.
        (region(outside=[(0, 0.5, 0.5, 0.3)], **BOX), None, (1 - 0.3) / 2),
    ],
)
def test_closed_forms(area, radius, half_edge):
    for largest, expected in ((largest_ball, radius), (largest_cube, half_edge)):
        found = largest(area, HERE)
        if expected is not None:
            assert found.size == pytest.approx(expected, rel=1e-9)
            assert expected <= found.at_most <= 1.1 * expected


@pytest.mark.parametrize("seed", [1, 2, 3, 5, 8])
def test_what_is_found_fits_and_touches(seed):
    """All points of its surface lie in the region, and of one a thousandth larger not all do."""
    area, points = random_region(seed), np.random.default_rng(seed).normal(size=(40_000, 3))
    shapes = {
        largest_ball: points / np.linalg.norm(points, axis=1)[:, None],
        largest_cube: points / np.abs(points).max(axis=1)[:, None],
    }
    corners = np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
    for largest, shape in shapes.items():
        found = largest(area, HERE)
        around = np.concatenate([shape, corners]) if largest is largest_cube else shape
        assert area.contains(found.center + (1 - 1e-9) * found.size * around).all()
        assert not area.contains(found.center + 1.001 * found.size * around).all()
        assert found.size <= found.at_most


def test_the_published_six_pus_against_its_voxels():
    area, size = six_pus(), 0.02
    low, high = np.array([-1.0, -1.0, 1.2]), np.array([1.0, 1.0, 2.6])
    counts = np.round((high - low) / size).astype(int)
    centers = low + (np.argwhere(np.ones(counts)) + 0.5) * size
    volume = VolumeData(size, (0, 0, 0), area.contains(centers).reshape(counts).astype(np.int64), {})
    ball, cube = largest_ball(area, HERE), largest_cube(area, HERE)
    assert inscribed_sphere_radius(volume) == pytest.approx(ball.size, abs=SPHERE_ERROR * size)
    assert inscribed_cube_edge(volume) == pytest.approx(2 * cube.size, abs=CUBE_ERROR * size)
    assert max(ball.at_most / ball.size, cube.at_most / cube.size) < 1.003
    for found in (ball, cube):  # the digits beyond would depend on the number of threads
        assert float(f"{found.size:.10g}") == found.size


def test_sizes_follow_the_scale_and_the_place_in_the_world():
    """A ball is as large however the base stands, a cube is not: its faces stay along the world's axes."""
    area = six_pus()
    for largest in (largest_ball, largest_cube):
        scaled = largest(moved(area, [3.0, -2.0, 1.0], 0.01), HERE)
        assert scaled.size == pytest.approx(0.01 * largest(area, HERE).size, rel=1e-6)
    turned = Transform(position_m=(1, 2, 3), euler_xyz_deg=(10, 20, 30)).matrix()
    ball, there = largest_ball(area, HERE), largest_ball(area, turned)
    assert there.size == pytest.approx(ball.size, rel=1e-6)
    np.testing.assert_allclose(there.center, turned[:3, :3] @ ball.center + turned[:3, 3], atol=1e-4)
    box = region(outside=FAR, **BOX)
    quarter = Transform(euler_xyz_deg=(0, 0, 45)).matrix()  # a square of edge e holds one turned by 45° of e / √2
    assert 2 * largest_cube(box, quarter).size == pytest.approx(1 / np.sqrt(2), rel=1e-9)


def test_nothing_fits_into_an_empty_region():
    for area in (region([(0, 0, 0, 1), (3, 0, 0, 1)]), region([(0, 0, 0, 1)], [(0, 0, 0, 1.2)])):
        assert largest_ball(area, HERE) is None and largest_cube(area, HERE) is None
