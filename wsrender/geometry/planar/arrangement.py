"""Curves split where they meet: pieces of one and the same surrounding from end to end, and what is on their sides."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from scipy.spatial import KDTree

from wsrender.errors import NumericalError
from wsrender.geometry.components import components
from wsrender.geometry.planar.curves import TURN, Curves, crossings
from wsrender.geometry.planar.distances import point_distances
from wsrender.short_repr import short_repr

# Relative to the size of the set. Each is far above the rounding that a dozen joints collect (1e-15 each), and far
# below the accuracy that is promised (1e-9).
TOUCHING = 2e-14  # gap below which curves touch
ON_CURVE = 2e-14  # distance below which a point lies on a curve, and curves are the same
ONE_PIECE = 1e-13  # distance below which pieces between the same two vertices are one
SAME_POINT = 1e-10  # distance below which points are one: a shallow crossing is known that well only

COARSER = (1.0, 10.0, 100.0)  # tolerances tried in turn, where curves nearly coincide

T = TypeVar("T")

_PLACES = (0.25, 0.5, 0.75)  # along a piece, where it is compared with another
Classes = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Class (K,) of points (K, 2) that keep a distance (K,) [m] from every curve of the arrangement."""

_SIDE_PLACES = np.array([0.5, 0.35, 0.65, 0.2, 0.8, 0.08, 0.92])  # along a piece, where its sides may be looked at
_NARROWEST = 2e-15  # space beside a piece that can be told from none, relative to the size of the set


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Curves on their whole lines and circles, the carriers, split at every point where they meet.

    Piece k is ``pieces[k]``, a part of carrier ``carrier[k]``; it runs from vertex ``ends[k, 0]`` to ``ends[k, 1]``
    (−1: a circle without vertex) and is covered by the curves ``covering[k]``.
    """

    carrier: np.ndarray  # (P,)
    pieces: Curves  # (P,)
    ends: np.ndarray  # (P, 2)
    covering: list[np.ndarray]
    vertices: np.ndarray  # (V, 2) [m]
    curves: Curves  # (N,) as given
    carrier_of: np.ndarray  # (N,)

    __repr__ = short_repr

    def only(self, rows: np.ndarray) -> "Arrangement":
        """The arrangement with some of its pieces."""
        kept = {"carrier": self.carrier[rows], "pieces": self.pieces[rows], "ends": self.ends[rows]}
        return replace(self, covering=[self.covering[k] for k in rows], **kept)


def told_apart(made: Callable[[float], T], size: float) -> T:
    """``made(size)``; where it raises NumericalError, with a larger size, that is with coarser tolerances.

    Vertices may then be off by 1e-9 or 1e-8 of the size. Raises NumericalError where that does not help either.
    """
    for factor in COARSER[:-1]:
        try:
            return made(factor * size)
        except NumericalError:
            continue
    return made(COARSER[-1] * size)


def arrange(curves: Curves, size: float) -> Arrangement:
    """Split curves at all their crossings, touching points and ends; coincident parts become one piece.

    ``size`` [m] of the set is what tolerances are relative to. Raises NumericalError where all curves are shorter.
    """
    carrier_of, rows = _carriers(curves, ON_CURVE * size)
    carriers = curves[rows]
    vertices, on_carrier, vertex = _vertices(curves, carriers, carrier_of, size)
    carrier, low, high, ends = [], [], [], []
    for c in range(len(carriers)):
        t, own = _split(carriers[np.array([c])], vertices, np.unique(vertex[on_carrier == c]))
        carrier.append(np.full(len(t) - 1, c))
        low.append(t[:-1])
        high.append(t[1:])
        ends.append(np.stack([own[:-1], own[1:]], axis=1))
    carrier, low, high = (np.concatenate(part) for part in (carrier, low, high))
    pieces = carriers[carrier].between(low, high)
    covering = _covering(curves, carrier_of, carrier, pieces)
    found = Arrangement(carrier, pieces, np.concatenate(ends), covering, vertices, curves, carrier_of)
    found = found.only(np.flatnonzero([len(members) > 0 for members in covering]))
    if len(found.pieces) == 0:
        raise NumericalError(f"no curve is longer than {SAME_POINT * size:.1e} m")
    return _without_twins(found, ONE_PIECE * size)


def _carriers(curves: Curves, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """The carrier of each curve, (N,), and for each carrier a curve that lies on it."""
    offset = curves.base[:, None] - curves.base
    apart = np.hypot(offset[..., 0], offset[..., 1])
    circles = (apart <= tolerance) & (np.abs(curves.radius[:, None] - curves.radius) <= tolerance)
    both_arcs, both_lines = (np.logical_and.outer(kind, kind) for kind in (curves.arc, ~curves.arc))
    same = both_arcs & circles
    if both_lines.any():
        # The ends of one line lie on the other: a test that needs no unit for an angle.
        whole = curves.between(np.full(len(curves), -np.inf), np.full(len(curves), np.inf))
        lines = np.flatnonzero(~curves.arc)
        ends = [point_distances(end[lines], whole[lines]) <= tolerance for end in (curves.start, curves.end)]
        same[np.ix_(lines, lines)] = ends[0] & ends[1]
    first = same.argmax(axis=0)
    rows, carrier_of = np.unique(first, return_inverse=True)
    return carrier_of, rows


def _vertices(
    curves: Curves, carriers: Curves, carrier_of: np.ndarray, size: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions of the vertices, (V, 2), and which lies on which carrier, as pairs (carrier, vertex)."""
    near, tolerance = ON_CURVE * size, SAME_POINT * size
    open_curves = np.flatnonzero(~curves.full)
    end_points = np.concatenate([curves[open_curves].start, curves[open_curves].end])
    distance = point_distances(end_points, curves)
    distance[np.arange(len(end_points)), np.tile(open_curves, 2)] = 0.0
    point, touched = np.nonzero(distance <= near)

    found = crossings(carriers, TOUCHING * size)
    on_both = np.ones(len(found.points), bool)
    for row in (found.first, found.second):
        on_both &= _covered(curves, carrier_of, carriers, row, found.points, tolerance)
    points = np.concatenate([end_points, found.points[on_both]])
    # Ends are known best; where several crossings fall together, the sharpest is.
    quality = np.concatenate([np.full(len(end_points), 2.0), found.sharpness[on_both]])
    crossing = len(end_points) + np.arange(np.count_nonzero(on_both))
    point = np.concatenate([point, crossing, crossing])
    on_carrier = np.concatenate([carrier_of[touched], found.first[on_both], found.second[on_both]])

    cluster = _clusters(points, tolerance)
    order = np.lexsort([-quality, cluster])
    best = order[np.unique(cluster[order], return_index=True)[1]]
    return points[best], on_carrier, cluster[point]


