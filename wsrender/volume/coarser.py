"""Volume data on a lattice of larger voxels."""

from dataclasses import replace

import numpy as np

from wsrender.volume.volume_data import VolumeData


def coarser(volume: VolumeData, factor: int) -> VolumeData:
    """The volume on the lattice whose voxels are ``factor`` times as long; it too is anchored at the origin."""
    first = np.array(volume.first_voxel)
    before = first % factor
    after = -(before + volume.count.shape) % factor
    margins = list(zip(before, after, strict=True))

    def blocks(values: np.ndarray, empty: float) -> np.ndarray:
        padded = np.pad(values, margins, constant_values=empty)
        nx, ny, nz = (length // factor for length in padded.shape)
        parts = padded.reshape(nx, factor, ny, factor, nz, factor).transpose(0, 2, 4, 1, 3, 5)
        return parts.reshape(nx, ny, nz, factor**3)

    def merged(statistic: str, values: np.ndarray) -> np.ndarray:
        if statistic == "mean":
            total = blocks(np.where(volume.occupied, values * volume.count, 0.0), 0.0).sum(axis=3)
            return np.divide(total, count, out=np.full(count.shape, np.nan), where=count > 0)
        reduce, empty = (np.fmax, -np.inf) if statistic == "maximum" else (np.fmin, np.inf)
        return np.where(count > 0, reduce.reduce(blocks(values, empty), axis=3), np.nan)

    count = blocks(volume.count, 0).sum(axis=3)
    statistics = {
        statistic: {name: merged(statistic, values) for name, values in by_index.items()}
        for statistic, by_index in volume.statistics.items()
    }
    x, y, z = (int(start) for start in first // factor)
    size = volume.voxel_size_m * factor
    return replace(volume, voxel_size_m=size, first_voxel=(x, y, z), count=count, statistics=statistics)
