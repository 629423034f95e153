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

from wsrender.errors import InputError
from wsrender.plots.space import new_space
from wsrender.plots.style import GREY, INK, add_title, paper_style
from wsrender.volume.table import Table

VELOCITY, FORCE, RENDERED = "#0072b2", "#d55e00", "#c8102e"  # Okabe and Ito 2008
_LONGEST = 0.22  # of an ellipsoid's half axis, relative to the arm's extent
_BAR = (0.875, 0.2, 0.02, 0.58)
_ROUND, _HALF_ROUND = 40, 20  # facets of an ellipsoid


@paper_style()
def limits_and_ellipsoids(posture: Table, ellipsoids: Table, *, title: str = "", frame: str = "world") -> Figure:
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
    around = np.concatenate([points, *(surface.reshape(-1, 3) for surface in surfaces.values())])
    middle, half = (around.min(axis=0) + around.max(axis=0)) / 2, 0.3 * np.ptp(around, axis=0).max()
    figure, axes = new_space(np.concatenate([around, [middle - half, middle + half]]), frame)  # no thin box
    colors = _colors()
    axes.plot(*points.T, color=INK, lw=8.0, solid_capstyle="round", zorder=3)  # outline
    for k, (start, end) in enumerate(pairwise(points)):
        color: Any = GREY if k == 0 else colors(float(nearness[k]))
        axes.plot(*np.stack([start, end]).T, color=color, lw=5.5, solid_capstyle="round", zorder=4)
    joints = points[1:-1]
    axes.scatter(*joints.T, s=45, c=colors(nearness[1:-1]), edgecolors=INK, depthshade=False, zorder=5)
    axes.plot(*points[:1].T, ls="", marker="s", ms=9, mfc=INK, mec="white", zorder=5)
    for name, color in (("velocity", VELOCITY), ("force", FORCE)):
        x, y, z = np.moveaxis(surfaces[name], -1, 0)
        axes.plot_surface(x, y, z, color=color, alpha=0.28, linewidth=0, shade=False, zorder=6)
        axes.plot_wireframe(x, y, z, color=color, alpha=0.5, linewidth=0.4, rstride=5, cstride=5, zorder=6)
    axes.legend(handles=_handles(ellipsoids), loc="upper left", frameon=False, fontsize=8)
    _draw_force(axes, points[-1], ellipsoids, extent)
    bar = figure.colorbar(ScalarMappable(Normalize(0, 1), colors), cax=figure.add_axes(_BAR))
    bar.set_label("Nearness of joint limits (0 middle, 1 limit)")
    bar.outline.set_visible(False)
    add_title(figure, title)
    return figure


def _colors() -> LinearSegmentedColormap:
    """Pale yellow in the middle of a range, dark red at a limit."""
    return LinearSegmentedColormap.from_list("nearness", mpl.colormaps["YlOrRd"](np.linspace(0.12, 1.0, 256)))


def _ellipsoid(center: np.ndarray, axes: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Points (u, v, 3) of the surface of an ellipsoid with axes (3, 3), one a row."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, _ROUND), np.linspace(0, np.pi, _HALF_ROUND))
    sphere = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)], axis=-1)
    return center + (sphere * radii) @ axes


def _draw_force(axes: Any, tip: np.ndarray, ellipsoids: Table, extent: float) -> None:
    """The rendered force as an arrow of a length of its own."""
    force = ellipsoids.columns.get("rendered_force")
    size = 0.0 if force is None else float(np.linalg.norm(force))
    if force is not None and size > 0:
        end = force / size * 0.35 * extent
        axes.quiver(*tip, *end, color=RENDERED, lw=2.0, arrow_length_ratio=0.2, zorder=8)


def _handles(ellipsoids: Table) -> list[Any]:
    """Legend entries, with what the longest axes stand for."""
    velocity, force = float(ellipsoids["velocity"].max()), float(ellipsoids["force"].max())
    rendered = ellipsoids.columns.get("rendered_force", np.zeros(3))
    handles: list[Any] = [
        Patch(facecolor=VELOCITY, alpha=0.5, label=f"velocity: up to {velocity:.3g} m/s at |q̇| = 1"),
        Patch(facecolor=FORCE, alpha=0.5, label=f"force: up to {force:.3g} N at |τ| = 1 (cut at 10 : 1)"),
    ]
    if rendered.any():
        label = f"rendered force, {np.linalg.norm(rendered):.2g} N"
        handles.append(Line2D([], [], color=RENDERED, lw=2.0, label=label))
    return handles
