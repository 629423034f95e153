"""Planar arms of the tests: by joints in the plane, and as robots."""

import numpy as np

import wsrender as ws
from wsrender.geometry.planar.exact_boundary import ExactBoundary
from wsrender.geometry.planar.planar_chain import PlanarChain, PlanarJoint, Plane

XY = Plane(np.zeros(3), np.eye(3)[:2])


def turning(x, y, low_deg, high_deg, name="turn"):
    center = np.array([x, y], float)
    return PlanarJoint(name, True, center, np.zeros(2), np.radians(low_deg), np.radians(high_deg))


def sliding(angle_deg, low, high, name="slide"):
    angle = np.radians(angle_deg)
    direction = np.round([np.cos(angle), np.sin(angle)], 15)
    return PlanarJoint(name, False, np.zeros(2), direction / np.linalg.norm(direction), low, high)


def boundary(joints, tip):
    return ExactBoundary(PlanarChain(tuple(joints), np.array(tip, float), XY, np.zeros(2)))


def revolute_joints(lengths, limits_deg):
    """Joints and tip of an arm along x."""
    at = np.concatenate([[0.0], np.cumsum(lengths)])
    joints = [
        turning(x, 0, *limits, name=f"joint{k}") for k, (x, limits) in enumerate(zip(at, limits_deg, strict=False), 1)
    ]
    return joints, (at[-1], 0.0)


def revolute_arm(lengths, limits_deg, **options):
    rows = [ws.DHRow(a=a, limits_deg=limits) for a, limits in zip(lengths, limits_deg, strict=True)]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows, name="planar"), **options)


def turn_and_slide():
    """RP of Alciatore & Ng: x = (5 + d) cos θ, y = (5 + d) sin θ."""
    return [turning(0, 0, -45, 45, "theta"), sliding(0, 0, 3, "d")], (5, 0)


def slide_and_turn(low_deg=30, high_deg=330):
    """PR of Alciatore & Ng: x = 2 sin θ, y = d − 2 cos θ."""
    return [sliding(90, 0, 6, "d"), turning(0, 0, low_deg, high_deg, "theta")], (0, -2)
