"""DH tables to MuJoCo and back: against 4×4 products, hand-worked tables and random ones."""

import itertools
import math
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.reference import chain_kinematics, dh_product
from wsrender import load_robot
from wsrender.documents.robot import DHTable
from wsrender.robots import load_dh, load_mjcf, load_urdf
from wsrender.robots.dh import modified_dh, structural_length, to_mjcf
from wsrender.robots.model_warning import ModelWarning

QUARTERS = st.sampled_from([0.0, math.pi / 2, -math.pi / 2, math.pi])
ANGLES = st.one_of(QUARTERS, st.floats(-3.1, 3.1))
LENGTHS = st.one_of(st.just(0.0), st.floats(-0.8, 0.8))
RUN = settings(max_examples=40, deadline=None, derandomize=True)
tiny_robots_too = pytest.mark.filterwarnings("ignore:the reach of:wsrender.robots.ModelWarning")


def table(rows, convention="modified"):
    return DHTable(convention=convention, rows=rows)


@st.composite
def tables(draw, alphas=ANGLES, lengths=LENGTHS):
    """DH tables of 1 to 7 joints with a configuration."""
    rows, q = [], []
    for _ in range(draw(st.integers(1, 7))):
        row = {"a": draw(lengths), "alpha": draw(alphas), "d": draw(lengths), "theta": draw(ANGLES)}
        if draw(st.booleans()) and draw(st.booleans()):
            row |= {"joint": "prismatic", "limits": (-0.5, 0.75)}
        rows.append(row)
        q.append(draw(st.floats(-0.5, 0.75)))
    return table(rows, draw(st.sampled_from(["modified", "standard"]))), np.array(q)


def pose_in_mujoco(mjcf, q):
    model = mujoco.MjModel.from_xml_string(mjcf)
    data = mujoco.MjData(model)
    data.qpos[:] = q
    mujoco.mj_kinematics(model, data)
    T = np.eye(4)
    T[:3, 3], T[:3, :3] = data.site("tool").xpos, data.site("tool").xmat.reshape(3, 3)
    return T


def product_of(rows, chain, q):
    """The pose that modified DH rows claim, joint displacements added."""
    T = np.eye(4)
    displacement = chain.joint_scale * q[chain.joint_source] + chain.joint_offset
    turn = np.concatenate([[0.0], np.where(chain.joint_is_revolute, displacement, 0.0), [0.0]])
    slide = np.concatenate([[0.0], np.where(chain.joint_is_revolute, 0.0, displacement), [0.0]])
    for (a, alpha, d, theta), more_theta, more_d in zip(rows, turn, slide, strict=True):
        T = T @ dh_product.step("modified", a, alpha, d + more_d, theta + more_theta)
    return T


# --- capsules along the links ---------------------------------------------------------------------------


@RUN
@given(tables(), st.floats(0.01, 0.2))
@tiny_robots_too
def test_capsules_lie_along_the_links_and_what_always_meets_is_excluded(case, radius):
    """From joint to joint: their ends are the base and the points of the skeleton. Only shapes come in addition."""
    bare, q = case
    robot = load_robot(bare.model_copy(update={"link_radius": radius}))
    assert load_robot(bare).has_inertia == robot.has_inertia
    np.testing.assert_array_equal(robot.chain.poses(q[None]), load_robot(bare).chain.poses(q[None]))
    bodies = robot.bodies
    data, poses = mujoco.MjData(bodies.model), bodies.poses(q[None])[0]
    data.qpos[:] = bodies.qpos(q[None])[0]
    mujoco.mj_kinematics(bodies.model, data)
    # Where the base is far from a small arm, drawings of it begin at the first joint.
    joints = np.vstack([robot.chain.T_world_base[:3, 3], robot.skeleton(q)[0]])
    slides = any(row.joint == "prismatic" for row in bare.rows)
    for one, T in zip(bodies.shapes, poses, strict=True):
        assert (one.kind, one.size[0]) == ("capsule", radius)
        gaps = [np.linalg.norm(joints - end, axis=1).min() for end in capsule_ends(one, T)]
        unturned = 1e-6 * one.size[1]  # MuJoCo leaves out turns of a geom by a few 1e-7 rad
        assert slides or max(gaps) < 1e-9 + unturned
    kept = {frozenset(bodies.shapes[k].body for k in pair) for pair in bodies.pairs}
    for one, other in itertools.combinations(dict.fromkeys(shape.body for shape in bodies.shapes), 2):
        geoms = ([shape.geom for shape in bodies.shapes if shape.body == name] for name in (one, other))
        distances = [mujoco.mj_geomDistance(bodies.model, data, *pair, 9.0, None) for pair in itertools.product(*geoms)]
        assert frozenset((one, other)) in kept or min(distances) < 1e-9


