"""What the view of a comparison of methods adds: errors by the size of voxels and triangles."""

from typing import TYPE_CHECKING

import numpy as np

from wsrender.results.view.additions import Additions, curve_plot
from wsrender.volume.table import Table

if TYPE_CHECKING:
    from wsrender.results.drawing.result_plots import ResultPlots


def view(plot: "ResultPlots") -> Additions:
    """A curve for each method."""
    table = plot.tables["methods"]
    of_each = {name: np.flatnonzero(table["method"] == name) for name in np.unique(table["method"])}
    tables = {
        name: Table({key: column[rows] for key, column in table.columns.items()}, table.units)
        for name, rows in of_each.items()
        if np.isfinite(table["size"][rows]).all()
    }
    named = ((f"errors of {name}", f"Error, {name}", each) for name, each in tables.items())
    return Additions(plots=[curve_plot(*each, "size", ["relative_error"]) for each in named])
