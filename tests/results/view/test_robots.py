"""A robot in a view, placed by the arrays of its manifest alone, stands where the library has it."""

import io

import numpy as np
import pytest
import trimesh
from scipy.spatial import KDTree

import wsrender as ws
from wsrender.results.view import Edited, edited_view, robot_view
from wsrender.results.view.robots import arms_of
from wsrender.results.view.stance import stance
from wsrender.robot import link_shapes
from wsrender.robots import library
from wsrender.volume.table import Table

CLOSE = 1e-6  # [m]


def frames(chain, q):
    """Base and joints' frames, then the tip's, (L + 2, 4, 4), written again from what the contract says of a chain."""
    T = np.reshape(chain["T_base"], (4, 4))
    found = [T]
    for k, at in enumerate(chain["source"]):
        by = chain["scale"][k] * q[at] + chain["offset"][k]
        motion = np.eye(4)
        if chain["revolute"][k]:
            motion[:2, :2] = [[np.cos(by), -np.sin(by)], [np.sin(by), np.cos(by)]]
        else:
            motion[2, 3] = by
        T = T @ np.reshape(chain["T_joint"][k], (4, 4)) @ motion
        found.append(T)
    return [*found, T @ np.reshape(chain["T_tip"], (4, 4))]


def read(view, data):
    """The parts of a GLB file, each in the coordinates of the file."""
    return trimesh.load(io.BytesIO(view.blobs[data["blob"]]), file_type="glb", process=False).dump()


def random_configurations(robot, count):
    lower, upper = (np.clip(each, -4, 4) for each in (robot.lower_limits, robot.upper_limits))
    return lower + np.random.default_rng(1).random((count, len(lower))) * (upper - lower)


@pytest.mark.parametrize("name", library.names())
def test_bodies_and_tip_stand_where_the_library_has_them(name):
    """Every triangle corner of the file lies on the robot's own, which `link_shapes` places by itself, and back."""
    robot = ws.load_robot(name, placement={"position_m": [1, -2, 0.5], "rpy_deg": [10, 20, 30]},
                          tool={"position_m": [0, 0.1, 0.2], "rpy_deg": [0, 40, 0]})  # fmt: skip
    view = robot_view(robot)
    (shown,) = view.manifest["robots"]
    assert view.manifest["omitted"] == [] and shown["name"] == name
    parts = [(link["frame"], read(view, link["geometry"])) for link in shown["links"]]
    assert sum(len(each) for _, each in parts) == len(robot.visuals) > 0
    for q in random_configurations(robot, 3):
        T = frames(shown["chain"], q)
        assert np.allclose(T[-1], robot.forward_kinematics(q)[0], rtol=0, atol=CLOSE)
        placed = [
            (mesh.vertices @ T[frame][:3, :3].T + T[frame][:3, 3], mesh) for frame, each in parts for mesh in each
        ]
        own = link_shapes(robot, q)
        order = [np.flatnonzero([_same(points, shape.vertices) for points, _ in placed]) for shape in own]
        assert all(len(found) >= 1 for found in order)
        for found, shape in zip(order, own, strict=True):
            colors = [placed[k][1].visual.material.baseColorFactor[:3] / 255 for k in found]
            assert any(np.allclose(color, shape.color, atol=1 / 255) for color in colors)


def _same(points, others):
    """Whether two clouds are the same but for copies of points."""
    if np.abs(points.min(axis=0) - others.min(axis=0)).max() > CLOSE:
        return False
    apart = [KDTree(to).query(of)[0].max() for of, to in ((points, others), (others, points))]
    return max(apart) < CLOSE