def capsule_ends(shape, T):
    return [T[:3, 3] + sign * shape.size[1] * T[:3, 2] for sign in (1, -1)]


def test_a_slides_capsule_reaches_the_link_before_wherever_it_stands():
    rows = [{"a": 0.0}, {"joint": "prismatic", "a": 0.3, "d": 0.1, "limits": [-0.3, 0.5]}]
    bodies = load_robot(table(rows).model_copy(update={"link_radius": 0.01})).bodies
    rod = [k for k, shape in enumerate(bodies.shapes) if shape.body == "link2"]
    for slide in (-0.3, 0.2, 0.5):
        T = bodies.poses(np.array([[0.3, slide]]))[0]
        heights = [end[2] for k in rod for end in capsule_ends(bodies.shapes[k], T[k])]
        assert (min(heights), max(heights)) == pytest.approx((slide - 0.5, slide + 0.3))  # its middle is at slide + 0.1


def test_links_too_short_for_a_capsule_have_none():
    rows = [{"a": 0.3}, {"a": 1e-8, "d": 1e-7}, {"a": 1e-5}]
    bodies = load_robot(table(rows, "standard").model_copy(update={"link_radius": 0.1})).bodies
    assert [shape.body for shape in bodies.shapes] == ["link1", "link3"]


def test_a_radius_is_in_the_unit_of_the_table():
    rows = [{"a": 300.0}, {"a": 200.0}]
    robot = load_robot(table(rows, "standard").model_copy(update={"link_radius": 20.0}), length_unit_m=0.001)
    assert robot.shapes["size_m"].tolist() == [pytest.approx([0.02, 0.15, 0]), pytest.approx([0.02, 0.1, 0])]


# --- table → MJCF ---------------------------------------------------------------------------------------


@RUN
@given(tables())
def test_mujoco_moves_as_the_product_of_the_rows(case):
    dh, q = case
    np.testing.assert_allclose(pose_in_mujoco(to_mjcf(dh), q), dh_product.frames(dh, q)[-1], atol=1e-12, rtol=0)


@pytest.mark.parametrize("convention", ["modified", "standard"])
@pytest.mark.parametrize("inertia", [(0.02, 0.03, 0.04), (0.02, 0.03, 0.04, 0.002, -0.003, 0.004)])
def test_inertias_act_where_the_table_puts_them(convention, inertia):
    body = {"mass": 1.5, "center_of_mass": (0.1, -0.05, 0.2), "inertia": inertia, "armature": 0.1}
    rows = [
        {"a": 0.3, "alpha": 0.4, "d": 0.1, "theta": 0.2, **body},
        {"a": -0.2, "alpha_deg": 90, "joint": "prismatic", "limits": (0, 1), **body},
        {"a": 0.1, "alpha": -1.1, "d": 0.3, **body},
    ]
    dh, q = table(rows, convention), np.array([0.7, 0.4, -1.2])
    model = mujoco.MjModel.from_xml_string(to_mjcf(dh))
    data, M = mujoco.MjData(model), np.zeros((3, 3))
    data.qpos[:] = q
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, M)
    np.testing.assert_allclose(M, dh_product.inertia_matrix(dh, q), atol=1e-12)


def test_a_rod_without_width_keeps_its_zero_moment():
    tilted = (0.5, 0.5, 1.0, 0.5, 0.0, 0.0)  # principal moments 0, 1, 1
    dh = table([{"mass": 2.0, "inertia": tilted, "alpha": 0.3}])
    model = mujoco.MjModel.from_xml_string(to_mjcf(dh))
    np.testing.assert_allclose(np.sort(model.body_inertia[1]), [0.0, 1.0, 1.0], atol=1e-11)


def test_names_limits_and_efforts_reach_the_model():
    rows = [{"limits_deg": (-90, 45), "effort_limit": 12.0, "name": "waist <1>"}, {"a": 0.5}]
    robot = load_dh(table(rows))
    assert robot.chain.joint_names == ("waist <1>", "joint2")
    np.testing.assert_allclose(robot.chain.lower_limits, [-math.pi / 2, -math.pi], rtol=1e-15)
    np.testing.assert_allclose(robot.chain.upper_limits, [math.pi / 4, math.pi], rtol=1e-15)
    assert robot.chain.periodic.tolist() == [False, True]
    assert robot.model.jnt_actfrcrange[0].tolist() == [-12.0, 12.0]
    assert not robot.chain.has_inertia


def test_numbers_keep_all_their_digits():
    row = {"a": 0.1 + 0.2, "limits": (-1 / 3, 2 / 3)}
    text = to_mjcf(table([row]))
    assert repr(0.1 + 0.2) in text and f"{-1 / 3!r} {2 / 3!r}" in text


