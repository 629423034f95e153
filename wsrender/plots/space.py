"""Three-dimensional axes in metres with equal scales."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.axes3d import Axes3D

from wsrender.errors import InputError
from wsrender.plots.style import GREY, add_color_bar, color_map, new_figure, quantity, value_range
from wsrender.volume.distribution_map import DistributionMap

ELEVATION_DEG, AZIMUTH_DEG = 24.0, -58.0  # of the eye
_SPACE = (0.0, 0.025, 0.82, 0.93)  # left, bottom, width, height of the axes in the figure
_BAR = (0.855, 0.2, 0.02, 0.58)
CLOUD_POINTS = 30_000  # more only hide each other
_THINNEST = 0.3  # least extent of an axis, relative to the largest: planar sets keep a legible box


def new_space(points: np.ndarray, frame: str) -> tuple[Figure, Axes3D]:
    """A figure with axes whose limits hold ``points`` (N, 3) [m], with equal scales on x, y and z."""
    figure = new_figure(6.4, 5.2, layout=None)  # constrained layout measures every tick of 3-D axes: slow
    figure.text(0.03, 0.03, f"{frame} frame", fontsize=8, color=GREY)
    return figure, add_space(figure, points, _SPACE)


def add_space(figure: Figure, points: np.ndarray, place: tuple[float, float, float, float]) -> Axes3D:
    """Such axes at left, bottom, width and height of a figure."""
    axes = Axes3D(figure, place, computed_zorder=False)
    figure.add_axes(axes)
    lower, upper = box(points)
    longest = (upper - lower).max()
    for name, low, high in zip("xyz", lower, upper, strict=True):
        axis = getattr(axes, f"{name}axis")
        axis.set_pane_color((1, 1, 1, 0))
        axis.pane.set_edgecolor("#dddddd")
        axis.set_major_locator(MaxNLocator(5 if high - low > 0.6 * longest else 3))
        getattr(axes, f"set_{name}lim")(low, high)
        getattr(axes, f"set_{name}label")(f"{name} [m]")
    aspect = (upper - lower) / longest
    zoom: Any = np.linalg.norm(aspect) / np.sqrt(3)  # undoes matplotlib's scaling: labels of flat boxes fit
    axes.set_box_aspect(aspect, zoom=zoom)
    axes.view_init(ELEVATION_DEG, AZIMUTH_DEG)
    return axes


def color_points(figure: Figure, samples: DistributionMap, index: str | None, rows: np.ndarray) -> np.ndarray:
    """Colours (len(rows), 4) of the rows of a map by an index (by default its first), with a colour bar.

    Colours span all rows of the map. A map without indices gets one colour and no bar. Raises InputError
    for an unknown index.
    """
    if index is None and not samples.indices:
        return color_map()(np.full(len(rows), 0.35))
    index = checked_index(samples, index)
    values = samples.indices[index]
    norm = value_range(values.min(initial=np.inf), values.max(initial=-np.inf))
    label = quantity(index, samples.units.get(index))
    add_color_bar(figure, norm, label, cax=figure.add_axes(_BAR))
    return color_map()(norm(values[rows]))


def checked_index(samples: DistributionMap, index: str | None) -> str:
    """The index itself, or the map's first; InputError where the map does not hold it."""
    if index is None:
        return next(iter(samples.indices))
    if index not in samples.indices:
        held = ", ".join(samples.indices) or "no index"
        raise InputError("index", f"the map has no {index!r}; it holds {held}")
    return index


def box(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners (3,), (3,) of a box around the points, not thinner than 0.3 of its longest edge [m]."""
    if len(points) == 0:
        return np.full(3, -0.5), np.full(3, 0.5)
    lower, upper = points.min(axis=0).astype(float), points.max(axis=0).astype(float)
    longest = (upper - lower).max()
    span = np.maximum(upper - lower, _THINNEST * longest) if longest > 0 else np.full(3, 0.1)
    middle = (lower + upper) / 2
    return middle - 0.52 * span, middle + 0.52 * span


def thinned(rows: int, most: int = CLOUD_POINTS) -> np.ndarray:
    """Indices of at most ``most`` of ``rows`` rows, evenly spaced: the same at every run."""
    return np.unique(np.linspace(0, rows - 1, min(rows, most)).astype(np.int64))


def far_half(points: np.ndarray) -> np.ndarray:
    """Whether a point (N, 3) lies beyond the vertical plane through the middle of all, seen by the eye.

    All points do where they form a thin sheet: half of it would hide, not show.
    """
    span = np.ptp(points, axis=0)
    if span.min() < _THINNEST * span.max():
        return np.ones(len(points), bool)
    azimuth = np.deg2rad(AZIMUTH_DEG)
    towards_eye = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    return (points - middle) @ towards_eye <= 0
