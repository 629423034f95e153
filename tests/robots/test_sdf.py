"""SDF: its poses, axes, limits, inertias, shapes and included models, against hand-made numbers and a second walk."""

import math
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.robots import model_packages
from tests.server.hostile.cases import zipped
from wsrender.errors import ModelError
from wsrender.robots import load
from wsrender.robots.loading import load_archive

SAME = 1e-12  # of a few products of transforms in double precision
TWO = """<sdf version="{version}"><model name="arm"><pose>0 0 1 0 0 0</pose>
  <link name="a"><pose>1 0 0 0 0 {half}</pose></link>
  <link name="b"><pose relative_to="{of}">{pose}</pose>{more}</link>
  <frame name="f" attached_to="a"><pose>0 0 2 0 0 {half}</pose></frame>
  <joint name="j" type="{kind}"><parent>{parent}</parent><child>{child}</child><pose>{joint}</pose>
    <axis><xyz {axis_of}>{axis}</xyz>
    <limit><lower>-1</lower><upper>2</upper><effort>7</effort><velocity>3</velocity></limit>
    {frame}</axis></joint></model></sdf>"""
PLAIN = {
    "version": "1.9", "half": math.pi / 2, "of": "", "pose": "1 0 1 0 0 0", "more": "", "kind": "revolute",
    "parent": "a", "child": "b", "joint": "0 0 0 0 0 0", "axis": "0 1 0", "axis_of": "", "frame": "",
}  # fmt: skip


def arm(**fields):
    return load(TWO.format(**(PLAIN | fields)), base=fields.pop("base", None), tip=fields.get("tip", "b"))


def tip_pose(robot, *q):
    return robot.chain.frames(np.array([q]))[0, -1]


def turn(axis, angle):
    return Rotation.from_rotvec(np.array(axis, float) * angle).as_matrix()


@pytest.mark.parametrize(
    ("fields", "position", "axis"),
    [
        ({}, (1, 0, 2), (0, 1, 0)),  # in the model's frame, which is 1 m up
        ({"of": "a", "pose": "1 0 1 0 0 0"}, (1, 1, 2), (-1, 0, 0)),  # a stands at (1, 0, 0), turned by 90°
        ({"of": "f", "pose": "1 0 1 0 0 0"}, (0, 0, 4), (0, -1, 0)),  # f at (1, 0, 2), turned by 180°
        ({"axis_of": 'expressed_in="a"'}, (1, 0, 2), (-1, 0, 0)),
        ({"axis_of": 'expressed_in="__model__"', "of": "a"}, (1, 1, 2), (0, 1, 0)),
        ({"version": "1.6", "frame": "<use_parent_model_frame>1</use_parent_model_frame>", "pose": "1 0 1 0 0 1"},
         (1, 0, 2), (0, 1, 0)),
        ({"version": "1.4", "pose": "1 0 1 0 0 1"}, (1, 0, 2), (0, 1, 0)),  # before 1.5, always the model's
        ({"joint": "0 0 0 0 0 1.5707963267948966"}, (1, 0, 2), (-1, 0, 0)),
        ({"version": "1.10", "joint": "0 0 0 0 0 1.5707963267948966"}, (1, 0, 2), (-1, 0, 0)),  # newer than 1.5
    ],
)  # fmt: skip
def test_poses_and_axes_are_in_the_frames_that_they_name(fields, position, axis):
    robot = arm(**fields)
    at_zero, turned = tip_pose(robot, 0.0), tip_pose(robot, 0.5)
    np.testing.assert_allclose(at_zero[:3, 3], position, atol=SAME)
    np.testing.assert_allclose(turned[:3, :3], turn(axis, 0.5) @ at_zero[:3, :3], atol=SAME)
    np.testing.assert_allclose(turned[:3, 3], position, atol=SAME)


def test_a_joint_turns_about_its_own_place():
    """0.3 m beside the origin of the child."""
    robot = arm(joint="0 0 0.3 0 0 0")
    center = np.array([1, 0, 2.3])
    expected = center + turn((0, 1, 0), 0.7) @ (np.array([1, 0, 2]) - center)
    np.testing.assert_allclose(tip_pose(robot, 0.7)[:3, 3], expected, atol=SAME)


