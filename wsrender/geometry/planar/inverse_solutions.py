"""How many postures of a two-joint arm, or separate self-motions of a three-joint arm, reach a point.

They are regions of one number, bounded by lines and arcs. A self-motion is a curve of postures that all reach a point:
the first joint leads the point along its orbit under the inverse motion. At each place there the other two joints have
up to two postures, the `ways`, which go on from place to place. They end where the orbit crosses a candidate of those
two joints' sweep: one of them at a joint limit, both in a singular position, where they meet. Pieces of orbit between
the crossings are nodes of a graph, one for each way that holds, and its components are counted (Burdick 1989 counts
those of arms without limits).
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from wsrender.errors import NumericalError
from wsrender.geometry.components import components
from wsrender.geometry.planar.arrangement import ON_CURVE, Classes, arrange, side_classes, told_apart
from wsrender.geometry.planar.curves import TURN, Curves
from wsrender.geometry.planar.distances import approaches, meetings, point_distances
from wsrender.geometry.planar.planar_chain import PlanarJoint, Source, candidates
from wsrender.geometry.planar.planar_set import PlanarSet, closes, loops_of

_AT_ONCE = 1 << 16  # pieces of orbits that are looked at together
_SHORTEST = 1e-12  # piece of an orbit that counts as none, relative to its length
_NEAREST = 1e-14  # distance from a candidate, relative to the size, at which ways cannot be told


@dataclass(frozen=True)
class NumberRegions:
    """Where a number of points (K, 2) is ``number``: area, and how many separate regions."""

    number: int
    area_m2: float
    regions: int


def regions_by_number(curves: Curves, numbers: Classes, size: float) -> list[NumberRegions]:
    """Regions by a number of points that changes on curves only; the least number above 0 first.

    ``numbers`` as for `side_classes`. Raises NumericalError where curves are too close to be told apart.
    """
    return told_apart(partial(_regions, curves, numbers), size)


def _regions(curves: Curves, numbers: Classes, size: float) -> list[NumberRegions]:
    found = arrange(curves, size)
    counts = side_classes(found, numbers, size)
    out = []
    for number in sorted(set(counts.ravel().tolist()) - {0}):
        rows = np.flatnonzero((counts[:, 0] == number) != (counts[:, 1] == number))
        sign, ends = np.where(counts[rows, 0] == number, 1.0, -1.0), found.ends[rows]
        if not closes(ends, sign, len(found.vertices)):
            raise NumericalError(f"the regions of {number} do not close: curves nearly coincide")
        loops = loops_of(PlanarSet(2, found.pieces[rows], sign, found.vertices, ends))
        area = sum(loop.signed_area for loop in loops)
        out.append(NumberRegions(number, float(area), sum(not loop.hole for loop in loops)))
    return out


def solution_regions(reached: PlanarSet, size: float) -> list[NumberRegions]:
    """Regions by number of inverse solutions, whole turns left aside, of a set that two joints sweep.

    The number changes only where a candidate of the sweep lies: at a limit of the first joint, along the path of an
    end of the second joint's curve, and along singular positions, the paths of its stationary points.
    """
    assert reached.candidates is not None
    curves = reached.candidates.curves
    return regions_by_number(curves, lambda points, margin: ways(reached, points, margin).sum(axis=1), size)


def inverse_solutions(reached: PlanarSet, points: np.ndarray) -> np.ndarray:
    """Number of inverse solutions at points (K, 2), (K,); on a curve where it changes, that of either side."""
    return ways(reached, points, candidate_distances(reached, points)).sum(axis=1)


def candidate_distances(reached: PlanarSet, points: np.ndarray) -> np.ndarray:
    """Distance of points (K, 2) to the candidates of a set, (K,) [m]."""
    assert reached.candidates is not None
    return point_distances(points, reached.candidates.curves).min(axis=1)


def ways(reached: PlanarSet, points: np.ndarray, margin: np.ndarray) -> np.ndarray:
    """Whether the orbits of points (K, 2) cross the curve of the second joint, each of two ways, (K, 2).

    The ways are the two postures of an elbow: each goes on where a point moves, and they meet in singular positions.
    The points keep ``margin`` (K,) [m] from the candidates, so the orbits from the ends of the curve and from touching
    it, and their own ends from the curve.
    """
    joint, inner = reached.joint, reached.inner
    assert joint is not None and inner is not None
    orbits = joint.orbits(points)
    met = np.stack([distance[:, 0] < margin / 4 for distance in approaches(orbits, inner.curves)], axis=1)
    if not orbits.arc[0] and not inner.curves.arc[0]:
        met[:, 1] = False  # two lines cross once
    return met


def self_motion_regions(reached: PlanarSet, size: float) -> list[NumberRegions]:
    """Regions by number of self-motions of a set that three joints sweep, the last two of them over an area.

    The number changes only where the pieces of orbits change: where an orbit ends on a candidate of the last two
    joints' sweep, touches one, or passes a point that two have in common; and where it passes the second joint's
    centre, if the third can bring the tip there: then the second is idle.
    """
    joint, inner = reached.joint, reached.inner
    assert joint is not None and inner is not None and inner.candidates is not None
    curves, vertices = inner.candidates.curves, arrange(inner.candidates.curves, size).vertices
    points = np.concatenate([vertices, _idle_points(inner, ON_CURVE * size)])
    found = candidates(joint, curves, points, np.full(len(points), -1), ON_CURVE * size)
    return regions_by_number(found.curves, lambda points, margin: self_motions(reached, points, size), size)


def _idle_points(inner: PlanarSet, tolerance: float) -> np.ndarray:
    """The second joint's centre, (1, 2), where the third brings the tip there; else none."""
    assert inner.joint is not None and inner.inner is not None
    center = inner.joint.center[None]
    idle = inner.joint.revolute and point_distances(center, inner.inner.curves).min() <= tolerance
    return center if idle else np.empty((0, 2))


