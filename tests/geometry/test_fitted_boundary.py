"""Boundaries of arms with more than three joints, fitted, against closed forms and the critical sets of equal arms."""

from collections import Counter

import numpy as np
import pytest
from scipy.optimize import minimize

import wsrender as ws
from tests.geometry.spatial_arms import BOX, SCARA, SPHERICAL, arm_of, boundary_of, robot, scara, sliding, turning
from wsrender.geometry.spatial.cells import CellLattice
from wsrender.geometry.spatial.critical_sets import NONE, CrossedSurfaces
from wsrender.geometry.spatial.grown_patches import best_refined_fit, grown_patches
from wsrender.geometry.spatial.spatial_boundary import TOLERANCE, fitted_boundary
from wsrender.reach.moving_joints import moving_joints
from wsrender.reach.reached_points import ReachedPoints
from wsrender.reach.volume_refinement import refined_volume

PI = np.pi


def fitted(subject, cells):
    chain = moving_joints(subject.chain)[0]
    return fitted_boundary(arm_of(subject), ReachedPoints(chain), cells, lambda points: None)


def kinds(found):
    return Counter(patch.kind for patch in found.patches)


def sizes(found):
    """Kind, radius, half angle and area of each patch, in order."""
    return sorted(
        (patch.kind, patch.fit.primitive.radius, patch.fit.primitive.half_angle, float(area))
        for patch, area in zip(found.patches, found.measures.areas, strict=True)
    )


@pytest.mark.parametrize(
    ("longer", "equal"),
    [
        # Its slide of 2 … 4 m in two of 1 … 2 m each.
        (robot([*SPHERICAL[:2], sliding(1, 2, alpha_deg=90), sliding(1, 2)], "spherical"), robot(SPHERICAL, "equal")),
        (robot([*SCARA[:2], sliding(0.1, 0.2), sliding(0.1, 0.2)], "scara", "standard"), scara()),
    ],
    ids=["spherical", "scara"],
)
def test_a_slide_in_two_parts_has_the_patches_of_one(longer, equal):
    found, expected = fitted(longer, 24), boundary_of(equal, 24)
    assert kinds(found) == kinds(expected)
    for one, other in zip(sizes(found), sizes(expected), strict=True):
        assert one[0] == other[0]
        assert one[1:3] == pytest.approx(other[1:3], abs=1e-5)
        assert one[3] == pytest.approx(other[3], rel=1e-4)
    assert all(patch.method == "fitted" and patch.sets == () for patch in found.patches)
    assert max(patch.fit.residual for patch in found.patches) <= 8 * TOLERANCE * found.arm.size
    assert found.measures.volume == pytest.approx(expected.volume, rel=1e-5)
    assert (len(found.edges), len(found.corners)) == (12, 8)
    assert sorted(edge.length for edge in found.edges) == pytest.approx(
        sorted(edge.length for edge in expected.edges), rel=1e-4
    )


def test_a_box_grown_by_a_disc():
    """Six planes and four quarters of cylinders, which touch the planes: those edges are known to a cell only."""
    tool = np.eye(4)
    tool[0, 3] = r = 0.05
    found = fitted(robot([*BOX, turning()], "grown", tool=tool), 24)
    assert kinds(found) == {"plane": 6, "cylinder": 4}
    radii = [patch.fit.primitive.radius for patch in found.patches if patch.kind == "cylinder"]
    assert radii == pytest.approx([r] * 4, abs=1e-5)
    a, b, length = 0.3, 0.4, 0.7
    base = a * b + 2 * r * (a + b) + PI * r**2
    assert found.measures.volume == pytest.approx(length * base, rel=2e-3)
    assert found.measures.areas.sum() == pytest.approx(2 * base + length * (2 * (a + b) + 2 * PI * r), rel=5e-3)


def test_ur5e_is_a_sphere_where_it_is_one_and_of_other_surfaces_at_its_axis():
    """The first two axes meet: where the arm reaches farthest it turns about both, but not to the first axis."""
    subject = ws.load_robot("ur5e")
    found = fitted(subject, 32)
    sphere = found.patches[0]
    assert sphere.kind == "sphere"
    farthest = -min(
        minimize(lambda q: -_from_shoulder(subject, q), start, method="BFGS", tol=1e-12).fun
        for start in ([0.1, 0.2, 0.3], [0.1, 2.0, -1.0], [-0.1, -1.0, 1.0], [0.0, -1.5, 3.0])
    )
    assert sphere.fit.primitive.radius == pytest.approx(farthest, abs=1e-6)
    assert sphere.fit.primitive.point == pytest.approx([0, 0, 0.1625], abs=1e-6)
    forms = [patch for patch in found.patches if patch.kind == "free_form"]
    assert forms and max(patch.fit.residual for patch in forms if patch.fit) > 1e3 * TOLERANCE
    volume, _ = refined_volume(subject.chain, 0.005)
    error = found.measures.volume_error
    assert volume.low - error <= found.measures.volume <= volume.high + error


def _from_shoulder(subject, q):
    pose = subject.forward_kinematics(np.array([[0, 0, *q, 0]]))
    return float(np.linalg.norm(pose[0, :3, 3] - [0, 0, 0.1625]))


def test_points_with_errors_are_fitted_by_least_squares():
    rng = np.random.default_rng(3)
    u, v = rng.uniform(0, 0.8, (2, 300))
    normal = np.column_stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)])
    ring = np.column_stack([np.cos(u), np.sin(u), 0 * u])
    points = 2 * ring + 0.5 * normal + 1e-7 * rng.normal(size=(300, 3))
    turned = normal + 3e-4 * rng.normal(size=(300, 3))
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    fit = best_refined_fit(points, turned, 2e-6)
    assert fit.primitive.kind == "torus" and fit.residual < 1e-6
    assert (fit.primitive.radius, fit.primitive.tube_radius) == pytest.approx((2, 0.5), abs=1e-5)


def crossed(reaches, gradient, box):
    """The crossings of a surface with a lattice of 16 cells, its normals, the loops of its cells and their width."""
    lattice = CellLattice.around(-box, box, 16, reaches, lambda points: None)
    found = lattice.crossings(reaches, lambda points: None)
    points = (found.inside + found.outside) / 2
    normals = gradient(points)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    surfaces = CrossedSurfaces(np.full(len(points), NONE), points, normals, np.zeros((len(points), 3)))
    return surfaces, lattice.loops(found), lattice.width


@pytest.mark.parametrize(("height", "tolerance"), [(0.95, 1e-4), (0.99, 2e-5)])
def test_a_surface_that_leaves_primitives_slowly_is_a_free_form(height, tolerance):
    """An ellipsoid of revolution: without the rule of eight tolerances it falls into bands of tori and spheres."""
    axes = np.array([1, 1, height])
    surfaces, loops, width = crossed(lambda x: ((x / axes) ** 2).sum(axis=1) <= 1, lambda x: x / axes**2, axes)
    (patch,), _, _ = grown_patches(surfaces, loops, tolerance, width)
    assert patch.kind == "free_form" and patch.fit.residual > 8 * tolerance


def test_a_surface_that_is_nearly_a_torus_is_not_forced():
    """An ellipsoid of revolution is farther from every primitive than the tolerance."""
    rng = np.random.default_rng(5)
    u, v = rng.uniform(0, 1, (2, 400))
    points = np.column_stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), 0.8 * np.sin(v)])
    normal = points / np.array([1, 1, 0.64])
    fit = best_refined_fit(points, normal / np.linalg.norm(normal, axis=1, keepdims=True), 2e-6)
    assert fit.residual > 1e-4
