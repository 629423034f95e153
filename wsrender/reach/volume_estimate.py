"""Volumes with confidence intervals from points whose membership is decided one by one (stratified sampling).

A stratum is a set of cells of one size. Points are drawn uniformly and independently within a stratum, so that the
share found is binomial, and more of them where they narrow the interval most (Neyman, *On the two different aspects of
the representative method*, 1934). Where a stratum would need many more points than it has cells, a pilot of a few
points per cell sorts its cells: those whose points agree become strata of their own, nearly without variance, the
others are cut in eight, and so are cells outside that a set comes near to, for thin sets pass between few points. So
the work grows with the boundary of what is measured, not with its volume. Pilot points only sort cells; they do not
enter the estimate, whose points are drawn afterwards.

Cells have one, two or three indices: the volume of a set in a plane is its area, on a line its length.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import numpy as np

Membership = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Points (N, d) [m] → labels (N, K) int8 for K sets: 1 inside, 0 outside, -1 undecided; and about how far each point is
from the sets, (N, K) [m]."""

QUANTILE = 1.959963984540054  # of the normal distribution: 95 %
FIRST_POINTS = 100  # of every stratum
PILOT_POINTS, DEEPEST, PAYS = 4, 6, 2.0  # points per cell; cuts; needed points per pilot point that make it pay
NEAR = 0.5  # edges of a cell: a pilot point outside a set that is nearer to it does not speak for its cell
GROWTH = 4.0  # largest factor by which a stratum's points grow between two looks
SAFETY = 0.9  # of the tolerance that is aimed at
BATCH = 1 << 15  # points decided at a time
PURE_SHARE = 0.4  # of the half width that strata without any variance may take together


@dataclass(frozen=True)
class Inside:
    """Points inside at least ``least`` and at most ``most`` of the sets; ``precise``: to the tolerance asked.

    ``sets``: the first of those that are meant, and the one after them; None: all. ``reaching``: at least so many sets
    must reach into a stratum; None: ``least``.
    """

    least: int
    most: int
    precise: bool = True
    sets: tuple[int, int] | None = None
    reaching: int | None = None


@dataclass(frozen=True)
class VolumeEstimate:
    """A volume [m³] with its 95 % interval, what undecided points may add to its half, and whether it is as asked.

    ``undecided_ci95``: of the volume whose points are undecided, twice ``undecided``.
    """

    value: float
    low: float
    high: float
    undecided: float
    met: bool
    undecided_ci95: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class VolumeEstimates:
    """Estimates by event, and the number of points decided for them (pilots included)."""

    volumes: dict[Any, VolumeEstimate]
    points: int


@dataclass(eq=False)
class _Stratum:
    cells: np.ndarray  # (M, d) int64
    edge: float  # [m]; a cell covers [i, i + 1) edge
    events: int
    sets: float  # at most so many reach into the cells
    depth: int = 0
    count: int = 0
    surely: np.ndarray = field(init=False)  # (E,) points in the event however undecided ones turn out
    possibly: np.ndarray = field(init=False)

    def __post_init__(self):
        self.surely = np.zeros(self.events, np.int64)
        self.possibly = np.zeros(self.events, np.int64)

    @property
    def volume(self) -> float:
        return len(self.cells) * self.edge ** self.cells.shape[1]

    @property
    def mixed(self) -> bool:
        """Whether some of its points, not all, were in an event, or may have been."""
        return bool(((self.possibly > 0) & (self.surely < self.count)).any())


def estimate_volumes(
    membership: Membership,
    strata: Iterable[np.ndarray],
    cell_edge_m: float,
    events: Mapping[Any, Inside],
    tolerance: float,
    *,
    sets: Sequence[int] | None = None,
    missed: Callable[[float], float] = lambda value: 0.0,
    seed: int = 0,
    max_points: int = 10_000_000,
    progress: Callable[[int, int], None] | None = None,
) -> VolumeEstimates:
    """Volumes of events to a relative ``tolerance`` of half the 95 % interval, from at most ``max_points`` points.

    Relative to the volume, or to that of all strata where no point was found.

    ``strata``: sets of cells (M, d) int64 of the lattice of edge ``cell_edge_m`` that together hold everything to be
    measured; cell (i, j, k) covers [i, i + 1) edge, and so on. ``sets``: into each of the strata at most so many sets
    reach, as is proven (None: all may). ``missed`` (value) is the volume that wrong "outside" labels may hide: it
    widens the interval. ``progress``: called with the points decided and about how many there will be.
    """
    estimation = _Estimation(membership, events, tolerance, missed, seed, max_points, progress)
    return estimation.run(list(strata), cell_edge_m, sets)


