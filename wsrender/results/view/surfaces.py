"""Triangles as GLB files for a page: coordinates as they are, not turned so that +Y is up."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.results.export.meshes import far_origin

Color = tuple[float, ...]
EXTRAS = {"unit": "m", "up": "+Z", "frame": "as the manifest says; coordinates are not turned"}
MOST_TRIANGLES = 1_000_000
_SMOOTH = 200_000  # triangles up to which normals are found; finer ones are flat
_CREASE = np.deg2rad(30.0)


@dataclass(frozen=True, eq=False)
class ColoredMesh:
    """Triangles of one colour (red, green, blue[, alpha], 0 … 1): ``vertices`` (V, 3) [m], ``faces`` (F, 3)."""

    vertices: np.ndarray
    faces: np.ndarray
    color: Color
    name: str = ""


def glb(parts: Iterable[ColoredMesh]) -> bytes:
    """A GLB file with a node for each part, of its name; those far from the origin stand relative to their node."""
    import trimesh
    from trimesh.visual import TextureVisuals

    scene = trimesh.Scene()
    for number, part in enumerate(parts):
        mesh = trimesh.Trimesh(part.vertices, part.faces, process=False)
        origin = far_origin(mesh)
        mesh.apply_translation(-origin)
        if len(part.faces) <= _SMOOTH:
            mesh = trimesh.graph.smooth_shade(mesh, angle=_CREASE)
            _ = mesh.vertex_normals  # the file holds those that are known
        mesh.visual = TextureVisuals(material=_material(part.color))
        place = trimesh.transformations.translation_matrix(origin)
        scene.add_geometry(mesh, node_name=part.name or f"part {number}", geom_name=f"part {number}", transform=place)
    found = scene.export(file_type="glb", tree_postprocessor=_add_extras)
    assert isinstance(found, bytes)
    return found


def _material(color: Color) -> Any:
    from trimesh.visual.material import PBRMaterial

    rgba = (*color[:3], color[3] if len(color) > 3 else 1.0)
    return PBRMaterial(
        baseColorFactor=[round(255 * each) for each in rgba],
        metallicFactor=0.0,
        roughnessFactor=0.7,
        alphaMode="OPAQUE" if rgba[3] >= 1 else "BLEND",
        doubleSided=True,
    )


def _add_extras(tree: dict[str, Any]) -> None:
    tree["asset"]["extras"] = EXTRAS