def test_a_tree_goes_over_joints_the_other_way():
    """The world holds the child: the parent moves against it."""
    hold = '</link><joint name="hold" type="fixed"><parent>world</parent><child>b</child></joint><link name="unused">'
    robot = load(TWO.format(**(PLAIN | {"more": hold, "joint": "0 0 0.3 0 0 0"})), tip="a")
    center = np.array([1, 0, 2.3])
    R = turn((0, 1, 0), -0.7)
    found = tip_pose(robot, 0.7)
    np.testing.assert_allclose(found[:3, 3], center + R @ (np.array([1, 0, 1]) - center), atol=SAME)
    np.testing.assert_allclose(found[:3, :3], R @ turn((0, 0, 1), math.pi / 2), atol=SAME)


def test_limits_units_and_couplings():
    robot = arm()
    assert (robot.chain.lower_limits, robot.chain.upper_limits) == (-1, 2)
    assert robot.chain.effort_limits.tolist() == [7] and robot.chain.velocity_limits.tolist() == [3]
    free = load(TWO.format(**PLAIN).replace("<lower>-1</lower><upper>2</upper>", "<lower>-1e16</lower>"), tip="b")
    assert free.chain.periodic.tolist() == [True]
    degrees = load(
        TWO.format(**(PLAIN | {"pose": "0 0 0 90 0 0"})).replace('relative_to=""', 'degrees="true"'), tip="b"
    )
    quaternion = '<pose rotation_format="quat_xyzw"'
    xyzw = load(TWO.format(**(PLAIN | {"pose": "0 0 0 2 0 0 2"})).replace('<pose relative_to=""', quaternion), tip="b")
    for each in (degrees, xyzw):
        np.testing.assert_allclose(tip_pose(each, 0)[:3, :3], turn((1, 0, 0), math.pi / 2), atol=SAME)
    follower = """<link name="c"><pose relative_to="b">0 0 1 0 0 0</pose></link><joint name="k" type="revolute">
      <parent>b</parent><child>c</child><axis><xyz>0 1 0</xyz><mimic joint="j"><multiplier>2</multiplier>
      <offset>0.1</offset><reference>0.3</reference></mimic></axis></joint></model>"""
    coupled = load(TWO.format(**PLAIN).replace("</model>", follower), tip="c")
    assert coupled.chain.n == 1
    R = turn((0, 1, 0), 0.7 + 2 * (0.7 - 0.3) + 0.1)
    np.testing.assert_allclose(tip_pose(coupled, 0.7)[:3, :3], R, atol=SAME)


def test_inertias_and_shapes():
    more = """<inertial><pose>.1 0 0 0 0 0</pose><mass>2</mass>
      <inertia><ixx>.1</ixx><iyy>.2</iyy><izz>.25</izz></inertia>
      </inertial><collision name="c"><pose>0 0 .5 0 0 0</pose><geometry><box><size>.2 .4 .6</size></box></geometry>
      </collision><visual name="v"><geometry><ellipsoid><radii>.1 .2 .3</radii></ellipsoid></geometry>
      <material><diffuse>1 0 0 .5</diffuse></material></visual>"""
    robot = arm(more=more)
    body = robot.model.body("b")
    assert body.mass == 2 and body.ipos.tolist() == [0.1, 0, 0]
    (box,), (ellipsoid,) = robot.bodies.shapes, robot.visuals.shapes
    assert (box.kind, box.size.tolist()) == ("box", [0.1, 0.2, 0.3])
    np.testing.assert_allclose(robot.bodies.poses(np.zeros((1, 1)))[0, 0, :3, 3], (1, 0, 2.5), atol=SAME)
    assert (ellipsoid.kind, ellipsoid.size.tolist()) == ("ellipsoid", [0.1, 0.2, 0.3])
    assert ellipsoid.rgba.tolist() == [1, 0, 0, 0.5]


