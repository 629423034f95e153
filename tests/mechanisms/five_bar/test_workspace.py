"""Workspace, loci and aspects against closed forms, and against dense lattices labelled by SciPy."""

import math

import numpy as np
import pytest
from scipy import ndimage

from wsrender.mechanisms.five_bar import WORKING_MODES, FiveBar, conditioning, workspace
from wsrender.mechanisms.five_bar.aspects import aspects
from wsrender.mechanisms.five_bar.isotropy import isotropic_b, isotropic_points
from wsrender.mechanisms.five_bar.loci import angle_curves, end_point, least_kappa_a_curves, pieces, type_2_curves

CB = FiveBar.symmetric(6.0, 8.0, 5.0)
LIMITED = FiveBar(1.0, (0.7, 0.9), (1.2, 0.8), ((-1.0, 2.0), None))
RANDOM = np.random.default_rng(11).uniform(0.3, 2.0, (6, 5))
DESIGNS = [
    CB,
    LIMITED,
    FiveBar(1.1, (0.9, 1.3), (1.4, 1.1), ((0.2, 4.0), (-1.0, 5.0))),
    FiveBar.symmetric(4.0, 6.0, 2.0),  # the coupler of length 2 L2 = L0 makes a parallelogram
    FiveBar.symmetric(1.0, 1.5, 1.5),  # legs that fold onto their base points
    FiveBar(7.0, (8.0, 1.0), (4.0, 6.0)),  # circles that touch
    *(FiveBar(base, (a, c), (b, d)) for base, a, b, c, d in RANDOM),
]


def type_2_pieces(five_bar, mode):
    found = [piece for curve in type_2_curves(five_bar) for piece in pieces(curve)]
    return [piece for piece in found if piece.working_mode == mode]


def all_aspects(five_bar, mode):
    return aspects(five_bar, mode, workspace(five_bar, mode), type_2_pieces(five_bar, mode))


def determinants(five_bar, mode, cells):
    """det A on a lattice around the left leg's reach, NaN outside the workspace, and the area of a cell."""
    reach = five_bar.reach_m(0)[1]
    at = np.linspace(-reach, reach, cells) + 1e-5
    points = np.stack(np.meshgrid(at, at, indexing="ij"), axis=-1).reshape(-1, 2)
    det_a = conditioning(five_bar, five_bar.inverse_kinematics(points, mode)).det_a
    return det_a.reshape(cells, cells), (at[1] - at[0]) ** 2


# --- workspace ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("mode", WORKING_MODES)
def test_area_of_the_paper_in_every_working_mode(mode):
    exact = 338 * math.acos(3 / 13) - 24 * math.sqrt(10) - 18 * math.pi
    assert exact == pytest.approx(319.776382597, abs=5e-10)
    assert workspace(CB, mode).area_m2 == pytest.approx(exact, abs=1e-11)


@pytest.mark.parametrize("five_bar", DESIGNS)
def test_area_is_that_of_a_lattice(five_bar):
    for mode in WORKING_MODES:
        region = workspace(five_bar, mode)
        det_a, cell = determinants(five_bar, mode, 300)
        counted = np.count_nonzero(~np.isnan(det_a)) * cell
        assert region.area_m2 == pytest.approx(counted, abs=region.perimeter_m * math.sqrt(cell))


@pytest.mark.parametrize("five_bar", DESIGNS)
def test_boundaries_are_closed_loops(five_bar):
    for mode in WORKING_MODES:
        for loop in workspace(five_bar, mode).loops:
            ends = np.array([arc.ends for arc in loop])
            np.testing.assert_allclose(ends[:, 1], np.roll(ends[:, 0], -1, axis=0), atol=1e-8 * five_bar.size_m)


