"""Volumes of several robots on one block of the lattice."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from wsrender.errors import InputError
from wsrender.volume.volume_data import VolumeData


def registered(volumes: Sequence[VolumeData]) -> list[VolumeData]:
    """The same volumes, each on the smallest block that holds all of them.

    Raises InputError for volumes of different voxel sizes.
    """
    if len({volume.voxel_size_m for volume in volumes}) > 1:
        sizes = ", ".join(f"{volume.voxel_size_m:g}" for volume in volumes)
        raise InputError("voxel_size_m", f"must be the same for all volumes, not {sizes}")
    first = np.min([volume.first_voxel for volume in volumes], axis=0)
    end = np.max([np.add(volume.first_voxel, volume.count.shape) for volume in volumes], axis=0)
    return [_on_block(volume, first, end - first) for volume in volumes]


def _on_block(volume: VolumeData, first: np.ndarray, shape: np.ndarray) -> VolumeData:
    before = np.subtract(volume.first_voxel, first)
    widths = list(zip(before, shape - before - volume.count.shape, strict=True))
    statistics = {
        statistic: {name: np.pad(values, widths, constant_values=np.nan) for name, values in by_index.items()}
        for statistic, by_index in volume.statistics.items()
    }
    x, y, z = (int(at) for at in first)
    return replace(volume, first_voxel=(x, y, z), count=np.pad(volume.count, widths), statistics=statistics)
