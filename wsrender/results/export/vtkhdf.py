"""Volume data ↔ VTKHDF ImageData, which ParaView, VTK, MATLAB and h5py open.

Format: VTK's *VTKHDF File Format*, ImageData. Cell arrays ``count`` and ``<statistic>_<index>`` have shape
(nz, ny, nx), vectors (nz, ny, nx, 3), NaN in empty voxels; ``Origin`` and ``Spacing`` are in metres in the world
frame. Units stand in the attribute ``unit`` of each array. The file holds no time stamps.
"""

import json
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import ArrayLike

from wsrender.errors import InputError
from wsrender.results.export.atomic import new_file
from wsrender.results.export.cells import BEST, Layers, cell_names, cell_units, cells_of, vector_names
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

LENGTHS = ("x_m", "y_m", "z_m")
_COMPRESSION_LEVEL = 1  # voxel values are mostly noise in their low bits: higher levels gain little


def write_volume_vtkhdf(volume: VolumeData, path: str | Path) -> None:
    """Write volume data as one ImageData with cell arrays."""
    taken = {"count"}
    names, vectors = cell_names(volume, taken), vector_names(volume, taken)
    units = cell_units(volume, names, vectors)
    layers = Layers(volume.voxels)
    with new_file(path) as temporary, h5py.File(temporary, "w") as file:
        root = _image(file, volume.shape, volume.origin_m, np.full(3, volume.voxel_size_m))
        root.attrs["first_voxel"] = np.array(volume.first_voxel, np.int64)
        root.attrs["frame"] = "world"
        root.attrs["units"] = json.dumps(volume.units)
        cells = root.create_group("CellData", track_order=True)
        _write_array(cells, "count", layers, volume.voxels.count).attrs["unit"] = units["count"]
        for (statistic, index), name in names.items():
            dataset = _write_array(cells, name, layers, cells_of(volume.voxels)[statistic][index])
            dataset.attrs.update({"statistic": statistic, "index": index, "unit": units[name]})
        for vector, name in vectors.items():
            dataset = _write_array(cells, name, layers, volume.voxels.vectors[vector])
            dataset.attrs.update({"vector": vector, "unit": units[name]})


def write_cells_vtkhdf(table: Table, path: str | Path) -> None:
    """Write a map of at most three axes as one ImageData: cell arrays of its columns of numbers, named as they are.

    Lengths x, y and z [m] are axes of the same names; others, which may be angles, take those that are left. An axis
    that the map has not is one cell thick, around 0. Attribute ``axes``: columns of the axes x, y, z, empty for none.
    """
    grid = table.grid
    assert grid and len(grid.axes) <= 3
    own = {name: "xyz".index(name[0]) for name in grid.axes if name in LENGTHS}
    left = [k for k in range(3) if k not in own.values()]
    at = [own[name] if name in own else left.pop(0) for name in grid.axes]
    shape, spacing, axes = np.ones(3, int), np.full(3, float(min(grid.step))), np.full(3, "", "<U32")
    origin = -spacing / 2
    shape[at], spacing[at], origin[at], axes[at] = grid.shape, grid.step, grid.origin, grid.axes
    with new_file(path) as temporary, h5py.File(temporary, "w") as file:
        root = _image(file, shape, origin, spacing)
        root.attrs["frame"], root.attrs["axes"] = grid.frame, json.dumps(axes.tolist())
        cells = root.create_group("CellData", track_order=True)
        for name, column in table.columns.items():
            if column.dtype.kind in "iuf" and name not in grid.axes:
                values = column.reshape(*grid.shape, *[1] * len(left), *column.shape[1:])
                values = np.moveaxis(values, (0, 1, 2), (*at, *left)).swapaxes(0, 2)
                dataset = cells.create_dataset(name, data=values, compression="gzip", track_times=False)
                dataset.attrs["unit"] = table.units.get(name, "1")


