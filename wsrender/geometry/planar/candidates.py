"""Where the boundary of a swept set can lie: at the joint's limits, and along paths of points of the set within."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from wsrender.geometry.planar.curves import Curves
from wsrender.geometry.planar.motion import PlanarJoint


class Source(IntEnum):
    """Where a candidate comes from: the inner boundary at a limit of the joint, or the path of one of its points."""

    LOWER = 0
    UPPER = 1
    PATH = 2


@dataclass(frozen=True, eq=False)
class Candidates:
    """N curves that may hold a boundary, each moved from piece ``parent`` of the set before, (N,), −1: from its point.

    ``point`` (N, 2) [m] is the point whose path a curve is, where it is one.
    """

    curves: Curves
    source: np.ndarray
    parent: np.ndarray
    point: np.ndarray


def candidates(
    joint: PlanarJoint, curves: Curves, points: np.ndarray, piece_of_point: np.ndarray, tolerance: float
) -> Candidates:
    """Candidates of a set with the boundary, or all points, ``curves`` and the vertices ``points`` on them.

    A whole turn has no limits. Points that the joint does not move have no path.
    """
    rows, stationary = joint.stationary(curves, tolerance)
    points = np.concatenate([points, stationary])
    piece = np.concatenate([piece_of_point, rows])
    paths = joint.paths(points)
    moving = paths.length > tolerance
    parts = [(paths[moving], Source.PATH, piece[moving], points[moving])]
    if not joint.full:
        nowhere = np.full((len(curves), 2), np.nan)
        for source, limit in ((Source.LOWER, joint.low), (Source.UPPER, joint.high)):
            parts.append((joint.move_curves(curves, limit), source, np.arange(len(curves)), nowhere))
    return Candidates(
        Curves.joined([part[0] for part in parts]),
        np.concatenate([np.full(len(part[0]), part[1]) for part in parts]),
        np.concatenate([part[2] for part in parts]),
        np.concatenate([part[3] for part in parts]),
    )
