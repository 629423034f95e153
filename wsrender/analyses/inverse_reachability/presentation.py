"""How base poses that reach a target are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.analyses.placed_bases import place_of
from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """From how many base poses and positions the target is reached, and which is farthest from the others."""
    about, best = document["bases"], document["best"]
    labels, places = about["labels"], about["positions"]
    others = ", ".join(f"{n:,} {name}" for name, n in labels.items() if n and name != "reachable")
    yield "base poses", f"{labels['reachable']:,} of {about['count']:,} reach the target ({others or 'all'})"
    yield "base positions", f"{places['reached']:,} of {places['count']:,}, {places['all']:,} in all orientations"
    if best:
        yield "best base", f"{place_of(best)}, the farthest from those that do not reach it"


_SHARE = "Positions of the base, by the share of its orientations from which the target is reached"
PRESENTATION = Presentation(
    (Picture("base_map", f"{_HERE}:base_map", _SHARE, ("tables.base_map",), ("tables.target",)),),
    facts,
    measured="",
)
