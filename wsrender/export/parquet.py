"""Distribution map ↔ Parquet: plain columns, no dictionary, zstd, byte-stream-split.

Columns are ``x``, ``y``, ``z`` [m, world frame], the joint values by joint name, ``qw``, ``qx``, ``qy``,
``qz`` and one per index. Units, frame and roles stand in the schema metadata under ``wsrender``, as JSON.
"""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from wsrender.errors import InputError
from wsrender.export.atomic import new_file
from wsrender.export.columns import DESCRIPTION, MapColumns, arrays_by_column, map_from_columns
from wsrender.volume.distribution_map import DistributionMap

ROWS_PER_GROUP = 1 << 18
_METADATA_KEY = DESCRIPTION.encode()


def write_map_parquet(samples: DistributionMap, path: str | Path) -> None:
    """Write a map; each row group holds 2¹⁸ rows, so memory does not grow with their number."""
    columns = MapColumns.of(samples)
    arrays = arrays_by_column(samples, columns)
    schema = _schema(columns, arrays)
    with (
        new_file(path) as temporary,
        pq.ParquetWriter(
            temporary, schema, compression="zstd", use_dictionary=False, use_byte_stream_split=True
        ) as writer,
    ):
        for start in range(0, len(samples), ROWS_PER_GROUP):
            rows = slice(start, start + ROWS_PER_GROUP)
            batch = [pa.array(np.ascontiguousarray(arrays[name][rows])) for name in schema.names]
            writer.write_batch(pa.RecordBatch.from_arrays(batch, schema=schema))


def _schema(columns: MapColumns, arrays: dict[str, np.ndarray]) -> pa.Schema:
    units = columns.column_units()
    types = {name: pa.from_numpy_dtype(arrays[name].dtype) for name in columns.names()}
    fields = [pa.field(name, kind, nullable=False, metadata={"unit": units[name]}) for name, kind in types.items()]
    return pa.schema(fields, metadata={_METADATA_KEY: columns.to_json()})


def read_map_parquet(path: str | Path) -> DistributionMap:
    """Read a map that ``write_map_parquet`` wrote, row group by row group.

    Raises InputError where the file is not Parquet, not a distribution map or damaged.
    """
    path = Path(path)
    try:
        with pq.ParquetFile(path) as file:
            return _read(file, path.name)
    except (pa.ArrowException, OSError) as error:
        raise InputError(path.name, f"cannot be read as a distribution map: {error}") from error


def _read(file: pq.ParquetFile, source: str) -> DistributionMap:
    schema = file.schema_arrow
    metadata = schema.metadata or {}
    if _METADATA_KEY not in metadata:
        raise InputError(source, "is a Parquet file, but not a distribution map written by wsrender")
    columns = MapColumns.from_json(metadata[_METADATA_KEY], source)
    missing = set(columns.names()) - set(schema.names)
    if missing:
        raise InputError(source, f"lacks the columns {', '.join(sorted(missing))}")
    return map_from_columns(columns, lambda names: _block(file, list(names)))


def _block(file: pq.ParquetFile, names: Iterable[str]) -> np.ndarray:
    """Columns of one dtype as an array (N, c)."""
    names = list(names)
    dtype = file.schema_arrow.field(names[0]).type.to_pandas_dtype()
    block = np.empty((file.metadata.num_rows, len(names)), dtype)
    start = 0
    for batch in file.iter_batches(ROWS_PER_GROUP, columns=names):
        stop = start + batch.num_rows
        for k, name in enumerate(names):
            block[start:stop, k] = batch.column(name).to_numpy(zero_copy_only=False)
        start = stop
    return block
