"""Poses, Jacobians and inertia matrices of the kernels against MuJoCo's own functions."""

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.reference.mujoco_library import MujocoRobot
from tests.reference.postures import random_postures
from tests.reference.published_robots import NAMES
from wsrender.engine import evaluate_kinematics
from wsrender.engine.kinematics import LEAST_SHARE
from wsrender.robots import library
from wsrender.tolerances import TOLERANCES

COUNT = 1000
WITH_INERTIA = [name for name in NAMES if name in ("franka_panda", "kuka_iiwa14", "puma560", "stanford_arm", "ur5e")]


def transform(position, rpy_deg):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = Rotation.from_euler("xyz", rpy_deg, degrees=True).as_matrix(), position
    return T


PLACEMENT, TOOL = transform((0.3, -0.2, 0.15), (30, -50, 110)), transform((0.05, 0.02, -0.11), (10, 80, -35))


@cache
def robot_and_references(name):
    robot = ws.load_robot(name, placement=PLACEMENT, tool=TOOL)
    q = random_postures(robot.chain, COUNT)
    reference = MujocoRobot(library.find(name), robot.joint_names, robot.tip_frame, PLACEMENT, TOOL)
    return robot, q, reference.at(q)


@pytest.mark.parametrize("name", NAMES)
def test_pose_and_jacobian(name, precision, device):
    robot, q, reference = robot_and_references(name)
    tolerance = TOLERANCES[precision]
    length = tolerance.position(robot.chain.reach)
    found = evaluate_kinematics(robot.chain, q, with_inertia=True, precision=precision, device=device)
    assert np.abs(found.pose[:, :3, 3] - reference.pose[:, :3, 3]).max() <= length
    assert np.abs(found.pose[:, :3, :3] - reference.pose[:, :3, :3]).max() <= tolerance.kinematics
    assert np.abs(found.jacobian[:, :3] - reference.jacobian[:, :3]).max() <= length
    assert np.abs(found.jacobian[:, 3:] - reference.jacobian[:, 3:]).max() <= tolerance.kinematics
    assert (found.pose[:, 3] == [0, 0, 0, 1]).all()


@pytest.mark.parametrize("name", WITH_INERTIA)
def test_inertia_matrix(name, precision, device):
    robot, q, reference = robot_and_references(name)
    found = robot.inertia_matrix(q, precision=precision, device=device)
    scale = np.abs(reference.inertia).max(axis=(1, 2), keepdims=True)
    assert (np.abs(found - reference.inertia) / scale).max() <= TOLERANCES[precision].inertia
    assert (found == found.transpose(0, 2, 1)).all()


@pytest.mark.parametrize("name", WITH_INERTIA)
def test_inertia_matrix_by_mujoco_itself(name):
    robot, q, reference = robot_and_references(name)
    found = robot.inertia_matrix(q[:50], method="mujoco")
    scale = np.abs(reference.inertia[:50]).max()
    # The loaded model gives massless links a negligible mass, which MuJoCo demands.
    assert np.abs(found - reference.inertia[:50]).max() <= 1e-12 * scale


def test_the_public_functions_are_the_kernel(device):
    robot, q, reference = robot_and_references("ur5e")
    tolerance = TOLERANCES["float64"]
    pose = robot.forward_kinematics(q[:20], device=device)
    J = robot.jacobian(q[:20], device=device)
    assert pose.shape == (20, 4, 4) and J.shape == (20, 6, 6)
    assert np.abs(pose - reference.pose[:20]).max() <= tolerance.position(robot.chain.reach)
    assert np.abs(J - reference.jacobian[:20]).max() <= tolerance.position(robot.chain.reach)


def test_one_configuration_and_none():
    robot, q, _ = robot_and_references("scara")
    assert (robot.forward_kinematics(q[0]) == robot.forward_kinematics(q[:1])).all()
    assert robot.jacobian(np.zeros((0, 4))).shape == (0, 6, 4)
    assert robot.forward_kinematics(np.zeros((0, 4))).shape == (0, 4, 4)


def test_the_jacobian_is_the_derivative_of_the_pose():
    robot, q, _ = robot_and_references("stanford_arm")
    h, q = 1e-6, q[:50]
    J = robot.jacobian(q)
    T = robot.forward_kinematics(q)
    for i in range(6):
        step = h * np.eye(6)[i]
        dT = (robot.forward_kinematics(q + step) - robot.forward_kinematics(q - step)) / (2 * h)
        spin = dT[:, :3, :3] @ T[:, :3, :3].transpose(0, 2, 1)
        # Central differences: rounding eps / h, truncation h².
        assert np.abs(J[:, :3, i] - dT[:, :3, 3]).max() < 1e-9
        assert np.abs(J[:, 3:, i] - np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], 1)).max() < 1e-9


@pytest.mark.parametrize("threads", [2, 5])
def test_threads_change_no_bit_of_kinematics(threads):
    robot = ws.load_robot("scara")
    lower, upper = robot.chain.lower_limits, robot.chain.upper_limits
    q = lower + np.random.default_rng(0).random((3 * LEAST_SHARE + 7, robot.chain.n)) * (upper - lower)
    one = evaluate_kinematics(robot.chain, q, True, device="cpu", threads=1)
    several = evaluate_kinematics(robot.chain, q, True, device="cpu", threads=threads)
    for name in ("pose", "jacobian", "inertia"):
        assert getattr(one, name).tobytes() == getattr(several, name).tobytes()