def test_a_floor_is_as_large_as_what_stands_on_it():
    """Larger than the arm reaches, by a fifth at most: else all else is small."""
    edited = Edited(robot={"library": "ur5e"}, environment={"items": [{"shape": "half_space", "name": "floor"}]})
    view, reach = edited_view(edited), ws.load_robot("ur5e").chain.reach
    (mesh,) = (each for each in view.manifest["meshes"] if each["role"] == "environment")
    bounds = trimesh.load(io.BytesIO(view.blobs[mesh["geometry"]["blob"]]), file_type="glb", process=False).bounds
    assert (bounds[1, :2] >= reach).all() and (bounds[1, :2] <= 1.2 * reach + 1e-6).all()
    assert np.allclose(bounds[0, :2], -bounds[1, :2])


def test_limits_home_and_names():
    robot = ws.load_robot("cylindrical")
    (shown,) = robot_view(robot).manifest["robots"]
    chain = shown["chain"]
    assert chain["joints"] == list(robot.joint_names) and chain["angle"] == list(robot.chain.revolute)
    assert chain["lower"] == robot.lower_limits.tolist() and chain["upper"] == robot.upper_limits.tolist()
    assert shown["home"] == stance(robot.chain).tolist()
    endless = """<mujoco><worldbody><body name="&lt;script&gt;"><joint name="turn" type="slide"/>
        <geom type="sphere" size=".1" mass="1"/><site name="tool"/></body></worldbody></mujoco>"""
    with pytest.warns(UserWarning, match="limits"):
        (shown,) = robot_view(endless).manifest["robots"]
    assert shown["chain"]["lower"] == shown["chain"]["upper"] == [None]
    assert shown["links"][0]["name"] == "<script>"


def test_coupled_joints_and_joints_on_other_branches():
    """A gripper's fingers move with a coordinate of the chain; the page needs no more than the arrays."""
    model = """<mujoco><worldbody><body name="arm"><joint name="lift" type="slide" range="0 1" limited="true"/>
        <geom type="box" size=".1 .1 .1"/><site name="tool" pos="0 0 .2"/>
        <body name="finger" pos=".1 0 0"><joint name="f" type="slide" axis="1 0 0" range="0 1" limited="true"/>
        <geom name="f" type="box" size=".01 .02 .05"/></body></body></worldbody>
        <equality><joint joint1="f" joint2="lift" polycoef="0.1 0.5 0 0 0"/></equality></mujoco>"""
    robot = ws.load_robot(model)
    view = robot_view(robot)
    (shown,) = view.manifest["robots"]
    for q in ([0.2], [0.9]):
        T = frames(shown["chain"], q)
        own = link_shapes(robot, q)
        for link in shown["links"]:
            (mesh,) = read(view, link["geometry"])
            frame = T[link["frame"]]
            points = mesh.vertices @ frame[:3, :3].T + frame[:3, 3]
            assert any(_same(points, shape.vertices) for shape in own), link["name"]
        assert np.allclose(T[-1], robot.forward_kinematics(q)[0], rtol=0, atol=CLOSE)


def test_robots_of_one_kind_are_not_shown_in_each_others_configurations():
    robot = ws.load_robot("scara")
    rows = np.arange(len(robot.joint_names)) * 0.01 + np.array([[0.1], [0.2]])
    of_left = Table({f"q_{name}": column for name, column in zip(robot.joint_names, rows.T, strict=True)})
    document = {"analysis": "base_placement", "robots": [{"name": "arm"}, {"name": "left_arm"}]}
    other, left = arms_of(document, {"targets_left_arm": of_left}, [robot, robot], [])
    assert other.configurations is None and other.home.tolist() == stance(robot.chain).tolist()
    assert left.said == "targets_left_arm" and np.array_equal(left.configurations, rows)
    assert np.array_equal(left.home, rows[0])


def test_a_python_class_is_drawn_as_sticks():
    class Pointer:
        """A turning rod."""

        limits = ((-1.0, 1.0),)

        def forward_kinematics(self, q):
            T = np.tile(np.eye(4), (len(q), 1, 1))
            T[:, 0, 3], T[:, 1, 3] = np.cos(q[:, 0]), np.sin(q[:, 0])
            return T

    shown = robot_view(Pointer()).manifest
    assert shown["robots"] == [] and shown["skeletons"] and "Python class" in shown["omitted"][0]
