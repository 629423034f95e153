"""Volume data as named arrays: what files of volumes hold."""

from collections.abc import Iterator, Mapping

import numpy as np

from wsrender.results.export.names import unique_names
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Values, Voxels, empty_array

CHUNK_BYTES = 1 << 21

BEST = "best_sample"  # of arrays, instead of a statistic: numbers of samples
CellNames = Mapping[tuple[str, str], str]


def cell_names(volume: VolumeData, taken: set[str]) -> dict[tuple[str, str], str]:
    """Name of the array of each (statistic, index), BEST among them: ``<statistic>_<index>``; ``taken`` is extended."""
    names = {}
    for statistic, by_index in cells_of(volume).items():
        for index in by_index:
            wanted = f"{statistic}_{index}"
            names[statistic, index] = unique_names([wanted], "array", taken)[wanted]
    return names


def cells_of(values: VolumeData | Voxels) -> dict[str, Values]:
    """What is held by statistic and index: dense of a volume, of voxels without the empty ones."""
    return {**values.statistics, **({BEST: values.best} if values.best else {})}


def vector_names(volume: VolumeData, taken: set[str]) -> dict[str, str]:
    """Name of the array of each vector: its own, unless that is taken; ``taken`` is extended."""
    return {name: unique_names([name], "array", taken)[name] for name in volume.vectors}


def cell_units(volume: VolumeData, names: CellNames, vectors: Mapping[str, str]) -> dict[str, str]:
    """Unit of the count and of every named array and vector; ``"1"`` where it has none."""
    units = {"count": "samples"}
    units |= {name: "1" if kind == BEST else volume.units.get(index, "1") for (kind, index), name in names.items()}
    return units | {name: volume.units.get(vector, "1") for vector, name in vectors.items()}


def cell_arrays(volume: VolumeData, names: CellNames, vectors: Mapping[str, str]) -> Iterator[tuple[str, np.ndarray]]:
    """The count and every named array, (nx, ny, nz), and vector, (nx, ny, nz, 3): each made in its turn."""
    yield "count", volume.count
    for (statistic, index), name in names.items():
        yield name, cells_of(volume)[statistic][index]
    for vector, name in vectors.items():
        yield name, volume.vectors[vector]


class Layers:
    """The voxels of a block in the order of the file, x fastest, and dense arrays of some layers of constant z."""

    def __init__(self, voxels: Voxels):
        x, y, z = voxels.at
        nx, ny, nz = voxels.shape
        self.shape = nz, ny, nx
        # The same for all arrays, so that a reader needs no chunk twice.
        self.thickness = int(np.clip(CHUNK_BYTES // max(8 * ny * nx, 1), 1, max(nz, 1)))
        cells = (z * ny + y) * nx + x
        self._order = np.argsort(cells)
        self._cells = cells[self._order]

    def chunk(self, values: np.ndarray, start: int) -> np.ndarray:
        """Values (V,) or (V, 3) in ``thickness`` layers from ``start`` on; layers past the last are empty."""
        _nz, ny, nx = self.shape
        below, size = start * ny * nx, self.thickness * ny * nx
        first, last = np.searchsorted(self._cells, [below, below + size])
        dense = empty_array((size, *values.shape[1:]), values.dtype)
        dense[self._cells[first:last] - below] = values[self._order[first:last]]
        return dense
