"""An arm in the postures of one pose, each in a colour."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from wsrender.results.drawing.faces import NUMBER, Faces
from wsrender.results.drawing.faces_of_surface import shaded
from wsrender.results.drawing.okabe_ito import BLUE, GREEN, ORANGE, PURPLE, SKY_BLUE, VERMILION
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.style import Heading, paper_style
from wsrender.results.drawing.view import add_legend, new_view

_COLORS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY_BLUE, "#595959", "#b8a800")


@paper_style()
def arms_in_postures(
    skeletons: np.ndarray,
    labels: Sequence[str],
    bodies: Faces | None = None,
    *,
    title: Heading | str = "",
    legend_title: str | None = None,
) -> Figure:
    """Arms (K, L+2, 3) [m] with a label each, as bodies, which are numbered by arm, where they are known."""
    points = skeletons.reshape(-1, 3) if bodies is None else np.concatenate([skeletons.reshape(-1, 3), bodies.vertices])
    figure, view = new_view(points, title, "world")
    if bodies is not None:
        view.add_surface(*shaded(bodies, view.space.camera))
    for arm, color in zip(skeletons if bodies is None else (), _COLORS, strict=False):
        view.add_line(arm, color="white", lw=3.2, solid_capstyle="round", zorder=5)
        view.add_line(arm, color=color, lw=2.0, solid_capstyle="round", zorder=6)
        view.add_marks(arm, color=color, marker="o", ms=3, zorder=6)
    view.add_marks(skeletons[0, -1:], marker="*", ms=13, mfc="#c8102e", mec="white", mew=0.7, zorder=9)
    handles = [Patch(facecolor=color, label=label) for color, label in zip(_COLORS, labels, strict=False)]
    add_legend(figure, handles, legend_title)
    return figure


def postures(plot: ResultPlots) -> Figure:
    """The postures of the first pose that has any, each with what blocks it."""
    arms = plot.skeleton
    assert arms is not None
    labels, bodies = labels_of(plot), bodies_of(plot)
    count = int(((plot.tables["postures"]["winding"] == 0) & _of_first_pose(plot)).sum())
    some = f"{len(labels)} of {count} postures" if len(labels) < count else None
    return arms_in_postures(arms, labels, bodies, title=plot.heading("other"), legend_title=some)


def _of_first_pose(plot: ResultPlots) -> np.ndarray:
    pose = plot.tables["postures"]["pose"]
    return pose == pose[0]


def labels_of(plot: ResultPlots) -> list[str]:
    """Of the postures of the first pose that has any, as many as are drawn: which it is, and what blocks it."""
    table, arms = plot.tables["postures"], plot.skeleton
    shown = np.flatnonzero((table["winding"] == 0) & _of_first_pose(plot))[: 0 if arms is None else len(arms)]
    reasons = table["reason"][shown] if "reason" in table.columns else np.full(len(shown), "")
    motions = plot.tables.get("self_motions")
    moving = set() if motions is None else set(motions["posture"][motions["pose"] == table["pose"][0]].tolist())
    return [
        f"posture {k}{', of a self-motion' if k in moving else ''}{f', blocked by {reason}' if reason else ''}"
        for k, reason in enumerate(reasons)
    ]


def bodies_of(plot: ResultPlots) -> Faces | None:
    """The bodies of the same, by posture, each in its colour; None where they are not known."""
    mesh = plot.meshes.get("bodies")
    if mesh is None or NUMBER not in mesh.face_attributes:
        return None
    number = np.asarray(mesh.face_attributes[NUMBER]).astype(int)
    colors = {k: tuple(int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)) for k, color in enumerate(_COLORS)}
    return Faces(np.asarray(mesh.vertices), np.asarray(mesh.faces), number, {}, colors)  # type: ignore[arg-type]
