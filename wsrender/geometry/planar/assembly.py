"""Pieces of an arrangement put together again: those that go on smoothly become one."""

import numpy as np

from wsrender.geometry.planar.arrangement import Arrangement
from wsrender.geometry.planar.candidates import Candidates
from wsrender.geometry.planar.motion import PlanarJoint
from wsrender.geometry.planar.planar_set import PlanarSet, Span


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
