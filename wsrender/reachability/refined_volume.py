"""The reachable volume with a confidence interval; of several robots, the volumes that so many of them reach.

Membership of a point is decided by inverse kinematics. The strata are, for every robot, the inner voxels of what a
Sobol set of configurations reaches (all 26 neighbours occupied), the border, and the rest of a box that holds the
reach: inner points are decided too, which finds voids.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wsrender.engine import configurations, evaluate_poses
from wsrender.reachability.dimension import fills_volume
from wsrender.reachability.inverse_solver import UNREACHABLE, InverseSolver
from wsrender.reachability.occupied_cells import occupied_cells
from wsrender.reachability.volume_estimate import Event, VolumeEstimate, estimate_volumes
from wsrender.robots.chain import Chain
from wsrender.robots.reachable_box import reachable_box
from wsrender.sampling import plan_sampling
from wsrender.spec.sampling import Sobol
from wsrender.volume.lattice import LatticeBlock, block_around
from wsrender.volume.neighbours import inner_and_outer

POSITION = 1e-8  # of the reach
SAMPLES_PER_CELL = 16
# Cells along the box's mean edge: as many as make the border's share fit a tolerance of 0.5 %; finer tolerances cut
# the border further (`estimate_volumes`).
CELLS = 64
TESTS, TEST_SAMPLES = 4096, 1 << 16  # targets of the measured false-negative rate, chosen from so many samples


@dataclass(frozen=True)
class FalseNegatives:
    """Reachable targets, spread evenly over the workspace, that the solver was tried on, and called unreachable."""

    tested: int
    missed: int

    @property
    def rate(self) -> float:
        """Missed targets over all."""
        return self.missed / self.tested if self.tested else 0.0


@dataclass(frozen=True)
class RefinedVolumes:
    """Volumes by event [m³], the points decided for them, and each robot's measured false negatives.

    ``position_m``: the largest residual that counted as reached [m].
    """

    volumes: dict[str, VolumeEstimate]
    points: int
    false_negatives: tuple[FalseNegatives, ...]
    position_m: float


def refined_volume(chain: Chain, tolerance: float, **options) -> tuple[VolumeEstimate, RefinedVolumes]:
    """The volume that the end effector of one chain reaches; options of `refined_volumes`.

    In the base frame, where the box that holds the reach is smallest: no volume depends on a placement.
    """
    found = refined_volumes([chain.placed(np.eye(4))], {"reachable": Event(1, 1)}, tolerance, **options)
    return found.volumes["reachable"], found


def refined_volumes(
    chains: Sequence[Chain],
    events: Mapping[str, Event],
    tolerance: float,
    *,
    seed: int = 0,
    max_points: int = 10_000_000,
    device: str = "cpu",
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> RefinedVolumes:
    """Volumes of the points that so many of the placed ``chains`` reach, to a relative ``tolerance``.

    ``events``: by name the least and largest number of chains, such as ``{"any": Event(1, 2), "all": Event(2, 2)}``;
    those that are not ``precise`` are estimated from the same points. ``progress``: called with the points decided
    and about how many there will be.
    """
    arms = [_Arm(chain, seed, device, threads) for chain in chains]
    low = np.min([arm.low for arm in arms], axis=0)
    high = np.max([arm.high for arm in arms], axis=0)
    solid = [arm for arm in arms if arm.solid]
    position_m = max(map(tolerance_m, chains))
    if not solid:
        volumes = {name: VolumeEstimate(0.0, 0.0, 0.0, 0.0, met=True) for name in events}
        return RefinedVolumes(volumes, 0, tuple(FalseNegatives(0, 0) for _ in arms), position_m)
    block = block_around(low, high, float(np.cbrt(np.prod(high - low))) / CELLS)
    classes = sum(arm.classes(block).astype(np.int64) * 3**k for k, arm in enumerate(solid))
    strata = [np.argwhere(classes == code) + block.first_voxel for code in np.unique(classes)]
    misses = [arm.false_negatives(block) for arm in arms]
    hidden = sum(miss.rate / (1 - miss.rate) if miss.rate < 1 else np.inf for miss in misses)

    def membership(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        decided = [arm.decided(points) for arm in arms]
        return np.stack([label for label, _ in decided], axis=1), np.stack([far for _, far in decided], axis=1)

    found = estimate_volumes(
        membership,
        strata,
        block.voxel_size_m,
        events,
        tolerance,
        missed=lambda value: hidden * value,
        seed=seed,
        max_points=max_points,
        progress=progress,
    )
    return RefinedVolumes(found.volumes, found.points, tuple(misses), position_m)


def tolerance_m(chain: Chain) -> float:
    """Residual that counts as reached [m]: a shell so thin adds nothing to any volume that is not flat."""
    return POSITION * (chain.reach or 1.0)


class _Arm:
    """One chain: its box, what its samples reach, and its solver."""

    def __init__(self, chain: Chain, seed: int, device: str, threads: int | None):
        self.solver = InverseSolver(chain, position_m=tolerance_m(chain), seed=seed, device=device, threads=threads)
        self.chain, self.seed, self.device, self.threads = self.solver.chain, seed, device, threads
        self.low, self.high = reachable_box(self.chain, self.chain.lower_limits, self.chain.upper_limits)

    @cached_property
    def solid(self) -> bool:
        """Whether the positions fill a volume."""
        return fills_volume(self.chain)

    def decided(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Labels (N,) int8 of points (N, 3), and distances (N,) [m] to the nearest reachable point that was found.

        A surface or a line has no volume: nothing lies in it by chance, and nothing has to be looked for near it.
        """
        if not self.solid:
            return np.full(len(points), UNREACHABLE, np.int8), np.full(len(points), np.inf)
        found = self.solver.solve(points)
        return found.label, found.distance_m

    def classes(self, block: LatticeBlock) -> np.ndarray:
        """Of every cell: 0 rest, 1 border, 2 inner, (nx, ny, nz)."""
        occupied = occupied_cells(self.chain, block, SAMPLES_PER_CELL * CELLS**3, self.seed, self.device, self.threads)
        inner, outer = inner_and_outer(occupied)
        return (inner.astype(np.int8) + outer)[1:-1, 1:-1, 1:-1]

    def false_negatives(self, block: LatticeBlock) -> FalseNegatives:
        """The solver tried on positions of samples that are none of its starts, one per cell."""
        if not self.solid:
            return FalseNegatives(0, 0)
        positions = self._positions(TEST_SAMPLES)
        cells = np.floor(positions / block.voxel_size_m).astype(np.int64) - block.first_voxel
        _, chosen = np.unique(np.ravel_multi_index(tuple(cells.T), block.shape), return_index=True)
        chosen = np.random.Generator(np.random.Philox(key=self.seed)).permutation(chosen)[:TESTS]
        labels, _ = self.decided(positions[chosen])
        return FalseNegatives(len(chosen), int((labels == UNREACHABLE).sum()))

    def _positions(self, count: int) -> np.ndarray:
        """Positions (N, 3) of a Sobol set of another seed than the solver's."""
        plan = plan_sampling(self.chain, Sobol(count, seed=(self.seed + 1) % 2**63))
        return evaluate_poses(self.chain, configurations(plan, np.arange(count)), device="cpu")[:, :3, 3]
