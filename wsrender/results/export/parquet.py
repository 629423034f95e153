"""Distribution maps and tables ↔ Parquet, volumes → Parquet: plain columns, no dictionary, zstd, byte-stream-split.

Columns of a map are ``x``, ``y``, ``z`` [m, world frame], the joint values by joint name, ``qw``, ``qx``, ``qy``,
``qz`` and one per index. Units and roles stand in the schema metadata under ``wsrender``, as JSON.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from wsrender.errors import InputError
from wsrender.results.export.atomic import new_file
from wsrender.results.export.column_type import column_type
from wsrender.results.export.columns import DESCRIPTION, MapColumns, arrays_by_column, columns_from_json, columns_of
from wsrender.results.export.voxel_rows import VoxelRows
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

ROWS_PER_GROUP = 1 << 18
_METADATA_KEY = DESCRIPTION.encode()


def write_table_parquet(data: DistributionMap | Table, path: str | Path) -> None:
    """Write a map or table; each row group holds 2¹⁸ rows, so memory does not grow with their number."""
    columns = columns_of(data)
    arrays = arrays_by_column(data, columns)
    schema = _schema(columns, arrays)
    with new_file(path) as temporary, _writer(temporary, schema) as writer:
        for start in range(0, len(data), ROWS_PER_GROUP):
            rows = slice(start, start + ROWS_PER_GROUP)
            batch = [pa.array(np.ascontiguousarray(arrays[name][rows])) for name in schema.names]
            writer.write_batch(pa.RecordBatch.from_arrays(batch, schema=schema))


def write_volume_parquet(volume: VolumeData, path: str | Path) -> None:
    """Write the occupied voxels, z fastest; columns as of `VoxelRows`, their unit in the metadata of each field."""
    rows = VoxelRows(volume)
    with new_file(path) as temporary, _writer(temporary, rows.schema) as writer:
        for batch in rows.batches(ROWS_PER_GROUP):
            writer.write_batch(batch)


def _writer(path: Path, schema: pa.Schema) -> pq.ParquetWriter:
    """Byte-stream-split is for numbers."""
    numbers: Any = [f.name for f in schema if pa.types.is_integer(f.type) or pa.types.is_floating(f.type)]
    # The type stubs know truth values only.
    return pq.ParquetWriter(path, schema, compression="zstd", use_dictionary=False, use_byte_stream_split=numbers)


def _schema(columns: Any, arrays: dict[str, np.ndarray]) -> pa.Schema:
    units = columns.column_units()
    types = {name: column_type(arrays[name]) for name in columns.names()}
    fields = [pa.field(name, kind, nullable=False, metadata={"unit": units[name]}) for name, kind in types.items()]
    return pa.schema(fields, metadata={_METADATA_KEY: columns.to_json()})


def read_table_parquet(path: str | Path) -> DistributionMap | Table:
    """Read the map or table that ``write_table_parquet`` wrote, row group by row group.

    Raises InputError where the file is not Parquet, not of wsrender or damaged.
    """
    with _opened(path) as file:
        return _read(file, Path(path).name)


def rows_in(path: str | Path) -> tuple[int, dict[str, str]]:
    """How many rows a map or table has, and the unit of each column ("1": none), by the file's end alone."""
    with _opened(path) as file:
        units = {field.name: (field.metadata or {}).get(b"unit", b"1").decode() for field in file.schema_arrow}
        return file.metadata.num_rows, units


def read_rows(path: str | Path, names: Sequence[str], start: int, stop: int) -> pa.Table:
    """Some columns of the rows ``start`` to ``stop`` of a map or table; other row groups are not read."""
    with _opened(path) as file:
        found, first = [file.schema_arrow.empty_table().select(names)], 0
        for group in range(file.num_row_groups):
            end = first + file.metadata.row_group(group).num_rows
            if start < end and first < stop:
                part = file.read_row_group(group, columns=list(names)).select(names)
                found.append(part.slice(max(start - first, 0), min(stop, end) - max(start, first)))
            first = end
        return pa.concat_tables(found)


def index_values(path: str | Path, index: str | None = None) -> tuple[str, str, np.ndarray]:
    """Name, unit and values (N,) of an index of a map, the first by default; no other column is read.

    Raises InputError for an index that the map does not have.
    """
    with _opened(path) as file:
        columns = columns_from_json((file.schema_arrow.metadata or {})[_METADATA_KEY], Path(path).name)
        held = columns.indices if isinstance(columns, MapColumns) else {}
        name = next(iter(held), None) if index is None else index
        if name is None or name not in held:
            raise InputError("index", f"the samples have no {name or 'index'}; they have {', '.join(held) or 'none'}")
        return name, columns.units.get(name, ""), _block(file, [held[name]])[:, 0]


@contextmanager
def _opened(path: str | Path) -> Iterator[pq.ParquetFile]:
    """A file of ``write_table_parquet``. Raises InputError."""
    path = Path(path)
    try:
        with pq.ParquetFile(path) as file:
            if _METADATA_KEY not in (file.schema_arrow.metadata or {}):
                raise InputError(path.name, "is a Parquet file, but not a map or table written by wsrender")
            yield file
    except (pa.ArrowException, OSError) as error:
        raise InputError(path.name, f"cannot be read as a table: {error}") from error


def _read(file: pq.ParquetFile, source: str) -> DistributionMap | Table:
    schema = file.schema_arrow
    columns = columns_from_json(schema.metadata[_METADATA_KEY], source)
    missing = set(columns.names()) - set(schema.names)
    if missing:
        raise InputError(source, f"lacks the columns {', '.join(sorted(missing))}")
    return columns.restored(lambda names: _block(file, list(names)))


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
