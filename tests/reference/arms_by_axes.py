"""Chains made of axes in space, and random ones of a class: what their closed form is, is known by construction."""

from dataclasses import replace

import numpy as np

from wsrender.robots.chain import Chain
from wsrender.robots.joint_space import unlimited

WRIST, PARALLEL = "spherical wrist", "three parallel axes"
RELATIONS = (
    "axes 1 and 2 intersecting",
    "axes 1 and 2 parallel",
    "axes 2 and 3 parallel",
    "axes 2 and 3 intersecting",
    "general arm",
)


def frame(z, at):
    """A frame (4, 4) with this z axis and origin."""
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.column_stack([x, np.cross(z, x), z]), at
    return T


def chain_of(directions, points, T_tip, lower, upper, revolute=None):
    """The chain whose axes have these ``directions`` (n, 3) and ``points`` (n, 3) at zero, and the tip's pose there."""
    n = len(directions)
    frames = [frame(h, o) for h, o in zip(directions, points, strict=True)]
    before = [np.eye(4), *frames[:-1]]
    return Chain(
        name="made",
        base_frame="world",
        tip_frame="tip",
        joint_names=tuple(f"q{k}" for k in range(n)),
        lower_limits=np.array(lower, float),
        upper_limits=np.array(upper, float),
        periodic=np.zeros(n, bool),
        efforts=unlimited(n),
        velocity_limits=np.full(n, np.inf),
        joint_is_revolute=np.ones(n, bool) if revolute is None else np.array(revolute, bool),
        joint_source=np.arange(n),
        joint_scale=np.ones(n),
        joint_offset=np.zeros(n),
        T_joint=np.array([np.linalg.inv(a) @ b for a, b in zip(before, frames, strict=True)]),
        T_tip=np.linalg.inv(frames[-1]) @ T_tip,
        mass=np.zeros(n),
        center_of_mass=np.zeros((n, 3)),
        inertia=np.zeros((n, 3, 3)),
        armature=np.zeros(n),
        has_inertia=False,
    )


def axes_of(chain):
    """Directions (n, 3), points (n, 3) and the tip's pose at zero displacement."""
    T, directions, points = np.eye(4), [], []
    for T_joint in chain.T_joint:
        T = T @ T_joint
        directions.append(T[:3, 2])
        points.append(T[:3, 3])
    return np.array(directions), np.array(points), T @ chain.T_tip


def reversed_chain(chain):
    """The same arm held at its tip: its pose is the inverse, its joints come the other way round."""
    directions, points, T_tip = axes_of(chain)
    T = np.linalg.inv(T_tip)
    ends = chain.lower_limits[::-1], chain.upper_limits[::-1]
    turned = -(T[:3, :3] @ directions[::-1].T).T, (T[:3, :3] @ points[::-1].T).T + T[:3, 3]
    return chain_of(*turned, T, *ends, chain.joint_is_revolute[::-1])


def slid_along_axes(chain, by):
    """The same axes with every frame elsewhere on its own, turned and slid by (n, 2) [rad, m]."""
    T_joint, T_tip = chain.T_joint.copy(), chain.T_tip.copy()
    for k, (angle, distance) in enumerate(by):
        c, s = np.cos(angle), np.sin(angle)
        move = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, distance], [0, 0, 0, 1]])
        T_joint[k] = T_joint[k] @ move
        if k + 1 < chain.n:
            T_joint[k + 1] = np.linalg.inv(move) @ T_joint[k + 1]
        else:
            T_tip = np.linalg.inv(move) @ T_tip
    return replace(chain, T_joint=T_joint, T_tip=T_tip)


def direction(random):
    """A unit vector (3,), any."""
    h = random.normal(size=3)
    return h / np.linalg.norm(h)


def across(random, *others):
    """A unit vector (3,) that is far from parallel to others."""
    while True:
        h = direction(random)
        if all(np.linalg.norm(np.cross(h, other)) > 0.5 for other in others):
            return h


def random_arm(kind, seed, kinds="RRR"):
    """A chain of six joints of the class ``kind``: one of RELATIONS before a spherical wrist, or PARALLEL.

    ``kinds`` of the first three joints: R or P.
    """
    random = np.random.default_rng(seed)
    h, o = np.empty((6, 3)), random.uniform(-0.5, 0.5, (6, 3))
    h[0] = direction(random)
    h[1] = across(random, h[0])
    h[2] = across(random, h[1])
    if kind == PARALLEL:
        h[2], h[3] = random.choice([-1, 1], 2)[:, None] * h[1]
        h[4] = across(random, h[3])
        h[5] = across(random, h[4])
        o[5] = o[4]
    else:
        if kind == RELATIONS[0]:
            o[1] = o[0] + random.uniform(-0.3, 0.3) * h[0]
        elif kind == RELATIONS[1]:
            h[1] = random.choice([-1, 1]) * h[0]
            h[2] = across(random, h[1])
        elif kind == RELATIONS[2]:
            h[2] = random.choice([-1, 1]) * h[1]
        elif kind == RELATIONS[3]:
            o[2] = o[1] + random.uniform(-0.3, 0.3) * h[1]
        else:  # beside arms whose first axes meet the quartic of general ones has no digits: no closed form
            while abs((o[1] - o[0]) @ np.cross(h[0], h[1])) < 0.02:
                o[1] = random.uniform(-0.5, 0.5, 3)
        h[3] = direction(random)
        h[4] = across(random, h[3])
        h[5] = across(random, h[4])
        o[4] = o[5] = o[3]
    T_tip = frame(direction(random), random.uniform(-0.5, 0.5, 3))
    middle, half = random.uniform(-1, 1, 6), random.choice([0.4, 1.0, 2.0, 3.0, 3.5, 6.2], 6)
    revolute = np.array([letter == "R" for letter in kinds] + [True] * 3)
    middle, half = np.where(revolute, middle, 0.3 * middle), np.where(revolute, half, 0.4)
    return chain_of(h, o, T_tip, middle - half, middle + half, revolute)
