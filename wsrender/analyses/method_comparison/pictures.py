"""Errors of methods against the edge of their voxels or triangles."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from wsrender.errors import InputError
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.style import Heading, color_map, new_figure, paper_style
from wsrender.volume.table import Table

LABELS = {
    "grid": "A: every leg at every voxel",
    "grid_by_subsystem": "B: by subsystem",
    "solids": "D: boolean solids",
}
LEAST_ERROR = 1e-7  # smaller ones are drawn there


@paper_style()
def errors_by_size(table: Table, *, title: Heading | str = "") -> Figure:
    """Size of the relative error of each method ([SNK] Fig. 10); that of the exact method is 0.

    Columns ``method``, ``size`` [m], ``relative_error``. InputError where a column is missing.
    """
    if not {"method", "size", "relative_error"} <= set(table.columns):
        raise InputError("table", f"holds {', '.join(table.columns)}; method, size and relative_error are needed")
    figure = new_figure(5.6, 3.9, title)
    axes = figure.add_subplot()
    colors = color_map()(np.linspace(0.1, 0.75, len(LABELS)))
    for (method, label), color, marker in zip(LABELS.items(), colors, "osD", strict=True):
        rows = np.flatnonzero(table["method"] == method)
        rows = rows[np.argsort(table["size"][rows])]
        style = {"color": color, "marker": marker, "ms": 4.5, "lw": 1.2, "label": label}
        # A and B have the same voxels: hollow marks of B around those of A.
        style |= {"mfc": "none", "ms": 8.0, "ls": "--"} if method == "grid_by_subsystem" else {}
        axes.plot(table["size"][rows], np.maximum(np.abs(table["relative_error"][rows]), LEAST_ERROR), **style)
    axes.set(xscale="log", yscale="log", xlabel="Edge of a voxel or triangle [m]", ylabel="|Error| / exact volume")
    axes.grid(zorder=0)
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    axes.legend(frameon=False, fontsize=8)
    return figure


def methods(plot: ResultPlots) -> Figure:
    """Errors of the methods of a comparison against the edge of their voxels or triangles."""
    return errors_by_size(plot.tables["methods"], title=plot.heading("other"))
