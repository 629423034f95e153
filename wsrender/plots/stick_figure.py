"""The arm as a stick figure in the cloud of its samples."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.axes3d import Axes3D

from wsrender.errors import InputError
from wsrender.plots.faces import Faces
from wsrender.plots.space import color_points, far_half, new_space, thinned
from wsrender.plots.style import GREY, INK, add_title, paper_style
from wsrender.plots.surface_faces import shaded
from wsrender.volume.distribution_map import DistributionMap

_ACCENT = "#c8102e"
_CLOUD_POINTS = 12_000


@paper_style()
def robot(
    skeleton: np.ndarray,
    samples: DistributionMap | None = None,
    index: str | None = None,
    *,
    surface: Faces | None = None,
    arms: int = 1,
    title: str = "",
    frame: str = "world",
) -> Figure:
    """Stick figures of the arm in representative configurations, before the far half of its workspace.

    ``skeleton`` (K, L+2, 3) holds world positions [m] of base, joint origins and tip; the first ``arms`` of the K are
    drawn in full, the others, configurations of the first, pale. The cloud is coloured by ``index`` (by default the
    map's first); without samples ``surface`` is drawn. Raises InputError for another shape or an unknown index.
    """
    skeleton = np.asarray(skeleton, np.float64)
    if skeleton.ndim != 3 or skeleton.shape[1] < 2 or skeleton.shape[2] != 3 or len(skeleton) == 0:
        raise InputError("skeleton", f"has shape {skeleton.shape}; it must be (K, L+2, 3) with K at least 1")
    if samples is None or len(samples) == 0:
        around = np.empty((0, 3)) if surface is None else surface.vertices
        figure, axes = new_space(np.concatenate([skeleton.reshape(-1, 3), around]), frame)
        if surface is not None:
            axes.add_collection3d(shaded(surface, alpha=0.35))
    else:
        figure, axes = new_space(np.concatenate([skeleton.reshape(-1, 3), samples.position]), frame)
        behind = np.flatnonzero(far_half(samples.position))
        rows = behind[thinned(len(behind), _CLOUD_POINTS)]
        colors = color_points(figure, samples, index, rows)
        cloud = samples.position[rows].T
        axes.scatter(*cloud, s=5, c=colors, alpha=0.6, linewidths=0, depthshade=False, rasterized=True)
    for arm in skeleton[: arms - 1 : -1]:
        axes.plot(*arm.T, color="white", lw=4.0, alpha=0.8, solid_capstyle="round", zorder=3)
        axes.plot(*arm.T, color=GREY, lw=2.0, marker="o", ms=3, zorder=4)
    for arm in skeleton[:arms]:
        _draw_arm(axes, arm)
    handles = [
        Line2D([], [], ls="", marker="s", ms=6, mfc=INK, mec="white", label="base"),
        Line2D([], [], ls="", marker="o", ms=5, mfc="white", mec=INK, mew=1.2, label="joint"),
        Line2D([], [], ls="", marker="*", ms=10, mfc=_ACCENT, mec="white", label="tip"),
    ]
    axes.legend(handles=handles, loc="upper left", frameon=False, fontsize=8)
    add_title(figure, title)
    return figure


def _draw_arm(axes: Axes3D, arm: np.ndarray) -> None:
    axes.plot(*arm.T, color="white", lw=5.5, solid_capstyle="round", zorder=5)
    axes.plot(*arm.T, color=INK, lw=3.2, solid_capstyle="round", zorder=6)
    axes.plot(*arm[1:-1].T, ls="", marker="o", ms=6, mfc="white", mec=INK, mew=1.4, zorder=7)
    axes.plot(*arm[:1].T, ls="", marker="s", ms=8, mfc=INK, mec="white", zorder=8)
    axes.plot(*arm[-1:].T, ls="", marker="*", ms=13, mfc=_ACCENT, mec="white", mew=0.7, zorder=9)
