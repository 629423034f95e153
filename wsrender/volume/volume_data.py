"""Volume data: statistics of the local indices per voxel of the world lattice ([WSR] II.C.2)."""

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True, eq=False)
class VolumeData:
    """A dense block of the world lattice, cropped to the occupied voxels.

    Voxel (i, j, k) of the arrays covers [(first_voxel + (i, j, k)) r, … + r) with r = ``voxel_size_m``;
    x runs along the first axis. ``count`` is int64 of shape (nx, ny, nz); ``statistics[s][name]`` holds
    statistic s ("maximum", "minimum", "mean") of index ``name``, float64 or float32, NaN in empty voxels.
    ``vectors[name]`` (nx, ny, nz, 3) holds the mean of a vector in world axes. ``units`` are of both.
    """

    voxel_size_m: float
    first_voxel: tuple[int, int, int]
    count: np.ndarray
    statistics: dict[str, dict[str, np.ndarray]] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    vectors: dict[str, np.ndarray] = field(default_factory=dict)

    @property
    def occupied(self) -> np.ndarray:
        """Whether a sample fell in the voxel, (nx, ny, nz) bool."""
        return self.count > 0

    @property
    def origin_m(self) -> np.ndarray:
        """Lower corner of the first voxel in the world frame [m], (3,)."""
        return np.array(self.first_voxel) * self.voxel_size_m

    def centers(self, axis: int) -> np.ndarray:
        """Centre coordinates of the voxels along an axis (0, 1, 2) [m]."""
        return (self.first_voxel[axis] + np.arange(self.count.shape[axis]) + 0.5) * self.voxel_size_m
