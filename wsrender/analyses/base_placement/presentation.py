"""How placements of a base are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How many placements serve all targets, and where the best one is."""
    about, best = document["placements"], document["best"]
    yield "placements", f"{about['count']:,}, {about['targets']:,} targets"
    yield "serving all targets", f"{about['serving_all']:,}"
    if best:
        place = ", ".join(f"{best[name]:.4g}" for name in ("x_m", "y_m", "z_m"))
        turn = ", ".join(f"{best[name]:.4g}" for name in ("roll_deg", "pitch_deg", "yaw_deg"))
        yield "best placement", f"({place}) m, ({turn})°: {best['served']:,} served"


_SERVED = "Targets served from each cell, at its best"
PRESENTATION = Presentation(
    (Picture("placements", f"{_HERE}:placements", _SERVED, ("tables.placement_map",), ("tables.targets",)),), facts
)
