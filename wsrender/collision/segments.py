"""Distances of segments from segments and from boxes."""

import numpy as np

SHORT = 1e-10  # squared length of an axis that is a point [m²], or length of half of one [m]


def axes_distance(middle_a: np.ndarray, half_a: np.ndarray, middle_b: np.ndarray, half_b: np.ndarray) -> np.ndarray:
    """Distances (N,) of segments given by middles and half axes (N, 3); never below the least (Ericson 2004, 5.1.9)."""

    def dot(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.einsum("...i,...i->...", x, y)

    r, a, e = middle_a - middle_b, np.maximum(dot(half_a, half_a), SHORT), np.maximum(dot(half_b, half_b), SHORT)
    b, c, f = dot(half_a, half_b), dot(half_a, r), dot(half_b, r)
    s = np.clip((b * f - c * e) / (a * e * 1.000001 - b * b), -1, 1)
    t = np.clip((b * s + f) / e, -1, 1)
    s = np.clip((b * t - c) / a, -1, 1)
    apart = r + s[..., None] * half_a - t[..., None] * half_b
    return np.sqrt(dot(apart, apart))


def box_distance(middle: np.ndarray, half: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Distances (N,) of segments from a box of half sizes (3,) at the origin, 0 within; never below the least.

    ``middle``, ``half`` (N, 3): middles and half axes in the box's frame. The squared distance is convex along a
    segment, and quadratic between the places where it comes level with a face: its slope, linear between these, is
    known at all of them.
    """

    def beyond(t: np.ndarray) -> np.ndarray:
        at = middle + t[:, None] * half
        return at - np.clip(at, -size, size)

    def slope(t: np.ndarray) -> np.ndarray:
        return np.einsum("ni,ni->n", beyond(t), half)

    low, high = -np.ones(len(middle)), np.ones(len(middle))
    below, above = slope(low), slope(high)
    with np.errstate(divide="ignore", invalid="ignore"):
        level = (np.concatenate([size - middle, -size - middle], axis=1) / np.tile(half, 2)).T
    for place in level:
        t = np.clip(np.nan_to_num(place), -1, 1)
        now = slope(t)
        lower, upper = (now <= 0) & (t > low), (now >= 0) & (t < high)
        low, below = np.where(lower, t, low), np.where(lower, now, below)
        high, above = np.where(upper, t, high), np.where(upper, now, above)
    rising = np.maximum(above - below, np.finfo(float).tiny)
    t = low + (high - low) * np.clip(-below / rising, 0, 1)
    return np.linalg.norm(beyond(t), axis=1)
