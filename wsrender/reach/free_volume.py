"""What chains reach in configurations that constraints admit: volumes free, blocked by reason, and undecided."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from wsrender.engine import sampled_positions
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.admissible_search import BLOCKED, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.pair_search import PairSearch
from wsrender.reach.reached_set import (
    SAMPLES_PER_TEST,
    FalseNegatives,
    ReachedSet,
    hidden_share,
    tests_of,
)
from wsrender.reach.volume_estimate import Inside, VolumeEstimate, estimate_volumes
from wsrender.reach.volume_refinement import RefinedVolumes, block_of, strata_of
from wsrender.volume.lattice import LatticeBlock
from wsrender.volume.voxels import neighbours_and_itself

FREE, ALL_BLOCKED = "free", "blocked"
NEAR_FREE = 4  # class of cells that admitted samples reach, or a neighbour of, from here on
LEVELS = {1: 6}  # of the border of what is free, by the number of sets; of more sets one


class FreeSet:
    """The free positions of a ``reached`` set, whose solver's chain is that of the ``admission``.

    A position's *depth* is 0 where it is unreachable, k where it is blocked by the k-th constraint, one more than there
    are constraints where it is free.
    """

    def __init__(self, reached: ReachedSet, admission: Admission):
        self.reached, self.names = reached, admission.names
        self.search = AdmissibleSearch(reached.solver, admission)

    def decided(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of points (N, d) whether they are that deep, (N, C + 1), and about how far they are from what is free (N,).

        Where solutions were found, but too few, points are at least 1 deep.
        """
        depths = np.arange(1, len(self.names) + 2)
        far = self.reached.outside(points)
        inside = far == 0
        found = self.search.decide(self.reached.padded(points[inside]))
        depth = np.where(found.label == REACHABLE, len(depths), found.reason)
        own = np.asarray(depth[:, None] >= depths, np.int8)
        own[found.pending] = UNDECIDED
        own[found.pending, 0] = np.where(found.rejected[found.pending].any(axis=1), 1, UNDECIDED)
        labels = np.zeros((len(points), len(depths)), np.int8)
        labels[inside] = own
        beside = np.where(found.label == UNREACHABLE, found.distance_m, found.near_m)
        far[inside] = np.where(found.label == REACHABLE, 0.0, beside)
        return labels, far

    def classes(self, block: LatticeBlock, levels: int) -> np.ndarray:
        """Of every cell of a block, of ``dimension`` axes, 0 where it is out of reach.

        Others are alike by what samples reach of their neighbours, from NEAR_FREE by what admitted samples do.
        """
        d = self.reached.dimension
        reach = self.reached.classes(block, 1)
        cells = block.places(self.search.samples[1][:, :d])
        occupied = np.zeros(reach.shape, bool)
        occupied[tuple(cells[((cells >= 0) & (cells < reach.shape)).all(axis=1)].T)] = True
        number = neighbours_and_itself(occupied).astype(np.int64)
        free = np.where(number > 0, 1 + (number - 1) * levels // (3**d - 1), 0)
        # Where the border of the region, or of the reach, passes through the innermost cells.
        free = np.where((free > levels) & (reach < 3), 1 + levels // 2, free)
        return np.where(free > 0, NEAR_FREE - 1 + free, reach) * (reach > 0)

    def false_negatives(self, block: LatticeBlock, tests: int) -> FalseNegatives:
        """The search tried on positions of admitted samples that are none of its starts, from as many cells."""
        q, _ = self.search.admission.samples(SAMPLES_PER_TEST * tests, (self.reached.solver.seed + 1) % 2**63)
        positions = sampled_positions(tip_pipeline(self.reached.solver.whole, q))
        targets = self.reached.targets(positions, block, tests)
        label = self.search.decide(targets).label
        return FalseNegatives(len(targets), int(((label == UNREACHABLE) | (label == BLOCKED)).sum()))

    def found_later(self, classes: np.ndarray, block: LatticeBlock, tests: int) -> FalseNegatives:
        """The search tried beside a longer one, at random points of the cells near what is free."""
        random = np.random.Generator(np.random.Philox(key=self.reached.seed))
        points = _points_of(classes, block, tests, random)
        points = self.reached.padded(points[self.reached.outside(points) == 0])
        found = self.search.decide(points)
        free = int((found.label == REACHABLE).sum())
        missed = self.search.blocked_wrongly(found, points)
        return FalseNegatives(free + missed, missed)


def _points_of(classes: np.ndarray, block: LatticeBlock, count: int, random: np.random.Generator) -> np.ndarray:
    """So many random points (N, d) [m] of the cells near what is free; none where there are no such cells."""
    near = np.unique(classes[classes >= NEAR_FREE]).tolist()
    cells = np.concatenate([*(np.argwhere(classes == k) for k in near), np.zeros((0, classes.ndim), np.int64)])
    if not len(cells):
        return np.zeros((0, classes.ndim))
    cells += block.first_voxel[: classes.ndim]
    at = random.integers(len(cells), size=count)
    return (cells[at] + random.random((count, classes.ndim))) * block.voxel_size_m


class Together:
    """Several sets of one space, and which of their arms must keep apart: ``pairs`` by the numbers of two sets.

    ``least`` by name: that many arms must reach a point freely; of two or more, two of them in configurations in which
    they keep apart. A point is as deep for that as the ``least``-th deepest of its depths: see `FreeSet`; where arms
    must keep apart one more than that is free, and what is left of one less is blocked by them.
    """

    def __init__(self, sets: Sequence[FreeSet], least: Mapping[str, int], pairs: Mapping[tuple[int, int], PairSearch]):
        self.sets, self.least, self.pairs = sets, least, pairs
        self.block = block_of([each.reached for each in sets])
        self.classes = [each.classes(self.block, LEVELS.get(len(sets), 1)) for each in sets]

    @property
    def events(self) -> dict[tuple[str, str], Inside]:
        """What depths mean, by name and part; what is free is to be measured to the tolerance."""
        events, first = dict[tuple[str, str], Inside](), 0
        together = next((each.names for each in self.pairs.values()), ())
        for name, least in self.least.items():
            reasons = (*self.sets[0].names, *(together if least > 1 else ()))
            free = len(reasons) + 1
            columns = first, first + free
            own = {
                FREE: (free, free),
                ALL_BLOCKED: (1, free - 1),
                **{each: (k, k) for k, each in enumerate(reasons, 1)},
            }
            for part, (low, high) in own.items():
                events[name, part] = Inside(low, high, part == FREE, columns, least)
            first += free
        return events

    def decided(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of points (N, d) whether they are that deep for each event, and about how far from it; see `FreeSet`."""
        at = tuple(np.clip(self.block.places(points), 0, np.array(self.classes[0].shape) - 1).T)
        labels = np.zeros((len(self.sets), len(points), len(self.sets[0].names) + 1), np.int8)
        far = np.full((len(self.sets), len(points)), np.inf)
        for k, (each, own) in enumerate(zip(self.sets, self.classes, strict=True)):
            possible = own[at] > 0
            labels[k, possible], far[k, possible] = each.decided(points[possible])
        columns, distances = [], []
        for least in self.least.values():
            surely, possibly = (labels == 1).sum(axis=0) >= least, (labels != 0).sum(axis=0) >= least
            columns.append(np.where(surely, 1, np.where(possibly, UNDECIDED, 0)))
            near = np.sort(far, axis=0)[min(least, len(far)) - 1]
            distances.append(np.broadcast_to(near[:, None], columns[-1].shape))
            if self.pairs and least > 1:
                alone = columns[-1][:, -1]
                columns.append(self._apart(points, labels[:, :, -1], alone)[:, None])
                distances.append(np.where(alone == 1, np.inf, near)[:, None])
        return np.concatenate(columns, axis=1), np.concatenate(distances, axis=1)

    def _apart(self, points: np.ndarray, free: np.ndarray, alone: np.ndarray) -> np.ndarray:
        """Whether two arms that are ``free`` (K, N) to reach points do so apart, (N,) int8."""
        label = np.where(alone == 0, 0, BLOCKED)
        label[alone == UNDECIDED] = UNDECIDED
        for (i, k), search in self.pairs.items():
            at = np.flatnonzero((free[i] == 1) & (free[k] == 1) & (label != REACHABLE))
            found = search.decide(self.sets[i].reached.padded(points[at]))
            label[at] = np.where(found == BLOCKED, label[at], found)
        return np.where(label == BLOCKED, 0, label)

    def misses(self, tests: int) -> tuple[FalseNegatives, ...]:
        """What the searches were tried on: of each set two, then those of pairs."""
        found: list[FalseNegatives] = []
        for each, own in zip(self.sets, self.classes, strict=True):
            found += [each.false_negatives(self.block, tests), each.found_later(own, self.block, tests)]
        for (i, k), search in self.pairs.items():
            random = np.random.Generator(np.random.Philox(key=self.sets[i].reached.seed))
            both = np.where(self.classes[k] >= NEAR_FREE, self.classes[i], 0)
            points = _points_of(both, self.block, tests, random)
            free = [self.sets[number].decided(points)[0][:, -1] == 1 for number in (i, k)]
            found.append(search.found_later(self.sets[i].reached.padded(points[free[0] & free[1]])))
        return tuple(found)


def free_volumes(
    sets: Sequence[FreeSet],
    least: Mapping[str, int],
    tolerance: float,
    *,
    pairs: Mapping[tuple[int, int], PairSearch],
    seed: int,
    max_points: int,
    progress: Callable[[int, int], None] | None,
) -> RefinedVolumes:
    """Volumes free, blocked, and blocked by each constraint, by name and part; the first to a relative ``tolerance``.

    ``sets``, ``least`` and ``pairs`` as `Together` has them. Blocked is what a search found so. What it may have missed
    widens all intervals: it is tried on positions of other admitted samples, and beside a longer search.
    """
    own = Together(sets, least, pairs)
    strata, reaching = strata_of(own.classes, min(least.values()))
    misses = own.misses(tests_of(tolerance))
    hidden = hidden_share(misses)
    whole = sum(map(len, strata)) * own.block.voxel_size_m ** sets[0].reached.dimension

    def missed(value: float) -> float:
        # A search that misses all of few targets says nothing of what there is, which is no more than all cells.
        return whole if np.isinf(hidden) else min(hidden * value, whole)

    d = sets[0].reached.dimension
    found = estimate_volumes(
        own.decided,
        [cells + own.block.first_voxel[:d] for cells in strata],
        own.block.voxel_size_m,
        own.events,
        tolerance,
        sets=reaching,
        missed=missed,
        seed=seed,
        max_points=max_points,
        progress=progress,
    )
    # A search that starts from nothing that is admitted says little by finding none.
    blind = any(not len(each.search.samples[0]) for each in sets)
    volumes = {}
    for (name, part), each in found.volumes.items():
        hides = whole if blind else missed(found.volumes[name, FREE].high)
        free = replace(each, high=whole, met=False) if blind else each
        volumes[name, part] = free if part == FREE else _less(each, hides)
    return RefinedVolumes(volumes, found.points, misses, max(each.reached.position_m for each in sets))


def _less(blocked: VolumeEstimate, missed: float) -> VolumeEstimate:
    """A blocked volume of which as much may be free, and that may hold as much of what was called unreachable."""
    return replace(blocked, low=max(blocked.low - missed, 0.0), high=blocked.high + missed)
