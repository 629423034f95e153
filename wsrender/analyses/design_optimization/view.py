"""What the view of optimised designs adds: values over designs, and objectives."""

from typing import TYPE_CHECKING

from wsrender.results.view.additions import Additions, curve_plot

if TYPE_CHECKING:
    from wsrender.results.drawing.result_plots import ResultPlots


def view(plot: "ResultPlots") -> Additions:
    """A sweep over one parameter as a curve; of a Pareto set the second objective against the first."""
    document, tables, plots = plot.document, plot.tables, []
    objectives = [each["name"] for each in document["objectives"]]
    if "sweep" in tables and len(document["parameters"]) == 1:
        (parameter,) = document["parameters"]
        plots.append(curve_plot("sweep", "Values over designs", tables["sweep"], parameter["name"], objectives))
    if "pareto" in tables:
        plots.append(curve_plot("pareto", "Beaten by none", tables["pareto"], objectives[0], objectives[1:]))
    return Additions(plots=plots)
