"""Targets in space, each by what was found out about it, with the arm that reaches some of them."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from wsrender.errors import InputError
from wsrender.results.drawing.cloud import thinned
from wsrender.results.drawing.faces import Faces
from wsrender.results.drawing.okabe_ito import VERDICTS
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.stick_figure import arm_handles, draw_arm
from wsrender.results.drawing.style import GREY, Heading, paper_style
from wsrender.results.drawing.view import DrawnAxes, new_view
from wsrender.volume.table import Table

# With a mark of its own each: told apart in grey too.
_MARKS: dict[str, dict[str, Any]] = {
    "reachable": {"marker": "o", "ms": 5.0, "mfc": VERDICTS["reachable"], "mec": "white", "mew": 0.5},
    "blocked": {"marker": "s", "ms": 5.0, "mfc": VERDICTS["blocked"], "mec": "white", "mew": 0.5},
    "unreachable": {"marker": "x", "ms": 5.0, "mec": VERDICTS["unreachable"], "mew": 1.4},
    "undecided": {"marker": "^", "ms": 6.0, "mfc": VERDICTS["undecided"], "mec": "black", "mew": 0.6},
}
_POINTS = 6000  # of each kind
_AXES = 400  # targets up to which the direction of the tip is drawn
_AXIS = 0.05  # its length, relative to the longest edge of the box


@paper_style()
def labelled_targets(
    targets: Table,
    skeleton: np.ndarray | None = None,
    *,
    body: Faces | None = None,
    title: Heading | str = "",
    frame: str = "world",
) -> Figure:
    """Columns ``position`` (N, 3) [m], ``label`` (N,) and, for whole poses, ``quat_wxyz`` (N, 4), of the tip.

    The first arm of ``skeleton`` (K, L+2, 3) [m], or its ``body``, reaches the first of the reachable ones. Raises
    InputError for a table without these columns or rows.
    """
    if not {"position", "label"} <= set(targets.columns) or len(targets) == 0:
        raise InputError("table", f"holds {', '.join(targets.columns)}; rows of position and label are needed")
    position, label = targets["position"], targets["label"].astype(str)
    arms = np.empty((0, 2, 3)) if skeleton is None else np.asarray(skeleton, float)[:1]
    standing = arms.reshape(-1, 3) if body is None else body.vertices
    figure, view = new_view(np.concatenate([position, standing]), title, frame)
    if "quat_wxyz" in targets.columns and len(targets) <= _AXES:
        oriented = np.isfinite(targets["quat_wxyz"]).all(axis=1)
        _draw_axes(view, position[oriented], targets["quat_wxyz"][oriented])
    for arm in arms:
        draw_arm(view, arm, body=body)
    handles = arm_handles([body]) if len(arms) else []
    for k, (name, marks) in enumerate(_MARKS.items()):
        at = np.flatnonzero(label == name)
        if len(at):
            view.add_marks(position[at[thinned(len(at), _POINTS)]], zorder=3 + 0.1 * k, **marks)
            handles.append(Line2D([], [], ls="", label=f"{name} ({len(at):,})", **marks))
    view.axes.legend(handles=handles, loc="upper left", frameon=False, fontsize=8)
    return figure


def _draw_axes(view: DrawnAxes, position: np.ndarray, quat_wxyz: np.ndarray) -> None:
    """The z axis of the tip at each target."""
    w, x, y, z = (quat_wxyz / np.linalg.norm(quat_wxyz, axis=1, keepdims=True)).T
    direction = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=1)
    length = _AXIS * float((view.space.upper - view.space.lower).max())
    view.add_segments(np.stack([position, position + length * direction], axis=1), color=GREY, lw=0.8, zorder=2.5)


def targets(plot: ResultPlots) -> Figure:
    """The targets of a reachability job by their labels, with the arm at the first that it reaches."""
    return labelled_targets(
        plot.tables["targets"], plot.skeleton, body=next(iter(plot.bodies), None), title=plot.heading("other")
    )
