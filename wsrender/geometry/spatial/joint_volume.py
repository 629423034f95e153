"""The volume that a three-joint arm reaches, as an integral over its second and third joint.

A displacement of these two reaches an orbit of the first joint. Each of the N displacements that reach the same orbit
covers an interval of it; where they overlap the volume counts once. So V = ∫∫ |det J| U / N dd₂ dd₃, where U is the
length of the intervals' union [rad or m].
"""

from collections.abc import Callable

import numpy as np

from wsrender.geometry.spatial.inverse import ThreeJointInverse
from wsrender.geometry.spatial.piecewise_integral import piecewise_integral
from wsrender.geometry.spatial.spatial_arm import TURN

TOLERANCE = 1e-8
MOST_LINES = 1000


def joint_volume(
    inverse: ThreeJointInverse, report: Callable[[int], None], most_lines: int = MOST_LINES
) -> tuple[float, float]:
    """Volume [m³] and how much the last refinement changed it; ``report(points)``."""
    arm = inverse.arm
    length = min(arm.high[0] - arm.low[0], TURN) if arm.revolute[0] else arm.high[0] - arm.low[0]

    def integrand(d3: np.ndarray, d2: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        d = np.column_stack([np.full(len(d2), (arm.low[0] + arm.high[0]) / 2), d2, d3])
        points, J, _ = arm.motion(d)
        det = np.linalg.det(J)
        first = inverse.solutions(points, first_limited=False)[:, :, 0]
        report(len(points))
        covered, overlaps = _union(first, length, bool(arm.revolute[0]))
        count = np.maximum(np.isfinite(first).sum(axis=1), 1)
        return np.abs(det) * covered / count, (count * 16 + overlaps) * 2 + (det > 0)

    outer, inner = _range(inverse, 2), _range(inverse, 1)
    return piecewise_integral(integrand, outer, inner, TOLERANCE, most_lines)


def _range(inverse: ThreeJointInverse, joint: int) -> tuple[float, float]:
    low, high = float(inverse.arm.low[joint]), float(inverse.arm.high[joint])
    return (low, low + TURN) if inverse.arm.full[joint] else (low, high)


def _union(first: np.ndarray, length: float, turning: bool) -> tuple[np.ndarray, np.ndarray]:
    """Length (N,) of the union of intervals of one ``length`` that start at −first (N, 8), and how many overlap."""
    count = np.isfinite(first).sum(axis=1)
    starts = np.where(np.isfinite(first), (-first) % TURN if turning else -first, np.inf)
    starts.sort(axis=1)
    last = np.maximum(count - 1, 0)
    following = np.column_stack([starts[:, 1:], np.full(len(starts), np.inf)])
    if turning:
        following[np.arange(len(starts)), last] = starts[:, 0] + TURN
    with np.errstate(invalid="ignore"):
        gaps = following - starts
    gaps = np.where(np.isfinite(starts), gaps, 0.0)
    covered = np.minimum(gaps, length).sum(axis=1)
    return np.where(count > 0, covered, length), ((gaps < length) & np.isfinite(starts)).sum(axis=1)
