"""Maps, tables and volumes as CSV: a quoted header, then one row per sample or per occupied voxel."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv

from wsrender.results.export.atomic import new_file
from wsrender.results.export.column_type import column_type
from wsrender.results.export.columns import arrays_by_column, columns_of
from wsrender.results.export.voxel_rows import VoxelRows
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
            batch = [pa.array(np.ascontiguousarray(arrays[name][rows])) for name in columns.names()]
            writer.write_batch(pa.RecordBatch.from_arrays(batch, schema=schema))


def write_volume_csv(volume: VolumeData, path: str | Path) -> None:
    """Write the occupied voxels, z fastest; columns as of `VoxelRows`."""
    rows = VoxelRows(volume)
    with new_file(path) as temporary, pyarrow.csv.CSVWriter(temporary, rows.schema) as writer:
        for batch in rows.batches(ROWS_PER_BLOCK):
            writer.write_batch(batch)
