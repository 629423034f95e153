"""URDF as found in the wild, against MuJoCo's own URDF reader and Pinocchio."""

import re

import mujoco
import numpy as np
import pytest

from tests.reference import chain_kinematics as reference
from tests.reference import mujoco_kinematics as by_mujoco
from wsrender import robots
from wsrender.errors import ModelError

# Everything that real files hold: comments, materials, transmissions, gazebo and undeclared prefixes, empty
# and massless links, fixed tips, odd names, turned and off-diagonal inertias, a continuous joint, axes that
# are missing or not unit vectors, a branch off the chain, meshes that are not there.
ARM = """<?xml version="1.0"?>
<!-- written by an exporter -->
<robot name="arm 7" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <material name="grey"><color rgba=".5 .5 .5 1"/></material>
  <link name="base_link">
    <visual><geometry><mesh filename="package://arm/meshes/base.dae"/></geometry></visual>
    <visual><origin xyz="0 0 .1"/><geometry><cylinder radius=".1" length=".2"/></geometry></visual>
    <collision>
      <geometry><mesh filename="file:///nowhere/base.stl" scale=".001 .001 .001"/></geometry></collision>
  </link>
  <link name="turret">
    <inertial><origin xyz="0.01 -0.02 0.1" rpy="0.3 -0.2 0.5"/><mass value="3.5"/>
      <inertia ixx="0.03" ixy="0.002" ixz="-0.001" iyy="0.04" iyz="0.003" izz="0.02"/></inertial>
  </link>
  <link name="upper/arm"><inertial><origin xyz="0.2 0 0"/><mass value="2.1"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.08" iyz="0" izz="0.07"/></inertial>
    <visual><geometry><box size=".4 .05 .05"/></geometry><material name="grey"/></visual></link>
  <link name="counterweight"><inertial><mass value="1.5"/>
      <inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/></inertial></link>
  <link name="slider"><inertial><mass value="0.8"/><origin xyz="0 0.05 0" rpy="0 0.4 0"/>
      <inertia ixx="0.002" ixy="0.0001" ixz="0" iyy="0.003" iyz="0" izz="0.0025"/></inertial>
    <collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="wrist"><inertial><mass value="0.4"/>
      <inertia ixx="4e-4" ixy="0" ixz="0" iyy="5e-4" iyz="0" izz="3e-4"/></inertial></link>
  <link name="flange"/>
  <link name="tool0"><inertial><origin xyz="0 0 0.03"/><mass value="0.2"/>
      <inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial></link>
  <link name="camera"/>
  <joint name="joint 1 (yaw)" type="revolute"><parent link="base_link"/><child link="turret"/>
    <origin xyz="0 0 0.3" rpy="0 0 0.4"/><axis xyz="0 0 2"/>
    <limit lower="-2.5" upper="2.8" effort="150" velocity="2"/><dynamics damping="5" friction="1"/></joint>
  <joint name="joint-2" type="revolute"><parent link="turret"/><child link="upper/arm"/>
    <origin xyz="0.05 0.1 0.2" rpy="-1.57 0.1 0"/>
    <limit lower="-1.5" upper="1.5" effort="150" velocity="2"/></joint>
  <joint name="balance" type="revolute"><parent link="upper/arm"/><child link="counterweight"/>
    <origin xyz="-0.2 0 0"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="joint_3" type="prismatic"><parent link="upper/arm"/><child link="slider"/>
    <origin xyz="0.4 0 0" rpy="0 0.3 0.2"/><axis xyz="0.6 0 -0.3"/>
    <limit lower="-0.1" upper="0.3" effort="80" velocity="1"/></joint>
  <joint name="j4" type="continuous"><parent link="slider"/><child link="wrist"/><origin rpy="0.1 0.2 0.3"/>
    <axis xyz="0 -1 0"/><limit effort="28" velocity="3"/></joint>
  <joint name="mount" type="fixed"><parent link="wrist"/><child link="flange"/><origin xyz="0 0 0.1"/></joint>
  <joint name="tip" type="fixed"><parent link="flange"/><child link="tool0"/><origin rpy="0 1.2 0"/></joint>
  <joint name="eye" type="fixed"><parent link="flange"/><child link="camera"/></joint>
  <transmission name="t1"><type>SimpleTransmission</type><joint name="joint-2"/>
    <actuator name="m"/></transmission>
  <gazebo reference="turret"><sensor:camera name="eye"/><plugin filename="libgazebo.so"/></gazebo>
</robot>
"""
JOINTS = ("joint 1 (yaw)", "joint-2", "joint_3", "j4")
KEEP_ALL = '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco></robot>'


