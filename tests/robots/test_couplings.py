"""Joints that follow other joints, and closed loops."""

import mujoco
import numpy as np
import pytest

from tests.reference import chain_kinematics as reference
from tests.reference import mujoco_kinematics as by_mujoco
from wsrender import robots
from wsrender.documents.robot import RobotSpec
from wsrender.documents.sampling import Grid
from wsrender.engine.grid_structure import structure_of
from wsrender.errors import ModelError
from wsrender.kinetostatics.kinematics import PostureKinematics
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot import evaluate_indices, link_shapes, robot_of_spec
from wsrender.robot.indices import evaluation_of
from wsrender.robots.model_warning import ModelWarning


def arm(equality, extra=""):
    """Four hinges a, b, c, d in a row (b with a ref), a finger f beside the last link, and equalities."""
    return f"""<mujoco><compiler angle="radian"/><worldbody>
      <body name="A"><joint name="a" axis="0 0 1" range="-1 1"/><geom size=".1" pos=".2 0 0"/>
      <body name="B" pos=".4 0 0">
        <joint name="b" axis="0 1 0" ref=".3" range="-1 2"/><geom size=".1" pos=".2 0 0"/>
      <body name="C" pos=".4 0 0"><joint name="c" axis="0 1 0.2" range="-2 2"/><geom size=".1" pos=".1 0 0"/>
      <body name="D" pos=".3 0 0"><joint name="d" axis="1 0 0" range="-2 2"/><geom size=".1" pos="0 .1 0"/>
        <site name="tool" pos="0 .1 .1"/>
        <body name="F"><joint name="f" axis="0 0 1" ref=".1"/><geom size=".02" pos=".1 0 0"/></body>
        <body name="G"><joint name="g" axis="0 0 1"/><geom size=".02" pos=".1 0 0"/></body>
      </body></body></body></body>{extra}</worldbody>
      <equality>{equality}</equality></mujoco>"""


def follow(follower, leader, coefficients, more=""):
    leads = f'joint2="{leader}"' if leader else ""
    return f'<joint joint1="{follower}" {leads} polycoef="{coefficients}" {more}/>'


def check(text, dependent, free):
    """Compares with MuJoCo, ``dependent`` giving the value of each follower from a dict of the free ones."""
    model = mujoco.MjModel.from_xml_string(text)
    robot = robots.load_mjcf(text)
    chain = robot.chain
    assert chain.joint_names == free
    step = 0.37 * np.eye(len(free))
    for q in np.random.default_rng(1).uniform(chain.lower_limits, chain.upper_limits, (5, chain.n)):
        values = dict(zip(free, q, strict=True))
        full = values | dependent(values)
        data = by_mujoco.at(model, full)
        T = by_mujoco.pose(model, data, "tool")
        names = [name for name in "abcdfg" if name in full]
        J, M = by_mujoco.jacobian(model, data, "tool", names), by_mujoco.inertia_matrix(model, data, names)
        S = np.array(
            [[_slope(dependent, values, name, free[k], step[k, k]) for k in range(len(free))] for name in names]
        )
        np.testing.assert_allclose(reference.forward_kinematics(chain, q), T, atol=1e-12)
        np.testing.assert_allclose(reference.jacobian(chain, q), J @ S, atol=1e-12)
        np.testing.assert_allclose(reference.inertia_matrix(chain.dynamic, q), S.T @ M @ S, atol=1e-12)
        again = mujoco.MjData(robot.model)
        robot.set_configuration(again, q)
        np.testing.assert_allclose(again.qpos, data.qpos, atol=1e-15)
    return chain


def _slope(dependent, values, name, wrt, step):
    if name in values:
        return float(name == wrt)
    moved = values | {wrt: values[wrt] + step}
    return (dependent(moved)[name] - dependent(values)[name]) / step


def test_a_follower_is_driven_by_its_leader():
    text = arm(follow("c", "b", "0.1 -0.5 0 0 0"))  # c = 0.1 − 0.5 (b − 0.3)
    chain = check(text, lambda v: {"c": 0.1 - 0.5 * (v["b"] - 0.3)}, ("a", "b", "d"))
    assert list(chain.joint_source) == [0, 1, 1, 2]


def test_a_follower_may_come_before_its_leader():
    check(arm(follow("a", "d", "0 0.4 0 0 0")), lambda v: {"a": 0.4 * v["d"]}, ("d", "b", "c"))


def test_followers_of_followers():
    text = arm(follow("d", "c", "0.2 2 0 0 0") + follow("c", "b", "-0.1 0.5 0 0 0"))

    def dependent(v):
        c = -0.1 + 0.5 * (v["b"] - 0.3)
        return {"c": c, "d": 0.2 + 2 * c}

    check(text, dependent, ("a", "b"))


