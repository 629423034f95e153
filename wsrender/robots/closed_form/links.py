"""Denavit and Hartenberg's numbers of six axes whose last ones meet."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from wsrender.robots.closed_form.axes import SAME, Axis, nearest_points, perpendicular


@dataclass(frozen=True, eq=False)
class Links:
    """T = base · Π Rz(θ_i) Tz(d_i) Tx(a_i) Rx(α_i) · tool (Denavit, Hartenberg 1955), each (6,) [rad, m].

    Joint i adds its displacement to ``theta`` [i] or ``d`` [i]; those of the first joint are 0.
    """

    theta: np.ndarray
    d: np.ndarray
    a: np.ndarray
    alpha: np.ndarray
    base: np.ndarray  # (4, 4)
    tool: np.ndarray  # (4, 4)


def links_of(axes: Sequence[Axis], T_tip: np.ndarray) -> Links:
    """The numbers of ``axes`` and the tip's pose (4, 4) at zero displacement.

    The foot on the last axis is its point. Axes that are parallel but for rounding become so: their common normal
    would be far away.
    """
    count = len(axes)
    normals, feet, before = [], [], axes[0].point
    for i, (axis, following) in enumerate(pairwise(axes)):
        h, k = axis.direction, following.direction
        x = np.cross(h, k)
        if np.linalg.norm(x) < SAME:
            foot = axis.point + h * (h @ (before - axis.point))
            other = following.point + k * (k @ (foot - following.point))
            x = other - foot
            if np.linalg.norm(x) < 1e-9:
                x = perpendicular(h)
        else:
            foot, other = nearest_points(axis, following)
        if i == count - 2:
            other = following.point
        length = np.linalg.norm(x)
        normals.append(x / length)
        feet.append((foot, other))
        before = other
    numbers = np.zeros((4, count))
    x, at = normals[0], feet[0][0]
    base = _frame(axes[0].direction, x, at)
    for i in range(count - 1):
        h, k, normal = axes[i].direction, axes[i + 1].direction, normals[i]
        foot, other = feet[i]
        alpha = _angle(h, k, normal)
        if abs(np.sin(alpha)) < SAME:
            alpha = np.pi * np.round(alpha / np.pi)
        numbers[:, i] = _angle(x, normal, h), h @ (foot - at), normal @ (other - foot), alpha
        x, at = normal, other
    last = _frame(axes[-1].direction, x, at)
    return Links(*numbers, base=base, tool=np.linalg.inv(last) @ T_tip)


def _angle(first: np.ndarray, second: np.ndarray, about: np.ndarray) -> float:
    return float(np.arctan2(about @ np.cross(first, second), first @ second))


def _frame(z: np.ndarray, x: np.ndarray, at: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.column_stack([x, np.cross(z, x), z]), at
    return T
