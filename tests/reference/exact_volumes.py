"""Workspaces whose volumes have a closed form or a quadrature of one, in float64."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

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


def turned_elbow(upper, lower, sector, shoulder, elbow):
    """A planar elbow that turns about an axis through its shoulder by less than 180°; angles [rad].

    The section is covered by circles about the shoulder, a radius for every bend; its area element is upper · lower ·
    sin(bend) dbend dψ, its way round the sector |r cos ψ|. An elbow that bends both ways covers two stretches of ψ.
    """

    def along(bend):
        stretches = []
        for way in (bend, -bend):
            if elbow[0] <= way <= elbow[1]:
                tip = upper + lower * np.exp(1j * way)
                stretches.append((shoulder[0] + np.angle(tip), shoulder[1] + np.angle(tip)))
        if len(stretches) == 2 and stretches[0][0] < stretches[1][1] and stretches[1][0] < stretches[0][1]:
            low, high = zip(*stretches, strict=True)
            stretches = [(min(low), max(high))]
        turned = sum(absolute_cosine(high) - absolute_cosine(low) for low, high in stretches)
        return upper * lower * np.sin(bend) * abs(upper + lower * np.exp(1j * bend)) * turned

    least = 0.0 if elbow[0] < 0 < elbow[1] else np.abs(elbow).min()
    # In pieces, for the bends at which ψ crosses ±90°, or stretches part, are somewhere between.
    pieces = sorted({*np.linspace(least, np.abs(elbow).max(), 200), np.abs(elbow).min()})
    return sector * sum(quad(along, a, b)[0] for a, b in pairwise(pieces))


def absolute_cosine(angle):
    """Integral of |cos| from 0."""
    turns = np.round(angle / np.pi)
    return 2 * turns + (-1.0) ** turns * np.sin(angle)


def ur5e():
    """All joints turn all round: at a height z the distances from the first axis fill one interval.

    The last link, of which w lies along the second axis, makes with d5 an end of the planar part of length
    √(d5² + d6² - w²); the planar part reaches every point of a disc, d4 + w beside the first axis.
    """
    arm, d4, d5, d6 = 0.425 + 0.3922, 0.1333, 0.0997, 0.0996
    w = np.linspace(-d6, d6, 2_001)
    radius, beside = arm + np.sqrt(d5**2 + d6**2 - w**2), d4 + w

    def squares(z):
        there = radius >= z
        return (radius**2 - z * z + beside**2)[there].max() - (beside[there] ** 2).min()

    z, step = np.linspace(0, radius.max(), 4_000, endpoint=False, retstep=True)
    return 2 * np.pi * step * sum(squares(each + step / 2) for each in z)


def stanford_arm():
    """In cylinders about the first axis, at heights z above the second, less what joint limits leave out.

    A wrist of length l, of which m lies along the second axis, adds √(l² - m²) to a planar arm of one slide a … b, that
    is bent by up to 90° either way, n = d2 + m beside the first axis. Of the limits ±170° of the first two joints the
    second keeps the slide out of a cone below; the first leaves a gap of 20° behind for every (m, side), so the share
    of the circle that no solution reaches is what their gaps have in common.
    """
    d2, l, a, b, limit = 0.154, 0.263, 12 * 0.0254, 50 * 0.0254, np.radians(170)  # noqa: E741
    m = np.linspace(-l, l, 1001)
    n, t = d2 + m, np.sqrt(l**2 - m**2)

    def squares(z):
        there = b + t >= z
        low, high = n**2 + np.maximum(a * a + t**2 - z * z, 0), n**2 + (b + t) ** 2 - z * z
        return high[there].max() - low[there].min()

    z, step = np.linspace(0, b + l, 4_000, endpoint=False, retstep=True)
    whole = 2 * np.pi * step * sum(squares(each + step / 2) for each in z)

    # Near the first axis: the share of the circle that the limits leave out, by quasi-random points of a cylinder.
    reach, height = 0.65, 2 * (b + l)
    points = qmc.Sobol(2, rng=0).random_base2(13)
    left_out = np.zeros(len(points))
    m = np.linspace(-l, l, 201)
    n, t = d2 + m, np.sqrt(l**2 - m**2)
    for k, (square, level) in enumerate(points):
        rho_2, z = reach**2 * square, height * (level - 0.5)
        x_2 = rho_2 - n**2
        s_2 = x_2 + z * z
        there = (x_2 >= 0) & (s_2 >= a * a + t**2) & (s_2 <= (b + t) ** 2)
        if not there.any():
            continue
        x, s, wrist = np.sqrt(x_2[there]), np.sqrt(s_2[there]), t[there]
        # From the slide, at least a long, to the point: the farthest that the wrist can bend away.
        slide = np.clip(np.sqrt(np.maximum(s**2 - wrist**2, 0)), a, b)
        away = np.arccos(np.clip((slide**2 + s**2 - wrist**2) / (2 * slide * s), -1, 1))
        allowed = np.arctan2(x, z) - away <= limit
        if not allowed.any():
            left_out[k] = 2 * np.pi
            continue
        aside = np.arctan2(x, n[there])[allowed]  # to either side: x and -x
        left_out[k] = max(2 * (np.pi - limit) - 2 * aside.max(), 0.0)
    return whole - reach**2 / 2 * height * float(left_out.mean())


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


def dh_arm(*rows, **placing):
    """A chain of modified DH rows (a, alpha [deg], d, theta [deg], joint)."""
    names = ("a", "alpha_deg", "d", "theta_deg")
    joints = [ws.DHRow(**dict(zip(names, row[:4], strict=True)), **row[4]) for row in rows]
    return ws.load_robot(ws.DHTable(convention="modified", rows=joints, name="arm"), **placing)


def slide(low, high):
    """A prismatic joint of a DH row [m]."""
    return {"joint": "prismatic", "limits": (low, high)}


def tool(x=0.0, z=0.0):
    """A tool point in the plane of the last joint [m]."""
    return ws.Transform(position_m=(x, 0.0, z))


def _elbow(upper, lower):
    return dh_arm((0, 0, 0, 0, {}), (0, 90, 0, 0, {}), (upper, 0, 0, 0, {}), tool=tool(x=lower))


def _torus():
    return dh_arm((0, 0, 0, 0, {}), (0.5, 90, 0, 0, {}), (0, 90, 0, 0, slide(0.1, 0.2)))


def _thin_shell():
    return dh_arm((0, 0, 0, 0, {}), (0, 90, 0, 0, {"limits_deg": (0, 180)}), (0, -90, 0, 0, slide(0.4, 0.401)))


def _gimbal():
    return dh_arm((0, 0, 0, 0, {}), (0, 90, 0, 0, {}), (0, -90, 0, 0, {}), tool=tool(x=0.3, z=0.1))


def _seven_joints():
    bends = (0, -90, 90, -90, 90, -90, 90)
    lengths = (0, 0, 0.4, 0, 0.3, 0, 0)
    return dh_arm(*((0, bend, d, 0, {}) for bend, d in zip(bends, lengths, strict=True)), tool=tool(z=0.1))


def _box(x, y, z, turned=(0.0, 0.0, 0.0)):
    slides = ((0, 0, 0, 0, slide(0, z)), (0, 90, 0, 90, slide(0, y)), (0, 90, 0, 0, slide(0, x)))
    return dh_arm(*slides, placement=ws.Transform(rpy_deg=turned))


def _library(name):
    return lambda: ws.load_robot(name)


CASES = {
    "articulated": Case(_library("articulated"), articulated()),
    "spherical": Case(_library("spherical"), np.pi / 2 * np.sqrt(2) * (0.4**3 - 0.2**3) / 3),
    "cylindrical": Case(_library("cylindrical"), np.pi / 4 * 0.4**2 * 0.2),
    "cartesian": Case(_library("cartesian"), 0.2**3),
    "scara, in a plane": Case(_library("scara"), 0.0),
    "phantom_omni": Case(
        _library("phantom_omni"),
        turned_elbow(0.127508, 0.149352, *np.radians([100]), np.radians([0, 105]), np.radians([-90, 0])),
    ),
    "dvrk_mtm": Case(
        _library("dvrk_mtm"),
        turned_elbow(
            0.2794,
            np.hypot(0.3048, 0.1506),
            *np.radians([105]),
            np.radians([-15, 50]),
            np.radians([-50, 35]) - np.arctan2(0.1506, 0.3048),
        ),
    ),
    "ur5e": Case(_library("ur5e"), ur5e(), 1e-6),
    "stanford_arm": Case(_library("stanford_arm"), stanford_arm(), 2e-4),
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
