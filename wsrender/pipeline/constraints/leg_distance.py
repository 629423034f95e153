"""The links of a mechanism's legs keep a distance, as line segments."""

from dataclasses import dataclass

import numpy as np

from wsrender.pipeline.constraints.constraint import Structure


@dataclass(frozen=True)
class LegDistance:
    """Admits what keeps the links of each of the ``pairs`` of legs ``least_m`` apart or more [m]."""

    least_m: float
    pairs: tuple[tuple[int, int], ...]
    name: str = "leg_distance"
    keeps: frozenset[Structure] = frozenset()
    device: str = "leg_distance"

    def pack(self, chain: object, origin: np.ndarray, precision: str) -> np.ndarray:
        """The square of the least distance (1,) [m²]."""
        return np.array([self.least_m**2])

    def distance(self, links: np.ndarray) -> np.ndarray:
        """Least distance of links (N, L, 2, 3), both ends of each [m], (N,); infinite where no pair has one.

        A link without a solution (NaN) has no distance.
        """
        least = np.full(len(links), np.inf)
        for a, b in self.pairs:
            least = np.fmin(least, segment_distance(links[:, a, 0], links[:, a, 1], links[:, b, 0], links[:, b, 1]))
        return least

    def host(self, q: np.ndarray, frames: np.ndarray) -> np.ndarray:
        """See `Constraint.host`."""
        return (self.distance(frames) < self.least_m).astype(np.int8)


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
