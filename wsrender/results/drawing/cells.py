"""Cells of a table of one or two axes, as where a base may stand: a map, or a curve, and what is marked on it."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from wsrender.results.drawing.okabe_ito import VERMILION
from wsrender.results.drawing.style import INK, Heading, color_map, new_figure, quantity
from wsrender.volume.table import CellGrid, Table

EMPTY = "#f2f2f0"  # cells from which nothing is reached
MARK = VERMILION  # what is best
BAR, BELOW = 1.3, 0.3  # room beside and below a map [in]
_LONGEST, _SHORTEST = 4.4, 1.6  # edges of a map [in]
_CURVE = (5.6, 2.6)


def map_size(cells: Table) -> tuple[float, float]:
    """Width and height of a map of two axes [in]."""
    assert cells.grid
    if cells.units[cells.grid.axes[0]] != cells.units[cells.grid.axes[1]]:
        return _LONGEST, _LONGEST * 0.75
    edges = np.array([high - low for low, high in _ends(cells.grid)])
    width, height = np.maximum(_LONGEST * edges / edges.max(), _SHORTEST)
    return float(width), float(height)


def map_figure(cells: Table, title: Heading | str, below: bool) -> tuple[Figure, Axes]:
    """A figure for one map of two axes, with room beside it and, where asked for, ``below``."""
    width, height = map_size(cells)
    figure = new_figure(width + BAR + 0.7, height + 0.6 + BELOW * below, title)
    return figure, figure.subplots()


def draw_map(axes: Axes, values: np.ndarray, cells: Table, **options: Any) -> AxesImage:
    """A value or colour of every cell of two axes, on axes that say where these are."""
    grid = cells.grid
    assert grid
    ends = _ends(grid)
    aspect = "equal" if cells.units[grid.axes[0]] == cells.units[grid.axes[1]] else "auto"
    extent = (*ends[0], *ends[1])
    image = axes.imshow(
        values.swapaxes(0, 1), origin="lower", extent=extent, aspect=aspect, interpolation="nearest", **options
    )
    for axis, column in zip("xy", grid.axes, strict=True):
        getattr(axes, f"set_{axis}label")(_label(column, cells))
    return image


def curve(
    cells: Table, name: str, says: str, best: tuple[float, ...] | None, best_is: str, title: Heading | str
) -> tuple[Figure, Axes]:
    """The column ``name`` over cells of one axis, upwards what it ``says``, with ``best``, if any, and what that is."""
    assert cells.grid
    (column,) = cells.grid.axes
    figure, axes = curve_figure(title, below=best is not None)
    axes.step(cells[column], cells[name], where="mid", color=color_map()(0.3), lw=1.6)
    if best is not None:
        axes.axvline(best[0], color=MARK, lw=1.2, label=best_is)
        legend_below(figure)
    draw_along(axes, cells, says)
    return figure, axes


def curve_figure(title: Heading | str, below: bool) -> tuple[Figure, Axes]:
    """A figure for curves over the one axis of cells."""
    width, height = _CURVE
    figure = new_figure(width, height + BELOW * below, title)
    return figure, figure.subplots()


def draw_along(axes: Axes, cells: Table, says: str) -> None:
    """What curves over the one axis of cells need."""
    assert cells.grid
    axes.set_xlabel(_label(cells.grid.axes[0], cells))
    axes.set_ylabel(says)
    axes.set_ylim(bottom=0)
    axes.grid(zorder=0)


def draw_marks(axes: Axes, best: tuple[float, ...] | None, targets: np.ndarray | None, best_is: str) -> None:
    """``best``, a star, and ``targets`` (K, 2), rings, by coordinates on the axes."""
    if targets is not None:
        label = "target" if len(targets) == 1 else "targets"
        axes.plot(*targets.T, ls="", marker="o", ms=4.5, mfc="none", mec=INK, mew=1.0, label=label, zorder=3)
    if best:
        axes.plot(*best, ls="", marker="*", ms=13, mfc=MARK, mec="white", mew=0.9, label=best_is, zorder=4)


def legend_below(figure: Figure, **options: Any) -> None:
    """Below the axes, where it hides nothing."""
    figure.legend(loc="outside lower center", frameon=False, fontsize=8, **{"ncols": 2} | options)


def _ends(grid: CellGrid) -> list[tuple[float, float]]:
    return [(low, low + size * step) for low, size, step in zip(grid.origin, grid.shape, grid.step, strict=True)]


def _label(column: str, cells: Table) -> str:
    return quantity(column.rpartition("_")[0], cells.units[column])
