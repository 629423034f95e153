"""Shapes as triangles: closed, outward, where the shape is."""

import numpy as np
import pytest
import trimesh

import wsrender as ws
from tests.world.test_distances import LENGTH, RADIUS, SHAPES
from wsrender.world.distances import NearestShape
from wsrender.world.triangles import foot, plate, triangles

LOWER, UPPER = np.array([-1.0, -2.0, 0.0]), np.array([1.0, 2.0, 3.0])
VOLUMES = {
    "sphere": 4 / 3 * np.pi * RADIUS**3,
    "box": 0.024,
    "mesh": 0.024,
    "cylinder": np.pi * RADIUS**2 * LENGTH,
    "capsule": np.pi * RADIUS**2 * (LENGTH + 4 / 3 * RADIUS),
}


@pytest.mark.parametrize("name", SHAPES)
def test_triangles_are_the_surface_of_the_shape(name):
    shape, _ = SHAPES[name]
    solid = trimesh.Trimesh(*triangles(shape), process=False)
    assert solid.is_watertight
    assert 0.98 * VOLUMES[name] < solid.volume < VOLUMES[name] * (1 + 1e-9)  # flat sides are inside of round ones
    nearest = NearestShape([shape])
    assert np.abs([nearest.at(vertex)[0] for vertex in solid.vertices]).max() < 1e-6


def test_a_plate_along_the_axes_is_as_large_as_the_picture():
    solid = trimesh.Trimesh(*plate(ws.HalfSpace(point_m=(5, 5, 0.25)), LOWER, UPPER), process=False)
    assert solid.is_watertight and solid.volume > 0
    np.testing.assert_allclose(solid.bounds, [[-1, -2, 0.25 - 0.016], [1, 2, 0.25]])


def test_a_tilted_plate_covers_the_picture():
    half_space = ws.HalfSpace(point_m=(0, 0, 1), normal=(0.5, -1, 2))
    solid = trimesh.Trimesh(*plate(half_space, LOWER, UPPER), process=False)
    normal = np.array([0.5, -1, 2]) / np.linalg.norm([0.5, -1, 2])
    heights = (solid.vertices - [0, 0, 1]) @ normal
    assert heights.max() == pytest.approx(0, abs=1e-12) and heights.min() == pytest.approx(-0.016)
    for point in np.random.default_rng(0).uniform(LOWER, UPPER, (200, 3)):
        on_plane = foot(half_space, point)
        assert (on_plane - [0, 0, 1]) @ normal == pytest.approx(0, abs=1e-12)
        assert np.cross(point - on_plane, normal) == pytest.approx(0, abs=1e-12)
        depth = np.einsum("ij,ij->i", on_plane - 0.008 * normal - solid.triangles[:, 0], solid.face_normals)
        assert depth.max() < 0  # inside of every face
