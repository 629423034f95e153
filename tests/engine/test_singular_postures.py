"""Postures whose Jacobian is singular: exact zeros, never a NaN; and closed forms of planar arms."""

import numpy as np
import pytest

import wsrender as ws
from tests.reference.local_indices import NAMES

VANISHING = [name for name in NAMES if name != "order_independent_manipulability"]


def planar_arm(*lengths):
    """A planar arm of revolute joints in the x-y plane: standard DH rows of these link lengths [m]."""
    rows = [{"a": length, "limits_deg": (-180, 180)} for length in lengths]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows, name="planar"))


def assert_zero(values, prefix=""):
    for name in VANISHING:
        assert (values[prefix + name] == 0).all(), (prefix + name, values[prefix + name].max())
    assert (values[prefix + "order_independent_manipulability"] == 0).all()


def test_a_planar_arm_moves_in_no_third_direction(precision, device):
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (500, 3))
    found = ws.evaluate_indices(planar_arm(0.3, 0.2, 0.1), q, precision=precision, device=device)
    assert_zero(found)


def test_an_arm_of_no_length_does_not_move(precision, device):
    """Links of no length: all columns are zero."""
    arm, q = planar_arm(0.0, 0.0), [[0.3, 0.4]]
    found = ws.evaluate_indices(arm, q, "kinematic", ("x", "y"), precision=precision, device=device)
    assert_zero(found)


def test_a_stretched_arm(precision, device):
    q = np.zeros((500, 2))
    q[:, 0] = np.random.default_rng(1).uniform(-np.pi, np.pi, 500)
    found = ws.evaluate_indices(planar_arm(0.4, 0.3), q, "kinematic", ("x", "y"), precision=precision, device=device)
    assert_zero(found)


@pytest.mark.parametrize("name", ["puma560", "ur5e"])
def test_a_singular_wrist(name, precision, device):
    robot = ws.load_robot(name)
    q = np.random.default_rng(2).uniform(robot.lower_limits, robot.upper_limits, (500, 6))
    q[:, 4] = 0.0
    found = ws.evaluate_indices(robot, q, "all", "full", precision=precision, device=device)
    assert_zero(found)
    assert_zero(found, "dynamic_")


def test_more_rows_than_joints(precision, device):
    robot = ws.load_robot("scara")
    q = np.random.default_rng(3).uniform(robot.lower_limits, robot.upper_limits, (100, 4))
    assert_zero(ws.evaluate_indices(robot, q, "all", "full", precision=precision, device=device))


def test_condition_of_a_planar_arm_of_equal_links():
    """The least condition number of a 2R arm with l1 = l2 is the golden ratio, at 131.8103149°."""
    q = np.deg2rad([[0.0, 131.8103149], [70.0, -131.8103149], [20.0, 130.0], [20.0, 133.0]])
    inverse = ws.evaluate_indices(planar_arm(0.5, 0.5), q, "kinematic", ("x", "y"))
    condition = 1 / inverse["inverse_condition_number"]
    assert condition[:2] == pytest.approx((1 + 5**0.5) / 2, rel=1e-12)
    assert (condition[2:] > condition[0]).all()


def test_an_isotropic_planar_arm():
    """l1 = sqrt(2) l2: condition number exactly 1 at ±135°."""
    arm = planar_arm(2**0.5, 1.0)
    found = ws.evaluate_indices(arm, np.deg2rad([[10.0, 135.0], [0.0, -135.0]]), "kinematic", ("x", "y"))
    assert found["inverse_condition_number"] == pytest.approx(1, rel=1e-12)
    assert found["isotropy"] == pytest.approx(1, rel=1e-12)
    # The lever of the second joint is l2 = 1, that of the first its perpendicular: both singular values are 1.
    assert found["manipulability"] == pytest.approx(1, rel=1e-12)


def test_manipulability_of_a_planar_arm_is_the_area_of_its_links():
    q = np.random.default_rng(4).uniform(-np.pi, np.pi, (100, 2))
    found = ws.evaluate_indices(planar_arm(0.7, 0.4), q, "kinematic", ("x", "y"))["manipulability"]
    assert found == pytest.approx(np.abs(0.28 * np.sin(q[:, 1])), abs=1e-15)
