"""What one chain reaches of a space of one, two or three dimensions: points decided one by one, and strata of cells."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from math import ceil
from typing import Any

import numpy as np

from wsrender.documents.sampling import Sobol
from wsrender.engine import configurations, sampled_positions
from wsrender.pipeline.constraints.region import RegionConstraint
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.cover import covered_cells
from wsrender.reach.dimension import TipSet
from wsrender.reach.evidence import UNREACHABLE
from wsrender.reach.inverse_solver import InverseSolver
from wsrender.reach.occupied_cells import occupied_cells
from wsrender.reach.starts import inwards, towards_limits
from wsrender.reach.volume_estimate import QUANTILE, wilson
from wsrender.robots.kinematics import Kinematics
from wsrender.robots.reachable_box import reachable_box
from wsrender.volume.lattice import LatticeBlock
from wsrender.volume.voxels import neighbours_and_itself

POSITION = 1e-8  # of the reach
SAMPLES_PER_CELL = 4
# Cells along the box's mean edge: as many as make the border's share fit a tolerance of 0.5 %; finer tolerances cut
# the border further (`estimate_volumes`).
CELLS = 64
# Targets of the measured false-negative rate: so many, or more, that none missed among them may hide no more than this
# share of the tolerance; chosen each from so many samples.
TESTS, HIDDEN_SHARE, SAMPLES_PER_TEST = 4096, 0.1, 16
NEXT_TO = 1e-3  # half of these have half their coordinates so near a limit, as a share of the range


@dataclass(frozen=True)
class FalseNegatives:
    """Reachable targets, spread evenly over the workspace, that the solver was tried on, and called unreachable."""

    tested: int
    missed: int

    @property
    def rate(self) -> float:
        """Missed targets over all."""
        return self.missed / self.tested if self.tested else 0.0


def hidden_share(found: Sequence[FalseNegatives]) -> float:
    """Upper end of the 95 % interval of how much of a volume solvers miss together, over what they find.

    Sums of rare events are as rare as those of one solver: of all misses together (Wilson 1927). None missed among n
    hide up to 3.84 / n.
    """
    tested = min((each.tested for each in found if each.tested), default=0)
    if not tested:
        return 0.0
    missed = sum(tested * each.missed / each.tested for each in found if each.tested)
    if missed >= tested:
        return np.inf
    most = float(wilson(np.array(missed), np.array(tested))[1])
    return most / (1 - most)


def tests_of(tolerance: float) -> int:
    """How many targets show whether the solver's misses matter to a relative tolerance."""
    return max(TESTS, ceil(QUANTILE**2 / (HIDDEN_SHARE * tolerance)))


def tolerance_m(chain: Kinematics) -> float:
    """Residual that counts as reached [m]: a shell so thin adds nothing to any volume that is not flat."""
    return POSITION * (chain.reach or 1.0)


