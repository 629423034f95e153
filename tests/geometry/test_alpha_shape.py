"""Alpha shapes against closed forms, circumradii against linear algebra, meshes against their tetrahedra."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay

from tests.geometry.solids import BALL, SHELL, TORUS, in_ball, in_shell, in_torus, uniform_points
from wsrender.errors import InputError
from wsrender.geometry import alpha_shape
from wsrender.geometry.alpha_shape import AlphaShape


@pytest.mark.parametrize(
    ("inside", "exact", "surface"),
    [(in_ball, BALL, 4 * np.pi), (in_shell, SHELL, 5 * np.pi), (in_torus, TORUS, 4 * np.pi**2 * 0.7 * 0.25)],
)
def test_volumes_of_solids(inside, exact, surface):
    """Too small by a layer as thick as the spacing of the points, h = (V/N)^(1/3), next to the surface."""
    points = uniform_points(inside, 8000)
    spacing = (exact / len(points)) ** (1 / 3)
    shape = AlphaShape.of(points, 2.5 * spacing)
    mesh = shape.mesh()
    assert mesh.is_volume
    assert mesh.volume == pytest.approx(shape.volume_m3, rel=1e-12)
    assert -0.6 * spacing * surface < mesh.volume - exact < 0
    probes = np.random.default_rng(5).uniform(-1.2, 1.2, (20_000, 3))
    share = shape.contains(probes).mean() * 2.4**3
    assert share == pytest.approx(shape.volume_m3, abs=4 * 2.4**3 * np.sqrt(0.25 / len(probes)))
    assert not shape.contains(probes)[~inside(probes)].sum() > 0.01 * len(probes)


def test_a_large_radius_gives_the_convex_hull():
    points = uniform_points(in_torus, 500)
    assert AlphaShape.of(points, 1e3).volume_m3 == pytest.approx(ConvexHull(points).volume, rel=1e-9)


@pytest.mark.parametrize("radius", [0.06, 0.08])
def test_sparse_points_still_give_a_closed_surface_of_the_same_volume(radius):
    """Such shapes touch themselves along edges and at points."""
    shape = AlphaShape.of(np.random.default_rng(3).random((1500, 3)), radius)
    mesh = shape.mesh()
    assert mesh.is_watertight and mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(shape.volume_m3, rel=1e-12)
    assert mesh.metadata["split_edges"] > 0


def test_two_tetrahedra_that_share_an_edge():
    """The corners 0, 1 are common; the tetrahedra between them are too large."""
    points = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1, 0.3], [0.5, 1, -0.3], [0.5, -1, 0.3], [0.5, -1, -0.3]])
    shape = AlphaShape.of(points, 0.66)
    assert shape.kept.sum() == 2
    mesh = shape.mesh()
    assert mesh.is_watertight
    assert mesh.metadata["split_edges"] == 1
    assert mesh.volume == pytest.approx(2 * 0.6 / 6)
    assert mesh.area == pytest.approx(shape_area(points, [(0, 1, 2, 3), (0, 1, 4, 5)]))


def shape_area(points, tetrahedra):
    area = 0.0
    for corners in tetrahedra:
        for left_out in corners:
            a, b, c = (points[k] for k in corners if k != left_out)
            area += np.linalg.norm(np.cross(b - a, c - a)) / 2
    return area


def test_points_of_a_grid_lie_on_common_spheres():
    """A 1.1 m cube of .1 m cells, each of circumradius .0866 m."""
    points = np.stack(np.meshgrid(*[np.arange(12) * 0.1] * 3), axis=-1).reshape(-1, 3)
    mesh = AlphaShape.of(points, 0.087).mesh()
    assert mesh.is_volume
    assert mesh.body_count == 1
    assert (mesh.volume, mesh.area) == (pytest.approx(1.1**3), pytest.approx(6 * 1.1**2))
    with pytest.raises(InputError, match=r"alpha_shape: 0.07 m is too small; the smallest tetrahedron has 0.0707 m"):
        AlphaShape.of(points, 0.07)


@pytest.mark.parametrize(
    ("points", "alpha", "message"),
    [
        (np.c_[np.random.default_rng(0).random((50, 2)), np.ones(50)], 0.5, "points: are 50 points in a plane"),
        (np.zeros((9, 3)), 0.5, "points: are 9 points in a plane"),
        (0.3 + 1e-16 * np.random.default_rng(0).random((64, 3)), None, "points: are 64 points in a plane"),
        (np.eye(3), 0.5, "points: are 3 points in a plane"),
        (np.zeros((9, 2)), 0.5, r"points: have shape \(9, 2\)"),
        (np.full((9, 3), np.nan), 0.5, "points: have shape"),
        (np.random.default_rng(0).random((50, 3)), 0.0, "alpha_shape: 0.0 is not allowed; a radius above 0"),
        (np.random.default_rng(0).random((50, 3)), np.inf, "alpha_shape: inf is not allowed"),
    ],
)
def test_what_has_no_shape(points, alpha, message):
    with pytest.raises(InputError, match=message):
        AlphaShape.of(points, alpha)


def test_places_in_tetrahedra_are_those_of_scipy(monkeypatch):
    """To rounding; of a grid's flat tetrahedra, and of nearly flat ones, none."""
    grid = np.stack(np.meshgrid(*[np.arange(6.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    nearly = grid + 1e-13 * np.random.default_rng(0).random(grid.shape)
    for points in (np.random.default_rng(1).random((500, 3)), grid, nearly):
        expected = Delaunay(points).transform
        monkeypatch.setattr(alpha_shape, "_in_general_position", lambda points: points)
        found = AlphaShape.of(points).located.transform
        np.testing.assert_array_equal(np.isnan(found), np.isnan(expected))
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9 * np.nanmax(np.abs(expected)))
    assert np.isnan(expected).any() and not np.isnan(expected).all()
