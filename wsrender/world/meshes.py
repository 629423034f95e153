"""The vertices of meshes, of which the convex hull counts."""

import hashlib
from collections import OrderedDict
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from wsrender.documents.shapes import ConvexMesh, Mesh
from wsrender.errors import InputError, ModelError
from wsrender.robots import mesh_files
from wsrender.robots.hulls import LEAST_M3, MOST_VERTICES, simplified
from wsrender.robots.uploaded import uploaded_content

TOLERANCE_M = 1e-3
KEPT = 32  # solids in pieces, by content: what takes seconds is done once in a process
_PIECES: OrderedDict[str, list[np.ndarray]] = OrderedDict()


def convex_parts(mesh: ConvexMesh | Mesh) -> list[np.ndarray]:
    """Corners (V, 3) [m] of the convex parts of a mesh, in its own frame: its hull, or the pieces of a solid.

    A hull of many corners is simplified outwards, as those of robots are. Raises InputError as `hull_vertices` and
    `convex_pieces` do, and where no hull of fewer corners is near enough.
    """
    if isinstance(mesh, ConvexMesh) or mesh.convex is not False:
        return [_simple_hull(mesh)]
    from wsrender.world.convex_pieces import convex_pieces

    field, tolerance_m = "path" if mesh.model is None else "model", mesh.tolerance_m or TOLERANCE_M
    vertices, faces = triangles_of(mesh)
    key = hashlib.sha256(b"".join([vertices.tobytes(), faces.tobytes(), np.float64(tolerance_m).tobytes()])).hexdigest()
    if (found := _PIECES.get(key)) is None:
        found = _PIECES[key] = convex_pieces(vertices, faces, tolerance_m, field)
        while len(_PIECES) > KEPT:
            _PIECES.popitem(last=False)
    return found


def _simple_hull(mesh: ConvexMesh | Mesh) -> np.ndarray:
    vertices = hull_vertices(mesh)
    if len(vertices) <= MOST_VERTICES:
        return vertices
    if (simpler := simplified(vertices)) is None:
        field = "vertices_m" if mesh.vertices_m is not None else "path" if mesh.model is None else "model"
        message = f"has a hull of {len(vertices)} corners; {MOST_VERTICES} that hold it go too far beyond it"
        raise InputError(field, f"{message}: give a simpler mesh")
    return simpler


def hull_vertices(mesh: ConvexMesh | Mesh) -> np.ndarray:
    """Corners (V, 3) [m] of the convex hull of a mesh, in its own frame.

    Raises InputError, naming the field, where its vertices lie in a plane, and where its file cannot be read.
    """
    if mesh.vertices_m is not None:
        field, vertices = "vertices_m", np.array(mesh.vertices_m)
    else:
        field, (vertices, _) = "path" if mesh.model is None else "model", triangles_of(mesh)
    try:
        hull = ConvexHull(vertices)
    except (QhullError, ValueError) as error:
        raise InputError(field, "enclose no volume: they lie in a plane") from error
    if hull.volume < LEAST_M3:
        raise InputError(field, f"enclose {hull.volume:.2g} m³; at least {LEAST_M3:g} m³ are needed")
    return vertices[hull.vertices]


def triangles_of(mesh: ConvexMesh | Mesh) -> mesh_files.Triangles:
    """Vertices (V, 3) [m] and faces (F, 3) of the file of a mesh. Raises InputError where it cannot be read."""
    if mesh.model is not None:
        content = uploaded_content(mesh.model, "model")
        vertices, faces = _read(content, f"{mesh.model[:8]}…{_ending(content)}", "model")
    else:
        path = Path(str(mesh.path))
        try:
            if path.stat().st_size > mesh_files.MAX_MESH_BYTES:
                raise InputError("path", f"{path} has more than {mesh_files.MAX_MESH_BYTES >> 20} MiB")
            content = path.read_bytes()
        except OSError as error:
            raise InputError("path", f"{path} cannot be read: {error.strerror}") from error
        vertices, faces = _read(content, str(path), "path")
    return mesh.length_unit_m * vertices, faces


def _read(content: bytes, name: str, field: str) -> mesh_files.Triangles:
    try:
        return mesh_files.triangles(content, name, field)
    except ModelError as error:
        raise InputError(field, f"{name} cannot be read as a mesh: {error.message}") from error


def _ending(content: bytes) -> str:
    """What the name of a mesh's file would end in, by what it begins with."""
    if content[:3] == b"ply":
        return ".ply"
    count = int.from_bytes(content[80:84], "little")
    binary = len(content) == 84 + 50 * count and len(content) >= 84
    return ".stl" if binary or content.lstrip()[:5].lower() == b"solid" else ".obj"
