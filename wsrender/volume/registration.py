"""Volumes of several robots on one block of the lattice."""

from collections.abc import Sequence

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
    end = np.max([np.add(volume.first_voxel, volume.shape) for volume in volumes], axis=0)
    (x, y, z), (nx, ny, nz) = first.tolist(), (end - first).tolist()
    return [
        VolumeData.of_voxels(
            volume.voxel_size_m,
            (x, y, z),
            volume.voxels.moved((nx, ny, nz), np.subtract(volume.first_voxel, first)),
            volume.units,
        )
        for volume in volumes
    ]