INCLUDED = {
    "main/world.sdf": b"""<sdf version="1.9"><model name="cell">
      <include><uri>model://arm_model</uri><name>left</name><pose>0 1 0 0 0 0</pose></include>
      <include><uri>../arm_model</uri><name>right</name><pose relative_to="left">0 -3 0 0 0 0</pose></include>
      <joint name="l" type="fixed"><parent>world</parent><child>left::a</child></joint></model></sdf>""",
    "arm_model/model.config": b"""<model><name>arm</name><sdf version="1.4">old.sdf</sdf>
      <sdf version="1.10">new.sdf</sdf></model>""",
    "arm_model/new.sdf": TWO.format(**(PLAIN | {"more": """<collision name="c"><geometry><mesh><uri>meshes/a.stl</uri>
      <scale>2 1 1</scale></mesh></geometry></collision>"""})).encode(),
    "arm_model/meshes/a.stl": trimesh.creation.box((0.1, 0.2, 0.3)).export(file_type="stl"),
}  # fmt: skip


def test_included_models(tmp_path):
    for name, content in INCLUDED.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(content)
    for robot in (
        load(tmp_path / "main" / "world.sdf", tip="right::b"),
        load_archive(zipped(INCLUDED), tip="right::b", entry="main/world.sdf"),
    ):
        np.testing.assert_allclose(tip_pose(robot, 0)[:3, 3], (1, -2, 1), atol=SAME)
        assert [np.ptp(each.vertices, axis=0).round(6).tolist() for each in robot.bodies.shapes] == [
            [0.2, 0.2, 0.3]
        ] * 2
    (tmp_path / "arm_model" / "new.sdf").unlink()
    with pytest.raises(ModelError, match="the included model 'model://arm_model' is not there"):
        load(tmp_path / "main" / "world.sdf")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('<sdf version="1.7"/>', "the SDF has no <model>"),
        ('<sdf version="new"><model name="a"/></sdf>', "version 'new'"),
        ('<sdf version="1.7"><model name="a"/></sdf>', "the SDF has no <link>"),
        ('<sdf version="1.7"><model name="a"><link name="a"/><link name="a"/></model></sdf>', "are named 'a'"),
        (TWO.format(**(PLAIN | {"of": "b"})), "is said by its own"),
        (TWO.format(**(PLAIN | {"of": "none"})), "there is no link, joint or frame 'none'"),
        (TWO.format(**(PLAIN | {"parent": "none"})), "refers to link 'none', which does not exist"),
        (TWO.format(**(PLAIN | {"pose": "1 2 3"})), "6 numbers are needed"),
        (TWO.format(**(PLAIN | {"kind": "ball"})), "has type 'ball'; allowed: revolute, continuous, prismatic, fixed"),
        (TWO.format(**(PLAIN | {"axis": "0 0 0"})), "it must not be zero"),
        (TWO.format(**(PLAIN | {"axis": "0 0 nan"})), "a finite number is needed"),
        ('<sdf version="1.7"><include><uri>https://fuel/arm</uri></include></sdf>', "models are not downloaded"),
        ('<sdf version="1.7"><include><uri>/etc</uri></include></sdf>', "is not there"),
    ],
)
def test_what_is_wrong_is_refused(text, message):
    with pytest.raises(ModelError, match=message):
        load(text, tip="b")


def test_loops_are_told_where_a_chain_leads_over_them():
    rod = """<link name="c"/><joint name="k" type="revolute"><parent>b</parent><child>c</child></joint>
      <joint name="close" type="ball"><parent>a</parent><child>c</child></joint></model>"""
    text = TWO.format(**PLAIN).replace("</model>", rod)
    with pytest.raises(
        ModelError, match=r"equality 'close' ties a, c into a closed loop .* the analysis parallel_work"
    ):
        load(text, tip="c")


@pytest.mark.parametrize("name", ["arm.usd", "arm.usda", "arm.usdz", "arm.xml"])
def test_usd_is_refused_with_the_way_to_convert(name, tmp_path):
    (tmp_path / name).write_bytes(b"PXR-USDC" + b"\0" * 20)
    with pytest.raises(ModelError, match=r"USD is not read: convert it to URDF, by Isaac Sim's extension"):
        ws.load_robot(tmp_path / name)