def _image(file: h5py.File, shape: ArrayLike, origin: ArrayLike, spacing: np.ndarray) -> h5py.Group:
    root = file.create_group("VTKHDF")
    root.attrs.create("Version", np.array([1, 0], np.int64))
    root.attrs.create("Type", b"ImageData", dtype=h5py.string_dtype("ascii", 9))
    root.attrs["WholeExtent"] = np.array([bound for size in np.asarray(shape) for bound in (0, size)], np.int64)
    root.attrs["Origin"] = np.asarray(origin, np.float64)
    root.attrs["Spacing"] = np.asarray(spacing, np.float64)
    root.attrs["Direction"] = np.eye(3).ravel()
    return root


def _write_array(group: h5py.Group, name: str, layers: Layers, values: np.ndarray) -> h5py.Dataset:
    """Write the array of values (V,) or (V, 3) in slabs of constant z, compressed in parallel."""
    shape = (*layers.shape, *values.shape[1:])
    if 0 in shape:
        return group.create_dataset(name, shape=shape, dtype=values.dtype, track_times=False)
    dataset = group.create_dataset(
        name,
        shape=shape,
        dtype=values.dtype,
        chunks=(layers.thickness, *shape[1:]),
        shuffle=True,
        compression="gzip",
        compression_opts=_COMPRESSION_LEVEL,
        track_times=False,
    )
    starts = range(0, shape[0], layers.thickness)
    with ThreadPoolExecutor() as pool:  # zlib releases the interpreter's lock
        chunks = pool.map(lambda start: _compressed(layers.chunk(values, start)), starts)
        for start, chunk in zip(starts, chunks, strict=True):
            dataset.id.write_direct_chunk((start, *(0 for _ in shape[1:])), chunk)
    return dataset


def _compressed(chunk: np.ndarray) -> bytes:
    """One chunk through HDF5's shuffle and deflate filters."""
    bytes_of_values = chunk.reshape(-1, 1).view(np.uint8)
    return zlib.compress(bytes_of_values.T.tobytes(), _COMPRESSION_LEVEL)


def read_volume_vtkhdf(path: str | Path) -> VolumeData:
    """Read volume data that ``write_volume_vtkhdf`` wrote.

    Raises InputError where the file is not HDF5, not an ImageData of wsrender or damaged.
    """
    path = Path(path)
    try:
        with h5py.File(path, "r") as file:
            return _read(file, path.name)
    except (OSError, KeyError, IndexError, ValueError, TypeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(path.name, f"cannot be read as volume data: {error}") from error


def _read(file: Any, name: str) -> VolumeData:  # h5py's own types are unions of all that a name may hold
    root = file["VTKHDF"]
    cells = root["CellData"]
    nz, ny, nx = cells["count"].shape
    for array, dataset in cells.items():
        expected = (nz, ny, nx, 3) if "vector" in dataset.attrs else (nz, ny, nx)
        if ("vector" in dataset.attrs or "statistic" in dataset.attrs) and dataset.shape != expected:
            raise InputError(name, f"array {array!r} has shape {dataset.shape}, not {expected}")
    step = cells["count"].chunks[0] if cells["count"].chunks else max(1, nz)
    # Slab by slab, so that the arrays are never all held with their empty voxels.
    slabs = [
        _voxels(cells, slice(start, start + step)).moved((nx, ny, nz), np.array([0, 0, start]))
        for start in range(0, max(1, nz), step)
    ]
    i, j, k = (int(first) for first in root.attrs["first_voxel"])
    size, units = float(root.attrs["Spacing"][0]), dict(json.loads(root.attrs["units"]))
    return VolumeData.of_voxels(size, (i, j, k), Voxels.joined(slabs), units)


def _voxels(cells: Any, layers: slice) -> Voxels:
    """What the voxels in some layers of constant z hold."""
    statistics: dict[str, dict[str, np.ndarray]] = {}
    vectors: dict[str, np.ndarray] = {}
    for dataset in cells.values():
        if "statistic" in dataset.attrs:
            by_index = statistics.setdefault(str(dataset.attrs["statistic"]), {})
            by_index[str(dataset.attrs["index"])] = dataset[layers].T
        elif "vector" in dataset.attrs:
            vectors[str(dataset.attrs["vector"])] = dataset[layers].transpose(2, 1, 0, 3)
    best = statistics.pop(BEST, {})
    return Voxels.of_arrays(cells["count"][layers].T, statistics, vectors, best)
