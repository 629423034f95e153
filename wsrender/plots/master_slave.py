"""A slave's workspace in its master's: green where it lies inside, red where it does not."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from wsrender.errors import InputError
from wsrender.plots.space import new_space, thinned
from wsrender.plots.style import GREY, add_title, paper_style
from wsrender.volume.table import Table

INSIDE, OUTSIDE = "#1a9641", "#c8102e"
_POINTS = 8000  # of each kind


@paper_style()
def mapped_points(table: Table, *, title: str = "", frame: str = "world") -> Figure:
    """Columns ``position`` (N, 3) [m], ``slave`` (N,) and ``inside`` (N,) bool; the master's points are grey.

    Raises InputError for a table without these columns or rows.
    """
    if not {"position", "slave", "inside"} <= set(table.columns) or len(table) == 0:
        raise InputError("table", f"holds {', '.join(table.columns)}; position, slave and inside are needed")
    position, slave, inside = (table[name] for name in ("position", "slave", "inside"))
    figure, axes = new_space(position, frame)
    failing = int(np.count_nonzero(slave & ~inside))
    kinds = [
        ("master", ~slave, GREY, 0.12, 2.0),
        ("slave, inside", slave & inside, INSIDE, 0.5, 4.0),
        (f"slave, outside ({failing:,})", slave & ~inside, OUTSIDE, 0.9, 7.0),
    ]
    handles = []
    for label, rows, color, alpha, size in kinds:
        at = np.flatnonzero(rows)
        if len(at) == 0:
            continue
        shown = position[at[thinned(len(at), _POINTS)]].T
        area: Any = size  # annotated as int in matplotlib
        axes.scatter(*shown, s=area, c=color, alpha=alpha, linewidths=0, depthshade=False, rasterized=True)
        handles.append(Line2D([], [], ls="", marker="o", ms=5, color=color, label=label))
    axes.legend(handles=handles, loc="upper left", frameon=False, fontsize=8)
    add_title(figure, title)
    return figure