class _Estimation:
    def __init__(self, membership, events, tolerance, missed, seed, max_points, progress):
        self.membership, self.events, self.tolerance, self.missed = membership, events, tolerance, missed
        self.max_points, self.progress = max_points, progress
        self.random = np.random.Generator(np.random.Philox(key=seed))
        self.points = self.expected = 0
        self.strata: list[_Stratum] = []

    def run(self, strata: list[np.ndarray], edge: float, sets: Sequence[int] | None) -> VolumeEstimates:
        there = zip(strata, sets or [np.inf] * len(strata), strict=True)
        self.strata = [_Stratum(cells, edge, len(self.events), most) for cells, most in there if len(cells)]
        while True:
            for stratum in self.strata:
                if not stratum.count:
                    self._add(stratum, FIRST_POINTS)
            volumes = self._volumes()
            wanted = [v for v, e in zip(volumes.values(), self.events.values(), strict=True) if e.precise]
            if all(v.met for v in wanted) or self.points >= self.max_points:
                return VolumeEstimates(volumes, self.points)
            self._narrow(volumes)

    def _narrow(self, volumes: dict[Any, VolumeEstimate]) -> None:
        """Take more points, or cut strata, as the widest of the intervals needs it."""
        needed = np.ceil(np.max([self._needed(k, v) for k, v in enumerate(volumes.values())], axis=0))
        missing = np.maximum(needed - [s.count for s in self.strata], 0)
        self.expected = int(min(self.points + missing.sum(), self.max_points))
        affordable = min((self.max_points - self.points) / max(missing.sum(), 1.0), 1.0)
        for stratum, target, lack in zip(list(self.strata), needed, missing, strict=True):
            more = int(np.ceil(min(affordable * lack, (GROWTH - 1) * stratum.count)))
            if more <= 0:
                continue
            pilot = PILOT_POINTS * len(stratum.cells)
            pays = affordable * target > PAYS * pilot and stratum.depth < DEEPEST
            if pays and stratum.mixed:
                self._sort(stratum)
            else:
                self._add(stratum, more)
        if not (needed > [s.count for s in self.strata[: len(needed)]]).any() and len(needed) == len(self.strata):
            for stratum in self.strata:  # so near the goal that nothing is missing on paper
                self._add(stratum, max(stratum.count // 4, 1))

    def _needed(self, event: int, volume: VolumeEstimate) -> np.ndarray:
        """Points of every stratum for one event: Neyman's, and enough where all points agree."""
        if volume.met or not list(self.events.values())[event].precise:
            return np.zeros(len(self.strata))
        half = SAFETY * self.tolerance * volume.value - volume.undecided - self.missed(volume.value) / 2
        half = max(half, 0.1 * self.tolerance * volume.value) or self.tolerance * sum(s.volume for s in self.strata)
        share = np.array([(s.surely[event] + s.possibly[event]) / (2 * s.count) for s in self.strata])
        size = np.array([s.volume for s in self.strata])
        spread = size * np.sqrt(share * (1 - share))
        neyman = (QUANTILE / half) ** 2 * spread.sum() * spread
        # Where all points agree, the fewest for which the root of the squares of size · QUANTILE² / points is small.
        pure = size * (spread == 0) * self._may_happen(event)
        agreeing = np.cbrt(pure**2) * QUANTILE**2 * np.sqrt(np.cbrt(pure**2).sum()) / (PURE_SHARE * half)
        return np.maximum(neyman, agreeing)

    def _volumes(self) -> dict[Any, VolumeEstimate]:
        return {name: self._volume(k, event) for k, (name, event) in enumerate(self.events.items())}

    def _volume(self, k: int, event: Inside) -> VolumeEstimate:
        """Intervals of the strata combined by the square-and-add method (Zou & Donner 2008)."""
        size = np.array([s.volume for s in self.strata])
        count = np.array([s.count for s in self.strata])
        surely = np.array([s.surely[k] for s in self.strata])
        possibly = np.array([s.possibly[k] for s in self.strata])
        here = size * self._may_happen(k)
        least, most = (size * surely / count).sum(), (size * possibly / count).sum()
        below = least - _deviation(size, surely, count)[0]
        above = most + _deviation(here, possibly, count)[1]
        fewer, more = _deviation(here, possibly - surely, count)
        value, hidden = (least + most) / 2, self.missed(most)
        above += hidden
        if event.most < max(e.most for e in self.events.values() if e.sets == event.sets):
            below -= hidden  # a point missed by one set may count for this event wrongly
        below = max(below, 0.0)
        met = bool(above - below <= 2 * self.tolerance * (value or size.sum()))
        open_ = float(most - least)
        interval = max(open_ - float(fewer), 0.0), open_ + float(more)
        return VolumeEstimate(float(value), float(below), float(above), open_ / 2, met, interval)

    def _may_happen(self, event: int) -> np.ndarray:
        """Whether enough sets reach into every stratum, (S,) bool."""
        asked = list(self.events.values())[event]
        least = asked.least if asked.reaching is None else asked.reaching
        return np.array([s.sets >= least for s in self.strata])

    def _add(self, stratum: _Stratum, count: int) -> None:
        """Decide more points of a stratum."""
        cells = stratum.cells[self.random.integers(len(stratum.cells), size=count)]
        surely, possibly = self._happens(self._decided(cells, stratum.edge)[0])
        stratum.surely += surely.sum(axis=0)
        stratum.possibly += possibly.sum(axis=0)
        stratum.count += count

    def _happens(self, labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Whether each event surely or possibly happens at points with these labels, (N, E) bool each."""
        surely, possibly = [], []
        for e in self.events.values():
            own = labels[:, slice(*(e.sets or (None,)))]
            inside = (own == 1).sum(axis=1)
            most = inside + (own < 0).sum(axis=1)
            surely.append((inside >= e.least) & (most <= e.most))
            possibly.append((most >= e.least) & (inside <= e.most))
        return np.stack(surely, axis=1), np.stack(possibly, axis=1)

    def _sort(self, stratum: _Stratum) -> None:
        """Replace a stratum by those of its cells whose pilot points agree, label by label, and the others' parts."""
        cells = np.repeat(stratum.cells, PILOT_POINTS, axis=0)
        labels, distance = self._decided(cells, stratum.edge)
        code = (labels.astype(np.int64) + 1) @ 3 ** np.arange(labels.shape[1])
        code = code.reshape(-1, PILOT_POINTS)
        near = ((labels == 0) & (distance < NEAR * stratum.edge)).any(axis=1).reshape(-1, PILOT_POINTS)
        agree = (code == code[:, :1]).all(axis=1) & ~near.any(axis=1)
        dimension = stratum.cells.shape[1]
        halves = np.array(list(product((0, 1), repeat=dimension)))
        finer = (2 * stratum.cells[~agree, None] + halves).reshape(-1, dimension)
        parts = [stratum.cells[agree & (code[:, 0] == c)] for c in np.unique(code[agree, 0])]
        about = stratum.events, stratum.sets
        new = [_Stratum(part, stratum.edge, *about, DEEPEST) for part in parts]
        new += [_Stratum(finer, stratum.edge / 2, *about, stratum.depth + 1)] * bool(len(finer))
        self.strata.remove(stratum)
        self.strata += new

    def _decided(self, cells: np.ndarray, edge: float) -> tuple[np.ndarray, np.ndarray]:
        """Labels and distances of a random point in each cell."""
        points = (cells + self.random.random(cells.shape)) * edge
        parts = []
        for first in range(0, len(points), BATCH):
            parts.append(self.membership(points[first : first + BATCH]))
            self.points += len(parts[-1][0])
            if self.progress:
                self.progress(self.points, max(self.points, self.expected))
        labels, distance = zip(*parts, strict=True)
        return np.concatenate(labels), np.concatenate(distance)


def _deviation(size: np.ndarray, successes: np.ndarray, count: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far below and above the volume of all strata that of ``successes`` may be (Zou & Donner 2008)."""
    share, (low, high) = successes / count, wilson(successes, count)
    return np.sqrt(((size * (share - low)) ** 2).sum()), np.sqrt(((size * (high - share)) ** 2).sum())


def wilson(successes: np.ndarray, count: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """95 % interval of a share (Wilson 1927)."""
    z2 = QUANTILE**2
    center = (successes + z2 / 2) / (count + z2)
    half = QUANTILE / (count + z2) * np.sqrt(successes * (count - successes) / count + z2 / 4)
    return np.maximum(center - half, 0.0), np.minimum(center + half, 1.0)
