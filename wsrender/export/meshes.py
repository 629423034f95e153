"""Meshes ↔ PLY, GLB and STL files."""

from pathlib import Path

import numpy as np
import trimesh

from wsrender.errors import InputError
from wsrender.export.atomic import new_file


def write_mesh(mesh: trimesh.Trimesh, path: str | Path) -> None:
    """Write a mesh in the format of the file name (.ply, .glb or .stl)."""
    path = Path(path)
    file_type = path.suffix.removeprefix(".").lower()
    if file_type not in ("ply", "glb", "stl"):
        raise InputError("path", f"{path.name} must end in .ply, .glb or .stl")
    with new_file(path) as temporary, temporary.open("wb") as file:
        mesh.export(file, file_type=file_type)


def read_mesh(path: str | Path, ending: str | None = None) -> trimesh.Trimesh:
    """Read what ``write_mesh`` wrote, vertices in float32; ``ending`` says the format where the name does not.

    Of PLY files the attributes of faces too, such as the number of the surface on which each lies.

    Raises InputError where the file is no mesh.
    """
    path = Path(path)
    try:
        mesh = trimesh.load(path, file_type=(ending or path.suffix).removeprefix("."), force="mesh", process=False)
    except Exception as error:  # each of trimesh's readers has errors of its own
        raise InputError(path.name, f"cannot be read as a mesh: {error}") from error
    if not isinstance(mesh, trimesh.Trimesh):
        raise InputError(path.name, "holds no mesh")
    raw = mesh.metadata.pop("_ply_raw", {}).get("face", {}).get("data")
    if isinstance(raw, np.ndarray) and raw.dtype.names is not None and len(raw) == len(mesh.faces):
        mesh.face_attributes |= {name: raw[name] for name in raw.dtype.names if raw[name].dtype.names is None}
    return mesh