def walked(path, q):
    """World poses of links of a file of one model, each pose of which is in the model's frame: a walk of its own."""
    model = next(ElementTree.parse(path).getroot().iter("model"))

    def said(element):
        x = np.array((element.findtext("pose") or "0 0 0 0 0 0").split(), float)
        out = np.eye(4)
        for axis, angle in ((2, x[5]), (1, x[4]), (0, x[3])):
            out[:3, :3] = out[:3, :3] @ turn(np.eye(3)[axis], angle)
        out[:3, 3] = x[:3]
        return out

    zero = {link.get("name"): said(model) @ said(link) for link in model.findall("link")}
    joints = {}
    for joint in model.findall("joint"):
        joints.setdefault(joint.findtext("child").strip(), joint)

    def pose(name):
        joint = joints.get(name)
        if joint is None:
            return zero[name]
        parent = joint.findtext("parent").strip()
        above = np.eye(4) if parent == "world" else pose(parent) @ np.linalg.inv(zero[parent])
        frame = zero[name] @ said(joint)
        move, value = np.eye(4), q.get(joint.get("name"), 0.0)
        if joint.find("axis") is not None:
            axis = np.array(joint.findtext("axis/xyz").split(), float)
            if (joint.findtext("axis/use_parent_model_frame") or "0").strip() == "1":
                axis = frame[:3, :3].T @ said(model)[:3, :3] @ axis
            axis /= np.linalg.norm(axis)
            if joint.get("type") == "revolute":
                move[:3, :3] = turn(axis, value)
            elif joint.get("type") == "prismatic":
                move[:3, 3] = axis * value
        return above @ frame @ move @ np.linalg.inv(frame) @ zero[name]

    return pose


CHAINS = {  # of files that others publish: base and tip
    "cassie_v2.sdf": ("pelvis", "left-hip-pitch"),
    "cassie_simple.sdf": ("pelvis", "right-hip-pitch"),
    "cassie_reduced.sdf": ("pelvis", "left-hip-pitch"),
    "cassie_wo_gearbox_spring.sdf": ("pelvis", "right-hip-yaw"),
    "kuka_world.sdf": (None, "lbr_iiwa_link_7"),
    "kuka_with_gripper.sdf": (None, "left_finger_tip"),
}


@pytest.mark.parametrize("name", CHAINS)
def test_published_files_against_another_walk(name):
    path = next((path for path in model_packages.files() if path.name == name), None)
    if path is None:
        pytest.skip("its package is not installed")
    base, tip = CHAINS[name]
    robot = load(path, base=base, tip=tip)
    if name.startswith("cassie"):  # the others' meshes are not in their package
        assert robot.visuals.shapes and robot.bodies.shapes and robot.visuals.notices == ()
    rng = np.random.default_rng(7)
    for _ in range(5):
        q = rng.uniform(-1, 1, robot.chain.n)
        pose = walked(path, dict(zip(robot.chain.joint_names, q, strict=True)))
        expected = pose(tip) if base is None else np.linalg.inv(pose(base)) @ pose(tip)
        found = tip_pose(robot, *q)
        if base is not None:
            found = np.linalg.inv(robot.chain.T_world_base) @ found
        np.testing.assert_allclose(found, expected, atol=SAME)


@pytest.mark.skipif(find_spec("pybullet") is None, reason="pybullet is not installed")
def test_a_published_file_against_bullet():
    """Bullet's own reader of SDF, which knows the tree by other rules."""
    import pybullet
    import pybullet_data

    path = Path(pybullet_data.getDataPath()) / "kuka_iiwa" / "kuka_with_gripper.sdf"
    robot = load(path, tip="left_finger_tip")
    client = pybullet.connect(pybullet.DIRECT)
    try:
        (body,) = pybullet.loadSDF(str(path), physicsClientId=client)
        infos = [pybullet.getJointInfo(body, k, client) for k in range(pybullet.getNumJoints(body, client))]
        numbers = {info[1].decode(): k for k, info in enumerate(infos)}
        links = {info[12].decode(): k for k, info in enumerate(infos)}
        q = np.linspace(-0.8, 0.9, robot.chain.n)
        for joint, value in zip(robot.chain.joint_names, q, strict=True):
            pybullet.resetJointState(body, numbers[joint], value, physicsClientId=client)
        state = pybullet.getLinkState(body, links["left_finger_tip"], 0, 1, client)
    finally:
        pybullet.disconnect(client)
    found = tip_pose(robot, *q)
    np.testing.assert_allclose(found[:3, 3], state[4], atol=1e-6)
    np.testing.assert_allclose(found[:3, :3], Rotation.from_quat(state[5]).as_matrix(), atol=1e-6)
