"""A polytope of velocities, forces or accelerations, alone, in its unit."""

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from wsrender.geometry.polytopes import Polytope
from wsrender.results.drawing.faces import Faces
from wsrender.results.drawing.faces_of_surface import shaded
from wsrender.results.drawing.okabe_ito import POLYTOPES
from wsrender.results.drawing.style import INK, Heading, new_figure, paper_style, quantity
from wsrender.results.drawing.view import add_view

_SIZE, _PLACE = (4.6, 4.0), (0.4, 0.3, 3.9, 3.4)  # of the figure and the view in it [in]


@paper_style()
def polytope(found: Polytope, *, title: Heading | str = "") -> Figure:
    """A polytope of dimension 2 or 3 about 0, which is marked, on axes in its unit."""
    names = tuple(quantity(axis, found.unit) for axis in "xyz")
    figure = new_figure(*_SIZE, title, layout=None)
    view = add_view(figure, np.concatenate([found.vertices, np.zeros((1, 3))]), _PLACE, names=names)
    color = to_rgb(POLYTOPES[found.kind])
    faces = Faces(found.vertices, found.triangles, np.zeros(len(found.triangles), int), {}, {0: color})
    view.add_surface(*shaded(faces, view.space.camera), alpha=0.75)
    view.add_outline(colors=[INK], linewidths=0.6, zorder=2.9)
    view.add_marks(np.zeros((1, 3)), marker="+", ms=10, mec=INK, mew=1.4, through=True, zorder=9)
    return figure
