"""The boundary of a planar arm: samples, Monte Carlo segments and the exact lines and arcs, one over the other."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from wsrender.errors import InputError
from wsrender.geometry.planar.segments import drawn
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.style import INK, Heading, new_figure, paper_style, quantity
from wsrender.volume.table import Table

SAMPLES, ESTIMATED, INSIDE, OUTSIDE = "#9ecae1", "#e6550d", "#1a9641", "#c8102e"
_LONGEST, _LEAST = 5.6, 1.6  # edges of the axes [in]


@paper_style()
def boundary_lines(tables: Mapping[str, Table], *, title: Heading | str = "") -> Figure:
    """Tables ``boundary``, ``monte_carlo``, ``samples`` and ``points`` of the analysis, as far as there are any.

    A Monte Carlo boundary that has not converged, by the column of that name, is pale and dashed, and the legend says
    so. Raises InputError where neither of the first three holds anything.
    """
    samples = tables["samples"]["position"] if "samples" in tables else np.empty((0, 2))
    lines = {name: _lines(tables[name]) for name in ("monte_carlo", "boundary") if name in tables}
    points = np.concatenate([samples, *(line for drawn_lines in lines.values() for line in drawn_lines)])
    if len(points) == 0:
        raise InputError("tables", "hold neither samples nor segments: there is nothing to draw")
    asked = tables["points"]["point"] if "points" in tables else np.empty((0, 2))
    figure, axes = _new_plane(np.concatenate([points, asked]), title)
    axes.plot(*samples.T, ls="", marker=".", ms=1.2, mew=0, color=SAMPLES, rasterized=True)
    axes.plot([], [], ls="", marker=".", ms=6, mew=0, color=SAMPLES, label="samples")
    styles: dict[str, dict[str, Any]] = {
        "monte_carlo": {"color": ESTIMATED, "lw": 1.6, "label": "Monte Carlo", "zorder": 3},
        "boundary": {"color": INK, "lw": 1.1, "label": "exact", "zorder": 4},
    }
    if "monte_carlo" in tables and not np.all(tables["monte_carlo"].columns.get("converged", True)):
        styles["monte_carlo"] |= {"alpha": 0.45, "ls": (0, (4, 2)), "label": "Monte Carlo,\nnot converged"}
    for name, pieces in lines.items():
        axes.add_collection(LineCollection(pieces, **styles[name]))
        starts = np.array([piece[0] for piece in pieces])
        axes.plot(*starts.T, ls="", marker="o", ms=3.2, mew=0, zorder=5, **_marked(styles[name]))
    if "points" in tables:
        _draw_points(axes, tables["points"])
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, fontsize=8)
    return figure


def _marked(style: dict[str, Any]) -> dict[str, Any]:
    """Colour of the ends of segments in a style of lines."""
    return {name: style[name] for name in ("color", "alpha") if name in style}


def _lines(table: Table) -> list[np.ndarray]:
    return [drawn(table, row) for row in range(len(table))]


def _new_plane(points: np.ndarray, heading: Heading | str) -> tuple[Figure, Axes]:
    """Axes with equal scales whose limits hold the points, with room for a legend on the right."""
    low, high = points.min(axis=0), points.max(axis=0)
    extent = np.maximum(high - low, 0.25 * max((high - low).max(), 1e-6))
    middle, half = (low + high) / 2, 0.54 * extent
    width, height = np.maximum(_LONGEST * extent / extent.max(), _LEAST)
    figure = new_figure(float(width) + 2.3, float(height) + 0.6, heading)
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
    axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
    for axis, name in ((axes.xaxis, "x"), (axes.yaxis, "y")):
        axis.set_major_locator(MaxNLocator(6))
        axis.set_label_text(quantity(name, "m"))
    axes.grid(zorder=0)
    axes.set_axisbelow(True)
    return figure, axes


def _draw_points(axes: Axes, table: Table) -> None:
    """Asked points, each with a thin line to the nearest point of the boundary."""
    for label, color, rows in (("inside", INSIDE, table["inside"]), ("outside", OUTSIDE, ~table["inside"])):
        if not rows.any():
            continue
        ends = np.stack([table["point"][rows], table["nearest"][rows]], axis=1)
        axes.add_collection(LineCollection(list(ends), color=color, lw=0.7, zorder=5))
        axes.plot(*table["point"][rows].T, ls="", marker="D", ms=4, mew=0, color=color, label=label, zorder=6)


def boundary(plot: ResultPlots) -> Figure:
    """The boundary of a planar arm: samples, Monte Carlo segments and the exact lines and arcs."""
    return boundary_lines(plot.tables, title=plot.heading("boundary"))