@pytest.mark.parametrize(
    ("five_bar", "area"),
    [
        (FiveBar.symmetric(10.0, 1.0, 1.0), 0.0),  # out of each other's reach
        (FiveBar.symmetric(4.0, 1.0, 1.0), 0.0),  # they touch in one point
        (FiveBar(0.5, (3.0, 0.2), (1.0, 0.2)), 0.0),  # the right leg's disc lies in the hole of the left one's
        (FiveBar(3.0, (3.0, 0.4), (1.0, 0.4)), math.pi * 0.8**2),  # … or in its annulus; it folds onto B
        (FiveBar(1.0, (2.0, 2.0), (2.0, 2.0)), 32 * math.acos(1 / 8) - 0.5 * math.sqrt(63)),  # two discs
        (FiveBar(1.0, (4.0, 1.0), (1.0, 5.0), (None, (math.pi, math.pi + 2e-3))), None),  # a sliver
    ],
)
def test_degenerate_workspaces(five_bar, area):
    for mode in WORKING_MODES:
        found = workspace(five_bar, mode).area_m2
        assert found == pytest.approx(area, abs=1e-12) if area is not None else 0 <= found < 0.1
        assert sum(each.area_m2 for each in all_aspects(five_bar, mode)) == pytest.approx(found, abs=1e-9)


def test_a_boundary_that_both_legs_have_counts_once():
    """θ2 = π puts D at A: the right leg's limit lies on the left leg's outer circle."""
    five_bar = FiveBar(1.0, (1.5, 1.0), (1.0, 2.5), (None, (math.pi - 1.0, math.pi)))
    for mode in WORKING_MODES:
        det_a, cell = determinants(five_bar, mode, 400)
        region = workspace(five_bar, mode)
        counted = np.count_nonzero(~np.isnan(det_a)) * cell
        assert region.area_m2 == pytest.approx(counted, abs=region.perimeter_m * math.sqrt(cell))


# --- loci -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("five_bar", DESIGNS)
def test_curves_keep_the_angle_of_the_distal_links_and_close_the_loop(five_bar):
    t = np.linspace(0, 2 * np.pi, 500)
    for delta in (0.0, np.pi, np.pi / 2, -np.pi / 2, 0.7):
        for curve in angle_curves(five_bar, delta, "any"):
            angles = curve.angles(t)
            assert np.abs(np.exp(1j * (angles[:, 2] - angles[:, 3])) - np.exp(1j * delta)).max() < 1e-9
            right = five_bar.elbows(angles)[:, 1]
            right = right + five_bar.distal_m[1] * np.stack([np.cos(angles[:, 3]), np.sin(angles[:, 3])], axis=1)
            np.testing.assert_allclose(end_point(five_bar, angles), right, atol=1e-13 * five_bar.size_m)


@pytest.mark.parametrize("five_bar", DESIGNS)
def test_pieces_stay_in_their_mode_and_end_on_its_boundary(five_bar):
    for piece in (piece for curve in type_2_curves(five_bar) for piece in pieces(curve)):
        angles = piece.angles(200)[1:-1]
        found = five_bar.inverse_kinematics(end_point(five_bar, angles), piece.working_mode)
        assert not np.isnan(found).any()
        np.testing.assert_allclose(np.cos(found - angles), 1.0, atol=1e-10)
        if not piece.closed:
            ends = end_point(five_bar, piece.angles(1))
            arcs = [arc for loop in workspace(five_bar, piece.working_mode).loops for arc in loop]
            for end in ends:
                gaps = [np.hypot(*(arc.points(np.linspace(0, 1, 20001)) - end).T).min() for arc in arcs]
                assert min(gaps) < 1e-3 * five_bar.size_m


