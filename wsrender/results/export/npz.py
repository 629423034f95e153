"""Maps, tables and volumes ↔ NumPy's npz: one plain array per column or statistic, never a pickle.

The array ``wsrender`` holds a description as JSON text: names, units and frame.
"""

import json
import zipfile
import zlib
from collections.abc import Iterable
from itertools import chain
from pathlib import Path

import numpy as np

from wsrender.errors import InputError
from wsrender.results.export.atomic import new_file
from wsrender.results.export.cells import BEST, cell_arrays, cell_names, vector_names
from wsrender.results.export.columns import DESCRIPTION, arrays_by_column, columns_from_json, columns_of
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData


def write_table_npz(data: DistributionMap | Table, path: str | Path) -> None:
    """Write a map or table as one array (N,) per column, named as in Parquet; of cells in the shape of their grid."""
    columns, shape = columns_of(data), (len(data),)
    if isinstance(data, Table) and data.grid:
        shape = data.grid.shape
    arrays = ((name, array.reshape(shape)) for name, array in arrays_by_column(data, columns).items())
    _write(path, columns.to_json(), arrays)


def read_table_npz(path: str | Path) -> DistributionMap | Table:
    """Read the map or table that ``write_table_npz`` wrote; InputError where the file is none or damaged."""
    description, arrays = _read(Path(path))
    columns = columns_from_json(description, Path(path).name)
    missing = set(columns.names()) - set(arrays)
    if missing:
        raise InputError(Path(path).name, f"lacks the arrays {', '.join(sorted(missing))}")
    return columns.restored(lambda names: np.stack([arrays[name].ravel() for name in names], axis=1))


def write_volume_npz(volume: VolumeData, path: str | Path) -> None:
    """Write volume data: ``count`` and ``<statistic>_<index>``, each (nx, ny, nz); vectors (nx, ny, nz, 3)."""
    taken = {"count", DESCRIPTION}
    names, vectors = cell_names(volume, taken), vector_names(volume, taken)
    description = {
        "frame": "world",
        "voxel_size_m": float(volume.voxel_size_m),
        "first_voxel": [int(i) for i in volume.first_voxel],
        "arrays": [[statistic, index, name] for (statistic, index), name in names.items()],
        "vectors": vectors,
        "units": volume.units,
    }
    _write(path, json.dumps(description), cell_arrays(volume, names, vectors))


def read_volume_npz(path: str | Path) -> VolumeData:
    """Read volume data that ``write_volume_npz`` wrote; InputError where the file is none or damaged."""
    path = Path(path)
    text, arrays = _read(path)
    try:
        description = json.loads(text)
        statistics: dict[str, dict[str, np.ndarray]] = {}
        for statistic, index, name in description["arrays"]:
            statistics.setdefault(statistic, {})[index] = arrays[name]
        best = statistics.pop(BEST, {})
        return VolumeData(
            voxel_size_m=description["voxel_size_m"],
            first_voxel=tuple(description["first_voxel"]),
            count=arrays["count"],
            statistics=statistics,
            units=description["units"],
            vectors={vector: arrays[name] for vector, name in description["vectors"].items()},
            best=best,
        )
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(path.name, f"is not volume data of wsrender: {error!r}") from error


def _write(path: str | Path, description: str, arrays: Iterable[tuple[str, np.ndarray]]) -> None:
    # Not np.savez: it takes the names as keyword arguments, so an index called "file" would fail.
    with (
        new_file(path) as temporary,
        zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as file,
    ):
        for name, array in chain([(DESCRIPTION, np.array(description))], arrays):
            with file.open(f"{name}.npy", "w", force_zip64=True) as member:
                np.lib.format.write_array(member, np.asarray(array), allow_pickle=False)


def _read(path: Path) -> tuple[str, dict[str, np.ndarray]]:
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        return str(arrays.pop(DESCRIPTION)), arrays
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(path.name, f"cannot be read as a file of wsrender: {error}") from error