def quietly(load, *arguments, **options):
    with pytest.warns(robots.ModelWarning):
        return load(*arguments, **options)


def by_mujocos_reader(text):
    """MuJoCo's own reading of a URDF whose meshes and prefixed tags are taken out."""
    text = re.sub(r"<(visual|collision)>.*?</\1>|<gazebo.*?</gazebo>", "", text, flags=re.DOTALL)
    return mujoco.MjModel.from_xml_string(text.replace("</robot>", KEEP_ALL))


def configurations(chain, count=10):
    return np.random.default_rng(5).uniform(chain.lower_limits, chain.upper_limits, (count, chain.n))


def test_kinematics_and_inertia_are_those_of_mujocos_reader():
    chain = quietly(robots.load_urdf, ARM).chain
    assert chain.joint_names == JOINTS
    assert (chain.name, chain.base_frame, chain.tip_frame) == ("arm 7", "world", "tool0")
    model = by_mujocos_reader(ARM)
    for q in configurations(chain):
        data = by_mujoco.at(model, dict(zip(JOINTS, q, strict=True)))
        T, J = by_mujoco.pose(model, data, "tool0"), by_mujoco.jacobian(model, data, "tool0", JOINTS)
        M = by_mujoco.inertia_matrix(model, data, JOINTS)
        np.testing.assert_allclose(reference.forward_kinematics(chain, q), T, rtol=0, atol=1e-12)
        np.testing.assert_allclose(reference.jacobian(chain, q), J, rtol=0, atol=1e-12)
        np.testing.assert_allclose(reference.inertia_matrix(chain, q), M, rtol=0, atol=1e-12 * M.max())


@pytest.mark.parametrize("tip", ["tool0", "camera", "counterweight", "wrist"])
def test_kinematics_and_inertia_are_those_of_pinocchio(tip):
    pin = pytest.importorskip("pinocchio")
    plain = re.sub(r"<gazebo.*?</gazebo>", "", ARM, flags=re.DOTALL)
    model = pin.buildModelFromXML(plain)
    data = model.createData()
    chain = quietly(robots.load_urdf, ARM, tip=tip).chain
    ids = [model.joints[model.getJointId(name)] for name in chain.joint_names]
    columns = [joint.idx_v for joint in ids]
    for q in configurations(chain, 5):
        full = pin.neutral(model)
        for joint, value in zip(ids, q, strict=True):
            at = slice(joint.idx_q, joint.idx_q + joint.nq)
            full[at] = (np.cos(value), np.sin(value)) if joint.nq == 2 else value
        frame = model.getFrameId(tip)
        J = pin.computeFrameJacobian(model, data, full, frame, pin.LOCAL_WORLD_ALIGNED)[:, columns]
        pin.updateFramePlacements(model, data)
        M = pin.crba(model, data, full)
        M = (np.triu(M) + np.triu(M, 1).T)[np.ix_(columns, columns)]
        T = data.oMf[frame].homogeneous
        np.testing.assert_allclose(reference.forward_kinematics(chain, q), T, rtol=0, atol=1e-12)
        np.testing.assert_allclose(reference.jacobian(chain, q), J, rtol=0, atol=1e-12)
        np.testing.assert_allclose(reference.inertia_matrix(chain, q), M, rtol=0, atol=1e-12 * M.max())


