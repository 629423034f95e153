"""The largest ball and the largest cube in the occupied voxels of a volume."""

import numpy as np
from scipy.ndimage import distance_transform_edt

from wsrender.volume.volume_data import VolumeData

# How far both may be off, in voxels, where the set has no details smaller than a voxel: the nearest voxel's centre lies
# within half a diagonal, and so does the nearest centre outside beyond the boundary; a cube may lose a voxel's width.
SPHERE_ERROR, CUBE_ERROR = (3**0.5 + 1) / 2, 1.0


def inscribed_sphere_radius(volume: VolumeData | None) -> float:
    """Radius [m] of the largest ball about a voxel's centre that meets no voxel outside; 0 of an empty volume.

    Distance transform to the centres of voxels outside, less half a voxel; right to SPHERE_ERROR.
    """
    if volume is None or not volume.n_occupied:
        return 0.0
    distance = np.asarray(distance_transform_edt(np.pad(volume.occupied, 1)))
    return float((distance.max() - 0.5) * volume.voxel_size_m)


def inscribed_cube_edge(volume: VolumeData | None) -> float:
    """Edge [m] of the largest cube of occupied voxels, faces along the axes; 0 of an empty volume. CUBE_ERROR."""
    if volume is None or not volume.n_occupied:
        return 0.0
    sums = np.pad(volume.occupied.astype(np.int64), ((1, 0),) * 3).cumsum(0).cumsum(1).cumsum(2)
    fits, fails = 1, min(volume.occupied.shape) + 1
    while fails - fits > 1:
        middle = (fits + fails) // 2
        fits, fails = (middle, fails) if _has_cube(sums, middle) else (fits, middle)
    return fits * volume.voxel_size_m


def _has_cube(sums: np.ndarray, edge: int) -> bool:
    """Whether some edge³ block is full; ``sums`` are the sums of all voxels below each corner."""
    for axis in range(3):
        high, low = [slice(None)] * 3, [slice(None)] * 3
        high[axis], low[axis] = slice(edge, None), slice(None, -edge)
        sums = sums[tuple(high)] - sums[tuple(low)]
    return bool((sums == edge**3).any())