def test_a_joint_led_from_another_branch_keeps_its_freedom():
    text = arm(follow("c", "f", "0.25 3 0 0 0")).replace('ref=".1"', 'ref=".1" range="-.5 .5"')
    chain = check(text, lambda v: {"c": 0.25 + 3 * (v["f"] - 0.1)}, ("a", "b", "f", "d"))
    assert (chain.lower_limits[2], chain.upper_limits[2]) == (-0.5, 0.5)


def test_a_joint_held_by_a_constant_equality():
    check(arm(follow("b", "", "0.5 0 0 0 0")), lambda v: {"b": 0.8}, ("a", "c", "d"))


def test_followers_off_the_chain_are_held_where_their_leader_puts_them():
    text = arm(follow("f", "g", "0.7 1 0 0 0"))
    check(text, lambda v: {"f": 0.8}, ("a", "b", "c", "d"))


def test_followers_off_the_chain_move_with_their_leader_on_it():
    """One finger follows a joint far up the arm, the other the first finger; what they weigh is where they are."""
    text = arm(follow("f", "b", "0.2 -1.5 0 0 0") + follow("g", "f", "0 2 0 0 0"))

    def dependent(v):
        f = 0.1 + 0.2 - 1.5 * (v["b"] - 0.3)
        return {"f": f, "g": 2 * (f - 0.1)}

    chain = check(text, dependent, ("a", "b", "c", "d"))
    assert list(chain.dynamic.joint_source) == [0, 1, 2, 3, 1, 1, 1, 1]
    robot, q = robot_of_spec(RobotSpec(mjcf=text)), np.full((1, 4), 0.3)
    expected = reference.inertia_matrix(chain.dynamic, q[0])
    np.testing.assert_allclose(robot.inertia_matrix(q, method="mujoco")[0], expected, atol=1e-12)


def test_followers_off_the_chain_that_are_not_linear_stand_still_and_are_told():
    """What else follows moves all the same."""
    text = arm(follow("f", "b", "0 -1.5 1 0 0") + follow("g", "b", "0 2 0 0 0"))
    with pytest.warns(ModelWarning, match="higher degree; .* off it, what they carry stands still"):
        robot = robots.load_mjcf(text)
    assert list(robot.chain.dynamic.joint_source) == [0, 1, 2, 3, 1, 1]
    (told,) = [notice for notice in robot.notices if notice.code == "followers_off_chain"]
    assert told.message.startswith("joint 'f' follows")
    with pytest.raises(ModelError, match="joint 'f' follows another joint by a polynomial of higher degree"):
        _ = robot.bodies


def test_polynomials_off_the_chain_are_evaluated():
    text = arm(follow("g", "", "0.5 0 0 0 0") + follow("f", "g", "0 1 2 0 0"))
    check(text, lambda v: {"g": 0.5, "f": 0.1 + 0.5 + 0.5}, ("a", "b", "c", "d"))


def test_inactive_equalities_do_not_bind():
    chain = robots.load_mjcf(arm(follow("c", "b", "0 1 0 0 0", 'active="false"'))).chain
    assert chain.joint_names == ("a", "b", "c", "d")


def test_limits_are_what_leader_and_followers_allow():
    with pytest.warns(ModelWarning, match="'c' allows it"):
        chain = robots.load_mjcf(arm(follow("c", "d", "1 -2 0 0 0"))).chain  # c = 1 − 2 d in [−2, 2]
    assert chain.joint_names == ("a", "b", "d")
    assert (chain.lower_limits[2], chain.upper_limits[2]) == pytest.approx((-0.5, 1.5))


def test_limits_that_leave_nothing_are_refused():
    with pytest.raises(ModelError, match="joint 'd': its limits and those of its followers leave"):
        robots.load_mjcf(arm(follow("c", "d", "9 1 0 0 0")))


@pytest.mark.parametrize(
    ("equality", "message"),
    [
        (follow("c", "b", "0 1 0.5 0 0"), "joint 'c' follows another joint by a polynomial of higher degree"),
        (follow("c", "b", "0 1 0 0 0") + follow("c", "a", "0 1 0 0 0"), "joint 'c' follows two joints"),
        (follow("c", "b", "0 1 0 0 0") + follow("b", "c", "0 1 0 0 0"), "form a cycle"),
        (
            "".join(follow(name, "g", "0.1 0 0 0 0") for name in "abcd"),
            "no joint of the chain is free to move: couplings hold a, b, c, d",
        ),
        (
            '<connect name="rod" body1="B" body2="D" anchor="0 0 0"/>',
            "equality 'rod' ties B, D into a closed",
        ),
        ('<weld body1="D"/>', "an equality ties D, world into a closed loop"),
        ('<weld body1="A" body2="F"/>', "an equality ties A, F into a closed loop"),
        ('<connect site1="tool" site2="post"/>', "an equality ties A, D into a closed loop"),
    ],
)
def test_couplings_that_are_refused(equality, message):
    text = arm(equality).replace('<body name="B"', '<site name="post"/><body name="B"')
    with pytest.raises(ModelError, match=message):
        robots.load_mjcf(text)


