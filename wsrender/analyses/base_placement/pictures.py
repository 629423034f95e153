"""The map of placements: how much of the targets is served from each cell, at its best, and by which arm."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Polygon
from matplotlib.ticker import MaxNLocator

from wsrender.documents.placements import TableEdge
from wsrender.errors import InputError
from wsrender.results.drawing.cells import (
    BAR,
    BELOW,
    EMPTY,
    curve,
    curve_figure,
    draw_along,
    draw_map,
    draw_marks,
    legend_below,
    map_figure,
    map_size,
)
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.stick_figure import ROBOTS
from wsrender.results.drawing.style import GREY, INK, Heading, color_map, new_figure, paper_style, quantity
from wsrender.results.drawing.whole import whole_ticks
from wsrender.volume.table import Table

_SERVED = {"served": "Targets served", "weight": "Weight of the targets served"}
_BEST = "best placement"
_MOST_COLORS = 12  # whole numbers that have a colour each
_SEVERAL = "#8c8c8c"  # cells that several arms serve equally well
_ACROSS = 3  # maps of arms beside each other
_FINE = 200  # parts of either axis, in each of which one placement is drawn of those that the Pareto set beats


@paper_style()
def placement_map(
    cells: Table,
    *,
    best: tuple[float, ...] | None = None,
    targets: np.ndarray | None = None,
    around: np.ndarray | None = None,
    title: Heading | str = "",
) -> Figure:
    """A table with a grid of one or two axes, coloured by its column weight or served.

    ``best``: coordinates on the axes of what is marked; ``targets`` (K, 2) in the plane of the axes; ``around`` (C, 2):
    corners of a table there. Raises InputError for another table.
    """
    if cells.grid is None or len(cells.grid.shape) > 2 or "served" not in cells.columns:
        raise InputError("table", "must hold cells of one or two axes, and how many targets each serves")
    grid, name = cells.grid, "weight" if "weight" in cells.columns else "served"
    values = cells[name].reshape(grid.shape).astype(float)
    if len(grid.shape) == 1:
        figure, axes = curve(cells, name, _SERVED[name], best, _BEST, title)
        axes.yaxis.set_major_locator(_ticks(name, 6))
        return figure
    below = bool(best) or targets is not None
    figure, axes = map_figure(cells, title, below)
    _served(figure, [axes], [values], name, cells)
    draw_marks(axes, best, targets, _BEST)
    if around is not None:
        axes.add_patch(Polygon(around, fill=False, ec=INK, lw=1.0, zorder=2, label="table"))
    if below:
        legend_below(figure, ncols=3)
    return figure


def _served(figure: Figure, panels: list[Axes], values: list[np.ndarray], name: str, cells: Table) -> None:
    """Grids of how much is served, on the axes of each, and the scale that they share."""
    top = max(1.0, *(float(each.max()) for each in values))
    norm = BoundaryNorm(np.arange(0.5, top + 1), 256) if name == "served" and top <= _MOST_COLORS else None
    limits = {"norm": norm} if norm else {"vmin": 0, "vmax": top}
    colors = color_map().with_extremes(bad=EMPTY)
    shown = zip(panels, values, strict=True)
    image, *_ = [draw_map(axes, np.ma.masked_less_equal(each, 0), cells, cmap=colors, **limits) for axes, each in shown]
    bar = figure.colorbar(image, ax=panels, label=_SERVED[name])
    if name == "served":
        bar.set_ticks(np.arange(1, top + 1).tolist() if norm else whole_ticks(_MOST_COLORS))


def _ticks(name: str, most: int) -> MaxNLocator:
    """Of how much is served; where targets are counted no part of one is written."""
    return whole_ticks(most) if name == "served" else MaxNLocator(most)


def placements(plot: ResultPlots) -> Figure:
    """The map of a job of placements, with its best one, and the targets where it is a plan of the world."""
    cells, document = plot.tables["placement_map"], plot.document["best"]
    assert cells.grid
    best = None if document is None else tuple(float(document[name]) for name in cells.grid.axes)
    plan = all(name in ("x_m", "y_m", "z_m") for name in cells.grid.axes) and len(cells.grid.axes) == 2
    targets = None
    if plan and "targets" in plot.tables:
        across = ["xyz".index(name[0]) for name in cells.grid.axes]
        targets = plot.tables["targets"]["position"][:, across]
    mounting = plot.document["job"]["mounting"]
    plane = cells.grid.axes == ("x_m", "y_m") and isinstance(mounting, Mapping)
    around = TableEdge(**mounting).corners if plane else None
    return placement_map(cells, best=best, targets=targets, around=around, title=plot.heading("other"))


@paper_style()
def arms_map(
    cells: Table, names: list[str], *, best: Mapping[str, tuple[float, ...]], title: Heading | str = ""
) -> Figure:
    """A map of each arm, of columns weight_ or served_<name>, on one scale, and one of where each serves best.

    ``best``: coordinates on the axes of what is marked, by arm. Raises InputError for another table.
    """
    if cells.grid is None or len(cells.grid.shape) > 2 or any(f"wins_{name}" not in cells.columns for name in names):
        raise InputError("table", "must hold cells of one or two axes, and where each of the arms serves best")
    kind = "weight" if f"weight_{names[0]}" in cells.columns else "served"
    values = [cells[f"{kind}_{name}"].astype(float).reshape(cells.grid.shape) for name in names]
    if len(cells.grid.shape) == 1:
        return _curves(cells, dict(zip(names, values, strict=True)), kind, best, title)
    count = len(names) + 1
    across, down = min(count, _ACROSS), -(-count // _ACROSS)
    width, height = (0.72 * edge for edge in map_size(cells))
    figure = new_figure(across * (width + 0.7) + BAR, down * (height + 0.75) + BELOW, title)
    panels = figure.subplots(down, across, squeeze=False).ravel()
    for axes in panels[count:]:
        axes.set_axis_off()
    _served(figure, list(panels[:count]), [*values, np.zeros_like(values[0])], kind, cells)
    wins = np.array([cells[f"wins_{name}"].reshape(cells.grid.shape) for name in names])
    which = np.select([~wins.any(axis=0), wins.sum(axis=0) > 1], [0, 1], 2 + wins.argmax(axis=0))
    colors = [EMPTY, _SEVERAL, *(_color(k) for k in range(len(names)))]
    draw_map(panels[count - 1], to_rgba_array(colors)[which], cells)
    panels[count - 1].set_title("serves best")
    for axes, name in zip(panels, names, strict=False):
        axes.set_title(name)
        draw_marks(axes, best.get(name), None, _BEST)
    shown = [Patch(facecolor=color, label=name) for name, color in zip(names, colors[2:], strict=True)]
    shown += [Patch(facecolor=_SEVERAL, label="several equally")] if (which == 1).any() else []
    marks = panels[0].get_legend_handles_labels()[0][:1]
    legend_below(figure, handles=[*shown, *marks], ncols=6)
    return figure


def _color(number: int) -> str:
    """Of an arm by its place, as where arms are drawn."""
    return ROBOTS[number % len(ROBOTS)]


def _curves(
    cells: Table,
    values: Mapping[str, np.ndarray],
    kind: str,
    best: Mapping[str, tuple[float, ...]],
    title: Heading | str,
) -> Figure:
    assert cells.grid
    (column,) = cells.grid.axes
    figure, axes = curve_figure(title, below=True)
    for k, (name, each) in enumerate(values.items()):
        axes.step(cells[column], each, where="mid", color=_color(k), lw=1.6, label=name)
        if name in best:
            axes.axvline(best[name][0], color=_color(k), lw=1.0, ls="--")
    draw_along(axes, cells, _SERVED[kind])
    axes.yaxis.set_major_locator(_ticks(kind, 6))
    legend_below(figure)
    return figure


def arms(plot: ResultPlots) -> Figure:
    """The maps of a job of placements of several robots, with the best placement of each."""
    cells, robots = plot.tables["arms_map"], plot.document["robots"]
    assert cells.grid
    best = {
        each["name"]: tuple(float(each["best"][axis]) for axis in cells.grid.axes) for each in robots if each["best"]
    }
    return arms_map(cells, [each["name"] for each in robots], best=best, title=plot.heading("other"))


@paper_style()
def trade_off(
    front: Table,
    placements: Mapping[str, Table],
    names: Sequence[str],
    *,
    best: tuple[float, float] | None = None,
    title: Heading | str = "",
) -> Figure:
    """How much placements serve against their index, or two indices: a Pareto set, and all, of each robot by name.

    ``names``: the columns of the two objectives; ``best``: values of what is marked.
    """
    figure = new_figure(5.6, 4.0 + BELOW, title)
    axes = figure.subplots()
    for k, (name, cells) in enumerate(placements.items()):
        several = len(placements) > 1
        x, y = _thinned(*(cells[column].astype(float) for column in names))
        label = f"{name}, all placements" if several else "all placements"
        axes.plot(x, y, ls="", marker=".", ms=3, color=_color(k) if several else GREY, alpha=0.4, label=label, zorder=2)
    x, y = (front[column] for column in names)
    axes.step(x, y, where="post", lw=0.8, color=INK, zorder=3)  # the largest weight first
    axes.plot(x, y, ls="", marker="o", ms=5, mfc="none", mec=INK, label="Pareto set", zorder=4)
    draw_marks(axes, best, None, _BEST)
    x, y = (_SERVED.get(name) or quantity(name, front.units[name]) for name in names)
    axes.set(xlabel=x, ylabel=y)
    axes.xaxis.set_major_locator(_ticks(names[0], 8))
    axes.grid(zorder=0)
    legend_below(figure)
    return figure


def _thinned(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of points those of finite values, one in each of many small parts of the plane."""
    finite = np.isfinite(y)
    x, y = x[finite], y[finite]
    parts = [np.floor(_FINE * (each - each.min()) / (np.ptp(each) or 1.0)) for each in (x, y)] if len(x) else [x, y]
    _, kept = np.unique(parts[0] * 2 * _FINE + parts[1], return_index=True)
    return x[kept], y[kept]


def pareto(plot: ResultPlots) -> Figure:
    """The Pareto set of a job of placements among all of them, with the best placement, which may be refined."""
    front, robots = plot.tables["pareto"], plot.document.get("robots", ())
    names = {each["name"]: f"placements_{each['name']}" for each in robots} or {"": "placements"}
    placements = {name: plot.tables[table] for name, table in names.items() if table in plot.tables}
    names, document = plot.document["pareto"]["objectives"], plot.document["best"]
    if names[0] not in _SERVED:  # two indices, of placements that serve as much as those of the set
        served = "weight" if "weight" in front.columns else "served"
        least = front[served].min() * (1 - 1e-9)
        placements = {name: _rows(cells, cells[served] >= least) for name, cells in placements.items()}
    best = tuple(document[name] for name in names)
    return trade_off(front, placements, names, best=best, title=plot.heading("other"))


def _rows(cells: Table, which: np.ndarray) -> Table:
    return Table({name: column[which] for name, column in cells.columns.items()}, cells.units)
