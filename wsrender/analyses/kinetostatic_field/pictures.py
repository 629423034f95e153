"""An arm with its links coloured by the nearness of their joints to a limit, and ellipsoids at the tip."""

from itertools import pairwise
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from scipy.spatial import ConvexHull

from wsrender.errors import InputError
from wsrender.results.drawing.okabe_ito import BLUE, VERMILION
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.style import GREY, INK, Heading, paper_style, three_digits
from wsrender.results.drawing.view import BAR, DrawnAxes, inches, new_view
from wsrender.volume.table import Table

VELOCITY, FORCE, RENDERED = BLUE, VERMILION, "#c8102e"
_LONGEST = 0.22  # of an ellipsoid's half axis, relative to the arm's extent
_ARROW = 0.35  # length of the arrow of a force, relative to the arm's extent
_ROUND, _HALF_ROUND = 41, 21  # points around an ellipsoid
_LINES = 5  # one of so many lines through them is drawn


@paper_style()
def limits_and_ellipsoids(
    posture: Table, ellipsoids: Table, *, title: Heading | str = "", frame: str = "world"
) -> Figure:
    """The arm of a table ``posture`` with the ``ellipsoids`` of its tip, each to a scale of its own.

    Raises InputError for tables that lack their columns.
    """
    for table, needed in ((posture, {"position", "limit_nearness"}), (ellipsoids, {"axis", "velocity", "force"})):
        if not needed <= set(table.columns):
            raise InputError("table", f"holds {', '.join(table.columns)}; {', '.join(sorted(needed))} are needed")
    points, nearness = posture["position"], posture["limit_nearness"]
    extent = float(np.linalg.norm(np.ptp(points, axis=0)))
    scales = {name: _LONGEST * extent / max(float(ellipsoids[name].max()), 1e-300) for name in ("velocity", "force")}
    surfaces = {name: _ellipsoid(points[-1], ellipsoids["axis"], ellipsoids[name] * scales[name]) for name in scales}
    arrow = _arrow(points[-1], ellipsoids, extent)
    around = np.concatenate([points, arrow, *(surface.reshape(-1, 3) for surface in surfaces.values())])
    middle, half = (around.min(axis=0) + around.max(axis=0)) / 2, 0.3 * np.ptp(around, axis=0).max()
    around = np.concatenate([around, [middle - half, middle + half]])  # no thin box
    figure, view = new_view(around, title, frame)
    _draw_arm(view, points, nearness)
    for name, color in (("velocity", VELOCITY), ("force", FORCE)):
        _draw_ellipsoid(view, surfaces[name], color)
    view.axes.legend(handles=_handles(ellipsoids), loc="upper left", frameon=False, fontsize=8)
    if len(arrow):
        start, end = view.space.camera.to_picture(arrow)
        style = {"arrowstyle": "-|>", "color": RENDERED, "lw": 2.0, "shrinkA": 0, "shrinkB": 0}
        view.axes.annotate("", end, start, arrowprops=style, zorder=8)
    bar = figure.colorbar(ScalarMappable(Normalize(0, 1), _colors()), cax=figure.add_axes(inches(figure, BAR)))
    bar.set_label("Nearness of joint limits (0 middle, 1 limit)")
    bar.outline.set_visible(False)
    return figure


def _draw_arm(view: DrawnAxes, points: np.ndarray, nearness: np.ndarray) -> None:
    """Links in the colours of their joints, (L+2, 3) [m]."""
    colors = _colors()
    view.add_line(points, color=INK, lw=8.0, solid_capstyle="round", zorder=3)  # outline
    for k, (start, end) in enumerate(pairwise(points)):
        color: Any = GREY if k == 0 else colors(float(nearness[k]))
        view.add_line(np.stack([start, end]), color=color, lw=5.5, solid_capstyle="round", zorder=4)
    view.add_dots(points[1:-1], colors(nearness[1:-1]), 45, edgecolors=INK, linewidths=1.0, zorder=5)
    view.add_marks(points[:1], marker="s", ms=9, mfc=INK, mec="white", zorder=5)


def _draw_ellipsoid(view: DrawnAxes, surface: np.ndarray, color: str) -> None:
    """A translucent ellipsoid of points (u, v, 3), with the lines of its near side."""
    seen = view.space.camera.to_picture(surface.reshape(-1, 3))
    flat = np.linalg.matrix_rank(seen - seen[0], tol=1e-6) < 2  # seen along a plane that it lies in
    outline = seen if flat else seen[ConvexHull(seen).vertices]
    view.axes.fill(*outline.T, facecolor=color, alpha=0.3, edgecolor=color, linewidth=0.8, zorder=6)
    center = surface.reshape(-1, 3).mean(axis=0)
    for lines in (surface[::_LINES], surface.transpose(1, 0, 2)[::_LINES]):
        for line in lines:
            middles = (line[1:] + line[:-1]) / 2
            near = view.space.camera.nearness(middles) > view.space.camera.nearness(center[None])
            view.add_segments(np.stack([line[:-1], line[1:]], axis=1)[near], color=color, lw=0.4, alpha=0.6, zorder=6)


def _colors() -> LinearSegmentedColormap:
    """Pale yellow in the middle of a range, dark red at a limit."""
    return LinearSegmentedColormap.from_list("nearness", mpl.colormaps["YlOrRd"](np.linspace(0.12, 1.0, 256)))


def _ellipsoid(center: np.ndarray, axes: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Points (u, v, 3) of the surface of an ellipsoid with axes (3, 3), one a row."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, _ROUND), np.linspace(0, np.pi, _HALF_ROUND))
    sphere = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)], axis=-1)
    return center + (sphere * radii) @ axes


def _arrow(tip: np.ndarray, ellipsoids: Table, extent: float) -> np.ndarray:
    """Start and end (2, 3) [m] of the rendered force as an arrow of a length of its own; (0, 3) without one."""
    force = ellipsoids.columns.get("rendered_force")
    size = 0.0 if force is None else float(np.linalg.norm(force))
    return np.empty((0, 3)) if force is None or not size else np.stack([tip, tip + force / size * _ARROW * extent])


def _handles(ellipsoids: Table) -> list[Any]:
    """Legend entries, with what the longest axes stand for."""
    velocity, force = float(ellipsoids["velocity"].max()), float(ellipsoids["force"].max())
    rendered = ellipsoids.columns.get("rendered_force", np.zeros(3))
    handles: list[Any] = [
        Patch(facecolor=VELOCITY, alpha=0.5, label=f"velocity: up to {three_digits(velocity)} m/s at |q̇| = 1"),
        Patch(facecolor=FORCE, alpha=0.5, label=f"force: up to {three_digits(force)} N at |τ| = 1 (cut at 10 : 1)"),
    ]
    if rendered.any():
        label = f"rendered force, {np.linalg.norm(rendered):.2g} N"
        handles.append(Line2D([], [], color=RENDERED, lw=2.0, label=label))
    return handles


def posture(plot: ResultPlots) -> Figure:
    """The arm in one posture: links coloured by nearness to joint limits, ellipsoids of velocity and force."""
    tables = plot.tables["posture"], plot.tables["ellipsoids"]
    return limits_and_ellipsoids(*tables, title=plot.heading("other"))