def test_limits_and_efforts():
    chain = quietly(robots.load_urdf, ARM).chain
    np.testing.assert_array_equal(chain.lower_limits, [-2.5, -1.5, -0.1, -np.pi])
    np.testing.assert_array_equal(chain.upper_limits, [2.8, 1.5, 0.3, np.pi])
    np.testing.assert_array_equal(chain.periodic, [False, False, False, True])
    assert chain.effort_limits is not None
    np.testing.assert_array_equal(chain.effort_limits, [150, 150, 80, 28])
    assert quietly(robots.load_urdf, ARM.replace('effort="80"', 'effort="0"')).chain.effort_limits is None
    np.testing.assert_array_equal(chain.velocity_limits, [2, 2, 1, 3])
    unlimited = ARM.replace('effort="80" velocity="1"', 'effort="80" velocity="inf"')
    assert np.isinf(quietly(robots.load_urdf, unlimited).chain.velocity_limits).tolist() == [False, False, True, False]


def test_meshes_are_dropped_with_one_warning_and_shapes_kept():
    with pytest.warns(robots.ModelWarning) as caught:
        robot = robots.load_urdf(ARM)
    assert len(caught) == 1
    assert "geometry of 2 meshes is dropped (package://arm/meshes/base.dae, …)" in str(caught[0].message)
    assert robot.model.nmesh == 0
    assert robot.model.ngeom == 3


def test_every_link_is_a_frame():
    model = quietly(robots.load_urdf, ARM).model
    names = {model.body(body).name for body in range(1, model.nbody)}
    assert names == set(re.findall(r'<link name="([^"]+)"', ARM))


def test_a_root_link_called_world_is_the_world():
    text = ARM.replace("base_link", "world")
    assert quietly(robots.load_urdf, text, base="world").chain.joint_names == JOINTS


def tree(*joints, links="abcd", inertial=""):
    body = "".join(f'<link name="{name}">{inertial}</link>' for name in links)
    return f'<robot name="r">{body}{"".join(joints)}</robot>'


def joint(name, parent, child, kind="revolute", more='<limit lower="-1" upper="1" effort="1" velocity="1"/>'):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="0.3 0 0"/><axis xyz="0 1 0"/>{more}</joint>'
    )


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_joints_of_several_freedoms_are_refused_on_the_chain_only(kind):
    text = tree(joint("loose", "a", "b", kind, ""), joint("j1", "b", "c"), joint("j2", "a", "d"))
    assert robots.load_urdf(text, tip="d").chain.joint_names == ("j2",)
    assert robots.load_urdf(text, base="b", tip="c").chain.joint_names == ("j1",)
    with pytest.raises(ModelError, match=f"joint 'loose' is {kind}: name a base below it"):
        robots.load_urdf(text, tip="c")


def test_mimic_joints_follow():
    mimic = '<limit lower="-3" upper="3" effort="1" velocity="1"/><mimic joint="{}" multiplier="{}" offset="{}"/>'
    text = tree(
        joint("j1", "a", "b"), joint("j2", "b", "c", more=mimic.format("j1", -2, 0.5)),
        joint("j3", "c", "d", "prismatic", mimic.format("j2", 0.1, 0.2)),
    )  # fmt: skip
    free = tree(joint("j1", "a", "b"), joint("j2", "b", "c"), joint("j3", "c", "d", "prismatic"))
    follower, chain = robots.load_urdf(text).chain, robots.load_urdf(free).chain
    assert follower.joint_names == ("j1",)
    for q in (-0.7, 0.0, 0.4):
        expected = reference.forward_kinematics(chain, [q, 0.5 - 2 * q, 0.2 + 0.1 * (0.5 - 2 * q)])
        np.testing.assert_allclose(reference.forward_kinematics(follower, [q]), expected, atol=1e-15)
    assert (follower.lower_limits[0], follower.upper_limits[0]) == (-1.0, 1.0)


