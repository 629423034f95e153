"""Primitives fitted to points and normals in a turned and shifted frame."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from wsrender.geometry.spatial.grown_patches import refined
from wsrender.geometry.spatial.surfaces import Primitive, PrimitiveSurface, best_fit

R, SHIFT = Rotation.from_euler("xyz", [0.3, -1.1, 2.0]).as_matrix(), np.array([0.3, -2.0, 1.0])
U, V = np.random.default_rng(1).uniform(0, 2, (2, 200))
Z = np.array([0.0, 0.0, 1.0])
OFF = np.array([0.01, -0.02, 0.01])
RADIAL = np.stack([np.cos(U), np.sin(U), 0 * U], axis=1)


def fitted(points, normals, tolerance=1e-12):
    return best_fit(points @ R.T + SHIFT, normals @ R.T, tolerance)


def around(v):
    """Directions in the half-plane of the axis at angle v."""
    return RADIAL * np.cos(v)[:, None] + Z * np.sin(v)[:, None]


KINDS = pytest.mark.parametrize(
    ("kind", "points", "normals", "numbers"),
    [
        ("plane", np.stack([U, V, 0 * U], axis=1), np.tile(Z, (200, 1)), {}),
        ("sphere", 2 * around(V), around(V), {"radius": 2}),
        ("cylinder", 1.5 * RADIAL + V[:, None] * Z, RADIAL, {"radius": 1.5}),
        (
            "cone",
            V[:, None] * (RADIAL * np.sin(0.4) + Z * np.cos(0.4)),
            RADIAL * np.cos(0.4) - Z * np.sin(0.4),
            {"half_angle": 0.4},
        ),
        ("torus", 2 * RADIAL + 0.5 * around(V), around(V), {"radius": 2, "tube_radius": 0.5}),
        # Across its own axis: both sides of the tube.
        ("torus", 0.2 * RADIAL + 0.5 * around(3 * V), around(3 * V), {"radius": 0.2, "tube_radius": 0.5}),
    ],
)


@KINDS
def test_each_kind_is_found_with_its_numbers(kind, points, normals, numbers):
    fit = fitted(points, normals)
    assert fit.primitive.kind == kind and fit.exact(1e-12)
    for name, value in numbers.items():
        assert getattr(fit.primitive, name) == pytest.approx(value, abs=1e-12)
    if kind in ("sphere", "cone", "torus"):
        assert fit.primitive.point == pytest.approx(SHIFT, abs=1e-11)
    if fit.primitive.axis is not None:
        assert np.abs(fit.primitive.axis @ R @ Z) == pytest.approx(1, abs=1e-12)
    distance, gradient = fit.primitive.distance(points @ R.T + SHIFT + 1e-3 * normals @ R.T)
    assert np.abs(distance) == pytest.approx(1e-3, abs=1e-12)
    assert np.abs((gradient * (normals @ R.T)).sum(axis=1)) == pytest.approx(1, abs=1e-9)


@KINDS
def test_least_squares_find_each_kind_from_beside_it(kind, points, normals, numbers):
    found = fitted(points, normals).primitive
    beside = replace(found, point=found.point + OFF, **{name: 1.02 * numbers[name] for name in numbers})
    if found.axis is not None:
        axis = found.axis + OFF
        beside = replace(beside, axis=axis / np.linalg.norm(axis))
    again = refined(beside, points @ R.T + SHIFT)
    assert np.abs(again.distance(points @ R.T + SHIFT)[0]).max() < 1e-12
    for name, value in numbers.items():
        assert getattr(again, name) == pytest.approx(value, abs=1e-11)


def test_lines_meet_a_surface_where_it_is_and_not_where_they_run_along_it():
    plane = PrimitiveSurface(Primitive("plane", np.zeros(3), Z))
    origin, slanted = np.array([[5.0, 0, 0.1], [0, 0, 0.1]]), np.array([0, 0.6, 0.8])
    met = plane.meet(origin, np.array([slanted, [1.0, 0, 0]]), np.zeros((2, 3)))
    assert met.s[0] == pytest.approx(-0.125) and met.normal[0] == pytest.approx(Z)
    assert np.isnan(met.s[1]) and np.isnan(met.normal[1]).all()


def test_a_hyperboloid_is_none_of_them():
    points = RADIAL * np.sqrt(1 + V**2)[:, None] + V[:, None] * Z
    normals = RADIAL * np.sqrt(1 + V**2)[:, None] - V[:, None] * Z
    fit = fitted(points, normals / np.linalg.norm(normals, axis=1, keepdims=True))
    assert not fit.exact(1e-6) and fit.residual > 1e-3


def test_points_of_a_plane_with_other_normals_are_no_plane():
    points = np.column_stack([np.zeros(200), U, V])
    fit = fitted(points, np.column_stack([np.cos(V), np.sin(V), 0 * V]))
    assert not fit.exact(1e-9)


def test_a_few_points_say_nothing():
    assert fitted(np.eye(3), np.tile(Z, (3, 1))) is None
