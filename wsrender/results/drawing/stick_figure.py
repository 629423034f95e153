"""The arm as a stick figure in the cloud of its samples."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.artist import Artist
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from wsrender.errors import InputError
from wsrender.results.drawing.cloud import far_half, scale_of, thinned
from wsrender.results.drawing.faces import Faces
from wsrender.results.drawing.faces_of_surface import shaded
from wsrender.results.drawing.okabe_ito import BLUE, GREEN, ORANGE, PURPLE, SKY_BLUE, VERMILION
from wsrender.results.drawing.style import GREY, INK, Heading, color_map, paper_style
from wsrender.results.drawing.view import BAR, View, inches, new_view
from wsrender.volume.distribution_map import DistributionMap

_ACCENT = "#c8102e"
ROBOTS = (BLUE, VERMILION, PURPLE, ORANGE, SKY_BLUE)
SHARED_COLOR, SHARED_LABEL = to_rgb(GREEN), "shared by at least two"
_CLOUD_POINTS = 12_000
_VEIL = 0.5  # opacity of a surface before the arm


@paper_style()
def robot(
    skeleton: np.ndarray,
    samples: DistributionMap | None = None,
    index: str | None = None,
    *,
    surface: Faces | None = None,
    shared: Faces | None = None,
    arms: int = 1,
    names: Sequence[str] = (),
    title: Heading | str = "",
    frame: str = "world",
) -> Figure:
    """Stick figures of the arm in representative configurations, before the far half of its workspace.

    ``skeleton`` (K, L+2, 3) holds world positions [m] of base, joint origins and tip; the first ``arms`` of the K are
    drawn in full, the others, configurations of the first, pale; ``names`` are those of arms of several robots, which
    have a colour each. The cloud is coloured by ``index`` (by default the map's first); without samples ``surface`` is
    drawn, and in it what several robots share. Raises InputError for another shape or an unknown index.
    """
    skeleton = np.asarray(skeleton, np.float64)
    if skeleton.ndim != 3 or skeleton.shape[1] < 2 or skeleton.shape[2] != 3 or len(skeleton) == 0:
        raise InputError("skeleton", f"has shape {skeleton.shape}; it must be (K, L+2, 3) with K at least 1")
    if samples is None or len(samples) == 0:
        around = np.empty((0, 3)) if surface is None else surface.vertices
        figure, view = new_view(np.concatenate([skeleton.reshape(-1, 3), around]), title, frame)
        if surface is not None:
            view.add_surface(*shaded(surface, view.space.camera), alpha=_VEIL)
        if shared is not None:
            view.add_surface(*shaded(replace(shared, colors={0: SHARED_COLOR}), view.space.camera), alpha=_VEIL)
    else:
        figure, view = new_view(np.concatenate([skeleton.reshape(-1, 3), samples.position]), title, frame)
        behind = np.flatnonzero(far_half(samples.position))
        rows = behind[thinned(len(behind), _CLOUD_POINTS)]
        scale = scale_of(samples, index)
        if scale is None:
            view.add_dots(samples.position[rows], color_map()(np.full(len(rows), 0.35)), 5)
        else:
            view.add_dots(samples.position[rows], scale[0](scale[1][rows]), 5)
            scale[0].add_bar(figure, cax=figure.add_axes(inches(figure, BAR)))
    for arm in skeleton[: arms - 1 : -1]:
        view.add_line(arm, color="white", lw=4.0, alpha=0.8, solid_capstyle="round", zorder=3.1)
        view.add_line(arm, color=GREY, lw=2.0, solid_capstyle="round", zorder=4)
        view.add_marks(arm, color=GREY, marker="o", ms=3, zorder=4)
    colors = [ROBOTS[k % len(ROBOTS)] if names else INK for k in range(arms)]
    for arm, color in zip(skeleton[:arms], colors, strict=False):
        draw_arm(view, arm, color)
    robots: list[Artist] = [
        Line2D([], [], color=color, lw=3.2, label=name) for name, color in zip(names, colors, strict=False)
    ]
    if shared is not None:
        robots.append(Patch(facecolor=SHARED_COLOR, alpha=_VEIL, label=SHARED_LABEL))
    view.axes.legend(handles=[*robots, *arm_handles()], loc="upper left", frameon=False, fontsize=8)
    return figure


def draw_arm(view: View, arm: np.ndarray, color: str = INK) -> None:
    """An arm through base, joints and tip (L+2, 3) [m]."""
    view.add_line(arm, color="white", lw=5.5, solid_capstyle="round", zorder=5)
    view.add_line(arm, color=color, lw=3.2, solid_capstyle="round", zorder=6)
    view.add_marks(arm[1:-1], marker="o", ms=6, mfc="white", mec=color, mew=1.4, zorder=7)
    view.add_marks(arm[:1], marker="s", ms=8, mfc=INK, mec="white", zorder=8)
    view.add_marks(arm[-1:], marker="*", ms=13, mfc=_ACCENT, mec="white", mew=0.7, zorder=9)


def arm_handles() -> list[Artist]:
    """Legend entries of base, joints and tip."""
    return [
        Line2D([], [], ls="", marker="s", ms=6, mfc=INK, mec="white", label="base"),
        Line2D([], [], ls="", marker="o", ms=5, mfc="white", mec=INK, mew=1.2, label="joint"),
        Line2D([], [], ls="", marker="*", ms=10, mfc=_ACCENT, mec="white", label="tip"),
    ]
