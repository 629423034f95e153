"""Labels and sets of open arms of six hinges: proofs, reasons, and what is left to the other search."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.engine.test_closed_form import anywhere, apart, in_the_box, near_limits
from tests.reach.test_closed_labels import ACCURACY, solver
from tests.reference.open_arms import TABLES, open_arm
from wsrender.pipeline.constraints.expression import ExpressionConstraint
from wsrender.reach import open_wrist_labels
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.posture_sets import PostureSolver
from wsrender.reach.targets import evidence_of

ARMS = ["CRX-10iA", "xArm6", "Jaco2, backwards", "random 2"]


def robot(name="CRX-10iA"):
    rows = [
        ws.DHRow(a=a, alpha_deg=alpha, d=d, theta_deg=theta, limits_deg=(low, high))
        for a, alpha, d, theta, low, high in TABLES[name]
    ]
    return ws.load_robot(ws.DHTable(convention="standard", rows=tuple(rows), name="open"))


@pytest.mark.parametrize("name", ARMS)
def test_no_configuration_refutes_what_is_proven(name):
    chain, random = open_arm(name), np.random.default_rng(0)
    near = chain.poses(near_limits(chain, 100))
    near[:, :3, 3] += random.normal(size=(100, 3)) * 1e-4  # on both sides of the boundary
    for T, proofs in ((in_the_box(chain, 200), 0.99), (near, 0.0)):
        found = solver(chain).solve(T[:, :3, 3], T[:, :3, :3])
        alone = solver(chain, closed=False).solve(T[:, :3, 3], T[:, :3, :3])
        assert not (found.label[alone.label == REACHABLE] == UNREACHABLE).any()
        assert (found.label[alone.label == UNREACHABLE] != REACHABLE).all()
        assert (found.label == UNDECIDED).sum() <= (alone.label == UNDECIDED).sum()
        assert found.proven[found.label == UNREACHABLE].mean() >= proofs
        if proofs and name in TABLES:  # all that a random arm does not reach is out of its box
            assert alone.proven.mean() < found.proven.mean()


@pytest.mark.parametrize("name", ARMS)
def test_poses_at_limits_are_reached(name):
    chain = open_arm(name)
    T = chain.poses(near_limits(chain, 600))
    found = solver(chain).solve(T[:, :3, 3], T[:, :3, :3])
    assert (found.label == REACHABLE).all() and not found.proven.any()
    back = chain.poses(found.q)
    assert np.linalg.norm(back[:, :3, 3] - T[:, :3, 3], axis=1).max() <= ACCURACY["position_m"] * (1 + 1e-9)


def test_targets_of_an_axis_are_decided_where_joint_6_turns_about_it():
    """The turn about the tip's axis is joint 6 then: what the whole pose reaches at no turn is out of reach."""
    chain = open_arm("CRX-10iA")
    T = in_the_box(chain, 300)
    arm = solver(chain, kind="axis")
    assert arm.closed.form.name.startswith("ball search along the turn about the tip's axis, ")
    found, label = arm.solve(T[:, :3, 3], T[:, :3, 2]), np.zeros(300, np.int8)
    for turn in np.arange(24) * np.pi / 12:
        R = T[:, :3, :3] @ Rotation.from_rotvec([0, 0, turn]).as_matrix()
        label |= solver(chain).solve(T[:, :3, 3], R).label == REACHABLE
    assert not (label.astype(bool) & found.proven).any()
    assert (found.label == REACHABLE)[label.astype(bool)].all()
    assert found.proven.mean() > 0.3


def test_moved_bases():
    """A base placement's labels: targets seen from moved bases, many times as many as are made at a time."""
    chain, random = open_arm("CRX-10iA"), np.random.default_rng(3)
    bases = np.tile(np.eye(4), (7, 1, 1))
    bases[:, :3, 3] = random.uniform(-0.3, 0.3, (7, 3))
    T, closed = in_the_box(chain, 40), solver(chain).closed
    made = (bases[:, None] @ T).reshape(-1, 4, 4)
    found = closed.labels_from(bases, T)
    assert (found == closed.labels(made[:, :3, 3], made[:, :3, :3])).all()
    assert {REACHABLE, UNREACHABLE} <= set(found.tolist())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(open_wrist_labels, "TOGETHER", 90)
        assert (closed.labels_from(bases, T) == found).all()


def test_robots_and_results_say_what_decides():
    arm = robot()
    assert arm.closed_form == "ball search along joint 6, axes 1 and 2 intersecting, axes 4 and 5 intersecting"
    T = arm.chain.poses(anywhere(arm.chain, 20))
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    assert evidence_of(arm.chain, "pose") == f"{arm.closed_form}, margin 1e-7"
    assert evidence_of(arm.chain, "position") == "search"
    never = (ExpressionConstraint("never", lambda q, position, axes: q[0] - 100.0),)
    found = ws.reachable(arm, T[:, :3, 3], quat, device="cpu", constraints=never)
    assert (found.labels == "blocked").mean() > 0.9 and not found.proven.any()


@pytest.mark.parametrize("name", ["CRX-10iA", "xArm6", "Piper"])
def test_sets_hold_the_configuration_that_made_the_pose(name):
    chain = open_arm(name)
    q = anywhere(chain, 150)
    found = PostureSolver(chain, device="cpu", threads=1).solve(chain.poses(q))
    assert found.complete.mean() > 0.95 and "complete where its terms" in found.evidence
    assert found.residual_m.max() < 1e-9 and found.residual_rad.max() < 1e-9
    of = [np.flatnonzero(found.pose == k) for k in range(len(q))]
    assert max(apart(chain, q[k], found.configurations[rows]).min() for k, rows in enumerate(of)) < 1e-6
    turns = (chain.upper_limits - chain.lower_limits) > 2 * np.pi + 0.1
    assert (found.windings.max() > 1) == turns.any()
    for k in range(3):  # every winding is one more configuration of the pose
        wound = np.array([each for row in of[k] for each in found.wound(int(row))])
        assert len(wound) == found.windings[of[k]].sum() == len(np.unique(np.round(wound, 6), axis=0))
        assert chain.poses(wound) == pytest.approx(np.tile(chain.poses(q[[k]]), (len(wound), 1, 1)), abs=1e-8)


def test_near_singular_poses_are_not_called_complete():
    chain = open_arm("CRX-10iA")
    q = anywhere(chain, 4000)
    at = np.argsort(np.linalg.svd(chain.jacobians(q), compute_uv=False)[:, -1])[:4]
    found = PostureSolver(chain, device="cpu", threads=1, starts=64).solve(chain.poses(q[at]))
    assert (found.sigma_min[:1] < 1e-3).all() and not found.complete[0]


def test_postures_of_the_analysis_are_those_of_the_function():
    arm = robot()
    T = arm.chain.poses(anywhere(arm.chain, 3))
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    found = ws.postures(arm, T[:, :3, 3], quat, device="cpu")
    assert len(found) >= 3 and found.complete.all()
    assert found.evidence.startswith("ball search along joint 6")
