"""What the view of a five-bar adds: the mechanism in its working modes, and its loci."""

from typing import TYPE_CHECKING

import numpy as np

from wsrender.results.view.additions import Additions, lines, vectors
from wsrender.results.view.manifest import Skeleton, ViewCurves
from wsrender.results.view.words import said

if TYPE_CHECKING:
    from wsrender.results.drawing.result_plots import ResultPlots
    from wsrender.volume.table import Table


def view(plot: "ResultPlots") -> Additions:
    """The posture of each working mode that pictures draw, and the loci of each kind."""
    return Additions(skeletons=mechanisms(plot.tables["drawn_postures"]), curves=loci(plot.tables["loci"]))


def mechanisms(drawn: "Table") -> list[Skeleton]:
    """From one fixed joint over elbow, end point and elbow to the other."""
    chains = drawn["chain"].reshape(-1, 5, 2)
    modes = drawn["working_mode"].tolist()
    return [
        {"name": f"working mode {mode}", "points": [vectors(chain)], "closed": False}
        for mode, chain in zip(modes, chains, strict=True)
        if np.isfinite(chain).all()
    ]


def loci(table: "Table") -> list[ViewCurves]:
    """Rows that follow each other in one curve are one line."""
    kinds, found = table["kind"], []
    same = [table[name] for name in ("kind", "working_mode", "curve", "assembly")]
    cuts = np.flatnonzero(np.any([each[1:] != each[:-1] for each in same], axis=0)) + 1
    runs = np.split(np.arange(len(table)), cuts)
    for kind in dict.fromkeys(kinds.tolist()):
        points = [table["position"][rows] for rows in runs if len(rows) and kinds[rows[0]] == kind]
        found.append(lines(str(kind), said(str(kind)), points))
    return found
