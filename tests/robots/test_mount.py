"""Joints that carry a robot's base: as if its model had been written with them."""

import mujoco
import numpy as np
import pytest

import wsrender as ws
from tests.reference import chain_kinematics as reference
from tests.reference import mujoco_kinematics
from tests.robots.test_length_unit import text as in_metres_over
from wsrender.errors import DocumentError, InputError

# What the model's defaults say of joints holds for its own alone; its angles are degrees.
ARM = """<mujoco><default><joint type="hinge" damping="1" armature="0.3" range="-90 90" pos="0 0 0.01" ref="20"
    actuatorfrcrange="-5 5"/></default>
  <custom><numeric name="velocity_limits" data="3 4"/></custom>
  <worldbody><geom name="ground" type="plane" size="1 1 1" pos="0 0 -0.4"/>{before}
    <body name="foot" pos="0.1 0 0"><inertial pos="0 0 0.1" mass="7" diaginertia="0.3 0.2 0.1"/>
      <geom name="housing" type="box" size="0.1 0.1 0.1" contype="1"/>
      <body name="a" pos="0 0 0.3"><joint name="j" axis="0 1 0"/>
        <inertial pos="0.1 0 0" mass="2" diaginertia="0.02 0.03 0.04"/>
        <body name="b" pos="0.4 0 0"><joint name="k" axis="1 0 0"/><geom name="tip" size="0.02" mass="1"/>
          <site name="tool" pos="0 0 0.1"/></body></body></body>{after}</worldbody></mujoco>"""
OWN = 'ref="0" armature="0" actuatorfrclimited="false"'
CARRIED = ARM.format(
    before=f"""<body name="carriage"><joint name="rail" type="slide" axis="0 1 0" range="-1 2" pos="0 0 0" {OWN}/>
      <joint name="waist" axis="0 0 1" range="-60 45" pos="-0.2 0.1 0" {OWN}/>""",
    after="</body>",
).replace("3 4", "0 0 3 4")
MOUNT = [
    {"name": "rail", "axis": "y", "limits": [-1, 2]},
    {"name": "waist", "joint": "revolute", "axis": [0, 0, 4], "position_m": [-0.2, 0.1, 0], "limits_deg": [-60, 45]},
]
NAMES = ("rail", "waist", "j", "k")
URDF = """<robot name="arm"><link name="base"><inertial><origin xyz="0 0 0.1"/><mass value="7"/>
    <inertia ixx="0.3" iyy="0.2" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="a"><inertial><mass value="2"/><inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/>
    </inertial></link>
  <joint name="j" type="revolute"><parent link="base"/><child link="a"/><origin xyz="0.1 0 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" velocity="3" effort="5"/></joint></robot>"""


def loaded(text=None, **fields):
    return ws.load_robot(text or ARM.format(before="", after=""), **fields)


@pytest.fixture(scope="module")
def robot():
    return loaded(mount=MOUNT)


@pytest.mark.parametrize("q", [(0.0, 0.0, 0.0, 0.0), (1.3, -0.9, 0.4, -1.1)])
def test_a_mount_moves_as_joints_of_the_model_do(robot, q):
    model, chain = mujoco.MjModel.from_xml_string(CARRIED), robot.chain
    data = mujoco_kinematics.at(model, dict(zip(NAMES, np.array(q) + model.qpos0, strict=True)))
    assert chain.joint_names == NAMES
    moved = np.array(q) + model.qpos0
    T = mujoco_kinematics.pose(model, data, "tool")
    np.testing.assert_allclose(reference.forward_kinematics(chain, moved), T, atol=1e-12)
    J = mujoco_kinematics.jacobian(model, data, "tool", NAMES)
    np.testing.assert_allclose(reference.jacobian(chain, moved), J, atol=1e-12)
    M = mujoco_kinematics.inertia_matrix(model, data, NAMES)
    np.testing.assert_allclose(reference.inertia_matrix(chain, moved), M, atol=1e-12)


def test_limits_speeds_and_forces_are_those_stated(robot):
    lower, upper = np.array([[-1, 2], np.radians([-60, 45]), *[np.radians([-90, 90])] * 2]).T
    np.testing.assert_allclose([robot.lower_limits, robot.upper_limits], [lower, upper], atol=1e-15)
    assert robot.chain.velocity_limits.tolist() == [np.inf, np.inf, 3.0, 4.0]
    assert robot.chain.efforts[1].tolist() == [np.inf, np.inf, 5.0, 5.0]
    given = loaded(mount=MOUNT, limits={"rail": (0, 3)}, velocity_limits={"rail": 2}, effort_limits={"rail": 90})
    assert given.upper_limits[0] == 3 and given.chain.velocity_limits[0] == 2 and given.chain.efforts[0, 0] == -90
    endless = loaded(mount=[{"name": "turntable", "joint": "revolute", "axis": "z"}])
    assert endless.chain.periodic.tolist() == [True, False, False]


