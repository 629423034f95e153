"""What the kinematics of library robots are compared with: models of other packages, by their own numbers.

A source gives poses (N, 4, 4) of the tool at joint angles (N, n). Packages are those of the extra ``test-models``.
"""

import importlib
from collections.abc import Callable
from functools import partial
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.library.published_chains import CHAINS
from tests.library.published_screws import SCREWS
from tests.library.published_tables import PR2, SAWYER, TABLES
from tests.robots.model_packages import folders

Poses = Callable[[np.ndarray], np.ndarray]
MISSING = "needs {}, of the extra test-models"


def exact(T: np.ndarray) -> np.ndarray:
    """A pose whose right angles, written as 1.5708 or shorter, are right angles."""
    T = np.array(T, dtype=float)
    near = np.round(T[:3, :3])
    T[:3, :3] = np.where(np.abs(T[:3, :3] - near) < 1e-4, near, T[:3, :3])
    return T


def ssik(name: str, base: np.ndarray | None = None, tool: np.ndarray | None = None) -> Poses:
    """Of a module of ssik: products of the poses and axes that it is generated with."""
    pytest.importorskip("ssik", reason=MISSING.format("ssik"))
    module = importlib.import_module(f"ssik.prebuilt.{name}_ik")
    joints = list(zip(module._JOINT_T_LEFTS, module._JOINT_AXES, module._JOINT_T_RIGHTS, strict=True))

    def poses(q: np.ndarray) -> np.ndarray:
        T, tilt = np.tile(np.eye(4) if base is None else base, (len(q), 1, 1)), np.eye(4)
        for k, (left, axis, right) in enumerate(joints):
            T = T @ exact(tilt @ left)
            axis, tilt = upright(np.asarray(axis, dtype=float))
            T = T @ rotations(axis, q[:, k]) @ exact(tilt @ right)
        return T @ (np.eye(4) if tool is None else tool)

    return poses


def ssik_along_axes(name: str) -> Poses:
    """Of a module of ssik all of whose frames stand as the base's: distances along its axes, and turns about them.

    Angles written as 1.571 tilt what it has by 0.4 thousandths, each joint's by all before it.
    """
    pytest.importorskip("ssik", reason=MISSING.format("ssik"))
    module = importlib.import_module(f"ssik.prebuilt.{name}_ik")
    joints = list(zip(module._JOINT_T_LEFTS, module._JOINT_AXES, strict=True))

    def along(vector: np.ndarray) -> np.ndarray:
        length = np.linalg.norm(vector)
        axis = np.round(vector / (length or 1.0))
        assert np.allclose(vector, length * axis, atol=1e-3 * length)
        return length * axis

    def poses(q: np.ndarray) -> np.ndarray:
        T = np.tile(np.eye(4), (len(q), 1, 1))
        for k, (left, axis) in enumerate(joints):
            shift = np.eye(4)
            shift[:3, 3] = along(left[:3, 3])
            T = T @ shift @ rotations(along(np.asarray(axis, dtype=float)), q[:, k])
        return T

    return poses


def upright(axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """An axis (3,) without the tilt of angles written as 1.5708, and the turn (4, 4) that takes the tilt away.

    Where ssik turns every link's frame to the base's, what follows the axis is tilted with it.
    """
    straight = np.round(axis) if np.abs(axis - np.round(axis)).max() < 1e-4 else axis
    T, about = np.eye(4), np.cross(axis, straight)
    if (sine := np.linalg.norm(about)) > 0:
        T = rotations(about, np.array([np.arcsin(sine)]))[0]
    return straight, T


def rotations(axis: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Rodrigues' rotations (N, 4, 4) about an axis (3,) by angles (N,) [rad]."""
    x, y, z = axis / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T = np.tile(np.eye(4), (len(angles), 1, 1))
    T[:, :3, :3] += np.sin(angles)[:, None, None] * K + (1 - np.cos(angles))[:, None, None] * (K @ K)
    return T


def turned_about_z(angle: float) -> np.ndarray:
    """A turn (4, 4) about z by an angle [rad]."""
    return exact(rotations(np.array([0.0, 0.0, 1.0]), np.array([angle]))[0])


def along_z(distance: float) -> np.ndarray:
    """A shift (4, 4) along z [m]."""
    T = np.eye(4)
    T[2, 3] = distance
    return T


Z_OUT_OF_X = np.array([[0.0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]])  # of a flange with x outwards
X_OUT_OF_Z = Z_OUT_OF_X.T
Z_OUT_X_UP = np.array(
    [[0.0, 0, 1, 0], [0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1]]
)  # of the same, as ROS-Industrial turns it


def urdf(path: str, base: str, tip: str) -> Poses:
    """Of a URDF of example-robot-data: products of its origins and turns, read here and nowhere else."""
    folder = next((each for each in folders() if each.parent.name == "example-robot-data"), None)
    if folder is None:
        pytest.skip(MISSING.format("example-robot-data"))
    above = {joint.find("child").get("link"): joint for joint in ElementTree.parse(folder / path).iterfind("joint")}
    joints, link = [], tip
    while link != base:
        joints.append(above[link])
        link = above[link].find("parent").get("link")

    def poses(q: np.ndarray) -> np.ndarray:
        T, column = np.tile(np.eye(4), (len(q), 1, 1)), 0
        for joint in reversed(joints):
            T = T @ _origin(joint)
            if joint.get("type") != "fixed":
                T = T @ rotations(np.array(_words(joint, "axis", "xyz", "1 0 0")), q[:, column])
                column += 1
        return T

    return poses


def _origin(joint: ElementTree.Element) -> np.ndarray:
    roll, pitch, yaw = _words(joint, "origin", "rpy", "0 0 0")
    x, y, z = np.eye(3)
    T = rotations(z, np.array([yaw]))[0] @ rotations(y, np.array([pitch]))[0] @ rotations(x, np.array([roll]))[0]
    T[:3, 3] = _words(joint, "origin", "xyz", "0 0 0")
    return exact(T)


def _words(joint: ElementTree.Element, tag: str, key: str, otherwise: str) -> list[float]:
    found = joint.find(tag)
    return [float(word) for word in (otherwise if found is None else found.get(key, otherwise)).split()]


def modified_dh(*rows: tuple[float, float, float]) -> Poses:
    """Of a table of modified DH parameters a [m], alpha [°], d [m], a row for each hinge (Craig 1986)."""
    z, x = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])

    def poses(q: np.ndarray) -> np.ndarray:
        T = np.tile(np.eye(4), (len(q), 1, 1))
        for k, (a, alpha, d) in enumerate(rows):
            shift = np.eye(4)
            shift[0, 3] = a
            T = T @ exact(rotations(x, np.array([np.radians(alpha)]))[0]) @ shift @ rotations(z, q[:, k]) @ along_z(d)
        return T

    return poses


