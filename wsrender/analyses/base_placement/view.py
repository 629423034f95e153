"""What the view of placements adds: what those of the Pareto set serve against their indices."""

from typing import TYPE_CHECKING

from wsrender.results.view.additions import Additions, curve_plot

if TYPE_CHECKING:
    from wsrender.results.drawing.result_plots import ResultPlots


def view(plot: "ResultPlots") -> Additions:
    """A curve over the Pareto set."""
    front = plot.tables.get("pareto")
    if front is None:
        return Additions()
    first, *others = plot.document["pareto"]["objectives"]
    return Additions(plots=[curve_plot("pareto", "Beaten by none", front, first, others)])
