"""How optimised designs are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from wsrender.indices.units import pretty_unit
from wsrender.results.presentation import Picture, Presentation, where_measured

_HERE = f"{__name__.rpartition('.')[0]}.pictures"
_BEST = "wsrender.results.drawing.result_plots:ResultPlots.surface"


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """The best design and what the search took."""
    search, best = document["search"], document["best"]
    yield from _facts_of_best(document, best) if best else [("best design", "none has a value")]
    yield "designs", f"{search['designs']:,}, {search['evaluated']:,} evaluated; {search['ended']}"


def _facts_of_best(document: Mapping[str, Any], best: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    yield "best design", ", ".join(f"{name} {value:.6g}" for name, value in best["parameters"].items())
    units = {objective["name"]: objective["unit"] or "1" for objective in document["objectives"]}
    values = (f"{name} {value:.6g} {pretty_unit(units[name])}" for name, value in best["values"].items())
    yield "its values", ", ".join(value.removesuffix(" 1") for value in values)
    if best["at_bounds"]:
        yield "at a bound", ", ".join(best["at_bounds"])
    if "pareto" in document:
        yield "beaten by none", f"{len(document['pareto'])} designs"


def _swept(plot: Any) -> bool:
    """Whether it is over one parameter, or over two of several values."""
    values = [array for name, array in list(plot.tables["sweep"].columns.items())[:2]]
    parameters = len(plot.document["parameters"])
    several = parameters == 2 and min(len(np.unique(array)) for array in values) > 1
    return plot.document["best"] is not None and (parameters == 1 or several)


def shown_job(document: Mapping[str, Any]) -> Any:
    """The job of the best design; where none has a value that of which it varies."""
    best, job = document["best"] or {}, document["job"] or {}
    return best.get("design") or job.get("design")


PRESENTATION = Presentation(
    (
        Picture("best", _BEST, needs=("meshes.best",), uses=("tables.surfaces",), options={"mesh": "best"}),
        Picture("sweep", f"{_HERE}:sweep", "The value over the designs", ("tables.sweep",), where=_swept),
        Picture("pareto", f"{_HERE}:pareto", "Objectives against each other", ("tables.pareto", "tables.evaluations")),
        Picture("trade_off", f"{_HERE}:pareto", needs=("tables.pareto", "tables.evaluations"), saved=False),
    ),
    facts,
    measured=where_measured,
    view=f"{__name__.rpartition('.')[0]}.view:view",
    job=shown_job,
)
