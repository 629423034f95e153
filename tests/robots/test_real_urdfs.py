"""URDFs of real robots against Pinocchio; skipped where pin or example-robot-data is not installed."""

import warnings
from pathlib import Path

import numpy as np
import pytest

import wsrender as ws

pin = pytest.importorskip("pinocchio")
ROBOTS = Path(pin.__file__).parents[4] / "cmeel.prefix/share/example-robot-data/robots"
if not ROBOTS.is_dir():
    ROBOTS = Path(pin.__file__).parents[4] / "share/example-robot-data/robots"
pytestmark = pytest.mark.skipif(not ROBOTS.is_dir(), reason="example-robot-data is not installed")

# Massless links, links that break the triangle inequality, antiparallel joint axes, floating and nested bases.
CASES = [
    ("ur_description/urdf/ur5_robot.urdf", "world", "tool0"),
    ("kinova_description/robots/kinova.urdf", None, "j2s6s200_end_effector"),
    ("panda_description/urdf/panda.urdf", "panda_link0", "panda_hand_tcp"),
    ("tiago_description/robots/tiago_dual.urdf", "torso_lift_link", "hand_left_grasping_frame"),
    ("tiago_description/robots/tiago_no_hand.urdf", "torso_lift_link", "wrist_ft_tool_link"),
    ("romeo_description/urdf/romeo.urdf", "torso", "l_gripper"),
    ("talos_data/robots/talos_left_arm.urdf", None, "gripper_left_base_link"),
    ("allegro_hand_description/urdf/allegro_left_hand.urdf", None, "link_3.0_tip"),
    ("icub_description/robots/icub.urdf", "chest", "l_gripper"),
    ("xarm_description/urdf/xarm7.urdf", "world", "link_eef"),
]
CONFIGURATIONS = 20
POSITION, INERTIA = 1e-12, 1e-10  # times the reach (at least 1 m), and relative to max|M|


@pytest.fixture(params=CASES, ids=lambda case: case[2])
def case(request):
    file, base, tip = request.param
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # dropped meshes, unphysical inertias
        robot = ws.load_robot(str(ROBOTS / file), base=base, tip=tip)
    return robot, pin.buildModelFromUrdf(str(ROBOTS / file)), base, tip


def _configurations(robot):
    generator = np.random.default_rng(5)
    return generator.uniform(robot.lower_limits, robot.upper_limits, (CONFIGURATIONS, len(robot.joint_names)))


def _pinocchio(model, robot, base, tip, q):
    """Pose, Jacobian and inertia matrix in the base frame, everything off the chain at its neutral place."""
    data, full = model.createData(), pin.neutral(model)
    joints = [model.joints[model.getJointId(name)] for name in robot.joint_names]
    for joint, value in zip(joints, q, strict=True):
        full[joint.idx_q : joint.idx_q + joint.nq] = (np.cos(value), np.sin(value)) if joint.nq == 2 else value
    pin.computeJointJacobians(model, data, full)
    pin.updateFramePlacements(model, data)
    frame = model.getFrameId(tip)
    T_world_base = data.oMf[model.getFrameId(base)] if base else pin.SE3.Identity()
    jacobian = pin.getFrameJacobian(model, data, frame, pin.LOCAL_WORLD_ALIGNED)
    dofs = [joint.idx_v for joint in joints]
    R = T_world_base.rotation.T
    upper = np.triu(pin.crba(model, data, full))
    inertia = upper + np.triu(upper, 1).T
    pose = (T_world_base.inverse() * data.oMf[frame]).homogeneous
    return pose, np.vstack([R @ jacobian[:3], R @ jacobian[3:]])[:, dofs], inertia[np.ix_(dofs, dofs)]


def test_kinematics_and_inertia_agree_with_pinocchio(case):
    robot, model, base, tip = case
    q = _configurations(robot)
    poses, jacobians, inertias = robot.forward_kinematics(q), robot.jacobian(q), robot.inertia_matrix(q)
    for row, pose, jacobian, inertia in zip(q, poses, jacobians, inertias, strict=True):
        expected_pose, expected_jacobian, expected_inertia = _pinocchio(model, robot, base, tip, row)
        reach = max(1.0, np.abs(expected_jacobian[:3]).max())
        np.testing.assert_allclose(pose, expected_pose, rtol=0, atol=POSITION * reach)
        np.testing.assert_allclose(jacobian, expected_jacobian, rtol=0, atol=POSITION * reach)
        np.testing.assert_allclose(inertia, expected_inertia, rtol=0, atol=INERTIA * np.abs(expected_inertia).max())


def test_limits_agree_with_pinocchio(case):
    robot, model, _base, _tip = case
    for name, lower, upper, periodic in zip(
        robot.joint_names, robot.lower_limits, robot.upper_limits, robot.chain.periodic, strict=True
    ):
        joint = model.joints[model.getJointId(name)]
        assert periodic == (joint.nq == 2)
        if not periodic:
            assert (lower, upper) == (model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q])


@pytest.mark.parametrize("finger", ["panda_leftfinger", "panda_rightfinger"])
def test_both_fingers_of_a_hand_have_one_freedom_more_than_its_arm(finger):
    """One finger mimics the other: whichever ends the chain, the width of the hand is its last coordinate."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        robot = ws.load_robot(str(ROBOTS / "panda_description/urdf/panda.urdf"), tip=finger)
    assert robot.joint_names[7:] == ("panda_finger_joint1",)
    q = _configurations(robot)
    leads = finger == "panda_rightfinger"  # of the other chain nothing follows: it holds the right finger still
    full = np.column_stack([q, leads * q[:, -1]])
    model = pin.buildModelFromUrdf(str(ROBOTS / "panda_description/urdf/panda.urdf"))
    C = np.eye(9, 8)
    C[8, 7] = leads
    M = robot.inertia_matrix(q, device="cpu")
    for row, T, found in zip(full, robot.forward_kinematics(q, device="cpu"), M, strict=True):
        data = model.createData()
        pin.framesForwardKinematics(model, data, row)
        np.testing.assert_allclose(T, data.oMf[model.getFrameId(finger)].homogeneous, atol=POSITION)
        by_pin = pin.crba(model, data, row)
        by_pin = C.T @ (np.triu(by_pin) + np.triu(by_pin, 1).T) @ C
        np.testing.assert_allclose(found, by_pin, atol=INERTIA * abs(by_pin).max())
