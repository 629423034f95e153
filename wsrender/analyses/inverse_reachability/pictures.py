"""The map of base positions: from what share of the orientations the target is reached."""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from wsrender.errors import InputError
from wsrender.results.drawing.cells import EMPTY, curve, draw_map, draw_marks, legend_below, map_figure
from wsrender.results.drawing.okabe_ito import ORANGE
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.style import Heading, color_map, paper_style
from wsrender.volume.table import Table

_OPEN = ORANGE  # cells that are not decided
_BEST = "best base"
SHARE = "Share of the base's orientations"


@paper_style()
def base_positions(
    cells: Table,
    *,
    best: tuple[float, ...] | None = None,
    target: tuple[float, ...] | None = None,
    title: Heading | str = "",
) -> Figure:
    """A table with a grid of one or two lengths, coloured by its column share.

    ``best``, ``target``: what is marked, by coordinates on the axes. Raises InputError for another table.
    """
    if cells.grid is None or len(cells.grid.shape) > 2 or "share" not in cells.columns:
        raise InputError("table", "must hold cells of one or two axes, and shares of orientations")
    if len(cells.grid.shape) == 1:
        figure, axes = curve(cells, "share", SHARE, best, _BEST, title)
        axes.set_ylim(0, 1.05)
        return figure
    open_ = (cells["reachable"] == 0) & (cells["undecided"] > 0)  # nothing is known but that some are undecided
    below = open_.any() or best is not None or target is not None
    figure, axes = map_figure(cells, title, bool(below))
    share, colors = cells["share"].reshape(cells.grid.shape), color_map().with_extremes(bad=EMPTY)
    image = draw_map(axes, np.ma.masked_less_equal(share, 0), cells, cmap=colors, vmin=0, vmax=1)
    figure.colorbar(image, ax=axes, label=SHARE)
    if open_.any():
        shown = np.ma.masked_equal(open_.reshape(share.shape), False)
        draw_map(axes, shown, cells, cmap=ListedColormap([_OPEN]))
    draw_marks(axes, best, None if target is None else np.array([target]), _BEST)
    handles = axes.get_legend_handles_labels()[0] + ([Patch(color=_OPEN, label="undecided")] if open_.any() else [])
    if below:
        legend_below(figure, handles=handles, ncols=len(handles))
    return figure


def base_map(plot: ResultPlots) -> Figure:
    """The map of a job's base positions, with the target, and the one farthest from those that do not reach it."""
    cells, document = plot.tables["base_map"], plot.document["best"]
    assert cells.grid
    best = None if document is None else tuple(float(document[name]) for name in cells.grid.axes)
    target = None
    if "target" in plot.tables:
        target = tuple(float(plot.tables["target"]["position"][0]["xyz".index(name[0])]) for name in cells.grid.axes)
    return base_positions(cells, best=best, target=target, title=plot.heading("other"))