# --- chain → modified DH, by hand -----------------------------------------------------------------------


def a_and_d(chain):
    rows = modified_dh(chain)
    return np.round(rows[:, 0], 9).tolist(), np.round(rows[:, 2], 9).tolist()


def test_the_planar_arm_ends_in_its_last_link():
    dh = table([{"a": 0.4}, {"a": 0.3}], "standard")
    chain = load_dh(dh).chain
    assert a_and_d(chain) == ([0.0, 0.0, 0.4, 0.3], [0.0, 0.0, 0.0, 0.0])
    assert structural_length(chain) == pytest.approx(0.7, abs=1e-12)


def test_parallel_axes_keep_the_offsets_of_their_joint_frames():
    rows = [{}, {"alpha_deg": -90, "d": 0.2435}, {"a": 0.4318, "d": -0.0934}, {"a": -0.02, "alpha_deg": 90}]
    a, d = a_and_d(load_dh(table(rows)).chain)
    assert a == [0.0, 0.0, 0.0, 0.4318, 0.02, 0.0]
    assert d == [0.0, 0.0, 0.2435, -0.0934, 0.0, 0.0]


SAME_ARM = """<mujoco><compiler angle="degree"/><worldbody>
  <body pos="0 0 0.15"><joint name="a" axis="0 0 1" range="-90 90"/><geom size=".01"/>
    <body pos="0 0.04 0.25"><joint name="b" axis="0 1 0" pos="0 {shift} 0" range="-90 90"/><geom size=".01"/>
      <body pos="0 -0.04 0.3"><joint name="c" axis="0 0 1" pos="0 0 {shift}" range="-9 9"/><geom size=".01"/>
        <site name="tool" pos="0 0 0.2"/>
      </body></body></body></worldbody></mujoco>"""


@pytest.mark.parametrize("shift", [0.0, 0.07, -0.3])
def test_joint_frames_anywhere_on_crossing_axes_give_the_same_parameters(shift):
    """Axes z, y, z meet at heights 0.4 and 0.4 + 0.3: d = 0.4 and 0.3 + 0.2 wherever the frames are."""
    chain = load_mjcf(SAME_ARM.format(shift=shift)).chain
    assert structural_length(chain) == pytest.approx(0.15 + 0.25 + 0.3 + 0.2, abs=1e-12)
    assert a_and_d(chain)[0] == [0.0, 0.0, 0.0, 0.0, 0.0]


def test_a_horizontal_first_axis_counts_its_height():
    text = """<mujoco><worldbody><body pos="0.1 0 0.5"><joint axis="0 1 0" range="-1 1"/><geom size=".01"/>
      <site name="tool" pos="0.4 0 0"/></body></worldbody></mujoco>"""
    rows = modified_dh(load_mjcf(text).chain)
    np.testing.assert_allclose(np.abs(rows[:, [0, 2]]), [[0, 0.5], [0.1, 0], [0.4, 0]], atol=1e-12)


def test_opposite_axes_are_parallel():
    rows = [{"a": 0.2}, {"a": 0.3, "alpha_deg": 180, "d": 0.1}]
    found = modified_dh(load_dh(table(rows)).chain)
    np.testing.assert_allclose(found[1:3, [0, 2]], [[0.2, 0.0], [0.3, 0.1]], atol=1e-12)
    assert found[2, 1] == math.pi


def test_axes_written_with_three_digits_are_parallel():
    """rpy of 1.57 and -1.57 about other axes leaves 1e-3 rad; the common normal must stay at the joint."""
    text = """<robot name="r"><link name="l0"/><link name="l1"/><link name="l2"/><link name="tip"/>
      <joint name="j1" type="continuous"><parent link="l0"/><child link="l1"/><axis xyz="0 0 1"/></joint>
      <joint name="j2" type="continuous"><parent link="l1"/><child link="l2"/>
        <origin xyz="0.3 0 0.1" rpy="1.57 0 0"/><axis xyz="0 1 0"/></joint>
      <joint name="e" type="fixed"><parent link="l2"/><child link="tip"/><origin xyz="0.2 0 0"/></joint>
    </robot>"""
    assert structural_length(load_urdf(text, tip="tip").chain) == pytest.approx(0.6, abs=1e-3)


def test_a_slide_counts_with_its_largest_offset():
    def length(d, limits):
        return structural_length(load_dh(table([{"joint": "prismatic", "d": d, "limits": limits}])).chain)

    assert length(0.1, (0.2, 0.4)) == pytest.approx(0.5, abs=1e-12)
    assert length(-0.5, (0.0, 0.2)) == pytest.approx(0.5, abs=1e-12)
    assert length(0.0, (-0.7, 0.2)) == pytest.approx(0.7, abs=1e-12)


