"""Which pieces of an arrangement separate: what lies on their two sides."""

from collections.abc import Callable

import numpy as np

from wsrender.errors import NumericalError
from wsrender.geometry.planar.arrangement import Arrangement
from wsrender.geometry.planar.distances import point_distances

Classes = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Class (K,) of points (K, 2) that keep a distance (K,) [m] from every curve of the arrangement."""

_PLACES = np.array([0.5, 0.35, 0.65, 0.2, 0.8, 0.08, 0.92])  # along a piece, where its sides may be looked at
_NARROWEST = 2e-15  # space beside a piece that can be told from none, relative to the size of the set


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
    for place in _PLACES:
        t = pieces.low + place * pieces.span
        distance = np.where(own, np.inf, point_distances(pieces.at(t), arrangement.curves))
        space = np.minimum(distance.min(axis=1, initial=np.inf), widest)
        better = space > best
        best_t, best = np.where(better, t, best_t), np.where(better, space, best)
    return best_t, best
