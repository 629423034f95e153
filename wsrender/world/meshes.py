"""The vertices of meshes, of which the convex hull counts."""

from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from scipy.spatial import ConvexHull, QhullError

from wsrender.documents.environment import Mesh
from wsrender.errors import InputError

LEAST_M3 = 1e-14  # volume of a mesh; MuJoCo refuses less than a tenth of it [m³]


def hull_vertices(mesh: Mesh) -> np.ndarray:
    """Corners (V, 3) [m] of the convex hull of a mesh, in its own frame.

    Raises InputError, naming the field, where its vertices lie in a plane, and where its file cannot be read.
    """
    field = "path" if mesh.vertices_m is None else "vertices_m"
    vertices = np.array(mesh.vertices_m) if mesh.vertices_m is not None else _of_file(mesh)
    try:
        hull = ConvexHull(vertices)
    except (QhullError, ValueError) as error:
        raise InputError(field, "enclose no volume: they lie in a plane") from error
    if hull.volume < LEAST_M3:
        raise InputError(field, f"enclose {hull.volume:.2g} m³; at least {LEAST_M3:g} m³ are needed")
    return vertices[hull.vertices]


def _of_file(mesh: Mesh) -> np.ndarray:
    """Vertices (V, 3) [m] of the file of a mesh."""
    path = Path(str(mesh.path))
    try:
        with path.open("rb") as file:
            found: Any = trimesh.load(file, file_type=path.suffix[1:].lower(), process=False)
        parts: list[Any] = found.dump() if isinstance(found, trimesh.Scene) else [found]
        vertices = np.concatenate([np.asarray(part.vertices, np.float64) for part in parts])
    except OSError as error:
        raise InputError("path", f"{path} cannot be read: {error.strerror}") from error
    except Exception as error:  # its readers raise whatever they stumble over
        raise InputError("path", f"{path} cannot be read as a mesh: {error}") from error
    if not np.isfinite(vertices).all():
        raise InputError("path", f"{path} must hold finite numbers")
    return mesh.length_unit_m * vertices
