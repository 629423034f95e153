"""Kinematics and Jacobians of the five-bar: closed forms, finite differences, NumPy's singular values."""

import math

import numpy as np
import pytest

from wsrender.errors import InputError
from wsrender.mechanisms.five_bar import (
    ASSEMBLY_MODES,
    WORKING_MODES,
    FiveBar,
    conditioning,
    jacobian,
    parallel_jacobian,
    serial_jacobian,
)

CB = FiveBar.symmetric(6.0, 8.0, 5.0)
UNEQUAL = FiveBar(1.1, (0.7, 0.9), (1.2, 0.8))
POINTS = np.random.default_rng(3).uniform([-0.7, -1.6], [1.6, 1.6], (400, 2))


def reached(five_bar, mode, points=POINTS):
    angles = five_bar.inverse_kinematics(points, mode)
    return points[~np.isnan(angles[:, 0])], angles[~np.isnan(angles[:, 0])]


def unit(angle):
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


@pytest.mark.parametrize("mode", WORKING_MODES)
def test_both_legs_end_at_the_point_in_their_mode(mode):
    points, angles = reached(UNEQUAL, mode)
    assert len(points) > 100
    for leg in (0, 1):
        end = UNEQUAL.bases[leg] + UNEQUAL.proximal_m[leg] * unit(angles[:, leg])
        end = end + UNEQUAL.distal_m[leg] * unit(angles[:, 2 + leg])
        np.testing.assert_allclose(end, points, atol=1e-14 * 50)
        assert (np.sign(np.sin(angles[:, 2 + leg] - angles[:, leg])) == (1 if mode[leg] == "+" else -1)).all()


@pytest.mark.parametrize("mode", WORKING_MODES)
def test_out_of_reach_is_what_either_leg_cannot_span(mode):
    angles = UNEQUAL.inverse_kinematics(POINTS, mode)
    left, right = (np.hypot(*(POINTS - base).T) for base in UNEQUAL.bases)
    inside = (left >= 0.5) & (left <= 1.9) & (right >= 0.1) & (right <= 1.7)
    np.testing.assert_array_equal(~np.isnan(angles[:, 0]), inside)


@pytest.mark.parametrize("mode", WORKING_MODES)
def test_forward_kinematics_in_the_assembly_mode_of_the_posture_gives_the_point_back(mode):
    points, angles = reached(UNEQUAL, mode)
    side = np.sin(angles[:, 3] - angles[:, 2]) > 0
    for assembly, rows in (("+", side), ("-", ~side)):
        np.testing.assert_allclose(UNEQUAL.forward_kinematics(angles[rows, :2], assembly), points[rows], atol=1e-10)


def test_forward_kinematics_of_the_paper():
    straight_up = [math.pi / 2, math.pi / 2]
    found = [CB.forward_kinematics(straight_up, assembly)[0] for assembly in ASSEMBLY_MODES]
    np.testing.assert_allclose(found, [[3, 12], [3, 4]], atol=1e-12)
    for point in found:
        kappas = [1 / conditioning(CB, CB.inverse_kinematics(point, mode)).inverse_kappa_a[0] for mode in WORKING_MODES]
        assert min(abs(kappa - 4 / 3) for kappa in kappas) < 1e-12


def test_distal_links_that_do_not_meet_give_nan():
    assert np.isnan(CB.forward_kinematics([math.pi, 0.0], "+")).all()  # C and D are 22 apart
    meeting = FiveBar(1.0, (2.0, 1.0), (1.5, 1.5))  # at θ = 0 the elbows lie on each other: P is free on a circle
    assert np.isnan(meeting.forward_kinematics([0.0, 0.0], "+")).all()


def test_limits_choose_the_turn_and_exclude():
    limited = FiveBar(1.1, (0.7, 0.9), (1.2, 0.8), ((3.0, 6.0), None))
    free = UNEQUAL.inverse_kinematics(POINTS, "+-")
    angles = limited.inverse_kinematics(POINTS, "+-")
    inside = (np.remainder(free[:, 0] - 3.0, 2 * np.pi) <= 3.0) & ~np.isnan(free[:, 0])
    np.testing.assert_array_equal(~np.isnan(angles[:, 0]), inside)
    assert inside.any() and (angles[inside, 0] >= 3.0).all() and (angles[inside, 0] <= 6.0).all()
    np.testing.assert_allclose(np.cos(angles[inside]), np.cos(free[inside]), atol=1e-12)


