"""How placements of a base are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.analyses.criteria import fact_of_covered, facts_of_criteria
from wsrender.analyses.placed_bases import place_of
from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How many placements serve all targets, and where the best one is."""
    if "robots" in document:
        yield from _facts_of_several(document)
        return
    about, best = document["placements"], document["best"]
    yield "placements", f"{about['count']:,}, {about['targets']:,} targets"
    between = best and not about["serving_all"] and best["served"] == about["targets"]
    yield "serving all targets", f"{about['serving_all']:,}{', but one between them does' if between else ''}"
    if best:
        yield "best placement", _placed(best)
        yield from _facts_of_pareto(document)
        yield from fact_of_covered(best)
    yield from facts_of_criteria(document)


def _facts_of_several(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    for each in document["robots"]:
        all_ = f"{each['placements']['serving_all']:,} of {each['placements']['count']:,} placements serve all"
        verdict = f"; {each['verdict']}" if "verdict" in each else ""
        yield each["name"], (f"{all_}; best {_placed(each['best'])}" if each["best"] else all_) + verdict
    if cells := document.get("arms"):
        alone = ", ".join(f"{name} {count:,}" for name, count in cells["alone"].items())
        yield "cells served best by", f"{alone}, several {cells['equal']:,}, none {cells['none']:,}"
    if document["best"]:
        yield "best arm", document["best"]["robot"]
        yield from _facts_of_pareto(document)
    yield from facts_of_criteria(document)


def _facts_of_pareto(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    if found := document.get("pareto"):
        yield "beaten by none", f"{found['placements']:,} placements in {' and '.join(found['objectives'])}"


def _placed(best: Mapping[str, Any]) -> str:
    return f"{place_of(best)}: {best['served']:,} served"


_SERVED = "Targets served from each cell, at its best"
_TRADED = "What placements serve against their least index, the Pareto set, and the best placement, as it is refined"
PRESENTATION = Presentation(
    (
        Picture("placements", f"{_HERE}:placements", _SERVED, ("tables.placement_map",), ("tables.targets",)),
        Picture("pareto", f"{_HERE}:pareto", _TRADED, ("tables.pareto",)),
        Picture("arms_map", f"{_HERE}:arms", f"{_SERVED}, by each arm, and which serves best", ("tables.arms_map",)),
    ),
    facts,
    measured="",
    view=f"{__name__.rpartition('.')[0]}.view:view",
)
