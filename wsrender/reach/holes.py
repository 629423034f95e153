"""Holes in a volume: empty voxels that lie wholly within what a robot reaches; too few samples leave them."""

from itertools import product

import numpy as np

from wsrender.pipeline.constraints.region import RegionConstraint
from wsrender.reach.evidence import REACHABLE
from wsrender.reach.inverse_solver import InverseSolver
from wsrender.reach.reached_set import tolerance_m
from wsrender.robots.kinematics import Kinematics
from wsrender.volume.volume_data import VolumeData

DRAWS = 4096  # a share of .5 % is found to a quarter of it
NEIGHBOURS = np.array([step for step in product((-1, 0, 1), repeat=3) if any(step)])
CORNERS = np.array(list(product((0, 1), repeat=3)))


def share_of_holes(
    chain: Kinematics,
    volume: VolumeData,
    *,
    seed: int = 0,
    device: str = "cpu",
    threads: int | None = None,
    region: RegionConstraint | None = None,
) -> float:
    """How many holes there are to each occupied voxel, estimated: empty voxels whose centre and corners are reachable.

    They are looked for among the neighbours of occupied voxels: of a random one's 26, a hole with k occupied
    neighbours is drawn k times as often as one with a single one, so it counts 1 / k (Horvitz, Thompson 1952).
    """
    occupied = _Occupied(volume)
    drawn = occupied.drawn_neighbours(seed)
    cells, times = np.unique(drawn[~occupied.holds(drawn)], axis=0, return_counts=True)
    solver = InverseSolver(chain, position_m=tolerance_m(chain), seed=seed, device=device, threads=threads)
    for places in (np.full((1, 3), 0.5), CORNERS):
        points = (cells[:, None] + places + volume.first_voxel) * volume.voxel_size_m
        reached = solver.solve(points.reshape(-1, 3)).label.reshape(points.shape[:2]) == REACHABLE
        if region is not None:
            reached &= region.holds(points.reshape(-1, 3)).reshape(points.shape[:2])
        cells, times = cells[reached.all(axis=1)], times[reached.all(axis=1)]
    beside = occupied.holds(cells[:, None] + NEIGHBOURS).sum(axis=1)
    return float(len(NEIGHBOURS) / DRAWS * (times / np.maximum(beside, 1)).sum())


def share_unseen(volume: VolumeData) -> float:
    """How many voxels more samples would add to each occupied one, at least, by those that hold one or two samples.

    f₁ (f₁ - 1) / (2 (f₂ + 1)) of them (Chao 1984); for independent samples, and nearly so for a Sobol sequence.
    """
    count = volume.voxels.count
    once, twice = (float(np.count_nonzero(count == times)) for times in (1, 2))
    return once * (once - 1) / (2 * (twice + 1)) / np.count_nonzero(count)


class _Occupied:
    """The occupied voxels of a volume, by their places (…, 3) in its block."""

    def __init__(self, volume: VolumeData):
        voxels = volume.voxels
        self.shape = voxels.shape
        self.cells = voxels.cells[voxels.count > 0]
        self.at = voxels.at[:, voxels.count > 0].T

    def holds(self, places: np.ndarray) -> np.ndarray:
        """Whether places hold a sample, (…) bool; none outside the block does."""
        within = np.all((places >= 0) & (places < self.shape), axis=-1)
        cells = np.ravel_multi_index(tuple(np.moveaxis(np.where(within[..., None], places, 0), -1, 0)), self.shape)
        found = np.minimum(np.searchsorted(self.cells, cells), len(self.cells) - 1)
        return within & (self.cells[found] == cells)

    def drawn_neighbours(self, seed: int) -> np.ndarray:
        """DRAWS neighbours of occupied voxels, both drawn at random, (DRAWS, 3)."""
        random = np.random.Generator(np.random.Philox(key=seed))
        at = self.at[random.integers(len(self.at), size=DRAWS)]
        return at + NEIGHBOURS[random.integers(len(NEIGHBOURS), size=DRAWS)]
