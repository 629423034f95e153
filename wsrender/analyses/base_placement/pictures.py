"""The map of placements: how much of the targets is served from each cell, at its best."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from wsrender.errors import InputError
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.style import INK, Heading, color_map, new_figure, paper_style, quantity
from wsrender.volume.table import Table

_NONE = "#f2f2f0"  # cells that serve nothing
_MARK = "#d55e00"
_MOST_COLORS = 12  # whole numbers that have a colour each
_LONGEST, _SHORTEST, _BAR, _LEGEND = 4.4, 1.6, 1.3, 0.3  # edges of the map, room beside and below it [in]


@paper_style()
def placement_map(
    cells: Table,
    *,
    best: tuple[float, ...] | None = None,
    targets: np.ndarray | None = None,
    title: Heading | str = "",
) -> Figure:
    """A table with a grid of one or two axes, coloured by its column weight or served.

    ``best``: coordinates on the axes of what is marked; ``targets`` (K, 2) in the plane of the axes. Raises InputError
    for another table.
    """
    if cells.grid is None or len(cells.grid.shape) > 2 or "served" not in cells.columns:
        raise InputError("table", "must hold cells of one or two axes, and how many targets each serves")
    grid, name = cells.grid, "weight" if "weight" in cells.columns else "served"
    values = cells[name].reshape(grid.shape).astype(float)
    if len(grid.shape) == 1:
        return _curve(cells, name, best, title)
    ends = [(low, low + size * step) for low, size, step in zip(grid.origin, grid.shape, grid.step, strict=True)]
    same = cells.units[grid.axes[0]] == cells.units[grid.axes[1]]
    width, height = _size(ends, same)
    below = _LEGEND if best or targets is not None else 0.0
    figure = new_figure(width + _BAR + 0.7, height + 0.6 + below, title)
    axes = figure.subplots()
    top = max(float(values.max()), 1.0)
    norm = BoundaryNorm(np.arange(0.5, top + 1), 256) if name == "served" and top <= _MOST_COLORS else None
    shown = np.ma.masked_less_equal(values.T, 0)
    colors = color_map().with_extremes(bad=_NONE)
    limits = {} if norm else {"vmin": 0, "vmax": top}
    image = axes.imshow(
        shown, origin="lower", extent=(*ends[0], *ends[1]), cmap=colors, norm=norm, aspect="equal" if same else "auto",
        interpolation="nearest", **limits,
    )  # fmt: skip
    label = "Targets served" if name == "served" else "Weight of the targets served"
    bar = figure.colorbar(image, ax=axes, label=label)
    if norm:
        bar.set_ticks(np.arange(1, top + 1).tolist())
    _mark(axes, best, targets)
    for axis, column in zip("xy", grid.axes, strict=True):
        getattr(axes, f"set_{axis}label")(_label(column, cells))
    axes.set_xlim(*ends[0])
    axes.set_ylim(*ends[1])
    if below:
        _legend(figure)
    return figure


def _curve(cells: Table, name: str, best: tuple[float, ...] | None, title: Heading | str) -> Figure:
    assert cells.grid
    (column,) = cells.grid.axes
    figure = new_figure(5.6, 2.6 + (_LEGEND if best else 0.0), title)
    axes = figure.subplots()
    axes.step(cells[column], cells[name], where="mid", color=color_map()(0.3), lw=1.6)
    if best:
        axes.axvline(best[0], color=_MARK, lw=1.2, label="best placement")
        _legend(figure)
    axes.set_xlabel(_label(column, cells))
    axes.set_ylabel("Targets served" if name == "served" else "Weight of the targets served")
    axes.set_ylim(bottom=0)
    axes.yaxis.set_major_locator(MaxNLocator(6, integer=name == "served"))
    axes.grid(zorder=0)
    return figure


def _label(column: str, cells: Table) -> str:
    return quantity(column.rpartition("_")[0], cells.units[column].replace("deg", "°"))


def _size(ends: list[tuple[float, float]], same: bool) -> tuple[float, float]:
    """Width and height of a map [in]."""
    if not same:
        return _LONGEST, _LONGEST * 0.75
    edges = np.array([high - low for low, high in ends])
    width, height = np.maximum(_LONGEST * edges / edges.max(), _SHORTEST)
    return float(width), float(height)


def _mark(axes: Axes, best: tuple[float, ...] | None, targets: np.ndarray | None) -> None:
    if targets is not None:
        axes.plot(*targets.T, ls="", marker="o", ms=4.5, mfc="none", mec=INK, mew=1.0, label="targets", zorder=3)
    if best:
        axes.plot(*best, ls="", marker="*", ms=13, mfc=_MARK, mec="white", mew=0.9, label="best placement", zorder=4)


def _legend(figure: Figure) -> None:
    """Below the axes, where it hides nothing."""
    figure.legend(loc="outside lower center", ncols=2, frameon=False, fontsize=8)


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
    return placement_map(cells, best=best, targets=targets, title=plot.heading("other"))