def between(base: np.ndarray, poses: Poses, tool: np.ndarray) -> Poses:
    """Of a source whose first frame stands at ``base``, and whose last one holds the tool: fixed poses (4, 4)."""
    return lambda q: base @ poses(q) @ tool


def aside(distance: float) -> np.ndarray:
    """A shift (4, 4) along y [m]."""
    T = np.eye(4)
    T[1, 3] = distance
    return T


XARM7 = [
    (0, 0, 0.267),
    (0, -90, 0),
    (0, 90, 0.293),
    (0.0525, 90, 0),
    (0.0775, 90, 0.3425),
    (0, 90, 0),
    (0.076, -90, 0.097),
]
TO_J2S6S200 = np.array([[0.0, -1, 0, 0], [0, 0, -1, 0], [1, 0, 0, 0], [0, 0, 0, 1]])  # of ssik's arm, of three fingers
EE_LINK = np.array([[0.0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])  # tool0 in the older ee_link of ROS

SECOND_SOURCES: dict[str, Callable[[], Poses]] = {
    "ur5": partial(ssik, "universal_robots.ur5", tool=EE_LINK),
    "ur3e": partial(ssik, "universal_robots.ur3e"),
    "ur10e": partial(ssik, "universal_robots.ur10e"),
    "abb_yumi_left_arm": partial(ssik, "abb.yumi_left"),
    "abb_yumi_right_arm": partial(ssik, "abb.yumi_right"),
    "kuka_iiwa7": partial(ssik, "kuka.iiwa7"),
    "doosan_m0609": partial(ssik_along_axes, "doosan.m0609"),
    "openarm_left_arm": partial(ssik, "openarm.left"),
    "openarm_right_arm": partial(ssik, "openarm.right"),
    "ur16e": partial(ssik, "universal_robots.ur16e"),
    "ur20": partial(ssik, "universal_robots.ur20"),
    "ur30": partial(ssik, "universal_robots.ur30"),
    "xarm6": partial(ssik, "ufactory.xarm6"),
    "franka_fr3": partial(ssik, "franka.fr3"),
    "kinova_gen3": partial(ssik, "kinova.gen3"),
    "kinova_gen3_lite": partial(ssik, "kinova.gen3_lite"),
    "kinova_j2n6s300": partial(ssik, "kinova.jaco2"),
    "kinova_j2s7s300": partial(ssik, "kinova.j2s7s300"),
    "kinova_j2s6s200": partial(ssik, "kinova.j2s6s300", tool=TO_J2S6S200),
    "sawyer": partial(between, np.eye(4), SAWYER.poses, turned_about_z(np.radians(80)) @ along_z(0.00075)),
    "pr2_left_arm": partial(between, aside(0.188), PR2.poses, along_z(0.18) @ X_OUT_OF_Z),
    "pr2_right_arm": partial(between, aside(-0.188), PR2.poses, along_z(0.18) @ X_OUT_OF_Z),
    "talos_left_arm": partial(urdf, "talos_data/robots/talos_full_v2.urdf", "torso_2_link", "wrist_left_ft_tool_link"),
    "unitree_z1": partial(ssik, "unitree.z1"),
    "viperx300s": partial(ssik, "trossen.viperx300s"),
    "widowx250s": partial(ssik, "trossen.widowx250s"),
    "xarm7": partial(modified_dh, *XARM7),
    "ur5e": partial(ssik, "universal_robots.ur5e", turned_about_z(np.pi)),
    "franka_panda": partial(ssik, "franka.panda"),
    "kuka_iiwa14": partial(ssik, "kuka.iiwa14"),
    "abb_irb120": partial(ssik, "abb.irb120", tool=Z_OUT_OF_X),
    "kuka_kr6_r900_sixx": partial(ssik, "kuka.kr6_r900", tool=Z_OUT_OF_X),
    "fanuc_crx10ia": partial(ssik, "fanuc.crx10ia", tool=Z_OUT_X_UP),
    "fanuc_crx10ia_l": partial(ssik, "fanuc.crx10ial"),
    "fanuc_crx5ia": partial(ssik, "fanuc.crx5ia", tool=Z_OUT_X_UP),
    "fanuc_lrmate200id": partial(ssik, "fanuc.lrmate200id", tool=Z_OUT_X_UP),
} | {name: partial(getattr, table, "poses") for name, table in (CHAINS | TABLES | SCREWS).items()}
