"""Boundary pieces run through one after the other: loops with the inside on the left."""

from dataclasses import dataclass

import numpy as np

from wsrender.errors import NumericalError
from wsrender.geometry.planar.curves import Curves
from wsrender.geometry.planar.planar_set import PlanarSet


@dataclass(frozen=True, eq=False)
class Loop:
    """Rows of pieces in the order they are run through, inside on the left: an outer loop turns counter-clockwise."""

    rows: np.ndarray
    signed_area: float  # [m²]; of a hole negative

    @property
    def hole(self) -> bool:
        """Whether the loop goes around a hole."""
        return self.signed_area < 0


def loops_of(region: PlanarSet) -> list[Loop]:
    """The loops of a region, the outer one first, then the holes by falling size.

    Where pieces meet at a point that is not passed twice in a row, the path turns to the right: a region stays one
    where it touches itself. Raises NumericalError where pieces do not follow each other.
    """
    areas = signed_areas(region.curves, region.sign)
    following = _following(region)
    if len(set(following)) < len(following):
        raise NumericalError("boundary pieces do not follow each other: curves nearly coincide")
    left, loops = dict.fromkeys(range(len(following))), []
    while left:
        rows = [next(iter(left))]
        while (row := following[rows[-1]]) != rows[0]:
            rows.append(row)
        left = {row: None for row in left if row not in rows}
        loops.append(Loop(np.array(rows), float(areas[rows].sum())))
    return sorted(loops, key=lambda loop: -loop.signed_area)


def closes(ends: np.ndarray, sign: np.ndarray, vertices: int) -> bool:
    """Whether pieces leave every vertex as often as they arrive; by their sign from the first end, or from the second.

    Ends are numbers of vertices, (P, 2), −1 of circles.
    """
    leaving, arriving = (np.where(sign > 0, ends[:, k], ends[:, 1 - k]) for k in (0, 1))
    degrees = [np.bincount(side[side >= 0], minlength=vertices) for side in (leaving, arriving)]
    return bool((degrees[0] == degrees[1]).all())


def _following(region: PlanarSet) -> list[int]:
    """The piece that comes after each, inside on the left."""
    forward = region.sign > 0
    leaving = np.where(forward, region.ends[:, 0], region.ends[:, 1])
    arriving = np.where(forward, region.ends[:, 1], region.ends[:, 0])
    out = []
    for row, vertex in enumerate(arriving):
        others = np.flatnonzero(leaving == vertex) if vertex >= 0 else np.array([row])
        out.append(int(others[0]) if len(others) == 1 else _rightmost(region, row, others))
    return out


def signed_areas(curves: Curves, sign: np.ndarray) -> np.ndarray:
    """Contribution of each curve to ½ ∮ x dy − y dx, (N,) [m²]."""
    a, b, center = curves.start, curves.end, curves.base
    lines = (a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]) / 2
    moment = center[:, 0] * (b - a)[:, 1] - center[:, 1] * (b - a)[:, 0]
    return sign * np.where(curves.arc, (curves.radius**2 * curves.span + moment) / 2, lines)


def _rightmost(region: PlanarSet, row: int, following: np.ndarray) -> int:
    """The piece that turns most to the right, seen a little way off the vertex where tangents may agree."""
    rows = np.array([row, *following])
    curves, forward = region.curves[rows], region.sign[rows] > 0
    # Backwards along the piece that arrives, forwards along those that leave.
    from_low = forward.copy()
    from_low[0] = not forward[0]
    step = curves.length.min() / 8
    t = step / np.where(curves.arc, curves.radius, 1.0)
    near = curves.at(np.where(from_low, curves.low + t, curves.high - t))
    ends = region.ends[row]
    offset = near - region.vertices[ends[1] if forward[0] else ends[0]]
    angle = np.arctan2(offset[:, 1], offset[:, 0])
    return int(following[np.mod(angle[1:] - angle[0], 2 * np.pi).argmin()])
