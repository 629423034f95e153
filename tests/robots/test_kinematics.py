"""What moves an end effector: a model's chain and functions of the host behind one interface."""

import ast
from pathlib import Path

import numpy as np
import pytest

import wsrender as ws
from tests.reference import chain_kinematics
from tests.reference.chain_kinematics import coupling
from wsrender.engine import Accuracy, evaluate_kinematics, evaluate_poses, sampled_positions, solve_inverse
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.robots.chain import Chain
from wsrender.robots.host_kinematics import HostKinematics
from wsrender.robots.joint_space import JointSpace, unlimited
from wsrender.robots.kinematics import Kinematics

SOURCES = Path(ws.__file__).parent
PLACEMENT = {"position_m": (0.3, -0.2, 0.15), "quat_wxyz": (0.5, 0.1, -0.7, 0.5)}
TOOL = {"position_m": (0.05, 0.02, -0.11), "quat_wxyz": (0.9, -0.3, 0.1, 0.3)}
COUPLED = """<mujoco><worldbody><body><joint name="lift" type="slide" axis="0 0 1" range="0 0.5"/><geom size=".1"/>
  <body pos=".3 0 .1" euler="20 0 40"><joint name="turn" axis="0 1 0" range="-90 90"/><geom size=".1"/>
    <body pos=".2 0 0"><joint name="follower" axis="1 0 1" range="-90 90"/><geom size=".1"/>
      <body pos="0 .1 .2"><joint name="out" type="slide" axis="1 0 0" range="0 0.2"/><geom size=".1"/>
        <site name="tool" pos=".1 .1 0"/></body></body></body></body></worldbody>
  <equality><joint joint1="follower" joint2="turn" polycoef="0.1 -0.5 0 0 0"/></equality></mujoco>"""


def load(source):
    return ws.load_robot(source, placement=PLACEMENT, tool=TOOL).chain


def samples(chain, count=20):
    return np.random.default_rng(3).uniform(chain.lower_limits, chain.upper_limits, (count, chain.n))


def as_functions(chain):
    """The same arm as functions of the host, in its own base frame and at its tip."""
    own = chain.placed(np.eye(4), np.eye(4))
    names = ("name", "base_frame", "tip_frame", "joint_names", "lower_limits", "upper_limits", "periodic")
    return HostKinematics(
        **{name: getattr(chain, name) for name in names},
        efforts=unlimited(chain.n),
        velocity_limits=np.full(chain.n, np.inf),
        turning=chain.revolute,
        has_inertia=False,
        base_pose=own.poses,
        base_jacobian=own.jacobians,
    ).placed(chain.T_world_base, chain.T_tip_tool)


@pytest.mark.parametrize("source", ["ur5e", "stanford_arm", COUPLED], ids=["ur5e", "stanford_arm", "coupled"])
def test_a_chain_on_the_host_is_the_reference(source):
    chain = load(source)
    q = samples(chain)
    assert chain.poses(q) == pytest.approx(np.array([chain_kinematics.forward_kinematics(chain, row) for row in q]))
    assert chain.jacobians(q) == pytest.approx(np.array([chain_kinematics.jacobian(chain, row) for row in q]))
    assert np.array_equal(chain.coupling, coupling(chain))


@pytest.mark.parametrize("source", ["stanford_arm", COUPLED], ids=["stanford_arm", "coupled"])
def test_functions_of_the_host_take_the_place_of_a_chain(source):
    chain = load(source)
    functions, q = as_functions(chain), samples(chain)
    found, expected = (evaluate_kinematics(each, q, device="cpu") for each in (functions, chain))
    assert found.pose == pytest.approx(expected.pose, abs=1e-12)
    assert found.jacobian == pytest.approx(expected.jacobian, abs=1e-12)
    assert np.array_equal(evaluate_poses(functions, q, device="cpu"), found.pose)
    positions = sampled_positions(tip_pipeline(functions, q))
    assert positions == pytest.approx(expected.pose[:, :3, 3], abs=1e-12)
    assert np.array_equal(functions.revolute, chain.revolute)


def test_inverse_kinematics_of_functions_end_where_those_of_a_chain_do():
    chain = load("stanford_arm")
    functions, q = as_functions(chain), samples(chain)
    targets = chain.poses(q)[:, :3, 3]
    starts = np.clip(q + 0.05, chain.lower_limits, chain.upper_limits)
    tries = [
        solve_inverse(each, targets, starts, Accuracy(1e-9, 1.0, 0.5), device="cpu") for each in (chain, functions)
    ]
    assert all(each.reached.all() for each in tries)
    assert tries[1].q == pytest.approx(tries[0].q, abs=1e-6)


def test_functions_have_a_joint_space_and_no_geometry():
    chain = load("stanford_arm")
    functions = as_functions(chain)
    assert isinstance(functions, JointSpace)
    assert isinstance(functions, Kinematics)
    assert not isinstance(functions, Chain)
    assert (functions.geometry, chain.geometry) == (None, chain)
    held = functions.held({"joint3": 0.2})
    assert (held.lower_limits[2], held.upper_limits[2], held.n) == (0.2, 0.2, chain.n)
    assert held.content_hash != functions.content_hash == as_functions(chain).content_hash


def test_boxes_hold_every_position_of_a_chain_and_the_samples_of_functions():
    chain = load("stanford_arm")
    functions = as_functions(chain)
    middle = chain.within(0.5)
    lower, upper = np.stack([chain.lower_limits, middle]), np.stack([middle, chain.upper_limits])
    q = np.random.default_rng(5).uniform(lower, upper, (500, 2, chain.n)).transpose(1, 0, 2)
    for each in (chain, functions):
        low, high = each.boxes(lower, upper)
        positions = np.stack([chain.poses(part)[:, :3, 3] for part in q])
        assert low.shape == high.shape == (2, 3)
        assert ((low[:, None] <= positions) & (positions <= high[:, None])).all(), type(each)


def test_nothing_asks_which_kind_of_kinematics_it_has():
    """What needs a geometry asks for it: a branch on a class is one that the next class forgets."""
    kinds = {"Chain", "HostKinematics", "HostRobot"}
    asked = []
    for path in sorted(SOURCES.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in ("isinstance", "issubclass", "type"):
                names = {name.id for name in ast.walk(node) if isinstance(name, ast.Name)}
                asked += [f"{path.relative_to(SOURCES)}: {ast.unparse(node)}"] if names & kinds else []
    assert asked == []
