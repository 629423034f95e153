"""Labels that searches along a free joint decide: proofs, reasons, and what is left to the other search."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.engine.test_closed_form import anywhere, in_the_box, near_limits
from tests.reach.test_closed_labels import ACCURACY, solver
from tests.reference.redundant_arms import swept
from wsrender.pipeline.constraints.expression import ExpressionConstraint
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.inverse_solver import closed_form_of, solved_bytes

ARMS = ["franka_panda", "kuka_iiwa14"]


@pytest.mark.parametrize("name", ARMS)
def test_no_configuration_refutes_what_is_proven(name):
    """What the other search alone finds reachable is never called unreachable; nearly all that is gets a proof."""
    chain = ws.load_robot(name).chain
    near = chain.poses(near_limits(chain, 300))
    near[:, :3, 3] += np.random.default_rng(0).normal(size=(300, 3)) * 1e-4  # on both sides of the boundary
    for T, proofs in ((in_the_box(chain, 600), 0.99), (near, 0.0)):
        found = solver(chain).solve(T[:, :3, 3], T[:, :3, :3])
        alone = solver(chain, closed=False).solve(T[:, :3, 3], T[:, :3, :3])
        assert not (found.label[alone.label == REACHABLE] == UNREACHABLE).any()
        assert (found.label[alone.label == UNREACHABLE] != REACHABLE).all()
        assert (found.label == UNDECIDED).sum() <= (alone.label == UNDECIDED).sum()
        assert found.proven[found.label == UNREACHABLE].mean() >= proofs
        if proofs:
            assert alone.proven.mean() < found.proven.mean() - 0.1


@pytest.mark.parametrize(("moved", "turned"), [(1e-3, 0.0), (0.0, 2e-3)])
@pytest.mark.parametrize("name", ARMS)
def test_nothing_within_the_tolerances_of_a_reached_pose_is_proven_out_of_reach(name, moved, turned):
    chain, random = ws.load_robot(name).chain, np.random.default_rng(5)
    T = chain.poses(near_limits(chain, 4000, 5))
    away, about = (random.normal(size=(len(T), 3)) for _ in range(2))
    away, about = (size * v / np.linalg.norm(v, axis=1, keepdims=True) for size, v in ((moved, away), (turned, about)))
    T[:, :3, 3] += away
    T[:, :3, :3] = Rotation.from_rotvec(about).as_matrix() @ T[:, :3, :3]
    for share, proven in ((1.0, False), (0.01, True)):
        near = {"position_m": max(share * moved, 1e-7), "angle_rad": max(share * turned, 1e-7)}
        assert solver(chain, **near).closed.unreachable(T[:, :3, 3], T[:, :3, :3]).any() == proven


@pytest.mark.parametrize("name", ARMS)
def test_poses_at_limits_are_reached(name):
    chain = ws.load_robot(name).chain
    T = chain.poses(near_limits(chain, 600))
    found = solver(chain).solve(T[:, :3, 3], T[:, :3, :3])
    assert (found.label == REACHABLE).all() and not found.proven.any()
    back = chain.poses(found.q)
    assert np.linalg.norm(back[:, :3, 3] - T[:, :3, 3], axis=1).max() <= ACCURACY["position_m"] * (1 + 1e-9)
    assert ((found.q >= chain.lower_limits) & (found.q <= chain.upper_limits)).all()


def test_directions_leave_the_turn_about_them_free():
    """Of the Panda without its last joint, beside whole poses with so many turns about z."""
    chain = ws.load_robot("franka_panda").chain
    T = in_the_box(chain, 400)
    found = solver(chain, "axis").solve(T[:, :3, 3], T[:, :3, 2])
    assert found.proven.mean() > 0.5 and found.proven[found.label == UNREACHABLE].mean() > 0.99
    some = False
    for turn in np.linspace(0, 2 * np.pi, 24, endpoint=False):
        turned = T[:, :3, :3] @ Rotation.from_rotvec([0, 0, turn]).as_matrix()
        some |= solver(chain).solve(T[:, :3, 3], turned).label == REACHABLE
    assert 0.05 < some.mean() < 0.6
    assert (found.label[some] == REACHABLE).all()
    assert (found.label[~some] == UNREACHABLE).mean() > 0.98


def test_reasons_are_those_of_an_arm_that_turns_for_ever():
    robot = ws.load_robot("franka_panda")
    narrow = ws.load_robot("franka_panda", limits=dict.fromkeys(robot.joint_names, (-1, 1)))
    T = in_the_box(robot.chain, 1000)
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    found = ws.reachable(narrow, T[:, :3, 3], quat, device="cpu")
    turning = ws.load_robot("franka_panda", limits=dict.fromkeys(robot.joint_names, (-np.pi, np.pi)))
    there = swept(turning.chain, T, 64)
    missed = found.labels == "unreachable"
    assert (missed & there).sum() > 50 and (missed & ~there).sum() > 50
    assert (found.reasons[missed & there] == "joint limits").all()
    assert (found.reasons[missed & ~there] == "out of reach").mean() > 0.97


def test_a_base_far_from_the_origin_and_turned():
    quat = tuple(Rotation.random(random_state=2).as_quat(scalar_first=True))
    placements = [None, ws.Transform(position_m=(5e5, 0, 0), quat_wxyz=quat)]
    labels = []
    for placement in placements:
        chain = ws.load_robot("franka_panda", placement=placement).chain
        T = in_the_box(ws.load_robot("franka_panda").chain, 1000)
        world = np.eye(4)
        if placement:
            world[:3, :3], world[:3, 3] = Rotation.from_quat(quat, scalar_first=True).as_matrix(), (5e5, 0, 0)
        T = world @ T
        found = solver(chain).solve(T[:, :3, 3], T[:, :3, :3])
        labels.append(found.label)
        assert found.proven.mean() > 0.7
    assert (labels[0] == labels[1]).all()


def test_blocked_poses_are_no_proofs():
    """Of an arm with seven joints not all postures are known."""
    robot = ws.load_robot("franka_panda")
    T = robot.chain.poses(anywhere(robot.chain, 40))
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    never = (ExpressionConstraint("never", lambda q, position, axes: q[0] - 100.0),)
    found = ws.reachable(robot, T[:, :3, 3], quat, device="cpu", constraints=never)
    assert (found.labels == "blocked").mean() > 0.9 and not found.proven.any()


def test_memory_is_that_of_closed_forms():
    panda = ws.load_robot("franka_panda").chain
    assert closed_form_of(panda, "pose") and closed_form_of(panda, "axis") and not closed_form_of(panda, "position")
    assert solved_bytes(1e5, "pose", panda) == solved_bytes(1e5, "pose", ws.load_robot("ur5e").chain)
