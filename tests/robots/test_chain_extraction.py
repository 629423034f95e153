"""The extracted Chain against MuJoCo's own kinematics and inertia of the untouched source."""

import mujoco
import numpy as np
import pytest

from tests.reference import chain_kinematics as reference
from tests.reference import mujoco_kinematics as by_mujoco
from wsrender import robots
from wsrender.errors import InputError, ModelError

TOLERANCE = 1e-12  # float64, metres and radians of robots of a few metres

# Several joints per body, joint ref and pos, axes in every direction, nested fixed bodies, frames, defaults,
# off-chain branches that carry mass, a slide, armature, sites turned against their body.
SERIAL = """
<mujoco model="serial">
  <compiler angle="radian"/>
  <default>
    <joint armature="0.02" range="-2 2"/>
    <default class="heavy"><geom density="3000"/></default>
  </default>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="base" pos="0.1 -0.2 0.3" euler="0.1 0.2 0.3">
      <geom size="0.1"/>
      <body name="one" pos="0 0 0.2" quat="0.8 0.1 -0.3 0.2">
        <joint name="a" axis="0 0 -1" ref="0.4" range="-1 2"/>
        <joint name="b" axis="1 -2 0.5" pos="0.05 0.02 -0.1"/>
        <geom type="capsule" size="0.05 0.2" pos="0.1 0 0.1" euler="0.4 0 0"/>
        <body name="bracket" pos="0.3 0 0.1" euler="0 0.7 0">
          <inertial pos="0.01 0.02 0.03" mass="0.7" fullinertia="0.01 0.012 0.015 0.001 -0.002 0.0005"/>
          <body name="camera" pos="0 0.1 0"><geom type="box" size="0.02 0.03 0.04"/>
            <body name="pan">
              <joint name="pan" axis="0 1 0" ref="0.2"/><geom size="0.03" pos="0.1 0 0"/>
            </body>
          </body>
          <frame pos="0.05 0 0" euler="0 0 0.5">
            <body name="two" childclass="heavy" pos="0.2 0.1 0">
              <joint name="c" type="slide" axis="0.3 0.1 1" ref="0.1" range="-0.3 0.4" pos="0.1 0 0"/>
              <joint name="d" axis="0 1 0" pos="0 0.1 0.2" armature="0.3"/>
              <geom type="cylinder" size="0.04 0.15" pos="0 0 0.1"/>
              <body name="flange" pos="0 0 0.3" euler="0.2 0 0.1"><geom size="0.05" pos="0.02 0 0"/>
                <site name="grip" pos="0.1 0.2 0.3" euler="0.3 -0.2 0.9"/>
              </body>
            </body>
          </frame>
        </body>
      </body>
    </body>
    <body name="table" pos="1 0 0"><joint name="wobble" axis="1 0 0"/><geom size="0.1" pos="0 0 1"/></body>
  </worldbody>
</mujoco>
"""
JOINTS = ("a", "b", "c", "d")


def configurations(chain, count=20):
    return np.random.default_rng(3).uniform(chain.lower_limits, chain.upper_limits, (count, chain.n))


@pytest.mark.parametrize("tip", ["grip", "flange", "two"])
def test_kinematics_and_inertia_are_those_of_mujoco(tip):
    model = mujoco.MjModel.from_xml_string(SERIAL)
    chain = robots.load_mjcf(SERIAL, tip=tip).chain
    assert chain.joint_names == JOINTS
    assert (chain.base_frame, chain.tip_frame, chain.name) == ("world", tip, "serial")
    for q in configurations(chain):
        data = by_mujoco.at(model, dict(zip(JOINTS, q, strict=True)))
        T, J = by_mujoco.pose(model, data, tip), by_mujoco.jacobian(model, data, tip, JOINTS)
        M = by_mujoco.inertia_matrix(model, data, JOINTS)
        np.testing.assert_allclose(reference.forward_kinematics(chain, q), T, rtol=0, atol=TOLERANCE)
        np.testing.assert_allclose(reference.jacobian(chain, q), J, rtol=0, atol=TOLERANCE)
        np.testing.assert_allclose(reference.inertia_matrix(chain, q), M, rtol=0, atol=TOLERANCE * M.max())


@pytest.mark.parametrize("base", ["base", "bracket", "camera_mount"])
def test_poses_are_expressed_in_the_base(base):
    source = SERIAL.replace(
        '<body name="camera"', '<site name="camera_mount" pos="0 0 .2" euler="1 0 0"/><body name="camera"'
    )
    model = mujoco.MjModel.from_xml_string(source)
    chain = robots.load_mjcf(source, base=base, tip="grip").chain
    assert chain.base_frame == base
    assert chain.joint_names == (JOINTS if base == "base" else ("c", "d"))
    for q in configurations(chain, 5):
        data = by_mujoco.at(model, dict(zip(chain.joint_names, q, strict=True)))
        T_world_base = by_mujoco.pose(model, data, base)
        expected = np.linalg.inv(T_world_base) @ by_mujoco.pose(model, data, "grip")
        turn = np.kron(np.eye(2), T_world_base[:3, :3].T)
        J = turn @ by_mujoco.jacobian(model, data, "grip", chain.joint_names)
        M = by_mujoco.inertia_matrix(model, data, chain.joint_names)
        np.testing.assert_allclose(reference.forward_kinematics(chain, q), expected, rtol=0, atol=TOLERANCE)
        np.testing.assert_allclose(reference.jacobian(chain, q), J, rtol=0, atol=TOLERANCE)
        np.testing.assert_allclose(reference.inertia_matrix(chain, q), M, rtol=0, atol=TOLERANCE * M.max())


