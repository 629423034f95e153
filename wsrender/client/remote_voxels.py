"""Voxels in a file on a server, as xarray's arrays that are read when they are used; needs the extra ``data``."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from traceback import clear_frames
from typing import Any

import h5py
import numpy as np
import xarray
from xarray.backends import BackendArray, BackendEntrypoint
from xarray.core import indexing

from wsrender.client.range_file import RangeFile
from wsrender.errors import InputError, WsrenderError
from wsrender.results import conversion
from wsrender.results.export.names import unique_names


def remote_dataset(file: RangeFile | Path, document: Mapping[str, Any]) -> xarray.Dataset:
    """What `wsrender.Result.to_xarray` makes of a volume, of its VTKHDF file; arrays are read when they are used.

    Raises InputError where it is none of wsrender's, and what reading raises.
    """
    try:
        with _checked(file):
            return xarray.open_dataset(file, engine=_Voxels, document=document)  # type: ignore[arg-type]
    except WsrenderError:
        raise
    except (OSError, KeyError, IndexError, ValueError, TypeError) as error:
        raise InputError("volume", f"cannot be read as volume data: {error}") from error


@contextmanager
def _checked(file: RangeFile | Path) -> Iterator[None]:
    """What fails of the download is raised, whatever was made of its zeros."""
    try:
        yield
    except Exception as error:
        # Else frames of h5py keep its list of access properties: HDF5 frees it after the interpreter's end and crashes.
        clear_frames(error.__traceback__)
        if isinstance(file, RangeFile):
            file.check()
        raise
    if isinstance(file, RangeFile):
        file.check()


class _Voxels(BackendEntrypoint):
    """How xarray opens a file that `wsrender.results.export.vtkhdf` wrote."""

    def open_dataset(  # type: ignore[override]
        self,
        filename_or_obj: RangeFile | Path,
        *,
        drop_variables: str | Iterable[str] | None = None,
        document: Mapping[str, Any],
    ) -> xarray.Dataset:
        with ExitStack() as opened:
            file: Any = opened.enter_context(h5py.File(filename_or_obj, "r"))
            found = self._of(file, filename_or_obj, document)
            found.set_close(opened.pop_all().close)
        return found

    def _of(self, file: Any, source: RangeFile | Path, document: Mapping[str, Any]) -> xarray.Dataset:
        root = file["VTKHDF"]
        cells, size = root["CellData"], float(root.attrs["Spacing"][0])
        shape = cells["count"].shape[::-1]
        centers = [
            (first + np.arange(n) + 0.5) * size for first, n in zip(root.attrs["first_voxel"], shape, strict=True)
        ]
        arrays, taken = {}, {*conversion.TAKEN}
        for stored, dataset in cells.items():
            name, words = stored, ("samples",)
            if stored != "count":
                about = dataset.attrs
                words = (about["vector"],) if "vector" in about else (about["statistic"], about["index"])
                wanted = "_".join(words)
                name = unique_names([wanted], "array", taken)[wanted]
            values = indexing.LazilyIndexedArray(_Cells(dataset, source))
            arrays[name] = conversion.VoxelArray(values, str(dataset.attrs["unit"]), words)
        return conversion.voxel_dataset(arrays, centers, size, document)


class _Cells(BackendArray):
    """An array (nz, ny, nx) or (nz, ny, nx, 3) of the file as one of (nx, ny, nz) or (nx, ny, nz, 3)."""

    def __init__(self, dataset: Any, file: RangeFile | Path):
        self._dataset, self._file = dataset, file
        nz, ny, nx, *parts = dataset.shape
        self.shape, self.dtype = (nx, ny, nz, *parts), dataset.dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self._read)

    def _read(self, key: tuple[int | slice, ...]) -> np.ndarray:
        x, y, z, *parts = key
        with _checked(self._file):
            values = np.asarray(self._dataset[(z, y, x, *parts)])
        along = sum(isinstance(each, slice) for each in (x, y, z))
        return values.transpose(*reversed(range(along)), *range(along, values.ndim))
