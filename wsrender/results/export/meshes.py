"""Meshes ↔ PLY, GLB, STL and OBJ files.

PLY, STL and OBJ hold the world frame as it is, z up. GLB follows glTF 2.0, where +Y is up: a point (x, y, z) stands
there as (x, z, −y), turned by −90° about x. Lengths are metres everywhere.

Vertices are written in single precision, of OBJ with eight decimals. Of a mesh far from the world's origin, where that
would lose its digits, PLY holds double precision and GLB moves a node; STL cannot.
"""

import io
import json
import struct
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from wsrender.errors import InputError
from wsrender.results.export.atomic import new_file
from wsrender.results.export.formats import GLB_FRAME as GLB_FRAME
from wsrender.results.export.formats import by_ending
from wsrender.volume.lattice import FAR

# What the file itself says of its frame, in the glTF member ``asset.extras``.
GLB_EXTRAS = {"up": "+Y", "unit": "m", "frame": "world frame (z up) turned by -90 degrees about x: (x, z, -y)"}
_T_GLTF_WORLD = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def write_mesh(mesh: trimesh.Trimesh, path: str | Path) -> None:
    """Write a mesh [m, world frame] in the format of the file name (.ply, .glb, .stl or .obj).

    Raises InputError for another name, and for .stl of a mesh that is far from the world's origin.
    """
    path = Path(path)
    file_type = by_ending("mesh", path, own=True).suffix
    origin = far_origin(mesh)
    if file_type == "stl" and origin.any():
        raise InputError(
            "path",
            f"{path.name}: the mesh is {np.abs(origin).max():.3g} m from the world's origin, where the single "
            "precision of STL files loses its shape; write .ply or .glb",
        )
    with new_file(path) as temporary, temporary.open("wb") as file:
        if file_type == "glb":
            _glb(mesh, origin).export(file, file_type="glb", tree_postprocessor=_add_extras)
        elif file_type == "ply" and origin.any():
            file.write(_double_ply(mesh))
        else:
            mesh.export(file, file_type=file_type)


def read_mesh(path: str | Path, ending: str | None = None) -> trimesh.Trimesh:
    """Read what ``write_mesh`` wrote, vertices [m] in the file's precision.

    ``ending`` says the format where the name does not. Of PLY files the attributes of faces too, such as the number of
    the surface on which each lies. GLB files of wsrender 0.1.0, which had z up, are known by what they lack, and read
    as they are.

    Raises InputError where the file is no mesh.
    """
    path = Path(path)
    file_type = (ending or path.suffix).removeprefix(".").lower()
    try:
        mesh = trimesh.load(path, file_type=file_type, force="mesh", process=False)
        turned = file_type == "glb" and _has_y_up(_tree(path))
    except Exception as error:  # each of trimesh's readers has errors of its own
        raise InputError(path.name, f"cannot be read as a mesh: {error}") from error
    if not isinstance(mesh, trimesh.Trimesh):
        raise InputError(path.name, "holds no mesh")
    if turned:
        mesh.apply_transform(_T_GLTF_WORLD.T)
    raw = mesh.metadata.pop("_ply_raw", {}).get("face", {}).get("data")
    if isinstance(raw, np.ndarray) and raw.dtype.names is not None and len(raw) == len(mesh.faces):
        mesh.face_attributes |= {name: raw[name] for name in raw.dtype.names if raw[name].dtype.names is None}
    return mesh


read_glb, read_ply, read_stl, read_obj = (partial(read_mesh, ending=ending) for ending in ("glb", "ply", "stl", "obj"))


def far_origin(mesh: trimesh.Trimesh) -> np.ndarray:
    """Where a mesh stands if it is far from the world's origin, else that origin, (3,) [m]."""
    if mesh.bounds is None:
        return np.zeros(3)
    low, high = mesh.bounds
    middle = (low + high) / 2
    return middle if np.abs(middle).max() > FAR * np.max(high - low) else np.zeros(3)


def _glb(mesh: trimesh.Trimesh, origin: np.ndarray) -> trimesh.Trimesh | trimesh.Scene:
    """A mesh with +Y up; of one that is far away, relative to a node there."""
    near = mesh.copy()
    near.apply_translation(-origin)
    near.apply_transform(_T_GLTF_WORLD)
    if not origin.any():
        return near
    there = trimesh.transformations.translation_matrix(_T_GLTF_WORLD[:3, :3] @ origin)
    scene = trimesh.Scene()
    scene.add_geometry(near, transform=there)
    return scene


def _double_ply(mesh: trimesh.Trimesh) -> bytes:
    """A binary PLY file whose coordinates are doubles: trimesh's own, with its vertices written anew."""
    single = io.BytesIO()
    mesh.export(single, file_type="ply")
    header, _, body = single.getvalue().partition(b"end_header\n")
    of_vertices = header[: header.index(b"element face")].splitlines()
    kinds = {b"float": "<f4", b"uchar": "u1", b"int": "<i4", b"double": "<f8"}
    fields = [line.split()[1:] for line in of_vertices if line.startswith(b"property")]
    read = np.dtype([(name.decode(), kinds[kind]) for kind, name in fields])
    old = np.frombuffer(body, read, len(mesh.vertices))
    new = old.astype([(name, "<f8" if name in "xyz" else read[name]) for name in read.names or ()])
    for axis, name in enumerate("xyz"):
        new[name] = mesh.vertices[:, axis]
        header = header.replace(f"property float {name}\n".encode(), f"property double {name}\n".encode())
    return header + b"end_header\n" + new.tobytes() + body[old.nbytes :]


def _add_extras(tree: dict[str, Any]) -> None:
    tree["asset"]["extras"] = GLB_EXTRAS


def _has_y_up(tree: dict[str, Any]) -> bool:
    """Whether a glTF file has +Y up: all but those of wsrender 0.1.0, written by trimesh without a word of it."""
    asset = tree["asset"]
    return "extras" in asset or "trimesh" not in asset.get("generator", "")


def _tree(path: Path) -> dict[str, Any]:
    """The JSON part of a GLB file: after a header of 12 bytes, the chunk's length and type (glTF 2.0, section 4.4)."""
    with path.open("rb") as file:
        header = file.read(20)
        return json.loads(file.read(struct.unpack("<I", header[12:16])[0]))
