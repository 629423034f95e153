"""Three-dimensional axes in metres with equal scales."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.axes3d import Axes3D

from wsrender.plots.style import GREY

ELEVATION_DEG, AZIMUTH_DEG = 24.0, -58.0  # of the eye
CLOUD_POINTS = 30_000  # more only hide each other
_THINNEST = 0.3  # least extent of an axis, relative to the largest: planar sets keep a legible box


def add_space(figure: Figure, points: np.ndarray, frame: str) -> Axes3D:
    """Axes whose limits hold ``points`` (N, 3) [m], with equal scales on x, y and z."""
    axes = figure.add_subplot(projection="3d", computed_zorder=False)
    lower, upper = box(points)
    for name, low, high in zip("xyz", lower, upper, strict=True):
        axis = getattr(axes, f"{name}axis")
        axis.set_pane_color((1, 1, 1, 0))
        axis.pane.set_edgecolor("#dddddd")
        axis.set_major_locator(MaxNLocator(5 if high - low > 0.6 * (upper - lower).max() else 3))
        getattr(axes, f"set_{name}lim")(low, high)
        getattr(axes, f"set_{name}label")(f"{name} [m]")
    axes.set_box_aspect(upper - lower, zoom=1.12)
    axes.view_init(ELEVATION_DEG, AZIMUTH_DEG)
    axes.text2D(0.0, 0.02, f"{frame} frame", transform=axes.transAxes, fontsize=8, color=GREY)
    return axes


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
