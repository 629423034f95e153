"""What the view of postures adds: what the arms that stand in them are called, and their colours."""

from dataclasses import replace
from typing import TYPE_CHECKING

from wsrender.analyses.postures.pictures import bodies_of, labels_of
from wsrender.results.view.additions import Additions

if TYPE_CHECKING:
    from wsrender.results.drawing.result_plots import ResultPlots


def view(plot: "ResultPlots") -> Additions:
    """The bodies by posture, as in the picture."""
    bodies = bodies_of(plot)
    return (
        Additions()
        if bodies is None
        else Additions(faces={"bodies": replace(bodies, labels=dict(enumerate(labels_of(plot))))})
    )
