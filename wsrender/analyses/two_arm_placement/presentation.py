"""How the targets that two arms share are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.analyses.placed_bases import place_of
from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"
_WHO = {"first": "the first arm alone", "second": "the second alone", "both": "both", "none": "none"}


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How many pairs of placements serve all targets; of the best one who serves how many, and where the arms stand."""
    about, pairs = document["targets"], document["pairs"]
    yield "pairs of placements", f"{pairs['count']:,}, {pairs['serving_all']:,} serving all {about['count']:,} targets"
    told = [f"{about[name]:,} by {who}" for name, who in _WHO.items()]
    told += [f"{about['undecided']:,} undecided"] if about["undecided"] else []
    yield "targets served", ", ".join(told)
    for name, each in document["best"].items():
        yield f"{name} base", f"{place_of(each)}: {each['served']:,} served"
    if found := document.get("hand_over"):
        best, own = found["best"], found["of_best_pair"]
        yield (
            "hand-overs",
            f"{own['free']:,} of {found['poses']:,} poses from there; {found['pairs']:,} pairs have some",
        )
        if best:
            x, y, z = best["position_m"]
            room = f"joint limit margin {best['joint_limit_margin']:.2g}"
            yield "best hand-over", f"pose {best['pose']} at ({x:.4g}, {y:.4g}, {z:.4g}) m, {room}"


_CAPTION = "Targets by which of the arms serves them from the best pair of placements"
PRESENTATION = Presentation(
    (Picture("shares", f"{_HERE}:shares", _CAPTION, ("tables.targets",), ("skeleton", "tables")),),
    facts,
    measured="",
)
