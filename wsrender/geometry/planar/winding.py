"""How often closed boundaries of lines and arcs wind around points."""

import numpy as np

from wsrender.geometry.planar.curves import TURN, Curves, cross

_AT_ONCE = 1 << 20  # angles that are held in memory at once


def winding_numbers(points: np.ndarray, curves: Curves, sign: np.ndarray) -> np.ndarray:
    """Winding number of the curves around points (K, 2) that lie on none of them, (K,) float: a whole number.

    ``sign`` (N,) is 1 where a curve is run through by increasing parameter, −1 where against it.
    """
    step = max(1, _AT_ONCE // max(len(curves), 1))
    parts = [points[first : first + step] for first in range(0, len(points), step)]
    return np.concatenate([_turns(part, curves) @ sign for part in parts] or [np.empty(0)])


def _turns(points: np.ndarray, curves: Curves) -> np.ndarray:
    """Angle that each curve subtends at each point, in turns, (K, N)."""
    a, b = curves.start - points[:, None], curves.end - points[:, None]
    area = cross(a, b) + 0.0  # never −0, whose arctan2 is −π
    angle = np.arctan2(area, (a * b).sum(axis=-1))
    offset = points[:, None] - curves.base
    inside = curves.arc & (np.hypot(offset[..., 0], offset[..., 1]) < curves.radius)
    # Between an arc and its chord the arc subtends a turn more than the chord.
    angle = np.where(inside & (area < 0), angle + TURN, angle)
    return np.where(curves.full, TURN * inside, angle) / TURN
