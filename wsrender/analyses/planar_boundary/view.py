"""What the view of a planar boundary adds: the plane of the world in which it lies."""

from typing import TYPE_CHECKING

import numpy as np

from wsrender.results.view.additions import Additions

if TYPE_CHECKING:
    from wsrender.results.drawing.result_plots import ResultPlots


def view(plot: "ResultPlots") -> Additions:
    """The frame of the plane."""
    plane, T = plot.document["plane"], np.eye(4)
    for k, name in enumerate(("x_axis", "y_axis", "normal", "origin_m")):
        T[:3, k] = plane[name]
    return Additions(in_plane=T)
