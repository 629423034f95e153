"""Designs: a value over two parameters that were swept, and objectives against each other."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from wsrender.errors import InputError
from wsrender.plots.style import GREY, INK, add_title, color_map, new_figure, paper_style, quantity, value_range
from wsrender.volume.table import Table

BEST = "#c8102e"


@paper_style()
def sweep_surface(table: Table, value: str | None = None, *, title: str = "") -> Figure:
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
    norm = value_range(float(heights[known].min()), float(heights[known].max()))
    figure = new_figure(9.2, 4.2)
    grid = np.meshgrid(across, up)
    space = figure.add_subplot(1, 2, 1, projection="3d")
    space.plot_surface(*grid, heights, cmap=color_map(), norm=norm, rcount=80, ccount=80, lw=0.2, edgecolor="#ffffff40")
    space.view_init(28, -125)
    zoom: Any = 0.82  # annotated as int in matplotlib
    space.set_box_aspect(None, zoom=zoom)
    for axis in (space.xaxis, space.yaxis, space.zaxis):
        axis.set_major_locator(MaxNLocator(4))
    space.set(xlabel=_label(table, x), ylabel=_label(table, y), zlabel=_label(table, name))
    plane = figure.add_subplot(1, 2, 2)
    filled = plane.contourf(*grid, heights, levels=14, cmap=color_map(), norm=norm)
    best = np.unravel_index(np.nanargmax(heights), heights.shape)
    at = across[best[1]], up[best[0]]
    label = f"largest: {heights[best]:.5g} at {at[0]:.4g}, {at[1]:.4g}"
    plane.plot(*at, marker="o", ms=6, mfc="none", mew=1.6, color=BEST, ls="", label=label, clip_on=False, zorder=5)
    plane.set(xlabel=_label(table, x), ylabel=_label(table, y))
    plane.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, fontsize=8)
    bar = figure.colorbar(filled, ax=plane, shrink=0.9)
    bar.set_label(_label(table, name))
    bar.outline.set_visible(False)
    add_title(figure, title)
    return figure


@paper_style()
def trade_off(designs: Table, front: Table, x: str, y: str, *, title: str = "") -> Figure:
    """Two values of all designs against each other, and those that no other design beats."""
    figure = new_figure(5.4, 4.2)
    axes = figure.add_subplot()
    axes.plot(designs[x], designs[y], ls="", marker=".", ms=3, color=GREY, alpha=0.5, label="all designs")
    order = np.argsort(front[x])
    label = f"beaten by none ({len(front)})"
    axes.plot(front[x][order], front[y][order], ls="-", lw=0.8, marker="o", ms=4, color=color_map()(0.35), label=label)
    axes.set(xlabel=_label(designs, x), ylabel=_label(designs, y))
    axes.grid(zorder=0)
    axes.legend(frameon=False, fontsize=8, labelcolor=INK)
    add_title(figure, title)
    return figure


def _three(table: Table, value: str | None) -> tuple[str, str, np.ndarray]:
    names = list(table.columns)
    if len(names) < 3 or (value is not None and value not in names[2:]):
        allowed = ", ".join(names[2:]) or "nothing beyond two columns"
        raise InputError("value", f"{value!r} is not a value of the table, which holds {allowed}")
    return names[0], names[1], table[value or names[2]]


def _label(table: Table, name: str) -> str:
    return quantity(name, table.units.get(name))
