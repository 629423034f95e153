"""Planar arms found from their chain: from DH tables, MJCF and URDF; errors name the joint that leaves the plane."""

import json

import numpy as np
import pytest

import wsrender as ws
from tests.geometry.planar_arms import revolute_arm
from wsrender.geometry.planar.planar_chain import planar_chain

LIMITS = [(-60, 60)] * 3
AREA = 31.497510350119

MJCF = """
<mujoco><compiler angle="degree"/><worldbody><body name="a"><joint name="one" axis="0 -1 0" range="-60 60"/>
<geom size="0.1"/><body name="b" pos="0 0 4"><joint name="two" axis="0 -1 0" range="-60 60"/><geom size="0.1"/>
<body name="c" pos="0 0 2"><joint name="three" axis="0 1 0" range="-60 60"/><geom size="0.1"/>
<site name="tool" pos="0 0.3 1"/></body></body></body></worldbody></mujoco>
"""
URDF = """
<robot name="slider"><link name="base"/><link name="a"/><link name="b"/><link name="c"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 -1"/>
<limit lower="-0.7853981633974483" upper="0.7853981633974483" effort="1" velocity="1"/></joint>
<joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><origin xyz="5 0 0"/><axis xyz="1 0 0"/>
<limit lower="0" upper="3" effort="1" velocity="1"/></joint>
<joint name="end" type="fixed"><parent link="b"/><child link="c"/></joint></robot>
"""


def write(folder, name, text):
    path = folder / name
    path.write_text(text)
    return path


def test_dh_table():
    assert ws.exact_boundary(revolute_arm([4, 2, 1], LIMITS)).area == pytest.approx(AREA, rel=1e-9)


def test_mjcf_in_the_plane_of_x_and_z(tmp_path):
    found = ws.exact_boundary(write(tmp_path, "arm.xml", MJCF))
    assert found.area == pytest.approx(AREA, rel=1e-9)
    assert found.plane.axes.tolist() == [[1, 0, 0], [0, 0, 1]]
    assert found.plane.origin == pytest.approx([0, 0.3, 0])
    assert found.contains([[0, 6.9], [0, 7.1], [6.9, 0]]).tolist() == [True, False, False]


def test_urdf(tmp_path):
    found = ws.exact_boundary(write(tmp_path, "arm.urdf", URDF))
    assert found.area == pytest.approx(39 * np.pi / 4, rel=1e-9)
    limits = {way for loop in found.segments for segment in loop for way in segment.limits_text.split(" | ")}
    assert limits == {"turn lower", "turn upper", "slide lower", "slide upper"}


def test_placement_and_tool_move_the_boundary():
    placement = ws.Transform(position_m=(100.0, -20.0, 3.0), rpy_deg=(0, 0, 90))
    found = ws.exact_boundary(revolute_arm([4, 2, 1], LIMITS, placement=placement))
    assert found.area == pytest.approx(AREA, rel=1e-9)
    assert found.contains([[100, -13.1], [100, -12.9], [106.9, -20]]).tolist() == [True, False, False]
    assert found.plane.origin[2] == 3
    longer = ws.exact_boundary(revolute_arm([4, 2, 0.5], LIMITS, tool=ws.Transform(position_m=(0.5, 0, 0))))
    assert longer.area == pytest.approx(AREA, rel=1e-9)


@pytest.mark.parametrize("row", range(6))
def test_postures_are_of_the_robot(row):
    robot = revolute_arm([4, 2, 1], LIMITS, placement=ws.Transform(position_m=(1, 2, 3), rpy_deg=(90, 0, 30)))
    found = ws.exact_boundary(robot)
    segment = found.segments[0][row]
    position = robot.forward_kinematics(np.array(segment.postures))[:, :3, 3]
    nearest = found.nearest(found.plane.coordinates(position))
    assert nearest.distance.max() < 1e-9
    assert found.plane.in_world(nearest.point) == pytest.approx(position)


def test_locked_joints_make_an_arm_planar():
    with pytest.raises(ws.ModelError, match=r"joint 'joint2' turns about \(0, 1, 0\), out of the plane"):
        ws.exact_boundary("puma560")
    held = ws.exact_boundary("puma560", locked={"joint1": 0.0, "joint4": 0.0, "joint5": 0.0, "joint6": 0.0})
    assert np.abs(held.plane.normal) == pytest.approx([0, 1, 0])
    assert held.dimension == 2
    robot = ws.load_robot("puma560")
    q = np.random.default_rng(0).uniform(robot.lower_limits, robot.upper_limits, (2000, 6))
    q[:, [0, 3, 4, 5]] = 0
    position = robot.forward_kinematics(q)[:, :3, 3]
    assert position @ held.plane.normal == pytest.approx(held.plane.origin @ held.plane.normal)
    nearest = held.nearest(held.plane.coordinates(position))
    assert (nearest.inside | (nearest.distance < 1e-9)).all()