def test_tendon_equalities_on_the_chain_are_refused():
    tendon = '<tendon><fixed name="t"><joint joint="a" coef="1"/><joint joint="b" coef="1"/></fixed></tendon>'
    text = arm('<tendon name="belt" tendon1="t"/>').replace("</mujoco>", tendon + "</mujoco>")
    with pytest.raises(ModelError, match="equality 'belt' ties A, B, world into a closed loop"):
        robots.load_mjcf(text)


@pytest.mark.parametrize(
    "equality",
    [
        '<connect body1="F" body2="G" anchor=".1 0 0"/>',
        '<weld body1="D" body2="F"/>',
        '<weld body1="m" body2="D"/>',
    ],
)
def test_loops_within_a_link_and_mocap_bodies_are_fine(equality):
    chain = robots.load_mjcf(arm(equality, '<body name="m" mocap="true"/>')).chain
    assert chain.joint_names == ("a", "b", "c", "d")


HAND = """<mujoco><compiler angle="radian"/><worldbody>
  <body name="palm"><joint name="wrist" axis="0 1 0.3" range="-1 1"/><geom size=".1" pos=".1 0 0"/>
    <body name="L1" pos=".1 .1 0" euler=".2 0 .1"><joint name="l1" axis="0 0 1" ref=".1" range="-1 1"/>
      <geom size=".03" pos=".05 0 .01"/>
      <body name="L2" pos=".1 0 0"><joint name="l2" axis=".1 0 1" range="-.5 .5"/><geom size=".02" pos=".03 .01 0"/>
      </body></body>
    <body name="R1" pos=".1 -.1 0"><joint name="r1" axis="0 .2 1" range="-3 3"/><geom size=".03" pos=".05 0 0"/>
      <body name="R2" pos=".1 0 0"><joint name="r2" axis="0 0 1" range="-3 3"/><geom size=".02" pos=".03 0 0"/>
        <site name="pad" pos=".06 0 .01"/></body></body>
  </body></worldbody>
  <equality><joint joint1="r1" joint2="l1" polycoef=".1 -1.5 0 0 0"/>
    <joint joint1="r2" joint2="l2" polycoef="0 2 0 0 0"/></equality></mujoco>"""


def followers(q):
    wrist, l1, l2 = q
    return {"wrist": wrist, "l1": l1, "l2": l2, "r1": 0.1 - 1.5 * (l1 - 0.1), "r2": 2 * l2}


@pytest.mark.parametrize("method", ["kernel", "mujoco"])
def test_leaders_on_another_branch_move_their_own_bodies(method):
    """Kinematics, and inertia over both fingers, against MuJoCo: the path has 3 of the 5 joints that move."""
    robot = robot_of_spec(RobotSpec(mjcf=HAND), tip="pad")
    assert robot.joint_names == ("wrist", "l1", "l2")
    assert list(robot.chain.joint_source) == [0, 1, 2]
    assert list(robot.chain.dynamic.joint_source) == [0, 1, 2, 2, 1, 1, 2]
    q = np.random.default_rng(3).uniform(robot.lower_limits, robot.upper_limits, (8, 3))
    model = mujoco.MjModel.from_xml_string(HAND)
    names = ["wrist", "l1", "l2", "r1", "r2"]
    C = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1.5, 0], [0, 0, 2]])
    T, J = robot.forward_kinematics(q, device="cpu"), robot.jacobian(q, device="cpu")
    M = robot.inertia_matrix(q, method=method, device="cpu")
    for row, *found in zip(q, T, J, M, strict=True):
        data = by_mujoco.at(model, followers(row))
        np.testing.assert_allclose(found[0], by_mujoco.pose(model, data, "pad"), atol=1e-12)
        np.testing.assert_allclose(found[1], by_mujoco.jacobian(model, data, "pad", names) @ C, atol=1e-12)
        full = by_mujoco.inertia_matrix(model, data, names)
        np.testing.assert_allclose(found[2], C.T @ full @ C, atol=1e-13)


