"""Maps, tables and volumes as CSV: a quoted header, then one row per sample or per occupied voxel."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv

from wsrender.results.export.atomic import new_file
from wsrender.results.export.cells import cell_names
from wsrender.results.export.column_type import column_type
from wsrender.results.export.columns import arrays_by_column, columns_of
from wsrender.results.export.names import unique_names
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

ROWS_PER_BLOCK = 1 << 18


def write_table_csv(data: DistributionMap | Table, path: str | Path) -> None:
    """Write a map or table; columns as in Parquet, values with the digits that restore them exactly."""
    columns = columns_of(data)
    arrays = arrays_by_column(data, columns)
    schema = pa.schema([(name, column_type(arrays[name])) for name in columns.names()])
    with new_file(path) as temporary, pyarrow.csv.CSVWriter(temporary, schema) as writer:
        for start in range(0, len(data), ROWS_PER_BLOCK):
            rows = slice(start, start + ROWS_PER_BLOCK)
            writer.write_batch(_batch([arrays[name][rows] for name in columns.names()], schema))


def write_volume_csv(volume: VolumeData, path: str | Path) -> None:
    """Write the occupied voxels, z fastest.

    Columns ``i``, ``j``, ``k`` (lattice index), ``x``, ``y``, ``z`` (centre [m], world frame), ``count``
    and ``<statistic>_<index>``; vectors as ``<name>_x``, ``<name>_y``, ``<name>_z``.
    """
    lattice = ("i", "j", "k", "x", "y", "z", "count")
    taken: set[str] = set(lattice)
    names = cell_names(volume, taken)
    voxels = volume.voxels.among(volume.voxels.count > 0)
    parts = {f"{name}_{axis}": vector[:, k] for name, vector in voxels.vectors.items() for k, axis in enumerate("xyz")}
    components = {name: parts[part] for part, name in unique_names(parts, "array", taken).items()}
    values = [voxels.statistics[statistic][index] for statistic, index in names]
    arrays = [voxels.count, *values, *components.values()]
    types = [pa.int64()] * 3 + [pa.float64()] * 3 + [pa.from_numpy_dtype(array.dtype) for array in arrays]
    header = [*lattice, *names.values(), *components]
    schema = pa.schema(list(zip(header, types, strict=True)))
    with new_file(path) as temporary, pyarrow.csv.CSVWriter(temporary, schema) as writer:
        for start in range(0, len(voxels.cells), ROWS_PER_BLOCK):
            rows = slice(start, start + ROWS_PER_BLOCK)
            cell = voxels.among(rows).at
            voxel = [first + along for first, along in zip(volume.first_voxel, cell, strict=True)]
            centers = [volume.centers(axis)[cell[axis]] for axis in range(3)]
            writer.write_batch(_batch([*voxel, *centers, *(array[rows] for array in arrays)], schema))


def _batch(arrays: list[np.ndarray], schema: pa.Schema) -> pa.RecordBatch:
    return pa.RecordBatch.from_arrays([pa.array(np.ascontiguousarray(a)) for a in arrays], schema=schema)
