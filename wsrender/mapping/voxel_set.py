"""Points as the set of the voxels that hold them."""

from dataclasses import dataclass

import numpy as np

from wsrender.errors import ResourceError
from wsrender.volume.lattice import LatticeBlock, block_around, check_voxels

MOST_VOXELS = 2**30  # one byte each


@dataclass(frozen=True, eq=False)
class VoxelSet:
    """Voxels of the world lattice that hold a point; ``occupied`` has the shape of ``block``."""

    block: LatticeBlock
    occupied: np.ndarray

    @classmethod
    def of(cls, points: np.ndarray, voxel_size_m: float) -> "VoxelSet":
        """The voxels of points (N, 3) [m]; ResourceError where their box has too many."""
        block = block_around(points.min(axis=0), points.max(axis=0), voxel_size_m)
        if block.size > MOST_VOXELS:
            raise ResourceError("voxel_size_m", f"{voxel_size_m} makes {block.size:.3g} voxels; 2^30 are allowed")
        check_voxels(block, 1)
        occupied = np.zeros(block.shape, bool)
        occupied[tuple(_cells(points, block).T)] = True
        return cls(block, occupied)

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether the voxel of each point (N, 3) [m] is in the set, (N,) bool."""
        cells = _cells(points, self.block)
        inside = ((cells >= 0) & (cells < self.block.shape)).all(axis=1)
        cells[~inside] = 0
        return inside & self.occupied[tuple(cells.T)]

    @property
    def volume_m3(self) -> float:
        """Volume of the voxels."""
        return int(np.count_nonzero(self.occupied)) * self.block.voxel_size_m**3


def _cells(points: np.ndarray, block: LatticeBlock) -> np.ndarray:
    return np.floor(points / block.voxel_size_m).astype(np.int64) - np.array(block.first_voxel)
