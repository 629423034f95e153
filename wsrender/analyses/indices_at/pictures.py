"""The polytopes of a configuration at the tip of its arm."""

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from wsrender.errors import InputError
from wsrender.indices.units import pretty_unit
from wsrender.results.drawing.faces import Faces
from wsrender.results.drawing.faces_of_surface import shaded
from wsrender.results.drawing.okabe_ito import POLYTOPES
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.stick_figure import draw_arm
from wsrender.results.drawing.style import paper_style, three_digits
from wsrender.results.drawing.view import add_legend, new_view

_COLORS = {kind: to_rgb(color) for kind, color in POLYTOPES.items()}
_VEIL = 0.5  # opacity, behind which the arm is seen


@paper_style()
def polytopes(plot: ResultPlots, configuration: int | None = None) -> Figure:
    """The arm at a configuration, by its row (default: the first with a mesh), with its polytopes at the tip."""
    table, meshes = plot.tables["polytopes"], plot.meshes
    rows = np.unique(table["configuration"])
    drawn = [k for k in rows if any(name.endswith(f"_polytope_{k}") for name in meshes)]
    k = drawn[0] if configuration is None else configuration
    found = {kind: meshes[f"{kind}_polytope_{k}"] for kind in _COLORS if f"{kind}_polytope_{k}" in meshes}
    if not found:
        raise InputError("configuration", f"{k} has no mesh of a polytope; {', '.join(map(str, drawn))} have")
    row = int(np.searchsorted(rows, k))
    arm, body = np.asarray(plot.skeleton)[row], plot.bodies[row]
    corners = [np.asarray(mesh.vertices) for mesh in found.values()] + ([] if body is None else [body.vertices])
    figure, view = new_view(np.concatenate([arm, *corners]), plot.heading("other"), "world")
    handles = []
    for kind, mesh in found.items():
        color = _COLORS[kind]
        number = np.zeros(len(mesh.faces), int)
        faces = Faces(np.asarray(mesh.vertices), np.asarray(mesh.faces), number, {}, {0: color})
        view.add_surface(*shaded(faces, view.space.camera), alpha=_VEIL)
        at = (table["configuration"] == k) & (table["kind"].astype(str) == kind)
        radius, scale = table["radius"][at][0], 1 / table["mesh_m_per_unit"][at][0]
        unit = pretty_unit(str(table["unit"][at][0]))
        label = f"{kind}: radius {three_digits(radius)} {unit},\n1 m stands for {three_digits(scale)} {unit}"
        handles.append(Patch(color=color, alpha=_VEIL, label=label))
    draw_arm(view, arm, body=body)
    add_legend(figure, handles)
    return figure
