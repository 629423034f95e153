"""Which critical set the boundary belongs to at each crossed edge of a lattice, and where exactly it is."""

from dataclasses import dataclass

import numpy as np

from wsrender.geometry.spatial.cells import LatticeCrossings
from wsrender.geometry.spatial.critical_sets import CriticalSet
from wsrender.geometry.spatial.inverse import ThreeJointInverse

_AT_STOP = 1e-4  # of a radian or of the arm's size: how near a limit a solution is, 1e-8 of a cell from the boundary
_BESIDE = 1e-6  # of a cell: how far the bisected and the computed crossing may be apart
_WITHIN = 1e-6  # of a radian or of the arm's size: limits of joints where edges of the boundary are near

NONE = -1


@dataclass(frozen=True, eq=False)
class CrossedSurfaces:
    """Of every crossing: ``critical_set`` (C,) by index or NONE, ``point`` and outward ``normal`` (C, 3), ``d`` (C, n).

    Where no critical set was met the point is that of the bisection, and the normal along the edge.
    """

    critical_set: np.ndarray
    point: np.ndarray
    normal: np.ndarray
    d: np.ndarray


def crossed_surfaces(
    sets: list[CriticalSet], inverse: ThreeJointInverse, crossings: LatticeCrossings, width: float
) -> CrossedSurfaces:
    """Find them, from all configurations that reach the last points inside."""
    arm = inverse.arm
    solutions = inverse.solutions(crossings.inside)
    unit = np.where(arm.revolute, 1.0, max(arm.size, 1e-300))
    count = len(crossings)
    found = CrossedSurfaces(
        np.full(count, NONE),
        (crossings.inside + crossings.outside) / 2,
        crossings.outward,
        np.full((count, arm.n), np.nan),
    )
    for index, each in enumerate(sets):
        start, near = _starts(each, solutions, unit)
        rows = np.flatnonzero(near & (found.critical_set == NONE))
        meeting = each.meet(crossings.inside[rows], crossings.outward[rows], start[rows])
        good = np.abs(meeting.s) <= _BESIDE * width
        with np.errstate(invalid="ignore"):
            d = arm.nearest_turn(meeting.d)
            good &= (((d >= arm.low - _WITHIN * unit) & (d <= arm.high + _WITHIN * unit)) | arm.full).all(axis=1)
        kept = rows[good]
        found.critical_set[kept], found.normal[kept], found.d[kept] = index, meeting.normal[good], d[good]
        found.point[kept] = crossings.inside[kept] + meeting.s[good, None] * crossings.outward[kept]
    return found


def _starts(each: CriticalSet, solutions: np.ndarray, unit: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of each point the solution (C, n) that is nearest to a critical set, and whether it is near enough (C,)."""
    if each.stops:
        stop = each.stops[0]
        distance = np.abs(solutions[:, :, stop.joint] - stop.at) / unit[stop.joint]
    else:
        sigma = np.linalg.svd(each.arm.motion(np.nan_to_num(solutions).reshape(-1, each.arm.n))[1], compute_uv=False)
        distance = (sigma[:, 2] / np.maximum(sigma[:, 0], 1e-300)).reshape(solutions.shape[:2])
        distance[np.isnan(solutions[:, :, 0])] = np.nan
    distance = np.where(np.isnan(distance), np.inf, distance)
    nearest = distance.argmin(axis=1)
    rows = np.arange(len(solutions))
    least = distance[rows, nearest]
    return solutions[rows, nearest], least <= (_AT_STOP if each.stops else np.finfo(float).max)
