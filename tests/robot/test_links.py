"""Bodies of links against MuJoCo's own positions and closed-form volumes."""

import mujoco
import numpy as np
import pytest
import trimesh

import wsrender as ws
from wsrender.robot import as_robot, link_shapes
from wsrender.robots.model_warning import ModelWarning

MODEL = """
<mujoco><compiler angle="degree"/>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="foot" pos="0 0 .2" euler="0 0 30">
      <geom name="cylinder" type="cylinder" size=".05 .1" rgba="1 0 0 1"/>
      <body name="arm" pos="0 0 .1">
        <joint name="a" axis="0 0 1" range="-90 90"/>
        <geom name="capsule" type="capsule" size=".03 .2" pos=".2 0 0" euler="0 90 0"/>
        <geom name="hull" type="box" size="1 1 1" group="3"/>
        <body name="hand" pos=".4 0 0">
          <joint name="b" axis="0 1 0" range="-90 90"/>
          <geom name="box" type="box" size=".1 .02 .03" pos=".1 0 0"/>
          <geom name="ball" type="sphere" size=".035"/>
          <geom name="egg" type="ellipsoid" size=".05 .03 .02" pos=".2 0 0"/>
          <site name="tool" pos=".2 0 0"/>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>"""
VOLUMES = {
    "cylinder": np.pi * 0.05**2 * 0.2,
    "capsule": np.pi * 0.03**2 * 0.4 + 4 / 3 * np.pi * 0.03**3,
    "box": 8 * 0.1 * 0.02 * 0.03,
    "ball": 4 / 3 * np.pi * 0.035**3,
    "egg": 4 / 3 * np.pi * 0.05 * 0.03 * 0.02,
}
Q = np.array([0.4, -0.7])


@pytest.fixture
def path(tmp_path):
    (tmp_path / "arm.xml").write_text(MODEL)
    return tmp_path / "arm.xml"


def test_links_are_where_mujoco_puts_them(path):
    shapes = link_shapes(ws.load_robot(path), Q)
    assert len(shapes) == len(VOLUMES)  # neither the plane nor the collision shape
    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    data.qpos[:] = Q
    mujoco.mj_kinematics(model, data)
    for (name, volume), shape in zip(VOLUMES.items(), shapes, strict=True):
        mesh = trimesh.Trimesh(shape.vertices, shape.faces)
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(volume, rel=0.02)  # facets lie inside round bodies
        np.testing.assert_allclose(mesh.center_mass, data.geom(name).xpos, atol=1e-9)
    assert shapes[0].color == (1.0, 0.0, 0.0)


@pytest.mark.parametrize("base", [None, "arm"])
def test_links_move_with_the_placement(path, base):
    """The middle of the egg is the tool, wherever the base stands."""
    T = np.array([[0, -1, 0, 0.5], [1, 0, 0, 0.1], [0, 0, 1, -0.3], [0, 0, 0, 1.0]])
    robot = ws.load_robot(path, base=base, placement=T)
    q = Q if base is None else Q[1:]
    egg = link_shapes(robot, q)[-1].vertices
    tip = robot.forward_kinematics(q, device="cpu")[0, :3, 3]
    np.testing.assert_allclose((egg.min(axis=0) + egg.max(axis=0)) / 2, tip, atol=1e-9)


def test_robots_without_bodies_have_none():
    class Class:
        limits = ((-1, 1),)

        def forward_kinematics(self, q):
            return np.tile(np.eye(4), (len(q), 1, 1))

    bare = ws.load_robot(ws.DHTable(convention="standard", rows=({"a": 0.4}, {"a": 0.3})))
    assert link_shapes(bare, np.zeros(2)) == []
    assert link_shapes(as_robot(Class()), [0]) == []


MESH = """<robot name="arm"><link name="a"><visual><geometry><mesh filename="arm.{suffix}"/></geometry></visual>
  <collision><geometry><sphere radius="9"/></geometry></collision></link><link name="tip"/><link name="world"/>
  <joint name="i" type="revolute"><parent link="world"/><child link="a"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="1"/></joint>
  <joint name="j" type="fixed"><parent link="a"/><child link="tip"/><origin xyz=".3 0 0"/></joint></robot>"""


def test_meshes_are_drawn_as_they_are(tmp_path):
    """Not their hulls, and not what may collide."""
    hollow = trimesh.creation.annulus(0.1, 0.2, 0.3)
    (tmp_path / "arm.stl").write_bytes(hollow.export(file_type="stl"))
    (tmp_path / "arm.urdf").write_text(MESH.format(suffix="stl"))
    robot = ws.load_robot(tmp_path / "arm.urdf", tip="tip")
    (shape,) = link_shapes(robot, np.zeros(1))
    drawn = trimesh.Trimesh(shape.vertices, shape.faces)
    assert drawn.volume == pytest.approx(hollow.volume, rel=1e-5)
    np.testing.assert_allclose(drawn.bounds.mean(axis=0), [0, 0, 1], atol=1e-6)


def test_bodies_that_cannot_be_read_are_told_of(tmp_path):
    (tmp_path / "m.stl").write_bytes(b"no mesh")
    (tmp_path / "arm.xml").write_text("""<mujoco><asset><mesh name="m" file="m.stl"/></asset><worldbody><body>
      <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/><joint range="-1 1"/><geom type="mesh" mesh="m"/>
      <site name="tool" pos="1 0 0"/></body></worldbody></mujoco>""")
    robot = ws.load_robot(tmp_path / "arm.xml")
    with pytest.warns(ModelWarning, match="the bodies of arm are not drawn: .*MuJoCo refuses the model"):
        assert link_shapes(robot, np.zeros(1)) == []
