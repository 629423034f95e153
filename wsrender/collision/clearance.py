"""How far solids are from touching: the least signed distance over pairs, and a lower bound of it from capsules."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wsrender.collision.covers import Capsules, outer_covers
from wsrender.collision.distance import AT_A_TIME, Distances, frames_of
from wsrender.collision.grids import Lookup
from wsrender.collision.segments import axes_distance
from wsrender.collision.solids import Pairs
from wsrender.robots.chain import Chain

ROUNDING = 1e-6  # what MuJoCo's distances, and those of axes that are nearly parallel, may be off [m]


@dataclass(frozen=True, eq=False)
class Clearance:
    """Distances over ``pairs``, which must have margins of 0, but for those that are proven ``never`` to collide.

    ``lookups``: of pairs with surfaces.
    """

    pairs: Pairs
    chain: Chain
    distances: Distances
    never: frozenset[int]
    lookups: Mapping[int, Lookup]

    def least(self, q: np.ndarray, limit_m: float) -> np.ndarray:
        """Least signed distance (N,) [m] at configurations ``q`` (N, n), cut to ± ``limit_m``; by MuJoCo in float64."""
        return np.concatenate([np.zeros(0), *(self._least(frames, limit_m) for frames in self._frames(q))])

    def lower_bound(self, q: np.ndarray, limit_m: float) -> np.ndarray:
        """What ``least`` is no less than, (N,) [m]: of the capsules around the solids, cut alike."""
        found = [self._bounds(frames).min(axis=0, initial=limit_m) for frames in self._frames(q)]
        return np.concatenate([np.zeros(0), *found]).clip(-limit_m, limit_m)

    def _frames(self, q: np.ndarray) -> Iterator[np.ndarray]:
        for start in range(0, len(q), AT_A_TIME):
            yield frames_of(self.chain, np.asarray(q[start : start + AT_A_TIME], np.float64))

    def _least(self, frames: np.ndarray, limit_m: float) -> np.ndarray:
        """The pair of the least bound is asked first, then the next, while their bounds are below what was found."""
        bounds, found = self._bounds(frames), np.full(len(frames), limit_m)
        if not len(bounds):
            return found
        order, at = np.argsort(bounds, axis=0), np.arange(len(frames))
        for places in order:
            at = at[bounds[places[at], at] < found[at]]
            if not len(at):
                break
            for k in np.unique(places[at]):
                here = at[places[at] == k]
                a, b = self.pairs.pairs[self._asked[k]]
                T_a, T_b = (frames[here, self.pairs.solids[s].joint + 1] @ self.pairs.solids[s].T for s in (a, b))
                found[here] = np.minimum(found[here], self.distances.between(a, b, T_a, T_b, limit_m))
        return np.maximum(found, -limit_m)

    @cached_property
    def _asked(self) -> list[int]:
        return [pair for pair in range(len(self.pairs.pairs)) if pair not in self.never]

    @cached_property
    def _covers(self) -> dict[int, tuple[Capsules, Capsules]]:
        """Of every solid but half-spaces one capsule around it, and a few."""
        solids = {int(k) for pair in self._asked for k in self.pairs.pairs[pair]}
        bounded = [k for k in solids if self.pairs.solids[k].kind not in ("half_space", "surface")]
        return dict(zip(bounded, outer_covers([self.pairs.solids[k] for k in bounded]), strict=True))

    def _bounds(self, frames: np.ndarray) -> np.ndarray:
        """Lower bounds of the signed distances of the pairs that are asked, (P, N) [m]."""
        placed: dict[int, list[tuple[np.ndarray, np.ndarray, np.ndarray]]] = {}
        for solid, covers in self._covers.items():
            T = frames[:, self.pairs.solids[solid].joint + 1] @ self.pairs.solids[solid].T
            placed[solid] = [_placed(cover, T) for cover in covers]
        bounds = np.empty((len(self._asked), len(frames)))
        for row, pair in enumerate(self._asked):
            a, b = (int(k) for k in self.pairs.pairs[pair])
            if pair in self.lookups:
                known = self.lookups[pair].distance(frames[:, self.lookups[pair].joint + 1])
                bounds[row] = np.where(known > 0, known, -np.inf)
                continue
            if self.pairs.solids[a].kind == "half_space":
                T = self.pairs.solids[a].T
                bounds[row] = _above(T[:3, 3], T[:3, 2], *placed[b][1])
                continue
            bounds[row] = _apart(placed[a][1], placed[b][1])
            # Parts that overlap do not say how deep the wholes do: one capsule around each does.
            deep = np.flatnonzero(bounds[row] <= 0)
            whole = ((middle[deep], half[deep], radius) for middle, half, radius in (placed[a][0], placed[b][0]))
            bounds[row, deep] = _apart(*whole)
        return bounds - ROUNDING


def _placed(capsules: Capsules, T: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Middles and half axes (N, C, 3) of capsules in frames (N, 4, 4), and radii (C,)."""
    R = T[:, :3, :3]
    middle = np.einsum("nij,cj->nci", R, (capsules.a + capsules.b) / 2) + T[:, None, :3, 3]
    return middle, np.einsum("nij,cj->nci", R, (capsules.b - capsules.a) / 2), capsules.radius


def _apart(a: tuple[np.ndarray, np.ndarray, np.ndarray], b: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    """Least signed distance (N,) of two sets of placed capsules; of overlapping ones that of the deepest two."""
    least = np.full(len(a[0]), np.inf)
    for i, radius_a in enumerate(a[2]):
        for k, radius_b in enumerate(b[2]):
            apart = axes_distance(a[0][:, i], a[1][:, i], b[0][:, k], b[1][:, k]) - radius_a - radius_b
            least = np.minimum(least, apart)
    return least


def _above(point: np.ndarray, normal: np.ndarray, middle: np.ndarray, half: np.ndarray, radius: np.ndarray):
    """Least height (N,) of placed capsules above a plane."""
    return ((middle - point) @ normal - np.abs(half @ normal) - radius).min(axis=1)