# --- Jacobians ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("five_bar", [CB, UNEQUAL])
@pytest.mark.parametrize("mode", WORKING_MODES)
def test_jacobians_are_those_of_finite_differences(five_bar, mode):
    points, angles = reached(five_bar, mode, POINTS * five_bar.size_m / 4)
    # Away from singularities, where differences say nothing.
    well = conditioning(five_bar, angles).inverse_kappa_j > 0.05
    points, angles = points[well], angles[well]
    A, B, J = (matrix(five_bar, angles) for matrix in (parallel_jacobian, serial_jacobian, jacobian))
    h = 1e-6
    for column in (0, 1):
        step = h * np.eye(2)[column]
        after, before = (five_bar.inverse_kinematics(points + s * step, mode)[:, :2] for s in (1, -1))
        rate = (after - before) / (2 * h)  # dθ/dp = B⁻¹ A
        np.testing.assert_allclose(np.einsum("nij,nj->ni", B, rate), A[:, :, column], rtol=1e-5, atol=1e-6)
        side = np.where(np.sin(angles[:, 3] - angles[:, 2]) > 0, "+", "-")
        for assembly in ASSEMBLY_MODES:
            rows = side == assembly
            moved = [five_bar.forward_kinematics(angles[rows, :2] + s * step, assembly) for s in (1, -1)]
            np.testing.assert_allclose((moved[0] - moved[1]) / (2 * h), J[rows, :, column], rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("five_bar", [CB, UNEQUAL])
@pytest.mark.parametrize("mode", WORKING_MODES)
def test_condition_numbers_are_those_of_numpy(five_bar, mode):
    _, angles = reached(five_bar, mode, POINTS * five_bar.size_m / 4)
    found = conditioning(five_bar, angles)
    A, B, J = (matrix(five_bar, angles) for matrix in (parallel_jacobian, serial_jacobian, jacobian))
    for matrix, inverse in ((A, found.inverse_kappa_a), (B, found.inverse_kappa_b), (J, found.inverse_kappa_j)):
        np.testing.assert_allclose(inverse, 1 / np.linalg.cond(matrix), atol=1e-13)
    np.testing.assert_allclose(found.det_a, np.linalg.det(A), rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(found.det_b, np.linalg.det(B), rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(found.manipulability, np.abs(np.linalg.det(J)), rtol=1e-8)


def test_condition_numbers_of_the_paper():
    kappas = {"++": 1.777380134, "+-": 1.265642333, "-+": 10.668177061, "--": 3.921855162}
    for mode, kappa in kappas.items():
        angles = CB.inverse_kinematics([5.0, 7.0], mode)
        found = conditioning(CB, angles)
        assert 1 / found.inverse_kappa_a[0] == pytest.approx(kappa, abs=5e-10)
        assert 1 / found.inverse_kappa_b[0] == pytest.approx(1.125001423, abs=5e-10)
        half = abs(math.tan((angles[0, 2] - angles[0, 3]) / 2))
        assert 1 / found.inverse_kappa_a[0] == pytest.approx(max(half, 1 / half), rel=1e-13)


def test_singular_postures_have_exact_zeros_and_no_nan():
    folded = np.array([[0.3, 1.0, 0.3, 2.0], [0.3, 1.0, 2.0, 2.0]])  # left leg stretched; distal links parallel
    found = conditioning(CB, folded)
    assert found.inverse_kappa_b[0] == found.inverse_kappa_j[0] == found.manipulability[0] == 0
    assert found.inverse_kappa_a[1] == found.inverse_kappa_j[1] == 0 and np.isinf(found.manipulability[1])
    assert np.isnan(jacobian(CB, folded)[1]).all() and np.isfinite(jacobian(CB, folded)[0]).all()
    assert np.isnan(conditioning(CB, np.full(4, np.nan)).inverse_kappa_j).all()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: FiveBar.symmetric(0.0, 1.0, 1.0), "base_m: must be greater than 0, not 0.0"),
        (lambda: FiveBar(1.0, (1.0, -2.0), (1.0, 1.0)), "proximal_m: must be greater than 0, not -2.0"),
        (lambda: FiveBar(1.0, (1.0,), (1.0, 1.0)), "proximal_m: has 1 values"),
        (lambda: FiveBar(1.0, (1.0, 1.0), (1.0, math.nan)), "distal_m: must be a finite number, not nan"),
        (lambda: FiveBar(1.0, (1.0, 1.0), (1.0, 1.0), ((1.0, 0.0), None)), r"limits_rad: \[1.0, 0.0\] is not"),
        (lambda: FiveBar(1.0, (1.0, 1.0), (1.0, 1.0), ((0.0, 7.0), None)), "limits_rad"),
        (lambda: CB.inverse_kinematics([5.0, 7.0], "+"), r"working_mode: '\+' is not a mode; allowed: \+\+, "),
        (lambda: CB.forward_kinematics([1.0, 1.0], "x"), "assembly_mode: 'x' is not a mode"),
        (lambda: CB.inverse_kinematics([1.0, 2.0, 3.0], "++"), r"position: has shape \(3,\); \(2,\) or \(N, 2\)"),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises(InputError, match=message):
        call()
