"""The exact sweep: from the tip to the base, each joint moves the set that the joints after it reach.

Alciatore & Ng 1994, section 4, completed: W_{n+1} = {tip}, W_i = ∪_q E_i(q) W_{i+1}. The boundary of W_i lies on the
candidates (`candidates`). They are split where they meet, and a piece is kept iff one of its sides is outside; a point
p is inside iff its orbit E_i(q)⁻¹ p meets W_{i+1}.
"""

from collections.abc import Sequence
from functools import partial

import numpy as np

from wsrender.errors import NumericalError
from wsrender.geometry.planar.arrangement import ON_CURVE, Arrangement, arrange, side_classes, told_apart
from wsrender.geometry.planar.planar_chain import Candidates, PlanarJoint, Source, candidates
from wsrender.geometry.planar.planar_set import PlanarSet, Span, closes


def swept_sets(joints: Sequence[PlanarJoint], tip: np.ndarray, size: float) -> list[PlanarSet]:
    """W_1 … W_{n+1} of a chain of n joints that moves ``tip`` (2,) [m]; ``size`` [m] bounds its reach.

    Raises NumericalError where curves are too close to be told apart.
    """
    sets = [PlanarSet.of_point(tip)]
    for joint in reversed(joints):
        sets.append(told_apart(partial(swept, sets[-1], joint), size))
    return sets[::-1]


def swept(inner: PlanarSet, joint: PlanarJoint, size: float) -> PlanarSet:
    """The set of all points to which a joint moves a set."""
    if inner.dimension == 0:
        return _path(inner, joint, size)
    found = candidates(joint, inner.curves, inner.vertices, inner.piece_of_vertex, ON_CURVE * size)
    arrangement = arrange(found.curves, size)
    if inner.dimension == 1 and joint.along_itself(inner.curves, ON_CURVE * size).all():
        return assembled(1, arrangement, np.ones(len(arrangement.pieces)), found, joint, inner)
    inside = side_classes(arrangement, lambda points, margin: inner.met_by(joint, points, margin), size)
    return _region(arrangement, inside, found, joint, inner)


def _path(inner: PlanarSet, joint: PlanarJoint, size: float) -> PlanarSet:
    """The path of a point: a curve, or the point itself where it is the centre."""
    point = inner.vertices
    paths = joint.paths(point)
    if paths.length[0] <= ON_CURVE * size:
        return PlanarSet.of_point(point[0], joint=joint, inner=inner)
    found = Candidates(paths, np.array([Source.PATH]), np.array([-1]), point)
    return assembled(1, arrange(paths, size), np.ones(1), found, joint, inner)


def _region(
    arrangement: Arrangement, inside: np.ndarray, found: Candidates, joint: PlanarJoint, inner: PlanarSet
) -> PlanarSet:
    """The region whose boundary are the pieces with one side outside."""
    kept = np.flatnonzero(inside[:, 0] != inside[:, 1])
    sign = np.where(inside[kept, 0], 1.0, -1.0)
    if len(kept) == 0 or not closes(arrangement.ends[kept], sign, len(arrangement.vertices)):
        raise NumericalError(f"the boundary does not close at joint {joint.name}: curves nearly coincide")
    return assembled(2, arrangement.only(kept), sign, found, joint, inner)


def assembled(
    dimension: int, parts: Arrangement, sign: np.ndarray, found: Candidates, joint: PlanarJoint, inner: PlanarSet
) -> PlanarSet:
    """The set with these pieces, whose inside lies on the left (``sign`` 1) or right (−1)."""
    chains = smooth_chains(parts, sign)
    first = np.array([chain[0] for chain in chains])
    spans = [_spans(parts, chain) for chain in chains]
    ends = np.array([(parts.ends[chain[0], 0], parts.ends[chain[-1], 1]) for chain in chains])
    meeting = np.bincount(ends[ends >= 0], minlength=len(parts.vertices) + 1)  # the last one: of no vertex
    # A circle that ends at its own start, where nothing else does, has no vertex.
    whole = (ends[:, 0] == ends[:, 1]) & (meeting[ends[:, 0]] == 2)
    ends[whole] = -1
    used, numbers = np.unique(ends[ends >= 0], return_inverse=True)
    ends[ends >= 0] = numbers
    low, high = (np.array([getattr(own[k], name) for own in spans]) for k, name in ((0, "low"), (-1, "high")))
    curves = parts.pieces[first].between(low, high)
    return PlanarSet(dimension, curves, sign[first], parts.vertices[used], ends, spans, found, joint, inner)


def smooth_chains(parts: Arrangement, sign: np.ndarray) -> list[list[int]]:
    """Rows of pieces that follow each other on one carrier, where nothing else meets them."""
    meeting = np.bincount(parts.ends[parts.ends >= 0], minlength=len(parts.vertices))
    starting = {(c, v, s): k for k, (c, v, s) in enumerate(zip(parts.carrier, parts.ends[:, 0], sign, strict=True))}
    following = {}
    for k, (c, v, s) in enumerate(zip(parts.carrier, parts.ends[:, 1], sign, strict=True)):
        if v >= 0 and meeting[v] == 2 and (c, v, s) in starting:
            following[k] = starting[c, v, s]
    chains, left = [], dict.fromkeys(range(len(sign)))
    # From pieces that follow none; what is left then are circles, from any piece.
    for k in [*(k for k in left if k not in set(following.values())), *left]:
        if k not in left:
            continue
        chain = [k]
        del left[k]
        while (k := following.get(k, -1)) in left:
            chain.append(k)
            del left[k]
        chains.append(chain)
    return chains


def _spans(parts: Arrangement, chain: list[int]) -> list[Span]:
    """The pieces of a chain as parts of one parameter range; angles go on beyond a turn."""
    spans, low = [], float(parts.pieces.low[chain[0]])
    for k in chain:
        high = low + float(parts.pieces.span[k])
        spans.append(Span(low, high, tuple(parts.covering[k].tolist())))
        low = high
    return spans
