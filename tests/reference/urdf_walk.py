"""Poses of a URDF's links by walking from its root: elements as they stand in the file, one rotation after another."""

from collections.abc import Mapping
from xml.etree.ElementTree import Element

import numpy as np


def pose(robot: Element, link: str, values: Mapping[str, float]) -> np.ndarray:
    """Pose (4, 4) of a link in that of the root; ``values`` of joints by name [rad or m], others at zero."""
    by_name = {joint.get("name", "").strip(): joint for joint in robot.findall("joint")}
    joints = {_end(joint, "child"): joint for joint in by_name.values()}
    T = np.eye(4)
    while link in joints:
        joint = joints[link]
        T = _origin(joint) @ _motion(joint, _value(joint, by_name, values)) @ T
        link = _end(joint, "parent")
    return T


def _end(joint: Element, tag: str) -> str:
    element = joint.find(tag)
    return "" if element is None else element.get("link", "").strip()


def _value(joint: Element, by_name: Mapping[str, Element], values: Mapping[str, float]) -> float:
    mimic, name = joint.find("mimic"), joint.get("name", "").strip()
    if mimic is None:
        return values.get(name, 0.0)
    leader = by_name.get(mimic.get("joint", "").strip())
    followed = 0.0 if leader is None else _value(leader, by_name, values)
    return float(mimic.get("multiplier", "1")) * followed + float(mimic.get("offset", "0"))


def _origin(joint: Element) -> np.ndarray:
    origin = joint.find("origin")
    T = np.eye(4)
    if origin is None:
        return T
    T[:3, 3] = np.array((origin.get("xyz") or "0 0 0").split(), float)
    roll, pitch, yaw = np.array((origin.get("rpy") or "0 0 0").split(), float)
    T[:3, :3] = _about(2, yaw) @ _about(1, pitch) @ _about(0, roll)
    return T


def _about(axis: int, angle: float) -> np.ndarray:
    R = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R[i, i] = R[j, j] = np.cos(angle)
    R[j, i] = np.sin(angle)
    R[i, j] = -np.sin(angle)
    return R


def _motion(joint: Element, value: float) -> np.ndarray:
    kind, tag = joint.get("type"), joint.find("axis")
    u = np.array((tag.get("xyz", "1 0 0") if tag is not None else "1 0 0").split(), float)
    T = np.eye(4)
    if kind not in ("revolute", "continuous", "prismatic"):
        return T
    u = u / np.linalg.norm(u)
    if kind == "prismatic":
        T[:3, 3] = value * u
    else:
        K = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
        T[:3, :3] = np.cos(value) * np.eye(3) + np.sin(value) * K + (1 - np.cos(value)) * np.outer(u, u)
    return T
