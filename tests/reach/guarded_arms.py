"""Arms of capsules beside a floor, a column and a wall: what is free of them, in closed form."""

from dataclasses import dataclass

import numpy as np

import wsrender as ws
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.robot.constraints import constraints_for

RADIUS = 0.03
FIRST, SECOND, STROKE = 0.5, 0.4, 0.2  # links of the SCARA
COLUMN, ROUND = np.array([0.45, 0.1]), 0.08  # where its column stands, and how thick
FLOOR, LINK = -0.31, 0.45  # of the 2R arm
WALL, NEAREST, FARTHEST = 0.42, 0.25, 0.6  # of the spherical arm


@dataclass(frozen=True)
class Guarded:
    """A robot and what stands around."""

    robot: ws.Robot
    constraints: tuple[Constraint, ...]


def _robot(bodies: str, placement: ws.Transform | None = None) -> ws.Robot:
    text = f'<mujoco><compiler angle="radian" autolimits="true"/><worldbody>{bodies}</worldbody></mujoco>'
    return ws.load_robot(text, tip="tip", placement=placement)


def _body(name: str, pos: str, joint: str, geom: str, inner: str) -> str:
    capsule = f'<geom type="capsule" size="{RADIUS}" fromto="{geom}"/>' if geom else ""
    inertial = '<inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>'
    return f'<body name="{name}" pos="{pos}">{inertial}<joint name="{name}" {joint}/>{capsule}{inner}</body>'


def _guarded(robot: ws.Robot, item: object) -> Guarded:
    around = ws.Environment(items=[item])
    return Guarded(robot, constraints_for(robot, None, around))


def two_links() -> Guarded:
    """Equal links in a vertical plane over a floor."""
    hinge, along = 'type="hinge" axis="0 -1 0" range="-3.14159265358979 3.14159265358979"', f"0 0 0 {LINK} 0 0"
    tip = f'<site name="tip" pos="{LINK} 0 0"/>'
    second = _body("second", f"{LINK} 0 0", hinge, along, tip)
    return _guarded(_robot(_body("first", "0 0 0", hinge, along, second)), ws.HalfSpace(point_m=(0, 0, FLOOR)))


def free_area_of_two_links() -> float:
    """A disc above the floor: equal links reach it with the elbow above the line to the tip, so never below the floor.

    The disc's segment below is R² acos(h / R) - h √(R² - h²).
    """
    R, h = 2 * LINK, -(FLOOR + RADIUS)
    return np.pi * R**2 - (R**2 * np.arccos(h / R) - h * np.sqrt(R**2 - h**2))


def scara() -> Guarded:
    """Two links that turn in a plane and a slide, beside a column higher than all of them."""
    tip = '<site name="tip" pos="0 0 0"/>'
    slide = _body("slide", f"{SECOND} 0 0", f'type="slide" axis="0 0 -1" range="0 {STROKE}"', "", tip)
    hinge = 'type="hinge" axis="0 0 1" range="{} {}"'
    second = _body("second", f"{FIRST} 0 0", hinge.format(-2.6, 2.6), f"0 0 0 {SECOND} 0 0", slide)
    robot = _robot(_body("first", "0 0 0", hinge.format(-2.9, 2.9), f"0 0 0 {FIRST} 0 0", second))
    return _guarded(robot, ws.Cylinder(position_m=(*COLUMN, 0), radius_m=ROUND, length_m=2.0))


def scara_labels(points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Whether points (N, 3) are reachable and whether free, (N,) bool; how far they are from where that changes.

    The last (N,) is the least margin [m or rad] of what decides: of the column, of limits.
    """
    d2 = (points[:, :2] ** 2).sum(axis=1)
    cosine = (d2 - FIRST**2 - SECOND**2) / (2 * FIRST * SECOND)
    reach = np.zeros(len(points), bool)
    margin = np.minimum(np.abs(1 - np.abs(cosine)), np.abs(2.6 - np.arccos(np.clip(cosine, -1, 1))))
    inside = (points[:, 2] <= 0) & (points[:, 2] >= -STROKE)
    free = reach.copy()
    for sign in (1, -1):
        q2 = sign * np.arccos(np.clip(cosine, -1, 1))
        q1 = np.arctan2(points[:, 1], points[:, 0]) - np.arctan2(SECOND * np.sin(q2), FIRST + SECOND * np.cos(q2))
        q1 = np.remainder(q1 + np.pi, 2 * np.pi) - np.pi
        there = inside & (np.abs(cosine) <= 1) & (np.abs(q2) <= 2.6) & (np.abs(q1) <= 2.9)
        elbow = FIRST * np.stack([np.cos(q1), np.sin(q1)], axis=1)
        gaps = distance_of_column(np.zeros(2), elbow), distance_of_column(elbow, points[:, :2])
        gap = np.minimum(*gaps) - ROUND - RADIUS
        reach |= there
        free |= there & (gap >= 0)
        margin = np.minimum(margin, np.minimum(np.abs(gap), np.abs(2.9 - np.abs(q1))))
    return reach, free, margin


def distance_of_column(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Of the column's axis from segments a … b in the plane, (N,)."""
    along = b - a
    t = np.clip(((COLUMN - a) * along).sum(axis=1) / (along**2).sum(axis=1), 0, 1)
    return np.linalg.norm(a + t[:, None] * along - COLUMN, axis=1)


def free_and_blocked_of_scara(levels: int = 2000) -> tuple[float, float]:
    """Volumes by the midpoint rule over a plane, of labels in closed form."""
    edge = 2 * (FIRST + SECOND) / levels
    middle = -(FIRST + SECOND) + edge * (np.arange(levels) + 0.5)
    x, y = np.meshgrid(middle, middle, indexing="ij")
    reach, free, _ = scara_labels(np.stack([x.ravel(), y.ravel(), np.full(x.size, -STROKE / 2)], axis=1))
    return free.sum() * edge**2 * STROKE, (reach & ~free).sum() * edge**2 * STROKE


def spherical(placement: ws.Transform | None = None) -> Guarded:
    """A slide that points anywhere, beside a wall; both are placed."""
    tip = '<site name="tip" pos="0 0 0"/>'
    ends = f"{-NEAREST} 0 0 0 0 0"
    slide = _body("slide", "0 0 0", f'type="slide" axis="1 0 0" range="{NEAREST} {FARTHEST}"', ends, tip)
    up = _body("up", "0 0 0", 'type="hinge" axis="0 -1 0" range="-1.5707963267949 1.5707963267949"', "", slide)
    turn = 'type="hinge" axis="0 0 1" range="-3.14159265358979 3.14159265358979"'
    robot = _robot(_body("turn", "0 0 0", turn, "", up), placement)
    T = np.eye(4) if placement is None else placement.matrix()
    point, normal = T[:3, :3] @ [WALL, 0, 0] + T[:3, 3], T[:3, :3] @ [-1, 0, 0]
    return _guarded(robot, ws.HalfSpace(point_m=tuple(point), normal=tuple(normal)))


def free_and_blocked_of_spherical() -> tuple[float, float]:
    """A spherical shell on this side of the wall: its outer ball's cap beyond is π h² (3 R - h) / 3, of height h."""
    height = FARTHEST - (WALL - RADIUS)
    cap = np.pi * height**2 * (3 * FARTHEST - height) / 3
    return 4 / 3 * np.pi * (FARTHEST**3 - NEAREST**3) - cap, cap