class ReachedSet:
    """The positions of a chain in the space of the world's first ``dimension`` axes, in which they all lie.

    ``solid``: whether they fill a part of it; what does not adds nothing to any volume. ``thickness_m``: how far beside
    that space they may lie. ``region``, with the frame (4, 4) of the chain's base in its world: where positions count.
    """

    def __init__(
        self,
        chain: Kinematics,
        dimension: int,
        *,
        solid: bool,
        thickness_m: float,
        seed: int,
        device: str,
        threads: int | None,
        region: RegionConstraint | None = None,
        T_region_base: np.ndarray | None = None,
    ):
        self.dimension, self.solid = dimension, solid
        self.position_m = max(tolerance_m(chain), thickness_m)
        self.solver = InverseSolver(chain, position_m=self.position_m, seed=seed, device=device, threads=threads)
        self.chain, self.seed, self.device, self.threads = self.solver.chain, seed, device, threads
        low, high = reachable_box(self.chain, self.chain.lower_limits, self.chain.upper_limits)
        self.low, self.high = low[:dimension], high[:dimension]
        self.region = region
        base = np.eye(4) if T_region_base is None else T_region_base
        self._T_region_own = base @ np.linalg.inv(chain.T_world_base)

    @classmethod
    def within(
        cls,
        chain: Kinematics,
        filled: TipSet,
        T_world_own: np.ndarray,
        dimension: int,
        T_region_base: np.ndarray,
        region: RegionConstraint | None,
        **how: Any,
    ) -> "ReachedSet":
        """What a chain, whose positions are ``filled``, reaches of the space of a frame's first axes."""
        return cls(
            chain.placed(np.linalg.inv(T_world_own) @ chain.T_world_base),
            dimension,
            solid=filled.dimension == dimension,
            thickness_m=filled.thickness_m(T_world_own, dimension),
            region=region,
            T_region_base=T_region_base,
            **how,
        )

    def decided(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Labels (N,) int8 of points (N, d), and distances (N,) [m] to the nearest reachable point that was found.

        Of points outside the region those to the region: what is reached in it is no nearer.
        """
        label, far = np.full(len(points), UNREACHABLE, np.int8), self.outside(points)
        inside = far == 0
        found = self.solver.solve(self.padded(points[inside]))
        label[inside], far[inside] = found.label, found.distance_m
        return label, far

    def padded(self, points: np.ndarray) -> np.ndarray:
        """Points (N, d) in the world, (N, 3)."""
        return np.pad(points, ((0, 0), (0, 3 - self.dimension)))

    def outside(self, points: np.ndarray) -> np.ndarray:
        """How far points (N, d) are from the region [m], (N,); 0 within the tolerance: arms may move in a border."""
        if self.region is None:
            return np.zeros(len(points))
        own = self.padded(points)
        far = self.region.distance(own @ self._T_region_own[:3, :3].T + self._T_region_own[:3, 3])
        return np.where(far <= self.position_m, 0.0, far)

    def decided_among(self, points: np.ndarray, possible: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The same of points in cells of which some are ``possible`` (N,) bool; near the others nothing is reached."""
        label, far = np.full(len(points), UNREACHABLE, np.int8), np.full(len(points), np.inf)
        label[possible], far[possible] = self.decided(points[possible])
        return label, far

    def classes(self, block: LatticeBlock, levels: int) -> np.ndarray:
        """Of every cell of a block, of ``dimension`` axes: 0 out of reach, 1 rest, 2 … border, ``levels`` + 2 inner.

        The more of a border cell's neighbours the samples reach, the more of it is reached: levels tell this apart.
        """
        count = SAMPLES_PER_CELL * CELLS**self.dimension
        beside = tuple(range(self.dimension, 3))
        sampled = occupied_cells(self.chain, block, count, self.seed, self.device, self.threads)
        number = neighbours_and_itself(np.asarray(sampled.any(axis=beside)))
        border = 2 + (number.astype(np.int64) - 1) * levels // (3**self.dimension - 1)
        rest = covered_cells(self.chain, block, self.dimension).astype(np.int64)
        return self._in_region(block, np.where(number > 0, border, rest), 2 + levels // 2)

    def _in_region(self, block: LatticeBlock, classes: np.ndarray, border: int) -> np.ndarray:
        """The classes without cells outside the region; ``border`` where its border passes through inner ones."""
        if self.region is None:
            return classes
        at = np.argwhere(classes > 0)
        centers = (at + block.first_voxel[: self.dimension] + 0.5) * block.voxel_size_m
        half = 0.5 * block.voxel_size_m * np.sqrt(self.dimension)
        corners = np.array(list(product((-0.5, 0.5), repeat=self.dimension))) * block.voxel_size_m
        within = np.all([self.outside(centers + corner) == 0 for corner in corners], axis=0)
        cut = self.outside(centers) <= half
        own = classes[tuple(at.T)]
        # A shape that lies within one cell holds none of its corners, and its centre is near.
        classes[tuple(at.T)] = np.where(within, own, np.where(cut, np.minimum(own, border), 0))
        return classes

    def false_negatives(self, block: LatticeBlock, tests: int = TESTS) -> FalseNegatives:
        """The solver tried on positions of samples that are none of its starts; see `targets`."""
        if not self.solid:
            return FalseNegatives(0, 0)
        targets = self.targets(self._positions(SAMPLES_PER_TEST * tests), block, tests)
        labels = self.solver.solve(targets).label
        return FalseNegatives(len(targets), int((labels == UNREACHABLE).sum()))

    def targets(self, positions: np.ndarray, block: LatticeBlock, tests: int) -> np.ndarray:
        """So many (M, 3), or fewer, of positions (N, 3) [m], from as many cells as there are.

        In the region, unless so few lie there that they say nothing of it.
        """
        positions = positions[:, : self.dimension]
        inside = positions[self.outside(positions) == 0]
        positions = inside if len(inside) >= tests else positions
        places = tuple(block.places(positions).T)
        numbers = np.ravel_multi_index(places, block.shape[: self.dimension])
        return self.padded(positions[chosen_evenly(np.asarray(numbers), self.seed)[:tests]])

    def _positions(self, count: int) -> np.ndarray:
        """Positions (N, 3), shuffled, of a Sobol set of another seed than the solver's, half of it next to limits."""
        q = configurations(tip_pipeline(self.chain, Sobol(count, seed=(self.seed + 1) % 2**63)))
        q[count // 2 :] = inwards(self.chain, towards_limits(self.chain, q[count // 2 :]), NEXT_TO)
        q = np.random.Generator(np.random.Philox(key=self.seed)).permutation(q)
        return sampled_positions(tip_pipeline(self.chain, q), threads=self.threads)


def chosen_evenly(numbers: np.ndarray, seed: int) -> np.ndarray:
    """Order (N,) of positions by the numbers of their cells (N,): one of every cell at random, then another of each."""
    random = np.random.Generator(np.random.Philox(key=seed))
    return np.lexsort((random.random(len(numbers)), _times_before(numbers)))


def _times_before(numbers: np.ndarray) -> np.ndarray:
    """How often each number (N,) has come before, (N,)."""
    order = np.argsort(numbers, kind="stable")
    starts = np.flatnonzero(np.diff(numbers[order], prepend=-1))
    times = np.empty(numbers.size, np.int64)
    times[order] = np.arange(numbers.size) - np.repeat(starts, np.diff(starts, append=numbers.size))
    return times