def test_what_stands_on_the_mount_moves_and_what_stands_in_the_world_does_not(robot):
    bodies = robot._loaded.bodies
    frames = {shape.name: (shape.frame, shape.surroundings) for shape in bodies.shapes}
    assert frames == {"ground": (-1, True), "housing": (1, False), "tip": (3, False)}
    around = {tuple(bodies.shapes[k].name for k in pair) for pair in bodies.around.tolist()}
    assert around == {("ground", "housing"), ("ground", "tip")}


def test_bodies_of_several_worlds_and_frames_are_carried_together():
    parts = "<worldbody><frame pos='0 0 1'><body name='x'/></frame></worldbody><worldbody>{}</worldbody>"
    arm = "<body pos='1 0 0'><joint name='j' range='-1 1'/><geom size='0.1'/><site name='tool'/></body>"
    robot = loaded(f"<mujoco>{parts.format(arm)}</mujoco>", mount=MOUNT[:1])
    np.testing.assert_allclose(robot.forward_kinematics([0.7, 0.1])[0][:3, 3], [1, 0.7, 0], atol=1e-12)
    assert int(robot.model.body("x").rootid[0]) == robot.model.body("base mount").id


def test_a_urdf_is_carried_with_its_base():
    robot = ws.load_robot(URDF, mount=[{"name": "rail", "axis": [1, 0, 1], "limits": [0, 2]}])
    T = robot.forward_kinematics([np.sqrt(2), 0.5])[0]
    np.testing.assert_allclose(T[:3, 3], [1.1, 0, 1.3], atol=1e-12)
    assert [shape.frame for shape in robot._loaded.bodies.shapes] == [0]
    assert reference.inertia_matrix(robot.chain, np.zeros(2))[0, 0] == pytest.approx(9.0)
    assert robot.chain.velocity_limits.tolist() == [np.inf, 3.0]


def test_a_mount_is_in_metres_whatever_the_model_is_in():
    mount = [{"name": "lift", "axis": "z", "limits": [0, 0.5]}]
    robots = [ws.load_robot(in_metres_over(1 / unit), mount=mount, length_unit_m=unit) for unit in (1.0, 1e-3)]
    metres, millimetres = (robot.forward_kinematics([[0.4, 0.3, 0.1, 0.2]])[0] for robot in robots)
    np.testing.assert_allclose(millimetres, metres, atol=1e-9)


def test_the_base_frame_stands_at_its_placement_while_the_mount_is_at_0():
    placement = {"position_m": [1, 2, 3], "rpy_deg": [0, 0, 90]}
    robot = loaded(mount=[{"name": "rail", "axis": "x", "limits": [5, 6]}], placement=placement)
    alone = loaded(placement=placement)
    moved = robot.forward_kinematics([[5.5, 0.1, 0.2]])[0] - alone.forward_kinematics([[0.1, 0.2]])[0]
    np.testing.assert_allclose(moved[:3, 3], [0, 5.5, 0], atol=1e-12)


RAIL = {"name": "rail", "axis": "x", "limits": [0, 1]}
REFUSED = [
    ({"mount": [RAIL | {"limits": None}]}, "mount.0.limits", "prismatic joint"),
    ({"mount": [RAIL | {"limits_deg": [0, 1]}]}, "mount.0.limits_deg", "together"),
    ({"mount": [RAIL | {"limits": None, "limits_deg": [0, 1]}]}, "mount.0.limits_deg", "in metres"),
    ({"mount": [RAIL | {"position_m": [0, 0, 1]}]}, "mount.0.position_m", "changes nothing"),
    ({"mount": [RAIL | {"axis": [0, 0, 0]}]}, "mount.0.axis", "no direction"),
    ({"mount": [RAIL | {"axis": "w"}]}, "mount.0.axis: must be", '"x", "y", "z"'),
    ({"mount": [RAIL, RAIL]}, "mount.1.name", "another than that of another joint"),
    ({"mount": [RAIL | {"name": str(k)} for k in range(7)]}, "mount", "6"),
    ({"mount": [RAIL | {"name": "j"}]}, "mount.0.name", "a joint of the model, 'j'"),
    ({"mount": [RAIL], "base": "foot"}, "mount", "base"),
]


@pytest.mark.parametrize(("fields", "field", "message"), REFUSED)
def test_what_cannot_carry_is_refused_by_name(fields, field, message):
    with pytest.raises((DocumentError, InputError), match=message) as error:
        loaded(**fields)
    assert field in str(error.value)
