"""Functions of users that ask for frames, Jacobian, gravity or limits, against MuJoCo's own numbers."""

import mujoco
import numpy as np
import pytest

import wsrender as ws
from tests.pipeline.test_torque import ARM, Bare, text_of
from tests.reference import mujoco_kinematics as by_mujoco
from wsrender import math
from wsrender.documents.constraints import Constraints
from wsrender.engine import SweepPlan, configurations, devices_of, sweep
from wsrender.errors import InputError
from wsrender.pipeline.constraints import registry
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot.constraints import constraints_for

COUNT = 1024
NEAR = {"float32": 3e-4, "float64": 3e-9}  # of a margin of about 1 to 100
PLACED = ws.Transform(position_m=(0.2, 0.1, 0.0), rpy_deg=(20, -35, 70))
GRAVITY = (1.0, 2.0, -9.0)


@pytest.fixture
def added(monkeypatch):
    """Constraints that the test adds, and forgets."""
    monkeypatch.setattr(registry, "_ADDED", {})
    ws.register_constraint("high", high)
    ws.register_constraint("gentle", gentle)
    ws.register_constraint("steep", lambda q, p, a, J: J[2][1] + 0.3 * J[5][2] - 0.1 * J[3][0])
    ws.register_constraint("middle", lambda q, p, a, *, limits: limits.upper[1] - limits.lower[1] - 4 * q[1])
    ws.register_constraint("mixed", mixed)


def high(q, position, axes, frames, height=0.2):
    return frames[2].position[2] - height + 0.2 * frames[1].axes[2][0] + 0.1 * (frames[-1].position[0] - position[0])


def gentle(q, position, axes, g, limits, share=0.5):
    return share * limits.effort[1] - math.absolute(g[1])


def mixed(q, position, axes, limits, J, g, frames, least=0.0):
    turned = frames[1].axes[0][1] - frames[1].axes[1][2] + frames[0].axes[1][0]
    return frames[2].position[0] - least + 0.1 * g[1] + J[0][1] + turned + 0.1 * limits.lower[0]


def swept(robot, name, precision, device, names=(), sampling=None, **options):
    pipeline = Pipeline(
        Evaluation(robot.chain, names, (0, 1, 2) if names else ()),
        plan_sampling(robot.chain, sampling or ws.Sobol(COUNT)),
        constraints_for(robot, Constraints(**{name: options or True}), gravity=GRAVITY),
        kept_rows=frozenset(),
        precision=precision,
    )
    found = sweep(pipeline, 0, pipeline.sampling.count, devices_of(device))
    rows = np.concatenate([found.rows[first] for first in sorted(found.rows)], axis=1)
    return configurations(pipeline), rows[-1] != 0, pipeline.constraints[0]


def numbers(robot, bare, q):
    """Anchors and axes of the joints (N, n, 3), Jacobians (N, 6, n) and bias forces (N, n) of a placed model."""
    model, T = bare.model, robot.chain.T_world_base
    model.opt.gravity = T[:3, :3].T @ GRAVITY
    found = []
    for row in q:
        data = by_mujoco.at(model, dict(zip(robot.joint_names, row, strict=True)))
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        J = by_mujoco.jacobian(model, data, robot.tip_frame, robot.joint_names)
        J = np.vstack([T[:3, :3] @ J[:3], T[:3, :3] @ J[3:]])
        found.append((data.xanchor @ T[:3, :3].T + T[:3, 3], data.xaxis @ T[:3, :3].T, J, data.qfrc_bias.copy()))
    return [np.array(each) for each in zip(*found, strict=True)]


def margins(robot, name, q):
    """What the functions above should be, of MuJoCo's numbers."""
    bare = Bare(text_of("ur5e"), list(robot.joint_names), robot.tip_frame, 0.0, np.zeros(3))
    anchors, axes, J, g = numbers(robot, bare, q)
    chain = robot.chain
    tip = chain.poses(q)[:, :3, 3]
    return {
        "high": anchors[:, 2, 2] - 0.3 + 0.2 * axes[:, 1, 0] + 0.1 * (anchors[:, -1, 0] - tip[:, 0]),
        "gentle": 0.1 * chain.effort_limits[1] - np.abs(g[:, 1]),
        "steep": J[:, 2, 1] + 0.3 * J[:, 5, 2] - 0.1 * J[:, 3, 0],
        "middle": chain.upper_limits[1] - chain.lower_limits[1] - 4 * q[:, 1],
    }[name]


OPTIONS = {"high": {"height": 0.3}, "gentle": {"share": 0.1}}


@pytest.mark.parametrize("names", ((), ("manipulability",), ("dynamic_manipulability",)), ids="".join)
@pytest.mark.parametrize("name", ("high", "gentle", "steep", "middle"))
def test_labels_are_those_of_mujocos_numbers(name, names, precision, device, added):
    robot = ws.load_robot("ur5e", placement=PLACED)
    q, rejected, twin = swept(robot, name, precision, device, names, **OPTIONS.get(name, {}))
    margin = margins(robot, name, q)
    sure = np.abs(margin) > NEAR[precision]
    np.testing.assert_array_equal(rejected[sure], (margin < 0)[sure])
    np.testing.assert_array_equal(twin.host(q, robot.chain.poses(q))[sure], rejected[sure])
    assert sure.mean() > 0.98 and 0.05 * COUNT < rejected.sum() < 0.95 * COUNT


