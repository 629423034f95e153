"""The patches of a spatial arm's boundary as faces in their colours."""

from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.plots.faces import NUMBER, Faces
from wsrender.volume.table import Table

if TYPE_CHECKING:
    import trimesh

_NUMBERS = {"radius_m": "R {:.3g}", "tube_radius_m": "r {:.3g}"}
_LISTED = 18  # patches, largest first, that the legend names


def faces_of_patches(mesh: "trimesh.Trimesh", patches: Table) -> Faces:
    """The triangles of the mesh by their patch, labelled with its kind, numbers and what generates it."""
    number = np.asarray(mesh.face_attributes[NUMBER])
    present, first = np.unique(number, return_index=True)
    visual: Any = mesh.visual
    rgba = np.asarray(visual.face_colors)[first] / 255.0
    colors = {int(k): (float(r), float(g), float(b)) for k, (r, g, b, _) in zip(present, rgba, strict=True)}
    labels = {k: _label(patches, k) for k in present[:_LISTED].tolist()}
    return Faces(np.asarray(mesh.vertices), np.asarray(mesh.faces), number, labels, colors)


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
