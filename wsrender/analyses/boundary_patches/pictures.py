"""The patches of a spatial arm's boundary as faces in their colours."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from wsrender.results.drawing.faces import NUMBER, Faces
from wsrender.results.drawing.faces_of_surface import surface_faces
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.volume.table import Table

if TYPE_CHECKING:
    import trimesh

_NUMBERS = {"radius_m": "R {:.3g}", "tube_radius_m": "r {:.3g}"}
_LISTED = 18  # patches, largest first, that the legend names


def faces_of_patches(mesh: "trimesh.Trimesh", patches: Table, listed: int | None = None) -> Faces:
    """The triangles of the mesh by their patch, the first labelled with kind, numbers and what generates them."""
    number = np.asarray(mesh.face_attributes[NUMBER])
    present, first = np.unique(number, return_index=True)
    visual: Any = mesh.visual
    rgba = np.asarray(visual.face_colors)[first] / 255.0
    colors = {int(k): (float(r), float(g), float(b)) for k, (r, g, b, _) in zip(present, rgba, strict=True)}
    labels = {k: _label(patches, k) for k in present[:listed].tolist()}
    faces = Faces(np.asarray(mesh.vertices), np.asarray(mesh.faces), number, labels, colors)
    return replace(faces, normals=_normals(faces, patches))


def _normals(faces: Faces, patches: Table) -> np.ndarray:
    """Normals (T, 3, 3) at corners: those of plane, sphere, cylinder and torus by their numbers, others by the mesh.

    Where a patch is cut its triangles may be slivers, which do not say how the surface lies.
    """
    normals = faces.smooth_normals()
    for k in np.unique(faces.number):
        rows = faces.number == k
        known = _known_normals(faces.corners[rows], patches, int(k))
        if known is not None:
            outwards = np.sign((known * normals[rows]).sum())
            normals[rows] = outwards * known
    return normals


def _known_normals(points: np.ndarray, patches: Table, k: int) -> np.ndarray | None:
    """Unit normals (…, 3) of a patch at points on it, to one of its sides; None where its kind does not say them."""
    kind, axis = str(patches["kind"][k]), patches["axis"][k]
    away = points - patches["point"][k]
    radial = away - (away @ axis)[..., None] * axis
    if kind == "plane":
        normals = np.broadcast_to(axis, points.shape)
    elif kind == "sphere":
        normals = away
    elif kind == "cylinder":
        normals = radial
    elif kind == "torus":
        normals = away - patches["radius_m"][k] * radial / np.linalg.norm(radial, axis=-1, keepdims=True).clip(1e-12)
    else:
        return None
    return normals / np.linalg.norm(normals, axis=-1, keepdims=True).clip(1e-12)


def _label(patches: Table, k: int) -> str:
    """Such as ``0 torus R 2 r 0.5 m: joint3 upper``."""
    numbers = [form.format(patches[name][k]) for name, form in _NUMBERS.items() if np.isfinite(patches[name][k])]
    if numbers:
        numbers.append("m")
    if np.isfinite(patches["half_angle_rad"][k]):
        numbers.append(f"{np.rad2deg(patches['half_angle_rad'][k]):.4g}°")
    words = " ".join([str(k), str(patches["kind"][k]).replace("_", " "), *numbers])
    generated = str(patches["generated_by"][k])
    return f"{words}: {generated}" if generated else words


def patches(plot: ResultPlots) -> Figure:
    """The boundary of a spatial arm from two sides: patches in their colours, edges and corners."""
    faces = faces_of_patches(plot.meshes["patches"], plot.tables["patches"], _LISTED)
    return surface_faces(faces, title=plot.heading("surface"))
