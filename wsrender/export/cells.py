"""Volume data as named arrays: what npz, CSV and MATLAB files hold."""

import numpy as np

from wsrender.errors import InputError
from wsrender.export.names import unique_names
from wsrender.volume.volume_data import VolumeData


def cell_names(volume: VolumeData, taken: set[str]) -> dict[tuple[str, str], str]:
    """Name of the array of each (statistic, index): ``<statistic>_<index>``; ``taken`` is extended."""
    names = {}
    for statistic, by_index in volume.statistics.items():
        for index in by_index:
            wanted = f"{statistic}_{index}"
            names[statistic, index] = unique_names([wanted], "array", taken)[wanted]
    return names


def vector_array(volume: VolumeData, name: str) -> np.ndarray:
    """One vector per voxel, (nx, ny, nz, 3); InputError where its shape is not that of the count."""
    array = np.asarray(volume.vectors[name])
    if array.shape != (*volume.count.shape, 3):
        raise InputError(f"vectors.{name}", f"has shape {array.shape}; the volume has {volume.count.shape}")
    return array


def vector_names(volume: VolumeData, taken: set[str]) -> dict[str, str]:
    """Name of the array of each vector: its own, unless that is taken; ``taken`` is extended."""
    return {name: unique_names([name], "array", taken)[name] for name in volume.vectors}


def cell_array(volume: VolumeData, statistic: str, index: str) -> np.ndarray:
    """One statistic of one index, (nx, ny, nz); InputError where its shape is not that of the count."""
    array = np.asarray(volume.statistics[statistic][index])
    if array.shape != volume.count.shape:
        field = f"statistics.{statistic}.{index}"
        raise InputError(field, f"has shape {array.shape}; the volume has {volume.count.shape}")
    return array
