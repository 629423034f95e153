"""How reachable targets are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How many targets are reached, are blocked, are not reached, and are not decided."""
    for name in ("reachable", "blocked", "unreachable", "undecided"):
        if name in document["targets"]:
            yield f"{name} targets", f"{document['targets'][name]:,}"


PRESENTATION = Presentation(
    (Picture("targets", f"{_HERE}:targets", needs=("tables.targets",), uses=("skeleton",)),), facts
)