def test_a_mimic_led_from_another_branch_keeps_its_freedom():
    text = tree(joint("finger", "a", "b"), joint("j", "a", "c"),
                joint("held", "c", "d", more='<mimic joint="finger" offset="0.25"/>'))  # fmt: skip
    free = tree(joint("finger", "a", "b"), joint("j", "a", "c"), joint("held", "c", "d"))
    held, chain = robots.load_urdf(text, tip="d").chain, robots.load_urdf(free, tip="d").chain
    assert held.joint_names == ("j", "finger")
    expected = reference.forward_kinematics(chain, [0.3, 0.25 + 0.1])
    np.testing.assert_allclose(reference.forward_kinematics(held, [0.3, 0.1]), expected, atol=1e-15)


def test_a_leader_on_another_branch_needs_limits_too():
    endless = '<joint name="finger" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>'
    text = tree(endless, joint("j", "a", "c"), joint("held", "c", "d", more='<mimic joint="finger"/>'))
    with pytest.raises(ModelError, match=r"'finger' has no <limit>.* \(it leads a joint of the chain\)"):
        robots.load_urdf(text, tip="d")


def test_limits_that_are_both_zero_count_as_none():
    unset = joint("j", "a", "b", more='<limit lower="0" upper="0" effort="0" velocity="0"/>')
    with pytest.warns(robots.ModelWarning, match="limits of j are both 0.*taken as no limits"):
        chain = robots.load_urdf(tree(unset, joint("k", "b", "c"), links="abc")).chain
    assert chain.periodic.tolist() == [True, False]


def test_faults_of_joints_off_the_chain_are_notes():
    text = tree(
        joint("j", "a", "b"),
        joint("broken", "a", "c", more=""),
        joint("lost", "a", "d", more='<mimic joint="x"/>'),
    )
    with pytest.warns(
        robots.ModelWarning, match="off the chain, .*'broken' has no <limit>.*; joint 'lost' mimics"
    ) as told:
        assert robots.load_urdf(text, tip="b").chain.joint_names == ("j",)
    assert len(told) == 1
    with pytest.raises(ModelError, match="revolute joint 'broken' has no <limit>"):
        robots.load_urdf(text, tip="c")
    with pytest.raises(ModelError, match="joint 'lost' mimics 'x', which is no other joint"):
        robots.load_urdf(text, tip="d")


@pytest.mark.parametrize(
    ("attributes", "inside", "message"),
    [
        ('type="spherical"', "", "'odd' has type 'spherical'; allowed"),
        ('type="free"', "", "'odd' has type 'free'; allowed"),
        ("", "", "'odd' has type ''; allowed"),
        ('type="revolute"', '<limit lower="1" upper="-1"/>', "its lower limit 1 is above its upper limit -1: give its"),
        ('type="revolute"', '<limit lower="-1,5" upper="1,5"/>', "lower limit is '-1,5'"),
        ('type="revolute"', '<limit lower="2" upper="2"/>', "its limits are both 2"),
        ('type="continuous"', '<axis xyz="0 0 0"/>', "its axis is '0 0 0'; it must not be zero"),
        ('type="continuous"', '<limit effort="-1"/>', "its effort limit is -1; it must not be negative"),
        ('type="continuous"', '<mimic joint="j" multiplier="x"/>', "mimic multiplier is 'x'"),
    ],
)
def test_an_odd_joint_is_a_note_off_the_chain_and_an_error_on_it(attributes, inside, message):
    odd = f'<joint name="odd" {attributes}><parent link="a"/><child link="b"/><origin xyz="0 0 1"/>{inside}</joint>'
    text = tree(odd, joint("j", "a", "c"), joint("k", "b", "d"))
    with pytest.warns(robots.ModelWarning, match=re.escape(message)) as caught:
        robot = robots.load_urdf(text, tip="c")
    assert [notice.code for notice in robot.notices] == ["joints_off_chain"]
    assert str(caught[0].message).startswith("off the chain, where it stands still: ")
    with pytest.raises(ModelError, match=re.escape(message)):
        robots.load_urdf(text, tip="d")
    with pytest.warns(robots.ModelWarning):
        assert robots.load_urdf(text, base="b", tip="d").chain.joint_names == ("k",)


