"""What a chain reaches in configurations that constraints admit: volumes free, blocked by reason, and undecided."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from wsrender.engine import sampled_positions
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.admissible_search import BLOCKED, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.reached_set import (
    SAMPLES_PER_TEST,
    FalseNegatives,
    ReachedSet,
    chosen_evenly,
    hidden_share,
    tests_of,
)
from wsrender.reach.volume_estimate import Event, VolumeEstimate, estimate_volumes
from wsrender.reach.volume_refinement import RefinedVolumes, block_of
from wsrender.volume.lattice import LatticeBlock
from wsrender.volume.voxels import neighbours_and_itself

FREE, ALL_BLOCKED = "free", "blocked"
LEVELS = 6  # of the border of what is free


class FreeSet:
    """The free positions of a ``reached`` set, whose solver's chain is that of the ``admission``.

    A position's *depth* is 0 where it is unreachable, k where it is blocked by the k-th constraint, one more than there
    are constraints where it is free.
    """

    def __init__(self, reached: ReachedSet, admission: Admission):
        self.reached, self.names = reached, admission.names
        self.search = AdmissibleSearch(reached.solver, admission)

    @property
    def events(self) -> dict[str, Event]:
        """What depths mean; the first is to be measured to the tolerance."""
        free = len(self.names) + 1
        each = {name: Event(k, k, precise=False) for k, name in enumerate(self.names, 1)}
        return {FREE: Event(free, free), ALL_BLOCKED: Event(1, free - 1, precise=False), **each}

    def decided(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of points (N, d) whether they are that deep, and about how far they are from what is free; both (N, C + 1).

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
        return labels, np.broadcast_to(far[:, None], labels.shape)

    def strata(self, block: LatticeBlock) -> tuple[list[np.ndarray], list[np.ndarray]]:
        """Cells (M, d) of a block that are alike: by what samples, and admitted samples, reach of their neighbours.

        All, and those of them that admitted samples reach, or a neighbour of.
        """
        d = self.reached.dimension
        reach = self.reached.classes(block, 1)
        cells = self._cells(block, self.search.samples[1])
        occupied = np.zeros(reach.shape, bool)
        occupied[tuple(cells[((cells >= 0) & (cells < reach.shape)).all(axis=1)].T)] = True
        number = neighbours_and_itself(occupied).astype(np.int64)
        free = np.where(number > 0, 1 + (number - 1) * LEVELS // (3**d - 1), 0)
        # Where the border of the region, or of the reach, passes through the innermost cells.
        free = np.where((free > LEVELS) & (reach < 3), 1 + LEVELS // 2, free)
        code = np.where(free > 0, 3 + free, reach) * (reach > 0)
        cells = {k: np.argwhere(code == k) + block.first_voxel[:d] for k in np.unique(code[code > 0]).tolist()}
        return list(cells.values()), [each for k, each in cells.items() if k > 3]

    def false_negatives(self, block: LatticeBlock, tests: int) -> FalseNegatives:
        """The search tried on positions of admitted samples that are none of its starts, from as many cells."""
        q, _ = self.search.admission.samples(SAMPLES_PER_TEST * tests, (self.reached.solver.seed + 1) % 2**63)
        positions = sampled_positions(tip_pipeline(self.reached.solver.whole, q))[:, : self.reached.dimension]
        inside = positions[self.reached.outside(positions) == 0]
        positions = inside if len(inside) >= tests else positions
        cells = self._cells(block, positions)
        numbers = np.ravel_multi_index(tuple(cells.T), block.shape[: self.reached.dimension])
        chosen = chosen_evenly(np.asarray(numbers), self.reached.seed)[:tests]
        label = self.search.decide(self.reached.padded(positions[chosen])).label
        return FalseNegatives(len(chosen), int(((label == UNREACHABLE) | (label == BLOCKED)).sum()))

    def found_later(self, strata: list[np.ndarray], edge: float, tests: int) -> FalseNegatives:
        """The search tried beside a longer one, at random points of cells (M, d) of an ``edge`` [m]."""
        random = np.random.Generator(np.random.Philox(key=self.reached.seed))
        cells = np.concatenate([*strata, np.zeros((0, self.reached.dimension), np.int64)])
        if not len(cells):
            return FalseNegatives(0, 0)
        points = (cells[random.integers(len(cells), size=tests)] + random.random((tests, cells.shape[1]))) * edge
        points = self.reached.padded(points[self.reached.outside(points) == 0])
        found = self.search.decide(points)
        free = int((found.label == REACHABLE).sum())
        missed = self.search.blocked_wrongly(found, points)
        return FalseNegatives(free + missed, missed)

    def _cells(self, block: LatticeBlock, positions: np.ndarray) -> np.ndarray:
        d = self.reached.dimension
        return np.floor(positions[:, :d] / block.voxel_size_m).astype(np.int64) - block.first_voxel[:d]


def free_volumes(
    reached: ReachedSet,
    admission: Admission,
    tolerance: float,
    *,
    seed: int,
    max_points: int,
    progress: Callable[[int, int], None] | None,
) -> RefinedVolumes:
    """Volumes free, blocked, and blocked by each constraint, by name; the first to a relative ``tolerance``.

    Blocked is what a search found so. What it may have missed widens all intervals: it is tried on positions of other
    admitted samples, and beside a longer search.
    """
    own = FreeSet(reached, admission)
    block = block_of([reached])
    strata, near_free = own.strata(block)
    tests = tests_of(tolerance)
    misses = own.false_negatives(block, tests), own.found_later(near_free, block.voxel_size_m, tests)
    hidden = hidden_share(misses)
    whole = sum(map(len, strata)) * block.voxel_size_m**reached.dimension

    def missed(value: float) -> float:
        # A search that misses all of few targets says nothing of what there is, which is no more than all cells.
        return whole if np.isinf(hidden) else min(hidden * value, whole)

    found = estimate_volumes(
        own.decided,
        strata,
        block.voxel_size_m,
        own.events,
        tolerance,
        missed=missed,
        seed=seed,
        max_points=max_points,
        progress=progress,
    )
    free = found.volumes[FREE]
    if not len(
        own.search.samples[0]
    ):  # the search starts from nothing that is admitted: that it finds none says little
        free = replace(free, high=whole, met=False)
    hides = missed(free.high) if len(own.search.samples[0]) else whole
    volumes = {name: free if name == FREE else _less(each, hides) for name, each in found.volumes.items()}
    return RefinedVolumes(volumes, found.points, misses, reached.position_m)


def _less(blocked: VolumeEstimate, missed: float) -> VolumeEstimate:
    """A blocked volume of which as much may be free, and that may hold as much of what was called unreachable."""
    return replace(blocked, low=max(blocked.low - missed, 0.0), high=blocked.high + missed)
