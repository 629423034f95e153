"""How reachable targets are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.analyses.criteria import fact_of_covered, facts_of_criteria
from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How many targets are reached, are blocked, are not reached, and are not decided."""
    for name in ("reachable", "blocked", "unreachable", "undecided"):
        if name in document["targets"]:
            yield f"{name} targets", f"{document['targets'][name]:,}"
    yield from fact_of_covered(document)
    yield from facts_of_criteria(document)


PRESENTATION = Presentation(
    (Picture("targets", f"{_HERE}:targets", needs=("tables.targets",), uses=("skeleton",)),), facts, measured=""
)
