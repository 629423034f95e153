"""How reachable targets are shown."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation

_ROOM, _AND = {"joint_margin_deg": "°", "joint_margin_m": " m"}, " and "
_HERE = f"{__name__.rpartition('.')[0]}.pictures"


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How many targets are reached, are blocked, are not reached, and are not decided."""
    for name in ("reachable", "blocked", "unreachable", "undecided"):
        if name in document["targets"]:
            yield f"{name} targets", f"{document['targets'][name]:,}"
    for k, each in enumerate(document.get("criteria", ()), 1):
        room = [f"{each[name]:g}{unit}" for name, unit in _ROOM.items() if each[name]]
        asked = f"{_percent(each['least_share'])} reached{f' with {_AND.join(room)} to the limits' if room else ''}"
        open_ = f", {_percent(each['undecided_share'])} undecided" if each["undecided_share"] else ""
        yield f"criterion {k}", f"{each['verdict']}: {_percent(each['share'])}{open_}; {asked} needed"
    if "verdict" in document:
        yield "verdict", document["verdict"]


def _percent(share: float) -> str:
    """To a digit more than round numbers, and never rounded up to what it does not reach."""
    return f"{math.floor(share * 1e4 + 1e-8) / 100:g} %"


PRESENTATION = Presentation(
    (Picture("targets", f"{_HERE}:targets", needs=("tables.targets",), uses=("skeleton",)),), facts
)
