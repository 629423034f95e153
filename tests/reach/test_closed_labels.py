"""Labels that closed forms decide: proofs, reasons, and what is left to the search."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.engine.test_closed_form import anywhere, at_singular_postures, in_the_box, near_limits, with_slides
from tests.reference import closed_form_inverse
from tests.reference.arms_by_axes import PARALLEL, RELATIONS, random_arm
from wsrender.engine import CLOSED_MARGIN, closed_postures
from wsrender.pipeline.constraints.expression import ExpressionConstraint
from wsrender.reach import InverseSolver, closed_labels
from wsrender.reach.admission import Admission
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.targets import evidence_of
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


ARMS = {kind: lambda kind=kind: random_arm(kind, 1) for kind in [*RELATIONS, PARALLEL]} | {
    "ill-conditioned quartic": lambda: random_arm(RELATIONS[4], 16),
    "slide between hinges": lambda: with_slides("RPR 0"),
    **{name: lambda name=name: ws.load_robot(name).chain for name in ("ur5e", "puma560", "stanford_arm", "scara")},
    "singular everywhere": lambda: ws.load_robot("stanford_arm").chain.held({"joint1": 0.1}),
    **{f"{name} from 0": lambda name=name: from_0(name) for name in ("ur5e", "articulated")},
}


def from_0(name):
    """Limits where the elbow is straight and wrists are in line."""
    robot = ws.load_robot(name)
    return ws.load_robot(name, limits=dict.fromkeys(robot.joint_names, (0, 2))).chain


@pytest.mark.parametrize("arm", ARMS)
def test_nothing_within_the_tolerances_of_a_reached_pose_is_proven_out_of_reach(arm):
    """At limits and singular poses, by moves of all sizes: slack is lost in proportion to them, and by little."""
    chain, random = ARMS[arm](), np.random.default_rng(3)
    number = 1_000 if arm == "singular everywhere" else 10_000  # each a search along a family there
    T = chain.poses(np.concatenate([near_limits(chain, 4 * number, 3), at_singular_postures(chain, number)]))
    for tolerance in (1e-3, 1e-5, 1e-7):
        decided = solver(chain, position_m=tolerance, angle_rad=tolerance).closed
        assert decided.margin < 600 * tolerance
        for _ in range(3):
            away, about = (random.normal(size=(len(T), 3)) for _ in range(2))
            away, about = (tolerance * v / np.linalg.norm(v, axis=1, keepdims=True) for v in (away, about))
            turned = Rotation.from_rotvec(about).as_matrix() @ T[:, :3, :3]
            assert not decided.unreachable(T[:, :3, 3] + away, turned).any()


@pytest.mark.parametrize(
    ("name", "kind", "held"),
    [
        ("ur5e", "axis", {}),
        ("ur5e", "axis", {"joint5": 1.0}),
        ("puma560", "axis", {"joint5": 1.0}),
        ("puma560", "position", {}),
    ],
)
def test_nothing_near_is_proven_out_of_reach_however_it_is_turned(name, kind, held):
    """Directions and positions leave turns open, of which a closed form is given any."""
    chain, random = ws.load_robot(name).chain.held(held), np.random.default_rng(4)
    T = chain.poses(np.concatenate([near_limits(chain, 20_000, 3), at_singular_postures(chain, 20_000)]))
    for tolerance in (1e-3, 1e-5, 1e-7):
        away, about = (random.normal(size=(len(T), 3)) for _ in range(2))
        away, about = (tolerance * v / np.linalg.norm(v, axis=1, keepdims=True) for v in (away, about))
        z = (Rotation.from_rotvec(about).as_matrix() @ T[:, :3, :3])[:, :, 2] if kind == "axis" else None
        decided = solver(chain, kind, position_m=tolerance, angle_rad=tolerance).closed
        assert not decided.unreachable(T[:, :3, 3] + away, z).any()


def test_what_an_arm_loses_is_measured_once(monkeypatch):
    """Margins of all its solvers go by it, in proportion to their tolerances."""
    measured, real = [], closed_labels.closed_postures
    monkeypatch.setattr(closed_labels, "closed_postures", lambda *args, **kw: measured.append(1) or real(*args, **kw))
    chain = ws.load_robot("ur5e", limits={"joint3": (-2.0, 1.2345)}).chain
    margins = [solver(chain, position_m=scale * 1e-5, angle_rad=scale * 1e-5).closed.margin for scale in (0.5, 1)]
    assert len(measured) == 2 * closed_labels.SAMPLES / closed_labels.TOGETHER
    assert margins[1] - CLOSED_MARGIN == pytest.approx(2 * (margins[0] - CLOSED_MARGIN))
    other = ws.load_robot("ur5e", limits={"joint3": (-1.0, 1.2345)}).chain
    assert solver(other).closed.margin != margins[0]


@pytest.mark.parametrize(("name", "margin"), [("ur5e", 8), ("puma560", 40), ("gao_6r", 50), ("stanford_arm", 30)])
def test_few_proofs_are_given_up_for_the_tolerances(name, margin):
    """Of poses without a posture 0.3 % at most are not proven; margins in tolerances."""
    chain = ws.load_robot(name).chain
    T = in_the_box(chain, 50_000)
    decided, found = solver(chain).closed, closed_postures(ClosedForm.of(chain), T, device="cpu")
    assert decided.margin < margin * 1e-5
    assert decided.unreachable(T[:, :3, 3], T[:, :3, :3])[found.count == 0].mean() > 0.997


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


def test_no_limit_holds_what_is_just_out_of_reach():
    """Straight arms and positions less than the margin beyond them: no proof, but no limit is the reason either."""
    chain = ws.load_robot("puma560").chain
    solving = solver(chain, "position", position_m=1e-6)
    low, high = chain.lower_limits, chain.upper_limits
    q = np.random.default_rng(2).uniform(low, high, (200, chain.n))
    elbow = np.linspace(low[2], high[2], 20_001)
    at = np.tile(q[0], (len(elbow), 1))
    at[:, 2] = elbow
    shoulder = chain.frames(q[:1])[0, 1, :3, 3]
    q[:, 2] = elbow[np.argmax(np.linalg.norm(chain.poses(at)[:, :3, 3] - shoulder, axis=1))]
    position = chain.poses(q)[:, :3, 3]
    position += 4e-6 * (position - shoulder) / np.linalg.norm(position - shoulder, axis=1, keepdims=True)
    assert (solving.closed.labels(position, None, unlimited=True) == UNDECIDED).all()
    assert not solving.held_by_limits(q, position).any()


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
    T = narrow.chain.poses(anywhere(narrow.chain, 60))
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    found = ws.reachable(narrow, T[:, :3, 3], quat, device="cpu", constraints=turned)
    assert (found.labels == "blocked").all() and found.proven.mean() > 0.9


def test_evidence_names_the_closed_form():
    assert evidence_of(ws.load_robot("ur5e").chain, "pose") == "closed form (three parallel axes), margin 1e-7"
    assert evidence_of(ws.load_robot("ur5e").chain, "position") == "search"
    searched = "ball search along joint 7 over a closed form (spherical shoulder, axes 6 and 5 intersecting)"
    assert evidence_of(ws.load_robot("franka_panda").chain, "pose") == f"{searched}, margin 1e-7"
    assert evidence_of(ws.load_robot("franka_panda").chain, "position") == "search"
