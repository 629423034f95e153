"""The least distance between the links of a mechanism's legs, as line segments."""

import numpy as np

from wsrender.mechanisms.mechanism import Mechanism


def leg_pairs(mechanism: Mechanism) -> list[tuple[int, int]]:
    """Pairs of legs whose distance counts: those that share neither end, nor a rail."""
    legs = range(len(mechanism.kinds))
    return [(a, b) for a in legs for b in legs[a + 1 :] if not _share_joint(mechanism, a, b)]


def _share_joint(mechanism: Mechanism, a: int, b: int) -> bool:
    return any(np.array_equal(ends[a], ends[b]) for ends in (mechanism.base, mechanism.platform))


def least_distance(mechanism: Mechanism, elbows: np.ndarray, joints: np.ndarray) -> np.ndarray:
    """Least distance between the links elbows … joints (N, L, 3) of two legs [m], (N,); infinite where none counts.

    A link without a solution (NaN) has no distance.
    """
    least = np.full(len(elbows), np.inf)
    if mechanism.clearance_m == 0:
        return least
    for a, b in leg_pairs(mechanism):
        distance = segment_distance(elbows[:, a], joints[:, a], elbows[:, b], joints[:, b])
        least = np.fmin(least, distance)
    return least


def segment_distance(p: np.ndarray, p_end: np.ndarray, q: np.ndarray, q_end: np.ndarray) -> np.ndarray:
    """Distance of the segments p … p_end and q … q_end, each (N, 3), (N,) (Ericson 2005, 5.1.9).

    Where the segments are neither crossing nor parallel one parameter is at an end; all four ends are tried.
    """
    u, v, w = p_end - p, q_end - q, p - q
    a, b, c = (u * u).sum(axis=1), (u * v).sum(axis=1), (v * v).sum(axis=1)
    d, e = (u * w).sum(axis=1), (v * w).sum(axis=1)
    determinant = a * c - b * b
    s = np.clip(np.divide(b * e - c * d, determinant, out=np.zeros_like(a), where=determinant > 0), 0, 1)
    tries = []
    for start in (s, np.zeros_like(s), np.ones_like(s)):
        t = np.clip(_ratio(b * start + e, c), 0, 1)
        near = np.clip(_ratio(b * t - d, a), 0, 1)
        tries.append(np.linalg.norm(w + near[:, None] * u - t[:, None] * v, axis=1))
    return np.minimum.reduce(tries)


def _ratio(above: np.ndarray, below: np.ndarray) -> np.ndarray:
    return np.divide(above, below, out=np.zeros_like(above), where=below > 0)
