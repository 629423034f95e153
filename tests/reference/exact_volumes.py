"""Workspaces whose volumes have a closed form or a quadrature of one, in float64."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad
from scipy.stats import qmc

import wsrender as ws
from tests.reference import closed_form_inverse as closed_form


@dataclass(frozen=True)
class Case:
    """An arm, the volume of its workspace [m³] and what that number may be off, relative."""

    robot: Callable[[], ws.Robot]
    volume: float
    error: float = 1e-9


def ball(radius, hole=0.0):
    """Volume of a ball, or of a shell."""
    return 4 / 3 * np.pi * (radius**3 - hole**3)


def articulated():
    """Sector of 90° times the integral of |u| over the section of the elbow: r from .2 to .4 m.

    The direction in the section is q2 + q3/2, q2 from -45° to 45°, with r = .4 cos(q3/2).
    """

    def along(r):
        bend = np.arccos(r / 0.4)
        low, high = -np.pi / 4 - bend, np.pi / 4 - bend
        behind = -2 - np.sin(low) if low < -np.pi / 2 else np.sin(low)  # of the first axis
        return r * r * (np.sin(high) - behind)

    return np.pi / 2 * quad(along, 0.2, 0.4, points=[0.4 * np.cos(np.pi / 4)])[0]


def puma560():
    """By the closed-form inverse kinematics at quasi-random points."""
    robot = ws.load_robot("puma560")

    def member(points):
        with np.errstate(invalid="ignore"):
            arm = closed_form.puma560_arm(points)
        limits = robot.lower_limits[:3], robot.upper_limits[:3], robot.chain.revolute[:3]
        return closed_form.within_limits(arm, *limits).any(axis=1)

    return quasi_volume(member, np.full(3, -0.9), np.full(3, 0.9))


def quasi_volume(member, low, high, power=20):
    """Share of Sobol points in a set, times the box."""
    points = qmc.scale(qmc.Sobol(3, rng=0).random_base2(power), low, high)
    inside = [np.count_nonzero(member(part)) for part in np.array_split(points, 16)]
    return sum(inside) / len(points) * float(np.prod(high - low))


def spherical_pair(m=80):
    """Volumes that any and both of two spherical arms reach, at x = ±.1 m, y = .4 m, turned by 90° ([WSR] Table V).

    The midpoint rule over x and y, on a grid along the edges of the sectors, of lengths along z in closed form: a point
    at ρ from the axis is reached where its distance lies within .2 … .4 m and |z| ≤ ρ.
    """
    step = 0.1 / np.sqrt(2) / m
    k = (np.arange(-10 * m, 10 * m) + 0.5) * step
    p, q = (each.ravel() for each in np.meshgrid(k, k))
    x, y = (p - q) / np.sqrt(2), (p + q) / np.sqrt(2)
    ends = []
    for base in (0.1, -0.1):
        dx, dy = x - base, y - 0.4
        rho = np.hypot(dx, dy)
        low = np.sqrt(np.maximum(0.04 - rho**2, 0))
        high = np.minimum(rho, np.sqrt(np.maximum(0.16 - rho**2, 0)))
        sector = -dy > np.abs(dx)
        ends.append((low, np.where(sector, np.maximum(high, low), low)))
    (low1, high1), (low2, high2) = ends
    both = np.maximum(np.minimum(high1, high2) - np.maximum(low1, low2), 0)
    each = (high1 - low1) + (high2 - low2)
    return 2 * step**2 * float((each - both).sum()), 2 * step**2 * float(both.sum())


def _arm(*rows, **placing):
    names = ("a", "alpha_deg", "d", "theta_deg")
    joints = [ws.DHRow(**dict(zip(names, row[:4], strict=True)), **row[4]) for row in rows]
    return ws.load_robot(ws.DHTable(convention="modified", rows=joints, name="arm"), **placing)


def _slide(low, high):
    return {"joint": "prismatic", "limits": (low, high)}


def _tool(x=0.0, z=0.0):
    return ws.Transform(position_m=(x, 0.0, z))


def _elbow(upper, lower):
    return _arm((0, 0, 0, 0, {}), (0, 90, 0, 0, {}), (upper, 0, 0, 0, {}), tool=_tool(x=lower))


def _torus():
    return _arm((0, 0, 0, 0, {}), (0.5, 90, 0, 0, {}), (0, 90, 0, 0, _slide(0.1, 0.2)))


def _thin_shell():
    return _arm((0, 0, 0, 0, {}), (0, 90, 0, 0, {"limits_deg": (0, 180)}), (0, -90, 0, 0, _slide(0.4, 0.401)))


def _gimbal():
    return _arm((0, 0, 0, 0, {}), (0, 90, 0, 0, {}), (0, -90, 0, 0, {}), tool=_tool(x=0.3, z=0.1))


def _seven_joints():
    bends = (0, -90, 90, -90, 90, -90, 90)
    lengths = (0, 0, 0.4, 0, 0.3, 0, 0)
    return _arm(*((0, bend, d, 0, {}) for bend, d in zip(bends, lengths, strict=True)), tool=_tool(z=0.1))


def _box(x, y, z, turned=(0.0, 0.0, 0.0)):
    slides = ((0, 0, 0, 0, _slide(0, z)), (0, 90, 0, 90, _slide(0, y)), (0, 90, 0, 0, _slide(0, x)))
    return _arm(*slides, placement=ws.Transform(rpy_deg=turned))


def _library(name):
    return lambda: ws.load_robot(name)


CASES = {
    "articulated": Case(_library("articulated"), articulated()),
    "spherical": Case(_library("spherical"), np.pi / 2 * np.sqrt(2) * (0.4**3 - 0.2**3) / 3),
    "cylindrical": Case(_library("cylindrical"), np.pi / 4 * 0.4**2 * 0.2),
    "cartesian": Case(_library("cartesian"), 0.2**3),
    "scara, in a plane": Case(_library("scara"), 0.0),
    "gao_6r": Case(_library("gao_6r"), 0.403721, 5e-4),
    "puma560": Case(_library("puma560"), puma560(), 4e-4),
    "slave_5r, on a sphere": Case(_library("slave_5r"), 0.0),
    "elbow with a void": Case(lambda: _elbow(0.3, 0.2), ball(0.5, 0.1)),
    "hollow torus": Case(_torus, 2 * np.pi**2 * 0.5 * (0.2**2 - 0.1**2)),
    "shell of 1 mm": Case(_thin_shell, ball(0.401, 0.4)),
    "seven joints": Case(_seven_joints, ball(0.8)),
    "box": Case(lambda: _box(0.3, 0.4, 0.2), 0.3 * 0.4 * 0.2),
    "slab of 1 mm, turned": Case(lambda: _box(0.3, 0.4, 0.001, (20, 30, 40)), 0.3 * 0.4 * 0.001),
    "needle of 2 mm, turned": Case(lambda: _box(0.5, 0.002, 0.002, (20, 30, 40)), 0.5 * 0.002**2),
    "box of 3 cm": Case(lambda: _box(0.03, 0.03, 0.03), 2.7e-5),
    "three joints, on a sphere": Case(_gimbal, 0.0),
}
