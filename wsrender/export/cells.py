"""Volume data as named arrays: what npz, CSV and MATLAB files hold."""

from collections.abc import Iterator, Mapping

import numpy as np

from wsrender.export.names import unique_names
from wsrender.volume.volume_data import VolumeData

CellNames = Mapping[tuple[str, str], str]


def cell_names(volume: VolumeData, taken: set[str]) -> dict[tuple[str, str], str]:
    """Name of the array of each (statistic, index): ``<statistic>_<index>``; ``taken`` is extended."""
    names = {}
    for statistic, by_index in volume.statistics.items():
        for index in by_index:
            wanted = f"{statistic}_{index}"
            names[statistic, index] = unique_names([wanted], "array", taken)[wanted]
    return names


def vector_names(volume: VolumeData, taken: set[str]) -> dict[str, str]:
    """Name of the array of each vector: its own, unless that is taken; ``taken`` is extended."""
    return {name: unique_names([name], "array", taken)[name] for name in volume.vectors}


def cell_arrays(
    volume: VolumeData, names: CellNames, vectors: Mapping[str, str] | None = None
) -> Iterator[tuple[str, np.ndarray]]:
    """The count and every named array, (nx, ny, nz), and vector, (nx, ny, nz, 3): each made in its turn."""
    yield "count", volume.count
    for (statistic, index), name in names.items():
        yield name, volume.statistics[statistic][index]
    for vector, name in (vectors or {}).items():
        yield name, volume.vectors[vector]
