"""A box that holds every position of an end effector, by interval arithmetic along the chain."""

from math import atan2, ceil, cos, hypot, pi

import numpy as np

from wsrender.robots.chain import Chain
from wsrender.robots.host_chain import HostChain


def reachable_box(chain: Chain, lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner (3,) [m] in the world of a box around all positions with q in lower … upper (n,).

    From the tip to the base, the box that holds the tip in one joint's frame gives the box that holds it in the
    frame before. Never too small, and thin where the workspace is planar or linear. Of a robot that is defined by a
    Python class it is `HostChain.box`.
    """
    if isinstance(chain, HostChain):
        return chain.box(lower, upper)
    low = high = (chain.T_tip @ chain.T_tip_tool)[:3, 3]
    limits = np.sort(chain.joint_scale * np.stack([lower, upper])[:, chain.joint_source], axis=0) + chain.joint_offset
    for i in reversed(range(len(chain.T_joint))):
        first, last = limits[:, i]
        if chain.joint_is_revolute[i]:
            low, high = _turned(low, high, first, last)
        else:
            low, high = low + np.array([0, 0, first]), high + np.array([0, 0, last])
        # The placement together with the first joint's frame: turned back and forth, a box would only grow.
        T = chain.T_joint[i] if i else chain.T_world_base @ chain.T_joint[0]
        low, high = _transformed(T, low, high)
    return low, high


def _transformed(T: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The box around a box moved by T (4, 4)."""
    center, half = T[:3, :3] @ (low + high) / 2 + T[:3, 3], np.abs(T[:3, :3]) @ (high - low) / 2
    return center - half, center + half


def _turned(low: np.ndarray, high: np.ndarray, first: float, last: float) -> tuple[np.ndarray, np.ndarray]:
    """The box around a box turned about z by every angle of first … last [rad]."""
    corners = [(x, y) for x in (low[0], high[0]) for y in (low[1], high[1])]
    circles = [(hypot(x, y), atan2(y, x)) for x, y in corners]
    xs = [r * c for r, angle in circles for c in _cosine_range(angle + first, angle + last)]
    ys = [r * c for r, angle in circles for c in _cosine_range(angle + first - pi / 2, angle + last - pi / 2)]
    return np.array([min(xs), min(ys), low[2]]), np.array([max(xs), max(ys), high[2]])


def _cosine_range(first: float, last: float) -> tuple[float, float]:
    """Smallest and largest cosine over first … last."""
    ends = cos(first), cos(last)
    through_top = 2 * pi * ceil(first / (2 * pi)) <= last
    through_bottom = 2 * pi * ceil((first - pi) / (2 * pi)) + pi <= last
    return (-1.0 if through_bottom else min(ends)), (1.0 if through_top else max(ends))
