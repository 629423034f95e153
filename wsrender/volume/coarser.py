"""Volume data on a lattice of larger voxels."""

import numpy as np

from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels


def coarser(volume: VolumeData, factor: int) -> VolumeData:
    """The volume on the lattice whose voxels are ``factor`` times as long; it too is anchored at the origin."""
    first = np.array(volume.first_voxel)
    start = first // factor
    x, y, z = start.tolist()
    nx, ny, nz = ((first + volume.shape - 1) // factor - start + 1).tolist()
    fine = volume.voxels.among(volume.voxels.count > 0)
    at = (fine.at + first[:, None]) // factor - start[:, None]
    cells, part_of = np.unique(np.ravel_multi_index(tuple(at), (nx, ny, nz)), return_inverse=True)
    order = np.argsort(part_of, kind="stable")
    starts = np.searchsorted(part_of[order], np.arange(len(cells)))

    def reduced(reduce: np.ufunc, values: np.ndarray) -> np.ndarray:
        return reduce.reduceat(values[order], starts) if len(starts) else values[:0]

    count = reduced(np.add, fine.count)

    def merged(statistic: str, values: np.ndarray) -> np.ndarray:
        if statistic == "mean":
            return reduced(np.add, values * fine.count) / count
        return reduced(np.fmax if statistic == "maximum" else np.fmin, values)

    statistics = {
        statistic: {name: merged(statistic, values) for name, values in by_index.items()}
        for statistic, by_index in fine.statistics.items()
    }
    voxels = Voxels((nx, ny, nz), cells.astype(np.int64), count, statistics)
    return VolumeData.of_voxels(volume.voxel_size_m * factor, (x, y, z), voxels, volume.units)