def test_a_note_tells_of_four_joints_and_counts_the_others():
    odd = [joint(f"odd{k}", "a", link).replace('"revolute"', '"screw"') for k, link in enumerate("cdefgh")]
    with pytest.warns(robots.ModelWarning, match=r"'odd0'.*'odd3' has type 'screw'[^']*, and 2 more$"):
        robots.load_urdf(tree(joint("j", "a", "b"), *odd, links="abcdefgh"), tip="b")


def test_limits_that_are_given_mend_those_of_the_file():
    none, inverted = '<limit effort="1"/>', '<limit lower="1" upper="-1"/>'
    for name, inside in (("j", ""), ("j", inverted), ("j", '<limit lower="2" upper="2"/>'), ("j", none)):
        robot = robots.load_urdf(tree(joint(name, "a", "b", more=inside), links="ab"), limits={"j": (-0.5, 2)})
        assert (robot.chain.lower_limits[0], robot.chain.upper_limits[0], robot.notices) == (-0.5, 2, ())


@pytest.mark.parametrize("others", [[], ["world_"], ["world_", "world__"]])
def test_a_link_called_world_that_is_not_the_root(others):
    links = "".join(f'<link name="{name}"/>' for name in ("map", "world", "arm", *others))
    fixed = "".join(
        f'<joint name="f{k}" type="fixed"><parent link="map"/><child link="{name}"/></joint>'
        for k, name in enumerate(others)
    )
    text = f"""<robot name="r">{links}{fixed}<joint name="up" type="fixed"><parent link="map"/><child link="world"/>
      <origin xyz="0 0 0.5"/></joint><joint name="j" type="continuous"><parent link="world"/><child link="arm"/>
      <origin xyz="0.25 0 0"/></joint></robot>"""
    above, within = robots.load_urdf(text, tip="arm"), robots.load_urdf(text, base="world", tip="arm")
    assert above.chain.T_joint[0, :3, 3] == pytest.approx([0.25, 0, 0.5])
    assert within.chain.T_joint[0, :3, 3] == pytest.approx([0.25, 0, 0])
    assert (above.chain.base_frame, within.chain.base_frame) == ("world", "world")


@pytest.mark.parametrize("infinite", ["inf", "+Infinity", "1e10"])
def test_a_hinge_with_infinite_limits_is_continuous(infinite):
    lower = "-" + infinite.removeprefix("+")
    text = tree(
        joint("j", "a", "b", more=f'<limit lower="{lower}" upper="{infinite}" effort="{infinite}"/>'), links="ab"
    )
    robot = robots.load_urdf(text)
    assert (robot.chain.periodic[0], robot.notices) == (True, ())


@pytest.mark.parametrize("moments", ["0 0 0", "0 1 5", "-1 1 1"])
@pytest.mark.parametrize("mass", [0, 1, -1])
@pytest.mark.parametrize("kind", ["fixed", "floating"])
def test_the_inertia_of_what_no_joint_moves_matters_to_nothing(moments, mass, kind):
    xx, yy, zz = moments.split()
    inertia = f'<inertia ixx="{xx}" iyy="{yy}" izz="{zz}"/>'
    inertial = f'<inertial><mass value="{mass}"/>{inertia}</inertial>'
    text = tree(joint("f", "a", "b", kind, ""), joint("j", "b", "c"), links="abc")
    for link in "ab":
        text = text.replace(f'<link name="{link}"></link>', f'<link name="{link}">{inertial}</link>')
    assert text.count("<inertial>") == 2
    assert robots.load_urdf(text, base="b").notices == ()