def test_dynamic_indices_count_the_bodies_of_leaders():
    robot = robot_of_spec(RobotSpec(mjcf=HAND), tip="pad")
    q = np.random.default_rng(4).uniform(robot.lower_limits, robot.upper_limits, (5, 3))
    found = evaluate_indices(robot, q, indices=["dynamic_manipulability"])["dynamic_manipulability"]
    J, M = robot.jacobian(q, device="cpu")[:, :3], robot.inertia_matrix(q, method="mujoco")
    np.testing.assert_allclose(found, np.abs(np.linalg.det(J)) / np.linalg.det(M), rtol=1e-9)


def test_grids_of_leaders_on_other_branches_take_no_short_cut_that_is_wrong():
    """The first joint's coordinate moves a body far down the arm too: M is not the same at all its levels."""
    text = arm(follow("a", "f", "0 1 0 0 0")).replace('ref=".1"', 'ref=".1" range="-.5 .5"')
    robot = robot_of_spec(RobotSpec(mjcf=text))
    assert robot.joint_names == ("f", "b", "c", "d")
    structures = {}
    for index in ("manipulability", "dynamic_manipulability"):
        evaluation = evaluation_of(
            robot, indices=[index], task="linear", convention="standard", joint_limit_penalty=None,
            characteristic_length_m=1.0, torque_scaling=False, inertia="kernel", precision="float64", index_options={},
        )  # fmt: skip
        structures[index] = structure_of(evaluation, plan_sampling(robot.chain, Grid(3)))
    assert structures["manipulability"].base_levels == 3
    assert structures["dynamic_manipulability"].base_levels == 1
    q = np.full((2, 4), 0.2)
    q[1, 0] = 0.4
    M = robot.inertia_matrix(q, method="mujoco")
    assert abs(M[0] - M[1]).max() > 1e-5 * abs(M).max()


def test_a_leader_above_the_base_moves_nothing_against_it():
    text = arm(follow("c", "a", "0 2 0 0 0"))
    robot = robots.load_mjcf(text, base="A")
    assert robot.chain.joint_names == ("b", "a", "d")
    assert robot.chain.with_branches is None
    q = np.array([0.4, 0.3, -0.2])
    data = by_mujoco.at(robot.model, {"a": 0.3, "b": 0.4, "c": 0.6, "d": -0.2})
    T = np.linalg.inv(by_mujoco.pose(robot.model, data, "A")) @ by_mujoco.pose(robot.model, data, "tool")
    np.testing.assert_allclose(reference.forward_kinematics(robot.chain, q), T, atol=1e-12)


def test_a_leader_on_another_branch_must_be_led_linearly():
    with pytest.raises(ModelError, match="joint 'c' follows another joint by a polynomial of higher degree"):
        robots.load_mjcf(arm(follow("c", "f", "0.25 3 1 0 0")))


def test_followers_that_narrow_their_leaders_limits_are_said():
    text = arm(follow("c", "d", "1 -2 0 0 0"))  # c = 1 − 2 d in [−2, 2], d in [−2, 2]
    told = r"the limits of joint 'd' are -0.5 … 1.5: its own are -2 … 2, but 'c' allows it -0.5 … 1.5; widen the limits"
    with pytest.warns(ModelWarning, match=told):
        robot = robots.load_mjcf(text)
    (notice,) = robot.notices
    assert (notice.code, notice.field) == ("follower_limits", "robot")
    assert robots.load_mjcf(arm(follow("c", "d", "0 0.5 0 0 0"))).notices == ()


def test_followers_that_leave_their_leader_nothing_are_named():
    with pytest.raises(ModelError, match=r"leave 7 … 2; .*: its own are -2 … 2, but 'c' allows it 7 … 11$"):
        robots.load_mjcf(arm(follow("c", "d", "-9 1 0 0 0")))


def test_postures_and_pictures_follow_leaders_on_another_branch():
    robot = robot_of_spec(RobotSpec(mjcf=HAND), tip="pad")
    q = np.array([0.3, -0.4, 0.2])
    posture = PostureKinematics(robot).at(q)
    np.testing.assert_allclose(posture.position, robot.forward_kinematics(q, device="cpu")[0, :3, 3], atol=1e-12)
    np.testing.assert_allclose(posture.J, robot.jacobian(q, device="cpu")[0], atol=1e-12)
    np.testing.assert_allclose(robot.skeleton(q)[0, -1], posture.position, atol=1e-12)
    data = by_mujoco.at(robot.model, followers(q))
    mujoco.mj_kinematics(robot.model, data)
    drawn = [shape.vertices.mean(axis=0) for shape in link_shapes(robot, q)]
    np.testing.assert_allclose(drawn, data.geom_xpos, atol=1e-9)
