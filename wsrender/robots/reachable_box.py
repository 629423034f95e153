"""Boxes that hold every position of an end effector, by interval arithmetic along the chain."""

from math import pi
from typing import TYPE_CHECKING

import numpy as np

from wsrender.robots.kinematics import Kinematics

if TYPE_CHECKING:
    from wsrender.robots.chain import Chain


def reachable_box(kinematics: Kinematics, lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner (3,) [m] in the world of a box around all positions with q in lower … upper (n,).

    Never too small, and thin where the workspace is planar or linear. Of a robot that is defined by a Python class it
    is drawn around samples, with a margin: no proof (see `HostKinematics.boxes`).
    """
    low, high = kinematics.boxes(lower[None], upper[None])
    return low[0], high[0]


def reachable_boxes(chain: "Chain", lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners (N, 3) [m] of boxes around all positions with q in lower … upper (N, n), each of a model's chain.

    From the tip to the base, the box that holds the tip in one joint's frame gives the box that holds it in the
    frame before.
    """
    low = high = np.tile((chain.T_tip @ chain.T_tip_tool)[:3, 3], (len(lower), 1))
    limits = np.stack([lower, upper])[..., chain.joint_source]
    limits = np.sort(chain.joint_scale * limits, axis=0) + chain.joint_offset
    for i in reversed(range(len(chain.T_joint))):
        first, last = limits[..., i]
        if chain.joint_is_revolute[i]:
            low, high = _turned(low, high, first, last)
        else:
            low, high = _slid(low, first), _slid(high, last)
        # The placement together with the first joint's frame: turned back and forth, a box would only grow.
        T = chain.T_joint[i] if i else chain.T_world_base @ chain.T_joint[0]
        low, high = _transformed(T, low, high)
    return low, high


def _slid(points: np.ndarray, by: np.ndarray) -> np.ndarray:
    return points + by[:, None] * np.array([0.0, 0.0, 1.0])


def _transformed(T: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The boxes around boxes moved by T (4, 4)."""
    center, half = (low + high) / 2 @ T[:3, :3].T + T[:3, 3], (high - low) / 2 @ np.abs(T[:3, :3]).T
    return center - half, center + half


def _turned(low: np.ndarray, high: np.ndarray, first: np.ndarray, last: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The boxes around boxes turned about z by every angle of first … last (N,) [rad]."""
    x = np.stack([low[:, 0], low[:, 0], high[:, 0], high[:, 0]])
    y = np.stack([low[:, 1], high[:, 1], low[:, 1], high[:, 1]])
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    xs = radius * _cosine_range(angle + first, angle + last)
    ys = radius * _cosine_range(angle + first - pi / 2, angle + last - pi / 2)
    corners = ((each.min(axis=(0, 1)), each.max(axis=(0, 1))) for each in (xs, ys))
    (x_low, x_high), (y_low, y_high) = corners
    return np.stack([x_low, y_low, low[:, 2]], axis=1), np.stack([x_high, y_high, high[:, 2]], axis=1)


def _cosine_range(first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Smallest and largest cosine over first … last, stacked."""
    ends = np.cos(first), np.cos(last)
    through_top = 2 * pi * np.ceil(first / (2 * pi)) <= last
    through_bottom = 2 * pi * np.ceil((first - pi) / (2 * pi)) + pi <= last
    return np.stack([np.where(through_bottom, -1.0, np.minimum(*ends)), np.where(through_top, 1.0, np.maximum(*ends))])
