"""How boundaries of planar arms are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Area, perimeter and number of segments of a planar boundary, and the area by Monte Carlo."""
    exact, estimated = document.get("exact") or {}, document.get("monte_carlo") or {}
    if "perimeter_m" in exact:
        unsure = "" if estimated.get("converged", True) else ", not converged"
        yield "area", f"{exact['area_m2']:.9g} m² (Monte Carlo: {estimated['area_m2']:.4g} m²{unsure})"
        yield "perimeter", f"{exact['perimeter_m']:.9g} m"
        kinds = [segment["kind"] for loop in exact["loops"] for segment in loop["segments"]]
        holes = sum(loop["hole"] for loop in exact["loops"])
        yield "boundary", f"{kinds.count('arc')} arcs, {kinds.count('line')} lines; {holes} hole{'s' * (holes != 1)}"


PRESENTATION = Presentation(
    (Picture("boundary", f"{_HERE}:boundary", "Boundary of the workspace", ("tables",)),),
    facts,
    drawings=("boundary",),  # the table of the lines and arcs around what the arm reaches,
    view=f"{__name__.rpartition('.')[0]}.view:view",
)