@pytest.mark.parametrize("five_bar", [CB, DESIGNS[6], DESIGNS[7], DESIGNS[8]])
def test_the_determinant_changes_its_sign_across_the_type_2_loci(five_bar):
    crossed = 0
    for piece in (piece for curve in type_2_curves(five_bar) for piece in pieces(curve)):
        points = end_point(five_bar, piece.angles(64))
        along = points[2:] - points[:-2]
        across = 1e-5 * five_bar.size_m * np.stack([-along[:, 1], along[:, 0]], 1) / np.hypot(*along.T)[:, None]
        sides = [
            conditioning(five_bar, five_bar.inverse_kinematics(points[1:-1] + s * across, piece.working_mode)).det_a
            for s in (1, -1)
        ]
        known = ~np.isnan(sides[0]) & ~np.isnan(sides[1])
        assert (sides[0][known] * sides[1][known] < 0).all()
        crossed += np.count_nonzero(known)
    assert crossed > 100


def test_no_singular_posture_is_away_from_the_loci():
    """Where det A changes its sign between cells of a lattice, a locus passes within a cell."""
    for five_bar in (CB, LIMITED):
        for mode in WORKING_MODES:
            det_a, cell = determinants(five_bar, mode, 200)
            reach, size = five_bar.reach_m(0)[1], math.sqrt(cell)
            i, j = np.nonzero(det_a[:-1] * det_a[1:] < 0)
            at = -reach + 1e-5 + size * np.stack([i + 0.5, j], axis=1)
            curves = [end_point(five_bar, piece.angles(3000)) for piece in type_2_pieces(five_bar, mode)]
            curve = np.concatenate([np.full((1, 2), 1e9), *curves])
            away = np.array([np.hypot(*(curve - point).T).min() for point in at])
            assert (away < 1.5 * size).all()


@pytest.mark.parametrize("five_bar", DESIGNS[:8])
@pytest.mark.parametrize("mode", WORKING_MODES)
def test_isotropic_loci(five_bar, mode):
    for run in isotropic_b(five_bar, mode):
        assert np.abs(conditioning(five_bar, run).inverse_kappa_b - 1).max() <= 1e-9
        np.testing.assert_array_equal(
            np.sign(np.sin(run[:, 2:] - run[:, :2])), [[1 if s == "+" else -1 for s in mode]] * len(run)
        )
    points = isotropic_points(five_bar, mode)
    ratio = min(five_bar.distal_m) / max(five_bar.distal_m)
    if len(points):
        assert np.abs(conditioning(five_bar, points).inverse_kappa_j - 1).max() < 1e-6
        np.testing.assert_allclose(conditioning(five_bar, points).inverse_kappa_a, ratio, atol=1e-9)
    for piece in (piece for curve in least_kappa_a_curves(five_bar) for piece in pieces(curve)):
        np.testing.assert_allclose(conditioning(five_bar, piece.angles(50)).inverse_kappa_a, ratio, atol=1e-9)


def test_isotropic_locus_of_b_is_where_a_lattice_has_it():
    for five_bar in (CB, FiveBar(1.1, (0.9, 1.3), (1.4, 1.1)), FiveBar(1.1, (0.9, 1.4), (1.4, 0.9))):
        step = 0.01 * five_bar.size_m / 4
        at = np.arange(-five_bar.reach_m(0)[1], five_bar.reach_m(0)[1], step)
        points = np.stack(np.meshgrid(at, at, indexing="ij"), axis=-1).reshape(-1, 2)
        angles = five_bar.inverse_kinematics(points, "+-")
        beta = np.multiply(five_bar.proximal_m, five_bar.distal_m) * np.abs(np.sin(angles[:, 2:] - angles[:, :2]))
        excess = (beta[:, 0] - beta[:, 1]).reshape(len(at), len(at))
        crossing = points.reshape(len(at), len(at), 2)[:-1][excess[:-1] * excess[1:] < 0]
        curve = np.concatenate([end_point(five_bar, run) for run in isotropic_b(five_bar, "+-")])
        away = np.array([np.hypot(*(curve - point).T).min() for point in crossing])
        assert len(away) > 50 and (away < 4 * step).all()