@pytest.mark.parametrize(("name", "dimension"), [("puma560", 1), ("ur5e", 2), ("articulated", 1)])
def test_the_joints_to_hold_are_a_remedy(name, dimension):
    """``articulated`` holds a joint at its limit: 0 is beyond it."""
    with pytest.raises(ws.ModelError) as raised:
        ws.exact_boundary(name)
    held = json.loads(str(raised.value).split("locked=")[1])
    assert "joint1" not in held and len(held) >= 2
    assert ws.exact_boundary(name, locked=held).dimension == dimension


def test_slides_out_of_the_plane_are_named():
    rows = [ws.DHRow(a=1, limits_deg=(0, 90)), ws.DHRow(joint="prismatic", limits=(0, 1), name="lift")]
    lift = ws.DHTable(convention="standard", rows=rows, name="lift")
    with pytest.raises(ws.ModelError, match=r"joint 'lift' slides along \(0, 0, 1\), out of the plane"):
        ws.exact_boundary(lift)
    assert ws.exact_boundary(lift, locked={"lift": 0.5}).dimension == 1
    with pytest.raises(ws.InputError, match=r"^locked.elbow: unknown joint; allowed: joint1, lift"):
        ws.exact_boundary(lift, locked={"elbow": 0.5})


@pytest.mark.parametrize("boundary", [ws.exact_boundary, ws.boundary_patches])
def test_a_joint_that_others_follow_is_named(boundary, tmp_path):
    end = '<joint name="end" type="fixed">'
    follower = '<joint name="follower" type="prismatic"><mimic joint="slide"/><axis xyz="0 1 0"/>'
    limit = '<limit lower="0" upper="3" effort="1" velocity="1"/>'
    coupled = URDF.replace(end, follower + limit)
    with pytest.raises(ws.ModelError, match="several joints follow 'slide'; a boundary needs each joint free"):
        boundary(write(tmp_path, "coupled.urdf", coupled))


def test_the_scara_of_the_library():
    """Each door says how joints are held there: of a job in its sampling."""
    with pytest.raises(ws.ModelError, match=r"joint 'joint4' turns about .*; .* locked=\{\"joint4\": 0.0\}$"):
        ws.exact_boundary("scara")
    assert ws.exact_boundary("scara", locked={"joint4": 0.0}).dimension == 2
    with pytest.raises(ws.ModelError) as raised:
        ws.planar_boundary("scara")
    as_field, in_python = str(raised.value).split('such as with "sampling": ')[1].split(", in Python sampling=")
    sampling = eval(in_python, {"ws": ws})
    assert json.loads(as_field) == sampling.model_dump(exclude={"seed"}, exclude_defaults=False)
    assert ws.planar_boundary("scara", sampling, device="cpu").document["exact"]["dimension"] == 2


def test_slides_alone():
    rows = [ws.DHRow(joint="prismatic", limits=(0, 2)), ws.DHRow(joint="prismatic", alpha_deg=90, limits=(0, 3))]
    found = ws.exact_boundary(ws.DHTable(convention="modified", rows=rows, name="gantry"))
    assert found.area == pytest.approx(6, rel=1e-9)
    assert [segment.kind for segment in found.segments[0]] == ["line"] * 4
    line = ws.exact_boundary(ws.DHTable(convention="modified", rows=rows[:1], name="slide"))
    assert (line.dimension, line.perimeter) == (1, pytest.approx(2))


def test_unknown_and_forbidden_locks():
    with pytest.raises(ws.InputError, match="unknown joint; allowed: joint1"):
        ws.exact_boundary("scara", locked={"elbow": 0.0})
    with pytest.raises(ws.InputError, match="is outside the joint"):
        ws.exact_boundary("scara", locked={"joint3": 3.0})


def test_the_size_bounds_the_reach():
    robot = revolute_arm([4, 2, 1], LIMITS)
    assert planar_chain(robot.chain).size == pytest.approx(7)


@pytest.mark.parametrize("points", [[[1, 2, 3]], [1, 2], [["a", "b"]], [[np.nan, 0]]])
def test_malformed_points_are_refused(points):
    with pytest.raises(ws.InputError, match="points"):
        ws.exact_boundary(revolute_arm([4, 2, 1], LIMITS)).contains(points)
