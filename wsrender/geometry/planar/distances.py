"""Distances of points and of orbits from lines and arcs; none of them depends on finding an intersection.

The least distance of two curves is taken at an end of one of them, or where their whole lines or circles come
closest. Each such point gives an upper bound that does not suffer where curves touch, so the least of them is exact
to rounding, tangent and coincident curves included.
"""

import numpy as np

from wsrender.geometry.planar.curves import TURN, Curves, turned_left

_TINY = 1e-300  # keeps parallel lines from dividing by zero
_AT_ONCE = 1 << 20  # distances that are held in memory at once


def point_distances(points: np.ndarray, curves: Curves) -> np.ndarray:
    """Distance of every point (…, 2) to each of N curves, (…, N) [m]."""
    return _distances(points[..., None, :] - curves.base, curves)


def _distances(offset: np.ndarray, curves: Curves) -> np.ndarray:
    """Distance of points, given by their offset (…, N, 2) from each curve's base, to that curve, (…, N)."""
    out = np.empty(offset.shape[:-1])
    lines, arcs = np.flatnonzero(~curves.arc), np.flatnonzero(curves.arc)
    if len(lines):
        out[..., lines] = _line_distances(offset[..., lines, :], curves[lines])
    if len(arcs):
        out[..., arcs] = _arc_distances(offset[..., arcs, :], curves[arcs])
    return out


def _line_distances(offset: np.ndarray, lines: Curves) -> np.ndarray:
    t = np.clip((offset * lines.direction).sum(axis=-1), lines.low, lines.high)
    away = offset - t[..., None] * lines.direction
    return np.hypot(away[..., 0], away[..., 1])


def _arc_distances(offset: np.ndarray, arcs: Curves) -> np.ndarray:
    x, y = offset[..., 0], offset[..., 1]
    ends = []
    for point in (arcs.start - arcs.base, arcs.end - arcs.base):
        ends.append(np.hypot(x - point[:, 0], y - point[:, 1]))
    within = np.mod(np.arctan2(y, x) - arcs.low, TURN) <= arcs.span
    return np.where(within, np.abs(np.hypot(x, y) - arcs.radius), np.minimum(*ends))


def orbit_distances(orbits: Curves, curves: Curves) -> np.ndarray:
    """Least distance of K orbits, all lines of one direction or all arcs about one centre, to N curves, (K,) [m]."""
    step = max(1, _AT_ONCE // max(len(curves), 1))
    parts = [np.arange(first, min(first + step, len(orbits))) for first in range(0, len(orbits), step)]
    return np.concatenate([_least(orbits[rows], curves) for rows in parts] or [np.empty(0)])


def _least(orbits: Curves, curves: Curves) -> np.ndarray:
    least = point_distances(np.concatenate([curves.start, curves.end]), orbits).min(axis=0)
    for ends in (orbits.start, orbits.end):
        least = np.minimum(least, point_distances(ends, curves).min(axis=1))
    for distances in approaches(orbits, curves):
        least = np.minimum(least, distances.min(axis=1))
    return least


def approaches(orbits: Curves, curves: Curves) -> list[np.ndarray]:
    """Distances (K, N) to N curves from the two points where each orbit's whole line or circle meets the curve's.

    Where an orbit does not reach such a point, from its start or end. Two lines meet once: both are the same.
    """
    return [_distances(_at(orbits, t) - curves.base, curves) for t in meetings(orbits, curves)]


def meetings(orbits: Curves, curves: Curves) -> tuple[np.ndarray, np.ndarray]:
    """Parameters (K, N) of the two points where orbits' whole lines or circles meet, or come nearest to, the curves'.

    The orbits are all lines of one direction or all arcs about one centre.
    """
    return (_arc_meetings if orbits.arc[0] else _line_meetings)(orbits, curves)


def _at(orbits: Curves, t: np.ndarray) -> np.ndarray:
    """Points of orbits (K,) at parameters (K, N), at their start where they do not reach as far, (K, N, 2)."""
    low, span = orbits.low[:, None], orbits.span[:, None]
    base = orbits.base[:, None]
    if orbits.arc[0]:
        t = np.where(np.mod(t - low, TURN) <= span, t, low)
        return base + orbits.radius[:, None, None] * np.stack([np.cos(t), np.sin(t)], axis=-1)
    return base + np.clip(t, low, low + span)[..., None] * orbits.direction[:, None]


def _arc_meetings(orbits: Curves, curves: Curves) -> tuple[np.ndarray, np.ndarray]:
    """Angles (K, N) at which whole circles about one centre cross, or come closest to, whole lines and circles."""
    radius, lines = orbits.radius[:, None], ~curves.arc
    normal = turned_left(curves.direction)
    offset = curves.base - orbits.base[0]
    height = (offset * normal).sum(axis=1)  # of the line over the centre
    distance = np.hypot(offset[:, 0], offset[:, 1])
    towards = np.where(lines[:, None], normal, offset)
    # tan²(half/2) = (1 − cos half)/(1 + cos half), whose factors lose no digits where the angle is small.
    apart = radius - distance
    versed = np.where(lines, radius - height, (curves.radius - apart) * (curves.radius + apart))
    rest = np.where(lines, radius + height, (radius + distance - curves.radius) * (radius + distance + curves.radius))
    half = 2 * np.arctan2(np.sqrt(np.maximum(versed, 0.0)), np.sqrt(np.maximum(rest, 0.0)))
    middle = np.arctan2(towards[:, 1], towards[:, 0])
    return middle - half, middle + half


def _line_meetings(orbits: Curves, curves: Curves) -> tuple[np.ndarray, np.ndarray]:
    """Parameters (K, N) at which whole lines cross, or come closest to, whole lines and circles."""
    u = orbits.direction[0]
    offset = curves.base - orbits.base[:, None]  # (K, N, 2)
    along, height = offset @ u, offset @ turned_left(u)
    slope = np.where(curves.arc, 1.0, curves.direction @ turned_left(u))
    slope = np.where(slope == 0, _TINY, slope)  # parallel: the ends tell
    with np.errstate(over="ignore", invalid="ignore"):
        crossing = along - np.nan_to_num(height / slope) * (curves.direction @ u)
    half = np.sqrt(np.maximum(curves.radius**2 - height**2, 0.0))
    return np.where(curves.arc, along - half, crossing), np.where(curves.arc, along + half, crossing)
