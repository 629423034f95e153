"""Designs: a value over two parameters that were swept, and objectives against each other."""

import numpy as np
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from wsrender.errors import InputError
from wsrender.results.drawing.color_scale import ColorScale, color_scale
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.style import GREY, INK, Heading, color_map, new_figure, paper_style, quantity
from wsrender.results.drawing.view import add_view, inches
from wsrender.volume.table import Table

BEST = "#c8102e"
_BOX = (1.0, 1.0, 0.7)  # edges of the box in which a surface is drawn


@paper_style()
def sweep_surface(table: Table, value: str | None = None, *, title: Heading | str = "") -> Figure:
    """A value (default: the third column) over the first two, as a surface and as contours; the largest is marked.

    Raises InputError for a table without three columns of numbers, or where the first two have fewer than two values.
    """
    x, y, z = _three(table, value)
    name = value or list(table.columns)[2]
    across, up = np.unique(table[x]), np.unique(table[y])
    if min(len(across), len(up)) < 2:
        raise InputError("table", f"holds fewer than two values of {x} or of {y}: there is no surface to draw")
    heights = np.full((len(up), len(across)), np.nan)
    heights[np.searchsorted(up, table[y]), np.searchsorted(across, table[x])] = z
    known = np.isfinite(heights)
    if not known.any():
        raise InputError("table", f"holds no {name}: there is nothing to draw")
    scale = color_scale(heights, _label(table, name))
    figure = new_figure(9.4, 4.3, title, layout=None)
    grid = np.stack([*np.meshgrid(across, up), heights], axis=-1)
    _draw_surface(figure, grid, scale, (_label(table, x), _label(table, y)))
    plane = figure.add_axes(inches(figure, (5.3, 0.6, 2.95, 3.25)))
    plane.contourf(across, up, heights, levels=_levels(scale), cmap=scale.colors, norm=scale.norm, extend=scale.extend)
    best = np.unravel_index(np.nanargmax(heights), heights.shape)
    at = across[best[1]], up[best[0]]
    label = f"largest: {heights[best]:.5g} at {at[0]:.4g}, {at[1]:.4g}"
    plane.plot(*at, marker="o", ms=6, mfc="none", mew=1.6, color=BEST, ls="", label=label, clip_on=False, zorder=5)
    plane.set(xlabel=_label(table, x), ylabel=_label(table, y))
    for axis in (plane.xaxis, plane.yaxis):
        axis.set_major_locator(MaxNLocator(5))
    plane.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, fontsize=8)
    scale.add_bar(figure, cax=figure.add_axes(inches(figure, (8.4, 0.6, 0.14, 3.25))))
    return figure


def _draw_surface(figure: Figure, grid: np.ndarray, scale: ColorScale, names: tuple[str, str]) -> None:
    """A surface (rows, columns, 3) in a box whose edges are no lengths, cell by cell in the colour of its mean."""
    cells = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=2).reshape(-1, 4, 3)
    cells = cells[np.isfinite(cells).all(axis=(1, 2))]
    extent = np.nanmax(grid, axis=(0, 1)) - np.nanmin(grid, axis=(0, 1))
    stretch = np.array(_BOX) / np.where(extent > 0, extent, 1.0)
    labels = (*names, scale.label)
    points = grid.reshape(-1, 3)
    points = points[np.isfinite(points).all(axis=1)] * stretch
    view = add_view(figure, points, (0.0, 0.3, 4.5, 3.9), -125.0, 28.0, stretch=stretch, names=labels)
    if len(cells):
        corners = np.concatenate([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]]) * stretch
        colors = np.tile(scale(cells[:, :, 2].mean(axis=1))[:, :3], (2, 1))
        view.add_surface(corners, np.repeat(colors[:, None], 3, axis=1))


def _levels(scale: ColorScale) -> list[float]:
    """Values between which a contour plot changes its colour: those of a whole number each, or round ones."""
    if isinstance(scale.norm, BoundaryNorm):
        return list(scale.norm.boundaries)
    low, high = scale.limits
    return [low, *(float(value) for value in MaxNLocator(14).tick_values(low, high) if low < value < high), high]


@paper_style()
def trade_off(designs: Table, front: Table, x: str, y: str, *, title: Heading | str = "") -> Figure:
    """Two values of all designs against each other, and those that no other design beats."""
    figure = new_figure(5.4, 4.2, title)
    axes = figure.add_subplot()
    axes.plot(designs[x], designs[y], ls="", marker=".", ms=3, color=GREY, alpha=0.5, label="all designs")
    order = np.argsort(front[x])
    label = f"beaten by none ({len(front)})"
    axes.plot(front[x][order], front[y][order], ls="-", lw=0.8, marker="o", ms=4, color=color_map()(0.35), label=label)
    axes.set(xlabel=_label(designs, x), ylabel=_label(designs, y))
    axes.grid(zorder=0)
    axes.legend(frameon=False, fontsize=8, labelcolor=INK)
    return figure


def _three(table: Table, value: str | None) -> tuple[str, str, np.ndarray]:
    names = list(table.columns)
    if len(names) < 3 or (value is not None and value not in names[2:]):
        allowed = ", ".join(names[2:]) or "nothing beyond two columns"
        raise InputError("value", f"{value!r} is not a value of the table, which holds {allowed}")
    return names[0], names[1], table[value or names[2]]


def _label(table: Table, name: str) -> str:
    return quantity(name, table.units.get(name))


def sweep(plot: ResultPlots, value: str | None = None) -> Figure:
    """A value of a design sweep over its first two parameters, as a surface and as contours; over one as a curve."""
    if len(plot.document["parameters"]) == 1:
        return plot.curves("sweep")
    return sweep_surface(plot.tables["sweep"], value, title=plot.heading("other"))


def pareto(plot: ResultPlots, x: str | None = None, y: str | None = None) -> Figure:
    """Two objectives of a Pareto search against each other, by default the first two."""
    first, second = (objective["name"] for objective in plot.document["objectives"][:2])
    tables = plot.tables["evaluations"], plot.tables["pareto"]
    return trade_off(*tables, x or first, y or second, title=plot.heading("other"))
