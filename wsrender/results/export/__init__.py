"""Files: maps, tables, volumes and surfaces in formats that other programs read.

Every writer is atomic (a file appears complete or not at all) and deterministic (equal data give equal
bytes). The functions are loaded on first use, because they import h5py, pyarrow, scipy or trimesh.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from wsrender.errors import MissingExtraError

if TYPE_CHECKING:
    from wsrender.results.export.csv import write_table_csv, write_volume_csv
    from wsrender.results.export.drawings import write_dxf, write_svg
    from wsrender.results.export.mat import write_table_mat, write_volume_mat
    from wsrender.results.export.meshes import GLB_FRAME, read_mesh, write_mesh
    from wsrender.results.export.npz import read_table_npz, read_volume_npz, write_table_npz, write_volume_npz
    from wsrender.results.export.parquet import read_table_parquet, write_table_parquet, write_volume_parquet
    from wsrender.results.export.skeleton import read_skeleton, write_skeleton
    from wsrender.results.export.vti import write_volume_vti
    from wsrender.results.export.vtkhdf import read_volume_vtkhdf, write_volume_vtkhdf

__all__ = [
    "GLB_FRAME",
    "read_mesh",
    "read_skeleton",
    "read_table_npz",
    "read_table_parquet",
    "read_volume_npz",
    "read_volume_vtkhdf",
    "write_dxf",
    "write_mesh",
    "write_skeleton",
    "write_svg",
    "write_table_csv",
    "write_table_mat",
    "write_table_npz",
    "write_table_parquet",
    "write_volume_csv",
    "write_volume_mat",
    "write_volume_npz",
    "write_volume_parquet",
    "write_volume_vti",
    "write_volume_vtkhdf",
]


_MODULES = {"GLB_FRAME": "formats", "read_mesh": "meshes"}


def __getattr__(name: str):
    module = _MODULES.get(name) or _module_of_format(name)
    if module is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        return getattr(import_module(f"{__name__}.{module}"), name)
    except ModuleNotFoundError as error:
        raise MissingExtraError(error.name or name, "engine") from error


def _module_of_format(function: str) -> str | None:
    """Where the table of formats has a function of this package from."""
    from wsrender.results.export.formats import own_functions

    return own_functions().get(function)
