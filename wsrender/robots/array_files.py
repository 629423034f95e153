"""Rows of numbers in files, from strangers too: .npy, Parquet and CSV, told by what they begin with.

What a file says of its size is checked before memory is taken for it, and nothing is unpickled.
"""

import hashlib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO, StringIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy

from wsrender.documents.array_files import ArrayFile
from wsrender.documents.point_sets import HEADERS, PointSet
from wsrender.documents.quantities import quoted
from wsrender.errors import InputError
from wsrender.robots.uploaded import uploaded_content

MOST_BYTES, MOST_UNPACKED = 256 << 20, 1 << 30  # of a file, and of what Parquet makes of it
MOST_ROWS, MOST_NUMBERS = 10_000_000, 1 << 25
_HEADERS = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}
_BATCH = 1 << 16  # rows of Parquet at a time
_LINE = re.compile(r"^[ \t]*[^#\s]", re.MULTILINE)


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows of numbers (N, n) float64, and the SHA-256 of their file, hexadecimal; None where a document lists them."""

    values: np.ndarray
    sha256: str | None = None

    def provenance(self, name: str) -> dict[str, str]:
        """The file that says them."""
        return {} if self.sha256 is None else {f"{name}_sha256": self.sha256}


def rows_in(given: tuple[tuple[float, ...], ...] | ArrayFile, headers: Sequence[Sequence[str]], field: str) -> Rows:
    """Rows that a document lists, or those of a file, in which one of ``headers`` may name the columns.

    Columns with these names may stand in any order; others are taken as they stand. Raises InputError, naming
    ``field``, file and what is allowed, for anything but finite numbers in so many columns, and for too many rows.
    """
    if not isinstance(given, ArrayFile):
        return Rows(np.array(given, np.float64) if given else np.zeros((0, len(headers[0]))))
    where, name = f"{field}.path", str(given.path)
    if given.model is not None:
        where, name = f"{field}.model", f"the upload {given.model[:12]}…"
    content = content_of(given.path, given.model, where)
    width = len(headers[0])
    most = min(MOST_ROWS, MOST_NUMBERS // width)
    needed = f"rows of {width} finite numbers are needed, 1 … {most:,} of them"
    if content[:4] == b"PAR1":
        values, columns = _of_parquet(content, where, name, width, most, needed)
    elif content[:6] == npy.MAGIC_PREFIX:
        values, columns = of_npy(content, where, name, needed), []
    else:
        values, columns = _of_csv(content, where, name, needed)
    if values.shape[1] != width or not 1 <= len(values) <= most:
        raise InputError(where, f"{name} has the shape {values.shape}; {needed}")
    values = np.array(values, np.float64)
    values += 0.0  # no negative zeros, as in canonical documents
    if not (finite := np.isfinite(values)).all():
        row, column = (int(k) for k in np.unravel_index(np.argmin(finite), finite.shape))
        said = columns[column] if columns else column + 1
        found = f"must be a finite number, not {values[row, column]:g}"
        raise InputError(where, f"{name}, row {row + 1}, column {said}: {found}")
    order = _order(columns, headers, where, name)
    return Rows(np.ascontiguousarray(values[:, order]), hashlib.sha256(content).hexdigest())


def listed_points(sources: Mapping[str, Any]) -> dict[str, Rows]:
    """The points (N, 3) [m] of those parts of a document that are sets of points, by field. Raises InputError."""
    return {name: rows_in(of.given, HEADERS, name) for name, of in sources.items() if isinstance(of, PointSet)}


def listed_provenance(listed: Mapping[str, Rows]) -> dict[str, str]:
    """The files of points, by field."""
    return {name: sha for field, rows in listed.items() for name, sha in rows.provenance(field).items()}


def content_of(path: str | None, model: str | None, field: str) -> bytes:
    """The bytes of a file given by path, or uploaded. Raises InputError where it cannot be had or is too large."""
    if model is not None:
        return uploaded_content(model, field)
    file = Path(str(path))
    try:
        if file.stat().st_size > MOST_BYTES:
            raise InputError(field, f"{path} has more than {MOST_BYTES >> 20} MiB")
        return file.read_bytes()
    except OSError as error:
        raise InputError(field, f"{path} cannot be read: {error.strerror}") from None


def of_npy(content: bytes, field: str, name: str, needed: str) -> np.ndarray:
    """The array (N, n) of a .npy file, of its own type, read where it lies; all of its numbers must be there.

    Raises InputError, with what is ``needed``, for anything but numbers of up to 64 bits in two dimensions.
    """
    file = BytesIO(content)
    try:
        version = npy.read_magic(file)
        if version not in _HEADERS:
            raise ValueError(f"version {version[0]}.{version[1]} is of no array of numbers")
        shape, columns_first, dtype = _HEADERS[version](file)
    except Exception as error:  # its reader raises whatever it stumbles over
        raise InputError(field, f"{name} cannot be read as an array of NumPy (.npy): {error}") from None
    if dtype.kind not in "fiu" or dtype.itemsize > 8 or len(shape) != 2 or min(shape) < 0:
        raise InputError(field, f"{name} has the shape {shape} of {dtype}; {needed}")
    there, said = len(content) - file.tell(), shape[0] * shape[1] * dtype.itemsize
    if there != said:
        message = f"its header says {said} bytes of numbers, there are {there}"
        raise InputError(field, f"{name} cannot be read as an array of NumPy (.npy): {message}")
    flat = np.frombuffer(content, dtype, shape[0] * shape[1], file.tell())
    return flat.reshape(shape, order="F" if columns_first else "C")


def open_parquet(content: bytes, field: str, name: str, texts: Sequence[str] = ()) -> tuple[Any, list[str]]:
    """A Parquet file that does not unpack to too much, and its columns; ``texts``: those that may be of text.

    Raises InputError.
    """
    from pyarrow import parquet

    try:
        there = [column for column in parquet.read_schema(BytesIO(content)).names if column in texts]
        file = parquet.ParquetFile(BytesIO(content), read_dictionary=there)
        columns, metadata = file.schema_arrow.names, file.metadata
    except Exception as error:  # its reader raises whatever it stumbles over
        raise InputError(field, f"{name} cannot be read as Parquet: {error}") from None
    unpacked = sum(metadata.row_group(k).total_byte_size for k in range(metadata.num_row_groups))
    if unpacked > MOST_UNPACKED:
        raise InputError(field, f"{name} holds {unpacked >> 20} MiB unpacked; at most {MOST_UNPACKED >> 20} MiB")
    # pandas keeps the index of a table's rows as a column of its own
    return file, [column for column in columns if not column.startswith("__index_level_")]


def _of_parquet(
    content: bytes, field: str, name: str, width: int, most: int, needed: str
) -> tuple[np.ndarray, list[str]]:
    """Numbers of the columns, NaN where there is none."""
    import pyarrow

    file, columns = open_parquet(content, field, name)
    rows = file.metadata.num_rows
    if len(columns) != width or not 1 <= rows <= most:
        raise InputError(field, f"{name} has the shape ({rows}, {len(columns)}); {needed}")
    for column in columns:
        if columns.count(column) > 1:
            raise InputError(field, f'{name} has the column "{column[:60]}" twice')
        kind = file.schema_arrow.field(column).type
        if not (pyarrow.types.is_floating(kind) or pyarrow.types.is_integer(kind)):
            raise InputError(field, f"{name}, column {column}: must hold numbers, not {kind}")
    try:
        parts, count = [], 0
        for batch in file.iter_batches(_BATCH, columns=columns):
            count += len(batch)
            if count > rows:
                break
            parts.append(np.column_stack([batch[column].cast("float64").to_numpy(False) for column in columns]))
    except (pyarrow.ArrowException, OSError, MemoryError) as error:
        raise InputError(field, f"{name} cannot be read as Parquet: {error}") from None
    if count != rows:
        raise InputError(field, f"{name} cannot be read as Parquet: it says {rows} rows, and has others")
    return np.concatenate(parts), columns


def _of_csv(content: bytes, field: str, name: str, needed: str) -> tuple[np.ndarray, list[str]]:
    """Numbers of the lines below a header, if there is one."""
    if content.count(b",") + content.count(b"\n") > MOST_NUMBERS:
        raise InputError(field, f"{name} holds more than {MOST_NUMBERS:,} numbers; {needed}")
    try:
        text = content.decode("utf-8-sig").strip()
        columns = [cell.strip() for cell in text.partition("\n")[0].lstrip("# ").split(",")]
        header = not all(map(_is_number, columns))
        text = text.partition("\n")[2] if header else text
        if not _LINE.search(text):
            raise ValueError(f"it holds none; {needed}")
        values = np.loadtxt(StringIO(text), delimiter=",", ndmin=2)
    except ValueError as error:
        raise InputError(field, f"{name} cannot be read as .npy, Parquet or CSV: {str(error)[:200]}") from None
    if header and len(columns) != values.shape[1]:
        raise InputError(field, f"{name} has {len(columns)} columns in its header, {values.shape[1]} below")
    return values, columns if header else []


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _order(columns: list[str], headers: Sequence[Sequence[str]], field: str, name: str) -> list[int]:
    """Which column is which: by their names, or as they stand where none is known."""
    for header in headers:
        if sorted(columns) == sorted(header):
            return [columns.index(each) for each in header]
        if known := [column for column in columns if column in header]:
            message = f"{name} has the columns {quoted(column[:60] for column in columns)}, of which only"
            raise InputError(field, f"{message} {quoted(known)} are known; allowed: {quoted(header)}, or no such names")
    return [*range(len(headers[0]))]
