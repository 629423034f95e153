"""A slave's workspace in its master's: green where it lies inside, red where it does not."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from wsrender.errors import InputError
from wsrender.results.drawing.cloud import thinned
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.style import GREY, Heading, paper_style
from wsrender.results.drawing.view import new_view
from wsrender.volume.table import Table

INSIDE, OUTSIDE = "#1a9641", "#c8102e"
_POINTS = 8000  # of each kind


@paper_style()
def mapped_points(table: Table, *, title: Heading | str = "", frame: str = "world") -> Figure:
    """Columns ``position`` (N, 3) [m], ``slave`` (N,) and ``inside`` (N,) bool; the master's points are grey.

    Raises InputError for a table without these columns or rows.
    """
    if not {"position", "slave", "inside"} <= set(table.columns) or len(table) == 0:
        raise InputError("table", f"holds {', '.join(table.columns)}; position, slave and inside are needed")
    position, slave, inside = (table[name] for name in ("position", "slave", "inside"))
    figure, view = new_view(position, title, frame)
    failing = int(np.count_nonzero(slave & ~inside))
    # What fails lies over what does not, and the master over both: a slave may surround it.
    kinds = [
        ("master", ~slave, GREY, {"size": 2.0, "alpha": 0.3, "zorder": 3.2}),
        (f"slave, inside ({np.count_nonzero(slave & inside):,})", slave & inside, INSIDE, {"size": 4.0, "alpha": 0.5}),
        (f"slave, outside ({failing:,})", slave & ~inside, OUTSIDE, {"size": 5.0, "alpha": 0.6, "zorder": 3.1}),
    ]
    handles = []
    for label, rows, color, style in kinds:
        at = np.flatnonzero(rows)
        if len(at) == 0:
            continue
        view.add_dots(position[at[thinned(len(at), _POINTS)]], color, **style)
        handles.append(Line2D([], [], ls="", marker="o", ms=5, color=color, label=label))
    view.axes.legend(handles=handles, loc="upper left", frameon=False, fontsize=8)
    return figure


def mapping(plot: ResultPlots) -> Figure:
    """A slave's points in its master's workspace: green inside, red outside."""
    return mapped_points(plot.tables["mapping"], title=plot.heading("samples"))
