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

from wsrender.errors import InputError
from wsrender.export.atomic import new_file
from wsrender.export.cells import cell_array, cell_names, vector_array, vector_names
from wsrender.volume.volume_data import VolumeData

_CHUNK_BYTES = 1 << 21
_COMPRESSION_LEVEL = 1  # voxel values are mostly noise in their low bits: higher levels gain little


def write_volume_vtkhdf(volume: VolumeData, path: str | Path) -> None:
    """Write volume data as one ImageData with cell arrays; InputError where an array's shape differs."""
    taken = {"count"}
    names, vectors = cell_names(volume, taken), vector_names(volume, taken)
    with new_file(path) as temporary, h5py.File(temporary, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs.create("Version", np.array([1, 0], np.int64))
        root.attrs.create("Type", b"ImageData", dtype=h5py.string_dtype("ascii", 9))
        extent = [bound for size in volume.count.shape for bound in (0, size)]
        root.attrs["WholeExtent"] = np.array(extent, np.int64)
        root.attrs["Origin"] = np.asarray(volume.origin_m, np.float64)
        root.attrs["Spacing"] = np.full(3, volume.voxel_size_m, np.float64)
        root.attrs["Direction"] = np.eye(3).ravel()
        root.attrs["first_voxel"] = np.array(volume.first_voxel, np.int64)
        root.attrs["frame"] = "world"
        root.attrs["units"] = json.dumps(volume.units)
        cells = root.create_group("CellData", track_order=True)
        _write_array(cells, "count", volume.count).attrs["unit"] = "samples"
        for (statistic, index), name in names.items():
            dataset = _write_array(cells, name, cell_array(volume, statistic, index))
            unit = volume.units.get(index, "1")
            dataset.attrs.update({"statistic": statistic, "index": index, "unit": unit})
        for vector, name in vectors.items():
            values = vector_array(volume, vector).transpose(2, 1, 0, 3)
            options = {"compression": "gzip", "compression_opts": _COMPRESSION_LEVEL, "track_times": False}
            dataset = cells.create_dataset(name, data=values, **options)
            dataset.attrs.update({"vector": vector, "unit": volume.units.get(vector, "1")})


def _write_array(group: h5py.Group, name: str, array: np.ndarray) -> h5py.Dataset:
    """Write (nx, ny, nz) as (nz, ny, nx) in slabs of constant z, compressed in parallel."""
    file_order = array.T
    if array.size == 0:
        return group.create_dataset(name, data=file_order, track_times=False)
    layer_bytes = array.itemsize * file_order[0].size
    layers = int(np.clip(_CHUNK_BYTES // layer_bytes, 1, len(file_order)))
    dataset = group.create_dataset(
        name,
        shape=file_order.shape,
        dtype=array.dtype,
        chunks=(layers, *file_order.shape[1:]),
        shuffle=True,
        compression="gzip",
        compression_opts=_COMPRESSION_LEVEL,
        track_times=False,
    )
    starts = range(0, len(file_order), layers)
    with ThreadPoolExecutor() as pool:  # zlib releases the interpreter's lock
        chunks = pool.map(lambda start: _compressed(file_order[start : start + layers], layers), starts)
        for start, chunk in zip(starts, chunks, strict=True):
            dataset.id.write_direct_chunk((start, 0, 0), chunk)
    return dataset


def _compressed(slab: np.ndarray, layers: int) -> bytes:
    """One chunk through HDF5's shuffle and deflate filters; the last slab is padded with zeros."""
    chunk = np.zeros((layers, *slab.shape[1:]), slab.dtype)
    chunk[: len(slab)] = slab
    bytes_of_values = chunk.reshape(-1, 1).view(np.uint8)
    return zlib.compress(bytes_of_values.T.tobytes(), _COMPRESSION_LEVEL)


def read_volume_vtkhdf(path: str | Path) -> VolumeData:
    """Read volume data that ``write_volume_vtkhdf`` wrote.

    Raises InputError where the file is not HDF5, not an ImageData of wsrender or damaged.
    """
    path = Path(path)
    try:
        with h5py.File(path, "r") as file:
            return _read(file)
    except (OSError, KeyError, ValueError, TypeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(path.name, f"cannot be read as volume data: {error}") from error


def _read(file: Any) -> VolumeData:  # h5py's own types are unions of all that a name may hold
    root = file["VTKHDF"]
    cells = root["CellData"]
    statistics: dict[str, dict[str, np.ndarray]] = {}
    vectors: dict[str, np.ndarray] = {}
    for dataset in cells.values():
        if "statistic" in dataset.attrs:
            by_index = statistics.setdefault(str(dataset.attrs["statistic"]), {})
            by_index[str(dataset.attrs["index"])] = _read_array(dataset)
        elif "vector" in dataset.attrs:
            vectors[str(dataset.attrs["vector"])] = dataset[...].transpose(2, 1, 0, 3)
    i, j, k = root.attrs["first_voxel"]
    return VolumeData(
        voxel_size_m=float(root.attrs["Spacing"][0]),
        first_voxel=(int(i), int(j), int(k)),
        count=_read_array(cells["count"]),
        statistics=statistics,
        units=dict(json.loads(root.attrs["units"])),
        vectors=vectors,
    )


def _read_array(dataset: h5py.Dataset) -> np.ndarray:
    """The array (nx, ny, nz), contiguous, read slab by slab so that no second copy is held."""
    array = np.empty(dataset.shape[::-1], dataset.dtype)
    step = dataset.chunks[0] if dataset.chunks else max(1, len(dataset))
    for start in range(0, len(dataset), step):
        array[:, :, start : start + step] = dataset[start : start + step].T
    return array