def test_placement_and_tool_are_applied():
    placement, tool = np.eye(4), np.eye(4)
    placement[:3] = [[0, -1, 0, 0.5], [1, 0, 0, -0.2], [0, 0, 1, 1.0]]
    tool[:3] = [[1, 0, 0, 0.1], [0, 0, -1, 0.2], [0, 1, 0, 0.3]]
    plain = robots.load_mjcf(SERIAL, tip="grip").chain
    placed = robots.load_mjcf(SERIAL, tip="grip", placement=placement, tool=tool).chain
    q = configurations(plain, 1)[0]
    expected = placement @ reference.forward_kinematics(plain, q) @ tool
    np.testing.assert_allclose(reference.forward_kinematics(placed, q), expected, rtol=0, atol=TOLERANCE)
    assert placed.content_hash != plain.content_hash


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("placement", np.diag([1, 1, -1, 1.0]), "placement: must be a rigid transform"),
        ("tool", np.diag([2, 2, 2, 1.0]), "tool: must be a rigid transform"),
        ("tool", np.eye(3), r"tool: must be a \(4, 4\) array"),
        ("placement", np.full((4, 4), np.nan), r"placement: must be a \(4, 4\) array of finite numbers"),
    ],
)
def test_transforms_must_be_rigid(field, value, message):
    with pytest.raises(InputError, match=message):
        robots.load_mjcf(SERIAL, tip="grip", **{field: value})


def test_joint_frames_are_right_handed_with_the_axis_along_z():
    chain = robots.load_mjcf(SERIAL, tip="grip").chain
    frames, _ = reference.joint_frames(chain, np.zeros(chain.n))
    R = frames[:, :3, :3]
    np.testing.assert_allclose(R @ R.transpose(0, 2, 1), np.broadcast_to(np.eye(3), R.shape), atol=1e-15)
    np.testing.assert_allclose(np.linalg.det(R), 1.0, atol=1e-15)


def test_a_configuration_can_be_handed_to_mujoco():
    robot = robots.load_mjcf(SERIAL, tip="grip")
    q = configurations(robot.chain, 1)[0]
    data = mujoco.MjData(robot.model)
    robot.set_configuration(data, q)
    mujoco.mj_kinematics(robot.model, data)
    tip = reference.forward_kinematics(robot.chain, q)[:3, 3]
    np.testing.assert_allclose(data.site("grip").xpos, tip, atol=TOLERANCE)
    np.testing.assert_allclose(data.qpos[robot.qpos_addresses], q, atol=1e-15)
    assert data.joint("pan").qpos[0] == 0.2  # off the chain: at its reference
    assert list(robot.dof_addresses) == by_mujoco.dofs(robot.model, JOINTS)


def test_unnamed_joints_get_unique_names():
    text = """<mujoco><worldbody><body><joint name="joint2"/><joint axis="0 1 0"/><geom size="1"/>
      <body pos="1 0 0"><joint/><geom size="1"/></body></body></worldbody></mujoco>"""
    chain = robots.load_mjcf(text).chain
    assert chain.joint_names == ("joint2", "joint2_", "joint3")
    assert chain.tip_frame == "body2"


def test_sixteen_joints_are_the_most():
    def arm(count):
        body = '<body pos="0.1 0 0"><joint/><geom size="0.05"/>'
        return f"<mujoco><worldbody>{body * count}{'</body>' * count}</worldbody></mujoco>"

    assert robots.load_mjcf(arm(16)).chain.n == 16
    with pytest.raises(ModelError, match="17 joints lie between base 'world' and tip 'body17'; at most 16"):
        robots.load_mjcf(arm(17))


@pytest.mark.parametrize(("length", "reach"), [(2000.0, "2e+03"), (0.001, "0.001")])
def test_an_implausible_reach_is_a_warning(length, reach):
    text = f"""<mujoco><worldbody><body><joint/><geom size=".1"/>
      <site name="tool" pos="{length} 0 0"/></body></worldbody></mujoco>"""
    with pytest.warns(robots.ModelWarning, match="metres, not millimetres") as caught:
        robots.load_mjcf(text)
    assert len(caught) == 1
    assert f"{float(reach):.3g} m" in str(caught[0].message)
