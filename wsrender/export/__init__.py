"""Files: maps, tables, volumes and surfaces in formats that other programs read.

Every writer is atomic (a file appears complete or not at all) and deterministic (equal data give equal
bytes). The functions are loaded on first use, because they import h5py, pyarrow, scipy or trimesh.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from wsrender.errors import MissingExtraError

if TYPE_CHECKING:
    from wsrender.export.csv import write_table_csv, write_volume_csv
    from wsrender.export.drawings import write_dxf, write_svg
    from wsrender.export.mat import write_table_mat, write_volume_mat
    from wsrender.export.meshes import GLB_FRAME, read_mesh, write_mesh
    from wsrender.export.npz import read_table_npz, read_volume_npz, write_table_npz, write_volume_npz
    from wsrender.export.parquet import read_table_parquet, write_table_parquet
    from wsrender.export.skeleton import read_skeleton, write_skeleton
    from wsrender.export.vtkhdf import read_volume_vtkhdf, write_volume_vtkhdf

_MODULES = {
    "GLB_FRAME": "meshes",
    "read_mesh": "meshes",
    "read_table_npz": "npz",
    "read_table_parquet": "parquet",
    "read_skeleton": "skeleton",
    "read_volume_npz": "npz",
    "read_volume_vtkhdf": "vtkhdf",
    "write_table_csv": "csv",
    "write_table_mat": "mat",
    "write_table_npz": "npz",
    "write_table_parquet": "parquet",
    "write_dxf": "drawings",
    "write_mesh": "meshes",
    "write_skeleton": "skeleton",
    "write_svg": "drawings",
    "write_volume_csv": "csv",
    "write_volume_mat": "mat",
    "write_volume_npz": "npz",
    "write_volume_vtkhdf": "vtkhdf",
}

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
    "write_volume_vtkhdf",
]


def __getattr__(name: str):
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        module = import_module(f"{__name__}.{_MODULES[name]}")
    except ModuleNotFoundError as error:
        raise MissingExtraError(error.name or name, "engine") from error
    return getattr(module, name)