def test_a_coupled_slide_counts_as_far_as_its_leader_drives_it():
    chain = load_dh(table([{"joint": "prismatic", "limits": (0.0, 0.2)}])).chain
    coupled = replace(chain, joint_scale=np.array([3.0]), joint_offset=np.array([0.1]))
    assert structural_length(coupled) == pytest.approx(0.7, abs=1e-12)


def test_the_tool_counts_and_the_placement_does_not():
    chain = load_dh(table([{"a": 0.2}, {"a": 0.3}])).chain
    tool, placement = np.eye(4), np.eye(4)
    tool[0, 3], placement[:3, 3] = 0.25, [1.0, 2.0, 3.0]
    assert structural_length(chain.placed(placement, tool)) == pytest.approx(0.75, abs=1e-12)


# --- chain → modified DH, random ------------------------------------------------------------------------


@tiny_robots_too
@RUN
@given(tables())
def test_the_parameters_of_any_table_reproduce_its_motion(case):
    dh, q = case
    assume(all(abs(math.sin(row.alpha)) in (0.0, 1.0) or abs(math.sin(row.alpha)) > 0.01 for row in dh.rows))
    chain = load_dh(dh).chain
    pose = product_of(modified_dh(chain), chain, q)
    np.testing.assert_allclose(pose, chain_kinematics.forward_kinematics(chain, q), atol=1e-8)


GENERIC = st.floats(0.05, 3.0) | st.floats(-3.0, -0.05) | st.sampled_from([math.pi / 2, -math.pi / 2])


@tiny_robots_too
@RUN
@given(tables(alphas=GENERIC), st.integers(0, 2**32 - 1))
def test_skew_axes_give_back_the_table_whatever_the_joint_frames(case, seed):
    dh, q = case
    assume(dh.convention == "modified")
    chain = load_dh(dh).chain
    moved = with_other_joint_frames(chain, np.random.default_rng(seed))
    rows = modified_dh(moved)
    joints = rows[1:-1]
    inner = slice(0, -1)  # the last joint's frame is parallel to the tip's: its d is shared with the last row
    np.testing.assert_allclose(joints[:, 0], [abs(row.a) for row in dh.rows], atol=1e-8)
    np.testing.assert_allclose(np.cos(joints[:, 1]), [math.cos(row.alpha) for row in dh.rows], atol=1e-9)
    np.testing.assert_allclose(joints[inner, 2], [row.d for row in dh.rows][inner], atol=1e-7)
    assert joints[-1, 2] + rows[-1, 2] == pytest.approx(dh.rows[-1].d, abs=1e-7)
    np.testing.assert_allclose(product_of(rows, moved, q), chain_kinematics.forward_kinematics(chain, q), atol=1e-7)


def with_other_joint_frames(chain, generator):
    """The same robot with every joint frame turned about, and moved along, its axis.

    A slide's axis is any line of its direction, so its frame is only turned.
    """
    T_joint, before = [], np.eye(4)
    for T, revolute in zip(chain.T_joint, chain.joint_is_revolute, strict=True):
        shift = generator.uniform(-0.5, 0.5) if revolute else 0.0
        change = dh_product.rotation_z(generator.uniform(-3, 3)) @ dh_product.translation(0.0, shift)
        T_joint.append(np.linalg.inv(before) @ T @ change)
        before = change
    return replace(chain, T_joint=np.array(T_joint), T_tip=np.linalg.inv(before) @ chain.T_tip)


@pytest.mark.parametrize("field", ["alpha", "theta"])
@pytest.mark.parametrize(("angle", "degrees"), [(90, True), (-45.0, True), (6.2, False), (-3.2, False)])
def test_angles_that_can_only_be_degrees_are_said(field, angle, degrees):
    rows = [{"a": 0.3, "limits": (-1, 1)}, {"a": 0.3, field: angle, "limits": (-1, 1)}]
    table = DHTable(convention="standard", rows=rows)
    if not degrees:
        assert load_dh(table).notices == ()
        return
    with pytest.warns(ModelWarning, match=rf"can only be degrees: joint2: {field} {angle:g} rad"):
        (notice,) = load_dh(table).notices
    assert (notice.code, notice.field) == ("units_angle", "robot.dh.rows")
    rows[1] = {"a": 0.3, f"{field}_deg": angle, "limits": (-1, 1)}
    assert load_dh(DHTable(convention="standard", rows=rows)).notices == ()
    whole = {"a": 0.3, f"{field}_deg": 360, "limits": (-1, 1)}
    assert load_dh(DHTable(convention="standard", rows=[whole])).notices == ()
