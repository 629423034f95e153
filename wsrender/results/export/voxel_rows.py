"""The occupied voxels of a volume as rows: what its CSV and Parquet files hold."""

from collections.abc import Iterator

import numpy as np
import pyarrow as pa

from wsrender.results.export.cells import cell_names, cell_units, cells_of
from wsrender.results.export.names import unique_names
from wsrender.volume.volume_data import VolumeData

LATTICE = ("i", "j", "k")
CENTER = ("x", "y", "z")


class VoxelRows:
    """Rows of the occupied voxels, z fastest.

    Columns ``i``, ``j``, ``k`` (lattice index), ``x``, ``y``, ``z`` (centre [m], world frame), ``count``
    and ``<statistic>_<index>``; vectors as ``<name>_x``, ``<name>_y``, ``<name>_z``. Fields have their unit.
    """

    def __init__(self, volume: VolumeData):
        self._volume = volume
        taken = {*LATTICE, *CENTER, "count"}
        names = cell_names(volume, taken)
        self._voxels = voxels = volume.voxels.among(volume.voxels.count > 0)
        parts = {(name, axis): vector[:, k] for name, vector in voxels.vectors.items() for k, axis in enumerate(CENTER)}
        free = unique_names([f"{name}_{axis}" for name, axis in parts], "array", taken)
        statistics = {name: cells_of(voxels)[kind][index] for (kind, index), name in names.items()}
        vectors = {free[f"{name}_{axis}"]: values for (name, axis), values in parts.items()}
        self._arrays = {"count": voxels.count, **statistics, **vectors}
        units = dict.fromkeys(LATTICE, "1") | dict.fromkeys(CENTER, "m")
        units |= cell_units(volume, names, {})
        units |= {free[f"{name}_{axis}"]: volume.units.get(name, "1") for name, axis in parts}
        types = dict.fromkeys(LATTICE, pa.int64()) | dict.fromkeys(CENTER, pa.float64())
        types |= {name: pa.from_numpy_dtype(array.dtype) for name, array in self._arrays.items()}
        self.schema = pa.schema(
            [pa.field(name, kind, nullable=False, metadata={"unit": units[name]}) for name, kind in types.items()]
        )

    def batches(self, rows: int) -> Iterator[pa.RecordBatch]:
        """All rows, so many at a time."""
        for start in range(0, len(self._voxels.cells), rows):
            part = slice(start, start + rows)
            cell = self._voxels.among(part).at
            voxel = [first + along for first, along in zip(self._volume.first_voxel, cell, strict=True)]
            centers = [self._volume.centers(axis)[cell[axis]] for axis in range(3)]
            arrays = [*voxel, *centers, *(array[part] for array in self._arrays.values())]
            columns = [pa.array(np.ascontiguousarray(array)) for array in arrays]
            yield pa.RecordBatch.from_arrays(columns, schema=self.schema)
