"""Where whole lines and circles cross or touch."""

from dataclasses import dataclass

import numpy as np

from wsrender.geometry.planar.curves import Curves, cross, turned_left


@dataclass(frozen=True, eq=False)
class Crossings:
    """K points common to two of the curves; ``sharpness`` is the sine of the angle at which they cross, 0 touching."""

    first: np.ndarray  # (K,) row of a curve
    second: np.ndarray  # (K,) row of another
    points: np.ndarray  # (K, 2) [m]
    sharpness: np.ndarray  # (K,)


def crossings(curves: Curves, tolerance: float) -> Crossings:
    """Every point common to two different whole lines or circles, ranges of parameters left aside.

    Curves that miss or pass each other by at most ``tolerance`` [m] touch: that gives one point, found without loss
    of digits, where the two points of a crossing would each have lost half of them.
    """
    i, j = np.triu_indices(len(curves), k=1)
    swap = curves.arc[i] & ~curves.arc[j]
    i, j = np.where(swap, j, i), np.where(swap, i, j)  # lines first
    both_lines, both_arcs = ~curves.arc[j], curves.arc[i]
    parts = [
        _line_line(curves, i[both_lines], j[both_lines], tolerance),
        _line_circle(curves, i[~both_lines & ~both_arcs], j[~both_lines & ~both_arcs], tolerance),
        _circle_circle(curves, i[both_arcs], j[both_arcs], tolerance),
    ]
    names = ("first", "second", "points", "sharpness")
    return Crossings(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def _line_line(curves: Curves, i: np.ndarray, j: np.ndarray, tolerance: float) -> Crossings:
    sine = cross(curves.direction[i], curves.direction[j])
    crossing = np.abs(sine) > tolerance
    i, j, sine = i[crossing], j[crossing], sine[crossing]
    t = cross(curves.base[j] - curves.base[i], curves.direction[j]) / sine
    return Crossings(i, j, curves.base[i] + t[:, None] * curves.direction[i], np.abs(sine))


def _line_circle(curves: Curves, i: np.ndarray, j: np.ndarray, tolerance: float) -> Crossings:
    offset, u, r = curves.base[j] - curves.base[i], curves.direction[i], curves.radius[j]
    height = np.abs(cross(u, offset))
    foot = curves.base[i] + (offset * u).sum(axis=1)[:, None] * u
    half = np.sqrt(np.maximum((r - height) * (r + height), 0.0))
    return _pairs(i, j, foot, u, half, half / r, height - r, tolerance)


def _circle_circle(curves: Curves, i: np.ndarray, j: np.ndarray, tolerance: float) -> Crossings:
    offset, r1, r2 = curves.base[j] - curves.base[i], curves.radius[i], curves.radius[j]
    d = np.hypot(offset[:, 0], offset[:, 1])
    apart = d > tolerance
    i, j, offset, r1, r2, d = i[apart], j[apart], offset[apart], r1[apart], r2[apart], d[apart]
    u = offset / d[:, None]
    outside, within = d - (r1 + r2), np.abs(r1 - r2) - d
    gap = np.maximum(outside, within)
    touch = np.where(outside > within, r1, np.where(r1 > r2, r1, -r1))  # along u, where the circles touch
    # Heron's formula for the height of the triangle of centres and crossing: no cancellation in the small factor.
    half = np.sqrt(np.maximum(-outside * -within * (d + np.abs(r1 - r2)) * (d + r1 + r2), 0.0)) / (2 * d)
    along = np.where(np.abs(gap) <= tolerance, touch, (d + (r1 - r2) * ((r1 + r2) / d)) / 2)
    sharpness = np.minimum(half * d / (r1 * r2), 1.0)
    return _pairs(i, j, curves.base[i] + along[:, None] * u, turned_left(u), half, sharpness, gap, tolerance)


def _pairs(i, j, middle, along, half, sharpness, gap, tolerance) -> Crossings:
    """One point where curves touch, two where they cross: ``half`` to either side of ``middle``."""
    touching, crossing = np.flatnonzero(np.abs(gap) <= tolerance), np.flatnonzero(gap < -tolerance)
    step = half[crossing, None] * along[crossing]
    rows = np.concatenate([touching, crossing, crossing])
    points = np.concatenate([middle[touching], middle[crossing] - step, middle[crossing] + step])
    sharpness = np.concatenate([np.zeros(len(touching)), sharpness[crossing], sharpness[crossing]])
    return Crossings(i[rows], j[rows], points, sharpness)
