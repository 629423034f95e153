"""Errors and times of methods against the edge of their voxels or triangles."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from wsrender.errors import InputError
from wsrender.plots.style import add_title, color_map, new_figure, paper_style
from wsrender.volume.table import Table

LABELS = {
    "grid": "A: every leg at every voxel",
    "grid_by_subsystem": "B: by subsystem",
    "solids": "D: boolean solids",
}
LEAST_ERROR = 1e-7  # smaller ones are drawn there


@paper_style()
def errors_and_times(table: Table, *, title: str = "") -> Figure:
    """Size of the relative error, and time, of each method; the exact one as a line.

    Columns ``method``, ``size`` [m], ``relative_error``, ``time`` [s]. InputError where a column is missing.
    """
    if not {"method", "size", "relative_error", "time"} <= set(table.columns):
        raise InputError("table", f"holds {', '.join(table.columns)}; method, size, relative_error, time are needed")
    figure = new_figure(8.4, 4.2)
    errors, times = figure.subplots(1, 2)
    colors = color_map()(np.linspace(0.1, 0.75, len(LABELS)))
    for (method, label), color, marker in zip(LABELS.items(), colors, "osD", strict=True):
        rows = np.flatnonzero(table["method"] == method)
        rows = rows[np.argsort(table["size"][rows])]
        size = table["size"][rows]
        style = {"color": color, "marker": marker, "ms": 4.5, "lw": 1.2, "label": label}
        # A and B have the same voxels: hollow marks of B around those of A.
        style |= {"mfc": "none", "ms": 8.0, "ls": "--"} if method == "grid_by_subsystem" else {}
        errors.plot(size, np.maximum(np.abs(table["relative_error"][rows]), LEAST_ERROR), **style)
        times.plot(size, table["time"][rows], **style)
    for row in np.flatnonzero(table["method"] == "exact"):
        times.axhline(table["time"][row], color="#c8102e", lw=1.2, label="C: exact, with its mesh")
    for axes, label in ((errors, "Size of the relative error of the volume"), (times, "Time [s]")):
        axes.set(xscale="log", yscale="log", xlabel="Edge of a voxel or triangle [m]", ylabel=label)
        axes.grid(zorder=0)
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_formatter(NullFormatter())
    figure.legend(*times.get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False, fontsize=8)
    add_title(figure, title)
    return figure