def self_motions(reached: PlanarSet, points: np.ndarray, size: float) -> np.ndarray:
    """Number of self-motions at points (K, 2), (K,); on a curve where it changes, that of either side."""
    joint, inner = reached.joint, reached.inner
    assert joint is not None and inner is not None and inner.candidates is not None
    step = max(1, _AT_ONCE // (2 * len(inner.candidates.curves) + 1))
    parts = [points[first : first + step] for first in range(0, len(points), step)]
    return np.concatenate([_counted(joint, inner, part, size) for part in parts] or [np.empty(0, np.int64)])


def _counted(joint: PlanarJoint, inner: PlanarSet, points: np.ndarray, size: float) -> np.ndarray:
    cuts = _cuts(joint.orbits(points), inner)
    count, most = cuts.places.shape[:2]
    places = cuts.places.reshape(-1, 2)
    margin = candidate_distances(inner, places)
    known = cuts.known & (margin > _NEAREST * size).reshape(count, most)
    held = ways(inner, places, margin).reshape(count, most, 2)
    order = np.argsort(~known, axis=1, kind="stable")  # pieces of which nothing can be told are left out
    held = np.take_along_axis(held & known[:, :, None], order[:, :, None], axis=1)
    before = np.take_along_axis(cuts.singular_before, order, axis=1)
    return _motions(held, before, known.sum(axis=1), cuts.singular if joint.full else None)


@dataclass(frozen=True, eq=False)
class _Cuts:
    """K orbits cut into M pieces each where they meet candidates; some pieces have no length.

    ``places`` (K, M, 2) [m] are their middles, ``known`` (K, M) says which have a length; ``singular_before`` (K, M)
    counts the singular positions met before each piece, ``singular`` (K,) all of them.
    """

    places: np.ndarray
    known: np.ndarray
    singular_before: np.ndarray
    singular: np.ndarray


def _cuts(orbits: Curves, inner: PlanarSet) -> _Cuts:
    found, span = inner.candidates, orbits.span[:, None]
    assert found is not None
    t = np.concatenate(meetings(orbits, found.curves), axis=1) - orbits.low[:, None]
    t = np.mod(t, TURN) if orbits.arc[0] else t
    met = (t >= 0) & (t <= span)
    t = np.where(met, t, span)
    order = np.argsort(t, axis=1)
    singular = np.cumsum(np.take_along_axis(met & np.tile(_singular(inner), 2), order, axis=1), axis=1)
    nothing = np.zeros_like(span)
    t = np.concatenate([nothing, np.take_along_axis(t, order, axis=1), span], axis=1)
    count, most = len(t), t.shape[1] - 1
    middle = orbits.low[:, None] + (t[:, 1:] + t[:, :-1]) / 2
    places = orbits[np.repeat(np.arange(count), most)].at(middle.ravel()).reshape(count, most, 2)
    before = np.concatenate([nothing.astype(np.int64), singular], axis=1)
    return _Cuts(places, np.diff(t, axis=1) > _SHORTEST * span, before, before[:, -1])


def _singular(inner: PlanarSet) -> np.ndarray:
    """Which candidates of a two-joint sweep are singular positions: paths of points within the second joint's curve."""
    found, curve = inner.candidates, inner.inner
    assert found is not None and curve is not None
    of_end = (found.point[:, None] == curve.vertices).all(axis=2).any(axis=1)
    return (found.source == Source.PATH) & ~of_end


def _motions(held: np.ndarray, before: np.ndarray, pieces: np.ndarray, singular: np.ndarray | None) -> np.ndarray:
    """Number of components (K,) of the ways that hold on pieces, (K, M, 2), of which the first ``pieces`` (K,) count.

    ``before`` (K, M) counts the singular positions before each piece; ``singular`` (K,) all of an orbit that closes.
    """
    count, most, _ = held.shape
    number = np.arange(most)
    last = number == (pieces - 1)[:, None]
    after = np.where(last, 0, number + 1) % most
    pair = number < (pieces - 1)[:, None]
    turned = np.take_along_axis(before, after, axis=1) - before
    if singular is not None:
        pair |= last
        turned += np.where(last, singular[:, None], 0)
    following = np.take_along_axis(held, after[:, :, None], axis=1)
    node = np.arange(held.size).reshape(held.shape)
    next_node = np.take_along_axis(node, after[:, :, None], axis=1)
    goes_on = held & following & pair[:, :, None]
    folds = pair & (turned > 0)
    ends = folds & held.all(axis=2) & ~following.any(axis=2)
    begins = folds & following.all(axis=2) & ~held.any(axis=2)
    links = [(node[goes_on], next_node[goes_on]), tuple(node[ends].T), tuple(next_node[begins].T)]
    a, b = (np.concatenate([link[k] for link in links]) for k in (0, 1))
    labels = components(held.size, a, b)
    _, first = np.unique(labels[held.ravel()], return_index=True)
    return np.bincount(node[held][first] // (2 * most), minlength=count)
