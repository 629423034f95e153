"""Orientations reached at a point: tilts on a disc, Euler angles as planes."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from wsrender.errors import InputError
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.style import INK, Heading, color_map, new_figure, paper_style
from wsrender.volume.table import Table

SYMBOLS = {"alpha": "α", "beta": "β", "gamma": "γ", "torsion": "σ"}
MOST_PANELS = 6
_REACHED = "reached"


@paper_style()
def orientation_map(table: Table, *, title: Heading | str = "") -> Figure:
    """What of a grid of orientations is reached, one panel for each of at most six levels of the last angle.

    The table has three columns of angles [rad], of a regular grid with the last fastest, and ``reached``. Azimuth and
    tilt are drawn on a disc, the tilt outwards from its middle; other angles as a plane, with the first across. Raises
    InputError for another table.
    """
    names = list(table.columns)[:3]
    if _REACHED not in table.columns or names[2:] not in (["gamma"], ["torsion"]):
        raise InputError("table", "does not hold orientations")
    levels = [np.unique(table[name]) for name in names]
    reached = table[_REACHED].reshape([len(level) for level in levels])
    shown = np.unique(np.linspace(0, len(levels[2]) - 1, MOST_PANELS).round().astype(int))
    columns = min(len(shown), 3)
    rows = -(-len(shown) // columns)
    figure = new_figure(2.9 * columns + 1.0, 3.0 * rows + 0.4, title)
    polar = names[0] == "azimuth"
    panels = figure.subplots(rows, columns, squeeze=False, subplot_kw={"projection": "polar"} if polar else {})
    for axes in panels.flat[len(shown) :]:
        axes.set_visible(False)
    for axes, level in zip(panels.flat, shown, strict=False):
        (_disc if polar else _plane)(axes, levels[0], levels[1], reached[:, :, level])
        if len(levels[2]) > 1 or not polar:
            axes.set_title(f"{SYMBOLS[names[2]]} = {np.rad2deg(levels[2][level]):.3g}°")
    handles = [Patch(color=_colors()(code), label=label) for code, label in ((1.0, "reached"), (0.0, "not reached"))]
    figure.legend(handles=handles, loc="outside lower center", ncols=2, frameon=False, fontsize=8)
    return figure


def _colors() -> ListedColormap:
    return ListedColormap(["#e9e9e9", color_map()(0.55)])


def _disc(axes: PolarAxes, azimuth: np.ndarray, tilt: np.ndarray, reached: np.ndarray) -> None:
    """Each orientation as the sector around it."""
    step = 2 * np.pi / len(azimuth)
    around = np.append(azimuth, azimuth[0] + 2 * np.pi) - step / 2
    edges = np.rad2deg(_edges(tilt).clip(min=0))
    axes.pcolormesh(around, edges, reached.T.astype(float), cmap=_colors(), vmin=0, vmax=1, rasterized=True)
    axes.yaxis.set_major_locator(MaxNLocator(4, prune="lower"))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}°")
    axes.tick_params(axis="y", colors=INK)
    axes.set_xlabel("azimuth around, tilt outwards", fontsize=8)
    axes.grid(color="white", lw=0.5)


def _plane(axes: Axes, first: np.ndarray, second: np.ndarray, reached: np.ndarray) -> None:
    edges = [np.rad2deg(_edges(values)) for values in (first, second)]
    axes.pcolormesh(*edges, reached.T.astype(float), cmap=_colors(), vmin=0, vmax=1, rasterized=True)
    axes.set_xlabel("α [°]")
    axes.set_ylabel("β [°]")
    axes.set_box_aspect(1)


def _edges(levels: np.ndarray) -> np.ndarray:
    """Ends of the cells around levels [rad]; a single one gets half a degree to either side."""
    if len(levels) == 1:
        return levels[0] + np.deg2rad([-0.5, 0.5])
    middle = (levels[1:] + levels[:-1]) / 2
    return np.concatenate([[2 * levels[0] - middle[0]], middle, [2 * levels[-1] - middle[-1]]])


def orientations(plot: ResultPlots) -> Figure:
    """Which orientations of a mechanism's platform are reached at a point."""
    return orientation_map(plot.tables["orientations"], title=plot.heading("other"))