SKEW = """<mujoco><compiler angle="radian"/><worldbody>
  <body name="A"><joint name="a" axis="0.3 0.1 1" range="-2 2"/><geom size=".1" pos=".2 0 .1" mass="1"/>
  <body name="B" pos=".3 0 .2"><joint name="b" type="slide" axis="0.2 1 0.7" range="-.2 .3"/><geom size=".1" mass="1"/>
  <body name="C" pos=".1 .2 0"><joint name="c" axis="1 0.4 -0.2" range="-2 2"/><geom size=".1" pos="0 .1 0" mass="1"/>
  <body name="D" pos="0 .2 .1"><joint name="d" axis="0.5 -0.4 0.7" range="-2 2"/><geom size=".1" mass="1"/>
    <site name="tool" pos="0 .1 .1"/></body></body></body></body></worldbody></mujoco>"""


@pytest.mark.parametrize("model", ("franka_panda", SKEW), ids=("panda", "skew"))
@pytest.mark.parametrize("away", ((0.2, 0.1, 0.0), (456_000.0, 5_428_000.0, 110.0)), ids=("near", "far"))
def test_all_at_once_as_numpy_says(model, away, precision, device, added):
    """Also from a base far from the world's origin, of whose positions single precision holds no millimetres."""
    robot = ws.load_robot(model, placement=ws.Transform(position_m=away, rpy_deg=(20, -35, 70)))
    q, _, twin = swept(robot, "mixed", precision, device)
    values = mixed(q.T, None, None, **{each: twin._asked(each, q, None) for each in twin.asks}) - away[0]
    q, rejected, twin = swept(robot, "mixed", precision, device, least=away[0] + np.median(values))
    values -= np.median(values)
    sure = np.abs(values) > NEAR[precision]
    np.testing.assert_array_equal(rejected[sure], (values < 0)[sure])
    np.testing.assert_array_equal(twin.host(q, robot.chain.poses(q))[sure], rejected[sure])
    assert sure.mean() > 0.98 and 0.4 * COUNT < rejected.sum() < 0.6 * COUNT


def test_a_leader_on_another_branch_weighs_too(precision, device, added):
    robot = ws.load_robot(ARM)
    slopes = (("c", "lead", 1.5, 0.2), ("d", "lead", -2.0, 0.0))
    ws.register_constraint("light", lambda q, p, a, g, J: 3.0 - math.absolute(g[2]) + 0.1 * J[0][2])
    q, rejected, twin = swept(robot, "light", precision, device)
    bare = Bare(ARM, ["a", "b", "lead"], "tool", 0.0, np.zeros(3), slopes)
    margin = 3.0 - np.abs(bare.efforts(q, GRAVITY)[0])[:, 2] + 0.1 * robot.chain.jacobians(q)[:, 0, 2]
    sure = np.abs(margin) > NEAR[precision]
    np.testing.assert_array_equal(rejected[sure], (margin < 0)[sure])
    np.testing.assert_array_equal(twin.host(q, robot.chain.poses(q))[sure], rejected[sure])
    assert 0.1 * COUNT < rejected.sum() < 0.9 * COUNT
    with pytest.raises(InputError, match=r"constraints\.high: takes frames, and joints of this robot follow"):
        constraints_for(robot, Constraints(high=True))


def test_by_jobs_with_gravity_and_without_effort_limits(added):
    job = {
        "analysis": "workspace",
        "robot": {"library": "ur5e"},
        "sampling": {"method": "grid", "per_joint": 4},
        "constraints": {"gentle": {"share": 0.2}},
        "refined_volume": None,
        "device": "cpu",
    }
    heavy, none = (ws.execute(job | {"gravity_m_s2": g}).document["samples"] for g in (None, (0, 0, 0)))
    assert heavy["rejected"]["gentle"] > 0 == none["rejected"]["gentle"]
    rows = [{"a": 0.4, "mass": 1.0, "limits": [-3, 3]}] * 2
    free = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
    assert not swept(free, "gentle", "float64", "cpu")[1].any()
    shapes = {
        SweepPlan(
            Pipeline(
                Evaluation(robot.chain),
                plan_sampling(robot.chain, ws.Sobol(64)),
                constraints_for(robot, Constraints(gentle={"share": share}), gravity=gravity),
            )
        ).shape
        for robot in (ws.load_robot("ur5e"),)
        for share, gravity in ((0.1, GRAVITY), (0.7, (0, 0, 0)))
    }
    assert len(shapes) == 1
    bare = ws.load_robot(ws.DHTable(convention="standard", rows=[{"a": 0.4, "limits": [-3, 3]}] * 2))
    with pytest.raises(InputError, match=r"constraints\.gentle: takes g, and the model of .* lacks masses"):
        constraints_for(bare, Constraints(gentle=True))
    with pytest.raises(InputError, match=r"constraints\.high: takes a joint that this robot of 2 does not have"):
        constraints_for(bare, Constraints(high=True))
