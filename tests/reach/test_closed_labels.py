"""Labels that closed forms decide: proofs, reasons, and what is left to the search."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.engine.test_closed_form import anywhere, in_the_box, near_limits
from tests.reference import closed_form_inverse
from wsrender.engine import closed_postures
from wsrender.pipeline.constraints.expression import ExpressionConstraint
from wsrender.reach import InverseSolver
from wsrender.reach.admission import Admission
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.targets import evidence_for
from wsrender.robot.constraints import constraints_for
from wsrender.robots.closed_form import ClosedForm

ACCURACY = {"position_m": 1e-5, "angle_rad": 1e-5}


def solver(chain, kind="pose", *, closed=True, **accuracy):
    """With its closed form, or without."""
    made = InverseSolver(chain, kind=kind, device="cpu", **(ACCURACY | accuracy))
    if not closed:
        made.closed = None
    return made


@pytest.mark.parametrize("name", ["ur5e", "puma560", "stanford_arm", "slave_5r", "scara"])
def test_no_configuration_refutes_what_is_proven(name):
    """What the search alone, which knows no closed form, finds reachable is never called unreachable."""
    chain = ws.load_robot(name).chain
    near = chain.poses(near_limits(chain, 1000))
    near[:, :3, 3] += np.random.default_rng(0).normal(size=(1000, 3)) * 1e-4  # on both sides of the boundary
    for T, proofs in ((in_the_box(chain, 1500), 0.95), (near, 0.0)):
        found = solver(chain).solve(T[:, :3, 3], T[:, :3, :3])
        alone = solver(chain, closed=False).solve(T[:, :3, 3], T[:, :3, :3])
        assert not (found.label[alone.label == REACHABLE] == UNREACHABLE).any()
        assert (found.label[alone.label == UNREACHABLE] != REACHABLE).all()
        assert (found.label == UNDECIDED).sum() <= (alone.label == UNDECIDED).sum()
        assert found.proven[found.label == UNREACHABLE].mean() >= proofs


@pytest.mark.parametrize("name", ["ur5e", "puma560", "gao_6r", "stanford_arm", "slave_5r", "scara", "cylindrical"])
def test_poses_at_limits_are_reached(name):
    chain = ws.load_robot(name).chain
    for q in (
        near_limits(chain, 2000),
        np.clip(np.round(anywhere(chain, 1000)), chain.lower_limits, chain.upper_limits),
    ):
        T = chain.poses(q)
        found = solver(chain).solve(T[:, :3, 3], T[:, :3, :3])
        assert (found.label == UNREACHABLE).sum() == 0
        assert (found.label == UNDECIDED).mean() < 0.002
        there = found.label == REACHABLE
        back = chain.poses(found.q)
        assert np.linalg.norm(back[:, :3, 3] - T[:, :3, 3], axis=1)[there].max() <= ACCURACY["position_m"] * (1 + 1e-9)
        assert ((found.q >= chain.lower_limits) & (found.q <= chain.upper_limits)).all()


def test_a_pose_within_the_tolerance_is_no_proof():
    """Just beyond a limit the closed form has no posture, but one within the tolerance is found, or not excluded."""
    chain = ws.load_robot("puma560").chain
    q = anywhere(chain, 500)
    q[:, 5] = chain.upper_limits[5]
    beyond = q.copy()
    beyond[:, 5] += 5e-6
    T = chain.poses(beyond)
    found = solver(chain).solve(T[:, :3, 3], T[:, :3, :3])
    assert (found.label == REACHABLE).all()
    beyond[:, 5] += 1e-3
    T = chain.poses(beyond)
    exact = closed_postures(ClosedForm.of(chain), T, device="cpu")
    found = solver(chain).solve(T[:, :3, 3], T[:, :3, :3])
    assert (found.label[exact.count == 0] != REACHABLE).all()
    assert found.proven[exact.slack < -2e-4].all() and not found.proven[exact.slack > -1e-4].any()


@pytest.mark.parametrize("name", ["ur5e", "puma560"])
def test_reasons_are_those_of_arms_that_turn_for_ever(name):
    robot = ws.load_robot(name)
    chain = robot.chain.held({})
    T = in_the_box(chain, 3000)
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    narrow = ws.load_robot(name, limits=dict.fromkeys(robot.joint_names, (-1, 1)))
    found = ws.reachable(narrow, T[:, :3, 3], quat, device="cpu")
    free = closed_postures(ClosedForm.of(narrow.chain), T, unlimited=True, device="cpu")
    missed = found.labels == "unreachable"
    assert missed.mean() > 0.5
    for reason, expected in (("joint limits", free.slack > 1e-3), ("out of reach", free.slack < -1e-3)):
        assert (missed & expected).sum() > 100
        assert (found.reasons[missed & expected] == reason).all()


def test_a_base_far_from_the_origin():
    near, far = (ws.load_robot("puma560", placement=ws.Transform(position_m=(x, 0, 0))) for x in (0.0, 5e6))
    T = in_the_box(near.chain, 2000)
    labels = []
    for robot, x in ((near, 0.0), (far, 5e6)):
        found = solver(robot.chain).solve(T[:, :3, 3] + [x, 0, 0], T[:, :3, :3])
        labels.append(found.label)
        assert found.proven.any()
    assert (labels[0] == labels[1]).all()


def test_blocked_poses_are_those_of_which_no_posture_is_admitted():
    """Against all postures of another closed form, each asked of the constraints by itself."""
    robot = ws.load_robot("ur5e")
    chain = robot.chain
    constraints = constraints_for(robot, None, ws.Environment(items=[ws.HalfSpace(point_m=(0, 0, -0.1))]))
    T = chain.poses(anywhere(chain, 300))
    T[:, :3, 3] += np.random.default_rng(3).normal(size=(300, 3)) * 0.2
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    found = ws.reachable(robot, T[:, :3, 3], quat, device="cpu", constraints=constraints)
    with np.errstate(invalid="ignore", divide="ignore"):
        solutions = closed_form_inverse.ur5e(T[:, :3, 3], T[:, :3, :3])
    there = closed_form_inverse.within_limits(solutions, chain.lower_limits, chain.upper_limits, chain.revolute)
    q = np.where(there[..., None], np.nan_to_num(solutions), 0.0)
    q = np.remainder(q - chain.lower_limits, 2 * np.pi) + chain.lower_limits
    admitted = Admission(chain, constraints).rejected(q.reshape(-1, 6)).reshape(there.shape) == 0
    truth = np.where((there & admitted).any(axis=1), "reachable", np.where(there.any(axis=1), "blocked", "unreachable"))
    assert min((truth == label).sum() for label in ("reachable", "blocked", "unreachable")) > 20
    assert (found.labels == truth).mean() > 0.99
    assert (found.labels == truth)[found.proven].all()
    assert found.proven[truth == "blocked"].mean() > 0.95
    assert not found.proven[truth == "reachable"].any()


def test_constraints_that_see_turns_leave_proofs_to_none():
    """Of a joint that turns twice a closed form gives one value, and a constraint may admit another."""
    robot = ws.load_robot("ur5e")
    T = robot.chain.poses(anywhere(robot.chain, 30))
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    turned = (ExpressionConstraint("turned", lambda q, position, axes: q[0] - 5.3),)
    assert not ws.reachable(robot, T[:, :3, 3], quat, device="cpu", constraints=turned).proven.any()
    narrow = ws.load_robot("ur5e", limits=dict.fromkeys(robot.joint_names, (-3.1, 3.1)))
    T = narrow.chain.poses(anywhere(narrow.chain, 30))
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    found = ws.reachable(narrow, T[:, :3, 3], quat, device="cpu", constraints=turned)
    assert (found.labels == "blocked").all() and found.proven.mean() > 0.9


def test_evidence_names_the_closed_form():
    assert evidence_for(ws.load_robot("ur5e").chain, "pose") == "closed form (three parallel axes), margin 1e-7"
    assert evidence_for(ws.load_robot("ur5e").chain, "position") == "search"
    searched = "ball search along joint 7 over a closed form (spherical shoulder, axes 6 and 5 intersecting)"
    assert evidence_for(ws.load_robot("franka_panda").chain, "pose") == f"{searched}, margin 1e-7"
    assert evidence_for(ws.load_robot("franka_panda").chain, "position") == "search"