# --- aspects --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("five_bar", DESIGNS)
def test_aspects_are_the_components_of_a_lattice(five_bar):
    for mode in WORKING_MODES:
        found = all_aspects(five_bar, mode)
        region = workspace(five_bar, mode)
        assert sum(each.area_m2 for each in found) == pytest.approx(region.area_m2, abs=1e-9 * five_bar.size_m**2)
        det_a, cell = determinants(five_bar, mode, 500)
        large = 0.02 * region.area_m2  # smaller parts fall apart on the lattice
        for assembly, side in (("+", det_a > 0), ("-", det_a < 0)):
            labels, _ = ndimage.label(side)
            counted = np.sort(np.bincount(labels.ravel())[1:] * cell)
            exact = np.sort([each.area_m2 for each in found if each.assembly_mode == assembly])
            counted, exact = counted[counted > large], exact[exact > large]
            assert len(counted) == len(exact)
            np.testing.assert_allclose(counted, exact, atol=0.02 * region.area_m2)


@pytest.mark.parametrize(
    "five_bar",
    [
        FiveBar.symmetric(4.0, 1.0, 2.0),  # flat postures of a parallelogram
        FiveBar.symmetric(4.0, 4.0, 2.0),  # a rhombus, which folds onto the type 1 singularity
        FiveBar(6.0, (6.0, 4.0), (5.0, 1.0)),  # a kite that does
        FiveBar(2.0, (1.0, 2.0), (3.0, 2.0)),
        FiveBar(3.0, (3.0, 3.0), (6.0, 3.0), (None, (0.0, 7 * math.pi / 4))),
        FiveBar(4.0, (4.0, 6.0), (1.0, 5.0), (None, (0.0, 5 * math.pi / 4))),
        FiveBar(2.0, (3.0, 4.0), (3.0, 6.0), ((math.pi, 11 * math.pi / 4), (-math.pi, 0.0))),
    ],
)
def test_aspects_of_mechanisms_that_can_lie_flat(five_bar):
    """Their loci end where both legs are stretched or folded at once, where boundaries touch, or run along one."""
    for mode in WORKING_MODES:
        found = all_aspects(five_bar, mode)
        region = workspace(five_bar, mode)
        assert sum(each.area_m2 for each in found) == pytest.approx(region.area_m2, abs=1e-9 * five_bar.size_m**2)
        det_a, cell = determinants(five_bar, mode, 300)
        for assembly, side in (("+", det_a > 0), ("-", det_a < 0)):
            area = sum(each.area_m2 for each in found if each.assembly_mode == assembly)
            assert area == pytest.approx(np.count_nonzero(side) * cell, abs=0.5 * region.perimeter_m * math.sqrt(cell))


def test_areas_of_the_aspects_of_the_paper():
    """By symmetry two halves in ++ and −−; in the others bounded by circles and the coupler curve with c = 2 L2."""
    half = (338 * math.acos(3 / 13) - 24 * math.sqrt(10) - 18 * math.pi) / 2
    for mode in ("++", "--"):
        assert [each.area_m2 for each in all_aspects(CB, mode)] == pytest.approx([half, half], abs=1e-9)
    mixed = all_aspects(CB, "+-")
    assert [each.assembly_mode for each in mixed] == ["-", "+", "-", "+"]
    assert max(each.area_error_m2 for each in mixed) < 1e-7
    mirrored = all_aspects(CB, "-+")
    assert [each.area_m2 for each in mirrored] == pytest.approx([each.area_m2 for each in mixed], abs=1e-7)
    # The smallest: above the circle of radius L2 about the upper C = D, below the outer circles, which it touches.
    top = math.sqrt(55)
    x = np.linspace(3.0, 13 * 3 / 8, 200_001)
    gap = np.sqrt(169 - x**2) - (top + np.sqrt(25 - (x - 3) ** 2))
    assert mixed[-1].area_m2 == pytest.approx(2 * np.trapezoid(gap, x), abs=1e-8)
