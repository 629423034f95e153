"""Maps, tables and volumes for MATLAB (version 5 MAT files, which GNU Octave and SciPy read too)."""

import re
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import savemat

from wsrender.results.export.atomic import new_file
from wsrender.results.export.cells import cell_arrays, cell_names, cell_units, vector_names
from wsrender.results.export.columns import arrays_by_column, columns_of
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

_HEADER = b"MATLAB 5.0 MAT-file, written by wsrender".ljust(116)


def write_table_mat(data: DistributionMap | Table, path: str | Path) -> None:
    """Write a map or table as one column vector (N, 1) per column, named as in Parquet but as MATLAB allows."""
    columns = columns_of(data)
    arrays = arrays_by_column(data, columns)
    _write(path, arrays, columns.column_units())


def write_volume_mat(volume: VolumeData, path: str | Path) -> None:
    """Write ``count``, ``<statistic>_<index>`` (nx, ny, nz), vectors (nx, ny, nz, 3), origin_m and voxel_size_m."""
    taken = {"count", "origin_m", "voxel_size_m"}
    names, vectors = cell_names(volume, taken), vector_names(volume, taken)
    arrays = dict(cell_arrays(volume, names, vectors))
    arrays |= {"origin_m": volume.origin_m, "voxel_size_m": np.array(volume.voxel_size_m)}
    _write(path, arrays, cell_units(volume, names, vectors))


def _write(path: str | Path, arrays: dict[str, np.ndarray], units: dict[str, str]) -> None:
    taken = {"units"}
    identifiers = {name: _identifier(name, taken) for name in arrays}
    variables: dict[str, Any] = {identifiers[name]: array for name, array in arrays.items()}
    variables["units"] = {identifiers[name]: unit for name, unit in units.items()}
    with new_file(path) as temporary, temporary.open("wb") as file:
        savemat(file, variables, long_field_names=True, oned_as="column", do_compression=True)
        file.seek(0)
        file.write(_HEADER)  # SciPy writes the time here


def _identifier(name: str, taken: set[str]) -> str:
    """A MATLAB identifier of at most 63 characters that is not in ``taken``, which is extended."""
    letters = re.sub(r"\W", "_", name, flags=re.ASCII)
    identifier = letters if letters[:1].isalpha() else f"v_{letters}"
    stem, number = identifier[:60], 2
    identifier = identifier[:63]
    while identifier in taken:
        identifier, number = f"{stem}_{number}", number + 1
    taken.add(identifier)
    return identifier