def _covered(
    curves: Curves, carrier_of: np.ndarray, carriers: Curves, row: np.ndarray, points: np.ndarray, tolerance: float
) -> np.ndarray:
    """Whether points on carriers, by their rows, lie on a curve of that carrier, (K,)."""
    t = carriers[row].parameter(points)
    slack = tolerance / np.where(carriers.arc, carriers.radius, 1.0)
    covered = np.zeros(len(points), bool)
    order = np.argsort(carrier_of, kind="stable")
    starts = np.searchsorted(carrier_of[order], np.arange(len(carriers) + 1))
    counts = np.diff(starts)
    for k in range(counts.max(initial=0)):
        rows = np.flatnonzero((counts[row] > k) & ~covered)
        members = order[starts[row[rows]] + k]
        own = curves[members]
        at = np.where(own.arc, t[rows], own.parameter(points[rows]))  # lines may run either way
        covered[rows] = own.holds(at, slack[row[rows]])
    return covered


def _clusters(points: np.ndarray, tolerance: float) -> np.ndarray:
    """Number of the vertex of each point: one for all within the tolerance of each other."""
    if len(points) == 0:
        return np.empty(0, np.int64)
    return components(len(points), *KDTree(points).query_pairs(tolerance, output_type="ndarray").T)


def _split(carrier: Curves, vertices: np.ndarray, own: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parameters at which a carrier is split and the vertices there; of a circle the first comes again at the end."""
    if len(own) == 0:
        return np.array([0.0, TURN]), np.array([-1, -1])
    t = carrier[np.zeros(len(own), np.int64)].parameter(vertices[own])
    order = np.argsort(t)
    t, own = t[order], own[order]
    return (np.append(t, t[0] + TURN), np.append(own, own[0])) if carrier.arc[0] else (t, own)


def _covering(curves: Curves, carrier_of: np.ndarray, carrier: np.ndarray, pieces: Curves) -> list[np.ndarray]:
    """The curves that cover each piece: those that hold its middle."""
    middle = (pieces.low + pieces.high) / 2
    points = pieces.at(middle)
    out = []
    for k, c in enumerate(carrier):
        members = np.flatnonzero(carrier_of == c)
        own = curves[members]
        at = own.parameter(np.broadcast_to(points[k], (len(members), 2)))
        out.append(members[own.holds(at)])
    return out


def _without_twins(found: Arrangement, tolerance: float) -> Arrangement:
    """The arrangement with one of each set of pieces that only rounding keeps apart.

    Where limits are written with a few digits, curves that should touch cross twice instead, a millionth of their
    length apart, with nothing between them that numbers could tell.
    """
    pairs = np.sort(found.ends, axis=1)
    order = np.lexsort(pairs.T)
    starts = np.flatnonzero(np.append(True, (np.diff(pairs[order], axis=0) != 0).any(axis=1)))
    dropped = set()
    for group in np.split(order, starts[1:]):
        if len(group) == 1 or pairs[group[0], 0] < 0:
            continue
        pieces = found.pieces[group]
        apart = np.zeros((len(group), len(group)))
        for place in _PLACES:
            points = pieces.at(pieces.low + place * pieces.span)
            apart = np.maximum(apart, point_distances(points, pieces))
        for k, row in enumerate(group):
            if row in dropped:
                continue
            twins = [other for other in group[k + 1 :][apart[k, k + 1 :] <= tolerance] if other not in dropped]
            found.covering[row] = np.concatenate([found.covering[row], *(found.covering[other] for other in twins)])
            dropped.update(twins)
    return found.only(np.array([k for k in range(len(found.pieces)) if k not in dropped], np.int64))


def side_classes(arrangement: Arrangement, classes: Classes, size: float) -> np.ndarray:
    """Classes on the left and right of every piece, (P, 2).

    Both sides are looked at beside the place with most space around it, at half that space: nothing but the piece
    lies between the two points. Raises NumericalError where there is no space.
    """
    t, space = _places(arrangement, size)
    pieces = arrangement.pieces
    if len(space) and space.min() < _NARROWEST * size:
        raise NumericalError(f"boundary curves come as close as {space.min():.1e} m without meeting")
    middle, step = pieces.at(t), (space / 2)[:, None] * pieces.normal(t)
    found = classes(np.concatenate([middle + step, middle - step]), np.tile(space / 2, 2))
    return found.reshape(2, -1).T


def _places(arrangement: Arrangement, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Parameter on each piece, and the distance of its point to every other carrier's curves, (P,) each."""
    pieces = arrangement.pieces
    best_t, best = np.zeros(len(pieces)), np.full(len(pieces), -1.0)
    widest = np.minimum(np.where(pieces.arc, pieces.radius / 2, np.inf), 0.05 * size)
    own = arrangement.carrier[:, None] == arrangement.carrier_of
    for k, members in enumerate(arrangement.covering):
        own[k, members] = True
    for place in _SIDE_PLACES:
        t = pieces.low + place * pieces.span
        distance = np.where(own, np.inf, point_distances(pieces.at(t), arrangement.curves))
        space = np.minimum(distance.min(axis=1, initial=np.inf), widest)
        better = space > best
        best_t, best = np.where(better, t, best_t), np.where(better, space, best)
    return best_t, best
