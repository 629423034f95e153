"""Shapes of library robots contain the meshes that they were fitted to, where a package of test-models has those."""

from importlib.util import find_spec
from pathlib import Path

import mujoco
import numpy as np
import pytest

from tests.library.from_urdf import links_of
from tests.robots.model_packages import folders
from wsrender.robots import library

trimesh = pytest.importorskip("trimesh")
KUKA = "xacro/kuka_description"
G1 = "g1_description/urdf/g1_29dof_rev_1_0.urdf"
LINKS = ("base_link", *(f"link_{k}" for k in range(1, 7)))


def agilus(arm):
    """Of KR 6 arms, which differ in links 2 and 4."""
    folders = [arm if link in ("link_2", "link_4") else "kr6_agilus" for link in LINKS]
    return [
        f"{KUKA}/kuka_kr6/meshes/{folder}/collision/{link}.stl" for folder, link in zip(folders, LINKS, strict=True)
    ]


MESHES = {
    "kuka_kr10_r1100_sixx": [f"{KUKA}/kuka_kr10/meshes/kr10r1100sixx/collision/{link}.stl" for link in LINKS],
    "kuka_kr6_r700_sixx": agilus("kr6r700sixx"),
    "kuka_kr6_r900_sixx": agilus("kr6r900sixx"),
    "kuka_kr3_r540": [f"{KUKA}/kuka_kr3/meshes/kr3r540/collision/{link}.stl" for link in LINKS],
    "kuka_kr16_2": [f"{KUKA}/kuka_kr16/meshes/kr16_2/collision/{link}.stl" for link in LINKS],
}


# Of URDFs: the folder of their package, the file, the links at the ends of the chain.
URDFS = {
    "pr2_left_arm": ("robots", "pr2_description/urdf/pr2.urdf", "torso_lift_link", "l_gripper_tool_frame"),
    "pr2_right_arm": ("robots", "pr2_description/urdf/pr2.urdf", "torso_lift_link", "r_gripper_tool_frame"),
    "so100": ("robots", "so_arm_description/urdf/so100.urdf", "base", "gripper"),
    "so101": ("robots", "so_arm_description/urdf/so101.urdf", "base_link", "gripper_link"),
    "unitree_g1_left_arm": ("robots", G1, "torso_link", "left_wrist_yaw_link"),
    "unitree_g1_right_arm": ("robots", G1, "torso_link", "right_wrist_yaw_link"),
    "ur3": ("robots", "ur_description/urdf/ur3_robot.urdf", "base_link", "tool0"),
    "ur5": ("robots", "ur_description/urdf/ur5_robot.urdf", "base_link", "tool0"),
    "ur10": ("robots", "ur_description/urdf/ur10_robot.urdf", "base_link", "tool0"),
    "xarm6": ("pybullet_data", "xarm/xarm6_robot.urdf", "link_base", "link6"),
}


def depths(model, geom, points):
    """How far points (N, 3) of a body's frame are inside a geom (N,) [m], negative outside."""
    R = np.empty(9)
    mujoco.mju_quat2Mat(R, model.geom_quat[geom])
    local = (points - model.geom_pos[geom]) @ R.reshape(3, 3)
    size, kind = model.geom_size[geom], mujoco.mjtGeom(model.geom_type[geom])
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        return (size - np.abs(local)).min(axis=1)
    off, along = np.linalg.norm(local[:, :2], axis=1), np.abs(local[:, 2])
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        return np.minimum(size[0] - off, size[1] - along)
    half = size[1] if kind == mujoco.mjtGeom.mjGEOM_CAPSULE else 0.0
    return size[0] - np.hypot(off, np.maximum(along - half, 0.0))


@pytest.mark.parametrize("name", MESHES)
def test_corners_of_the_meshes_are_inside(name):
    spec = find_spec("rtbdata")
    if spec is None:
        pytest.skip("needs rtb-data, of the extra test-models")
    folder = Path(spec.origin).parent
    model = mujoco.MjModel.from_xml_path(str(library.find(name)))
    for body, file in zip(("base", *(f"link{k}" for k in range(1, 7))), MESHES[name], strict=True):
        assert least_depth(model, body, np.asarray(trimesh.load(folder / file, force="mesh").vertices)) > -1e-6, body


def least_depth(model, body, points):
    """How far the outermost of points (N, 3) is inside a body's shapes [m]."""
    first, count = model.body(body).geomadr[0], model.body(body).geomnum[0]
    return np.max([depths(model, geom, points) for geom in range(first, first + count)], axis=0).min()


@pytest.mark.parametrize("name", URDFS)
def test_corners_of_a_urdfs_meshes_are_inside(name):
    package, file, base, tip = URDFS[name]
    folder = next((folder for folder in folders() if folder.name == package), None)
    if folder is None:
        pytest.skip("needs example-robot-data and pybullet, of the extra test-models")
    model = mujoco.MjModel.from_xml_path(str(library.find(name)))
    data, T = mujoco.MjData(model), np.eye(4)
    mujoco.mj_kinematics(model, data)  # all joints at zero: some bodies' frames are not those of this edition's links
    for link in links_of(folder / file, base, tip)[0]:
        T, body = T @ link.T_parent, data.body(link.name)
        for mesh in link.meshes:
            points = mesh.vertices @ T[:3, :3].T + T[:3, 3]
            assert least_depth(model, link.name, (points - body.xpos) @ body.xmat.reshape(3, 3)) > -1e-6, link.name
