"""The arm in the cloud of its samples: its bodies, or a stick figure where they are not known."""

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
from wsrender.results.drawing.view import BAR, DrawnAxes, inches, new_view
from wsrender.volume.distribution_map import DistributionMap

_ACCENT = "#c8102e"
ROBOTS = (BLUE, VERMILION, PURPLE, ORANGE, SKY_BLUE)
SHARED_COLOR, SHARED_LABEL = to_rgb(GREEN), "shared by at least two"
_CLOUD_POINTS = 12_000
_VEIL = 0.5  # opacity of a surface before the arm
_PALE, _TINT = 0.45, 0.75  # opacity of an arm in other configurations; how strong a robot's colour is on its bodies


@paper_style()
def robot(
    skeleton: np.ndarray,
    samples: DistributionMap | None = None,
    index: str | None = None,
    *,
    surface: Faces | None = None,
    shared: Faces | None = None,
    bodies: Sequence[Faces | None] = (),
    arms: int = 1,
    names: Sequence[str] = (),
    title: Heading | str = "",
    frame: str = "world",
) -> Figure:
    """The arm in representative configurations, before the far half of its workspace.

    ``skeleton`` (K, L+2, 3) holds world positions [m] of base, joint origins and tip; the first ``arms`` of the K are
    drawn in full, the others, configurations of the first, pale; ``names`` are those of arms of several robots, which
    have a colour each. ``bodies`` of the K are drawn instead of lines through these positions. The cloud is coloured by
    ``index`` (by default the map's first); without samples ``surface`` is drawn, and in it what several robots share.
    Raises InputError for another shape or an unknown index.
    """
    skeleton = np.asarray(skeleton, np.float64)
    if skeleton.ndim != 3 or skeleton.shape[1] < 2 or skeleton.shape[2] != 3 or len(skeleton) == 0:
        raise InputError("skeleton", f"has shape {skeleton.shape}; it must be (K, L+2, 3) with K at least 1")
    seen = [each.vertices for each in bodies if each is not None]
    standing = np.concatenate([skeleton.reshape(-1, 3), *seen])
    bodies = [*bodies, *[None] * (len(skeleton) - len(bodies))]
    if samples is None or len(samples) == 0:
        around = np.empty((0, 3)) if surface is None else surface.vertices
        figure, view = new_view(np.concatenate([standing, around]), title, frame)
        if surface is not None:
            view.add_surface(*shaded(surface, view.space.camera), alpha=_VEIL)
        if shared is not None:
            view.add_surface(*shaded(replace(shared, colors={0: SHARED_COLOR}), view.space.camera), alpha=_VEIL)
    else:
        figure, view = new_view(np.concatenate([standing, samples.position]), title, frame)
        behind = np.flatnonzero(far_half(samples.position))
        rows = behind[thinned(len(behind), _CLOUD_POINTS)]
        scale = scale_of(samples, index)
        if scale is None:
            view.add_dots(samples.position[rows], color_map()(np.full(len(rows), 0.35)), 5)
        else:
            view.add_dots(samples.position[rows], scale[0](scale[1][rows]), 5)
            scale[0].add_bar(figure, cax=figure.add_axes(inches(figure, BAR)))
    for arm, body in reversed([*zip(skeleton, bodies, strict=True)][arms:]):
        if body is not None:
            draw_bodies(view, body, pale=True)
            continue
        view.add_line(arm, color="white", lw=4.0, alpha=0.8, solid_capstyle="round", zorder=3.1)
        view.add_line(arm, color=GREY, lw=2.0, solid_capstyle="round", zorder=4)
        view.add_marks(arm, color=GREY, marker="o", ms=3, zorder=4)
    colors = [ROBOTS[k % len(ROBOTS)] if names else INK for k in range(arms)]
    for arm, body, color in zip(skeleton[:arms], bodies, colors, strict=False):
        draw_arm(view, arm, color, body=body if body is None or not names else in_color(body, color))
    robots: list[Artist] = [
        Line2D([], [], color=color, lw=3.2, label=name) for name, color in zip(names, colors, strict=False)
    ]
    if shared is not None:
        robots.append(Patch(facecolor=SHARED_COLOR, alpha=_VEIL, label=SHARED_LABEL))
    view.axes.legend(handles=[*robots, *arm_handles(bodies[:arms])], loc="upper left", frameon=False, fontsize=8)
    return figure


def draw_arm(view: DrawnAxes, arm: np.ndarray, color: str = INK, *, body: Faces | None = None) -> None:
    """An arm through base, joints and tip (L+2, 3) [m], or its ``body``."""
    if body is not None:
        draw_bodies(view, body)
        view.add_marks(arm[-1:], marker="*", ms=11, mfc=_ACCENT, mec="white", mew=0.7, zorder=9, through=True)
        return
    view.add_line(arm, color="white", lw=5.5, solid_capstyle="round", zorder=5)
    view.add_line(arm, color=color, lw=3.2, solid_capstyle="round", zorder=6)
    view.add_marks(arm[1:-1], marker="o", ms=6, mfc="white", mec=color, mew=1.4, zorder=7)
    view.add_marks(arm[:1], marker="s", ms=8, mfc=INK, mec="white", zorder=8)
    view.add_marks(arm[-1:], marker="*", ms=13, mfc=_ACCENT, mec="white", mew=0.7, zorder=9)


def draw_bodies(view: DrawnAxes, body: Faces, pale: bool = False) -> None:
    """The bodies of an arm, before what else is drawn of its workspace."""
    corners, colors = shaded(body, view.space.camera)
    view.add_surface(corners, colors, alpha=_PALE if pale else 1.0, zorder=4.0 if pale else 5.0)
    if not pale:
        view.add_outline(colors=[INK], linewidths=0.6, zorder=5.1)


def in_color(body: Faces, color: str) -> Faces:
    """Bodies in the colour of their robot, light enough to be shaded."""
    light = tuple(1 - _TINT * (1 - part) for part in to_rgb(color))
    return replace(body, colors=dict.fromkeys(body.colors, light))


def arm_handles(bodies: Sequence[Faces | None] = (None,)) -> list[Artist]:
    """Legend entries of base, joints and tip of arms, or of the tip alone where all have bodies."""
    marks: list[Artist] = [
        Line2D([], [], ls="", marker="s", ms=6, mfc=INK, mec="white", label="base"),
        Line2D([], [], ls="", marker="o", ms=5, mfc="white", mec=INK, mew=1.2, label="joint"),
        Line2D([], [], ls="", marker="*", ms=10, mfc=_ACCENT, mec="white", label="tip"),
    ]
    return marks if any(body is None for body in bodies) else marks[-1:]
