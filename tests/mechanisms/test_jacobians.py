"""Jacobians against finite differences of the inverse kinematics, indices against their own definition."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.mechanisms.mechanisms import mechanism, poses_of
from wsrender.errors import InputError
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.jacobians import jacobians, platform_jacobian, pose_indices

STEP = 1e-6
NAMES = ("manipulability", "inverse_condition_number", "minimum_singular_value", "isotropy")
KAPPAS = ("inverse_condition_number_A", "inverse_condition_number_J")
RUS = {
    "legs": [
        {"type": "RUS", "base_m": [np.cos(a), np.sin(a), 0],
         "platform_m": [0.4 * np.cos(a + s), 0.4 * np.sin(a + s), 0],
         "axis": [-np.sin(a), np.cos(a), 0], "zero": [np.cos(a), np.sin(a), 0], "crank_m": 0.4, "link_m": 1.3,
         "angle_deg": [-179, 179], "branch": "minus"}
        for a, s in zip(np.deg2rad([0, 60, 120, 180, 240, 300]), [0.3, -0.3] * 3, strict=True)
    ]
}  # fmt: skip
POSES = {
    "stewart_gough": ("stewart_gough", [0.05, -0.03, 0.55]),
    "six_pus": ("six_pus", [0.05, -0.1, 1.9]),
    "delta": ("delta", [0.1, -0.05, -0.7]),
    "RUS": (RUS, [0.05, -0.02, 1.1]),
}


def poses_near(position, count, turned):
    random = np.random.default_rng(1)
    poses = poses_of(np.array(position) + random.uniform(-0.05, 0.05, (count, 3)))
    if turned:
        poses[:, :3, :3] = Rotation.from_rotvec(random.uniform(-0.1, 0.1, (count, 3))).as_matrix()
    return poses


@pytest.mark.parametrize("name", POSES)
def test_rows_are_the_derivatives_of_the_actuated_values(name):
    """Row by row, b dq = a dx: central differences along each of the platform's six (three) velocities."""
    document, position = POSES[name]
    mech = mechanism(document)
    poses = poses_near(position, 20, not mech.translational)
    legs = inverse_kinematics(mech, poses)
    assert not np.isnan(legs.values).any()
    J = jacobians(mech, legs, poses)
    for axis in range(mech.degrees_of_freedom):
        moved = []
        for sign in (1, -1):
            there = poses.copy()
            if axis < 3:
                there[:, axis, 3] += sign * STEP
            else:
                turn = Rotation.from_rotvec(sign * STEP * np.eye(3)[axis - 3]).as_matrix()
                there[:, :3, :3] = turn @ there[:, :3, :3]
            moved.append(inverse_kinematics(mech, there).values)
        rate = (moved[0] - moved[1]) / (2 * STEP)
        np.testing.assert_allclose((J.B @ rate[..., None])[..., 0], J.A[:, :, axis], atol=1e-8)


@pytest.mark.parametrize("name", POSES)
def test_the_platform_moves_as_its_jacobian_says(name):
    """A ẋ = B q̇ solved for ẋ, put back."""
    document, position = POSES[name]
    mech = mechanism(document)
    poses = poses_near(position, 10, not mech.translational)
    J = jacobians(mech, inverse_kinematics(mech, poses), poses)
    qdot = np.random.default_rng(0).normal(size=(10, len(mech.kinds), 1))
    xdot = platform_jacobian(J) @ qdot
    np.testing.assert_allclose(J.A @ xdot, J.B @ qdot, atol=1e-9)


@pytest.mark.parametrize("name", POSES)
def test_indices_are_those_of_the_singular_values(name):
    document, position = POSES[name]
    mech, length = mechanism(document), 0.35
    poses = poses_near(position, 15, not mech.translational)
    J = jacobians(mech, inverse_kinematics(mech, poses), poses)
    matrix = np.linalg.solve(J.A, J.B)
    rows = list(range(mech.degrees_of_freedom))
    if len(rows) == 6:
        matrix[:, :3] /= length
    values = pose_indices(mech, poses, NAMES, rows, length)
    sigma = np.array([np.linalg.svd(m, compute_uv=False) for m in matrix])
    np.testing.assert_allclose(values["manipulability"], np.abs(np.linalg.det(matrix)), rtol=1e-9)
    np.testing.assert_allclose(values["inverse_condition_number"], sigma[:, -1] / sigma[:, 0], rtol=1e-9)
    np.testing.assert_allclose(1 / values["inverse_condition_number_J"], np.linalg.cond(matrix), rtol=1e-9)
    angular = pose_indices(mech, poses, NAMES, rows[-3:], length)  # κ(J) is that of all rows, whatever the task
    np.testing.assert_array_equal(angular["inverse_condition_number_J"], values["inverse_condition_number_J"])
    np.testing.assert_allclose(values["minimum_singular_value"], sigma[:, -1], rtol=1e-9)
    H = matrix @ np.swapaxes(matrix, 1, 2)
    m = len(rows)
    isotropy = np.linalg.det(H) ** (1 / m) / (np.trace(H, axis1=1, axis2=2) / m)
    np.testing.assert_allclose(values["isotropy"], isotropy, rtol=1e-8)
    scaled = J.A / np.where(np.arange(m) < 3, 1, length)
    np.testing.assert_allclose(1 / values["inverse_condition_number_A"], np.linalg.cond(scaled), rtol=1e-9)
    np.testing.assert_allclose(values["determinant_A"], np.linalg.det(scaled), rtol=1e-9)
    size = np.abs(np.diagonal(J.B, axis1=1, axis2=2))
    np.testing.assert_allclose(values["inverse_condition_number_B"], size.min(axis=1) / size.max(axis=1))


def test_a_platform_with_similar_hexagons_is_never_held():
    """Base and platform similar and parallel: an architecture singularity (Ma & Angeles 1991); all indices are 0."""
    mech = mechanism({"library": "stewart_gough", "base_angle_deg": 60, "platform_angle_deg": 60})
    values = pose_indices(mech, poses_of([[0, 0, 0.6]]), NAMES, range(6))
    assert all(values[name][0] == 0 for name in (*NAMES, "determinant_A", *KAPPAS))


def test_mechanisms_with_other_numbers_of_legs_have_no_indices():
    mech = mechanism({"legs": [{"type": "UPS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "length_m": [0, 1]}] * 5})
    with pytest.raises(InputError, match="must be 6 for Jacobians and indices, not 5"):
        pose_indices(mech, poses_of([[0, 0, 0.6]]), NAMES, range(6))
