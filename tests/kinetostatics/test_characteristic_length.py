"""Characteristic lengths against the isotropic arms of Chablat and Bennis, and closed forms."""

import numpy as np
import pytest

import wsrender as ws
from wsrender.kinetostatics import condition_number, conditioning_length, least_condition_length, rms_length

PLANAR = (0, 1, 5)
LENGTHS = {"rms": rms_length, "conditioning": conditioning_length, "least_condition": least_condition_length}
A = 0.3


def planar_3r():
    return ws.load_robot(ws.DHTable(convention="standard", rows=[ws.DHRow(a=a) for a in (A, A, A / np.sqrt(3))]))


def diestro():
    rows = [ws.DHRow(a=0.05, d=0.05, alpha_deg=90 if k % 2 == 0 else -90) for k in range(6)]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows))


def jacobian(robot, *degrees):
    return robot.jacobian(np.radians(degrees))[0]


@pytest.mark.parametrize("method", LENGTHS)
def test_isotropic_planar_arm(method):
    J = jacobian(planar_3r(), 17, 120, 150)
    length = LENGTHS[method](J, PLANAR)
    assert length == pytest.approx(A / np.sqrt(6), rel=1e-9)
    assert condition_number(J, length, PLANAR) == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize("method", LENGTHS)
def test_diestro(method):
    J = jacobian(diestro(), 33, 90, -90, 90, -90, 180)
    length = LENGTHS[method](J)
    assert length == pytest.approx(0.05, rel=1e-9)
    assert condition_number(J, length) == pytest.approx(1, abs=1e-9)


def test_rms_length_is_that_of_the_lever_arms():
    J = jacobian(diestro(), 3, 40, -70, 20, 10, 60)
    assert rms_length(J) == pytest.approx(np.sqrt((np.linalg.norm(J[:3], axis=0) ** 2).mean()), rel=1e-12)
    J = jacobian(planar_3r(), 3, 40, -70)
    assert rms_length(J, PLANAR) == pytest.approx(np.sqrt((J[:2] ** 2).sum() / 6), rel=1e-12)


def scanned(J, cost, rows=range(6)):
    """Least cost over a fine scan of lengths."""
    lengths = np.geomspace(1e-3, 10, 20001)
    costs = [cost(np.linalg.svd((J / ([[L]] * 3 + [[1.0]] * 3))[list(rows)], compute_uv=False)) for L in lengths]
    return lengths[np.argmin(costs)]


def test_lengths_of_a_skew_posture_are_the_least_of_a_scan():
    """Distance to σU, U with orthonormal rows: Σσ² − (Σσ)²/m, minimised over σ and U in closed form."""
    J = jacobian(diestro(), 3, 40, -70, 20, 10, 60)
    assert conditioning_length(J) == pytest.approx(scanned(J, lambda s: (s**2).sum() - s.sum() ** 2 / 6), rel=1e-3)
    assert least_condition_length(J) == pytest.approx(scanned(J, lambda s: s[0] / s[-1]), rel=1e-3)
    assert conditioning_length(J) != pytest.approx(least_condition_length(J), rel=1e-2)


@pytest.mark.parametrize("method", ["rms", "conditioning", "least_condition"])
def test_the_method_is_named(method):
    posture = np.radians([0, 120, 150]).tolist()
    choice = {"method": method, "posture": posture}
    field = ws.force_field(planar_3r(), task=["x", "y", "rz"], characteristic_length=choice)
    assert (field.length.method, field.length.length_m) == (method, pytest.approx(A / np.sqrt(6)))
    assert field.length.condition_number == pytest.approx(1)


def test_given_and_needless_lengths():
    field = ws.force_field("ur5e", characteristic_length={"method": "given", "length_m": 0.4})
    assert (field.length.method, field.length.length_m) == ("given", 0.4)
    slides = [ws.DHRow(joint="prismatic", alpha_deg=90, limits=(0, 1)), ws.DHRow(joint="prismatic", limits=(0, 1))]
    assert ws.force_field(ws.load_robot(ws.DHTable(convention="standard", rows=slides))).length.method == "none"


def test_a_singular_posture_has_no_conditioning_length():
    with pytest.raises(ws.InputError, match=r"characteristic_length\.posture: is singular: the 6 rows"):
        ws.force_field("ur5e", task="full", characteristic_length={"method": "conditioning", "posture": [0] * 6})


def test_a_posture_of_another_robot():
    with pytest.raises(ws.InputError, match=r"characteristic_length\.posture: has 2 values; the robot has 6 joints"):
        ws.force_field("ur5e", characteristic_length={"method": "rms", "posture": [0, 0]})
