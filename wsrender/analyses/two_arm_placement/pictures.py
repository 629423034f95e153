"""Targets in space by which of two arms serves them, and where the arms stand."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from wsrender.errors import InputError
from wsrender.results.drawing.cloud import thinned
from wsrender.results.drawing.faces import Faces
from wsrender.results.drawing.okabe_ito import VERDICTS
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.stick_figure import arm_handles, draw_arm, in_color
from wsrender.results.drawing.style import INK, Heading, paper_style
from wsrender.results.drawing.view import new_view
from wsrender.volume.table import Table

# With a mark of its own each: told apart in grey too.
_MARKS: dict[str, dict[str, Any]] = {
    "first": {"marker": "o", "ms": 5.0, "mfc": VERDICTS["first"], "mec": "white", "mew": 0.5},
    "second": {"marker": "D", "ms": 4.5, "mfc": VERDICTS["second"], "mec": "white", "mew": 0.5},
    "both": {"marker": "s", "ms": 5.0, "mfc": VERDICTS["both"], "mec": "white", "mew": 0.5},
    "none": {"marker": "x", "ms": 5.0, "mec": VERDICTS["none"], "mew": 1.4},
    "undecided": {"marker": "^", "ms": 6.0, "mfc": VERDICTS["undecided"], "mec": "black", "mew": 0.6},
}
_POINTS = 6000  # of each kind
_BASES = {"first": "P", "second": "X"}


@paper_style()
def shared_targets(
    targets: Table,
    bases: dict[str, np.ndarray],
    arms: np.ndarray | None = None,
    *,
    bodies: Sequence[Faces | None] = (),
    title: Heading | str = "",
) -> Figure:
    """Columns ``position`` (N, 3) [m] and ``label`` (N,); ``bases``: (3,) [m] of the first and second arm.

    ``arms`` (2, L, 3) [m]: joint origins and tips of both at a hand-over, or None; drawn as ``bodies`` where known.
    Raises InputError for a table without these columns or rows.
    """
    if not {"position", "label"} <= set(targets.columns) or len(targets) == 0:
        raise InputError("table", f"holds {', '.join(targets.columns)}; rows of position and label are needed")
    position, label = targets["position"], targets["label"].astype(str)
    standing = [each[None] for each in bases.values()] + ([] if arms is None else [arms.reshape(-1, 3)])
    standing += [each.vertices for each in bodies if each is not None]
    figure, view = new_view(np.concatenate([position, *standing]), title, "world")
    handles = []
    for k, (name, marks) in enumerate(_MARKS.items()):
        at = np.flatnonzero(label == name)
        if len(at):
            view.add_marks(position[at[thinned(len(at), _POINTS)]], zorder=3 + 0.1 * k, **marks)
            handles.append(Line2D([], [], ls="", label=f"{name} ({len(at):,})", **marks))
    for name, place in bases.items():
        marks = {"marker": _BASES[name], "ms": 10.0, "mfc": INK, "mec": "white", "mew": 0.5}
        view.add_marks(place[None], zorder=9, through=True, **marks)
        handles.append(Line2D([], [], ls="", label=f"base of the {name} arm", **marks))
    for name, arm, body in zip(bases, [] if arms is None else arms, [*bodies, None, None], strict=False):
        color = _MARKS[name]["mfc"]
        draw_arm(view, arm, color, body=None if body is None else in_color(body, color))
        handles.append(Line2D([], [], color=color, lw=3.2, label=f"{name} arm, hand-over"))
    handles += arm_handles()[-1:] if arms is not None else []
    view.axes.legend(handles=handles, loc="upper left", frameon=False, fontsize=8)
    return figure


def shares(plot: ResultPlots) -> Figure:
    """The targets of a job of two arms by which serves them from the best pair of placements."""
    best = plot.document["best"]
    bases = {name: np.array(each["T_world_base"])[:3, 3] for name, each in best.items()}
    return shared_targets(plot.tables["targets"], bases, plot.skeleton, bodies=plot.bodies, title=plot.heading("other"))
