"""How workspaces of parallel mechanisms are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import REACHABLE, Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"
_MEASURED = {"dexterous": "dexterous", "total_orientation": "total-orientation"}
_SURFACE = "wsrender.results.drawing.result_plots:ResultPlots.surface"


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How many orientations are reached at a point, where that was asked."""
    if found := document.get("orientation_workspace"):
        share = f"{100 * found['share']:.3g} % of their measure"  # a solid angle or a volume of rotations
        if "share_of_ranges" in found:  # since version 0.3
            low, high = (100 * end for end in found["share_of_ranges_ci95"])
            share += f"; {100 * found['share_of_ranges']:.4g} % of the whole ranges (95 %: {low:.4g} … {high:.4g})"
        yield "orientations reached", f"{found['reached']:,} of {found['orientations']:,}, {share}"


def measured(document: Mapping[str, Any]) -> str:
    """Which workspace the headline measures; of orientations at a point none."""
    if document.get("orientation_workspace"):
        return ""
    return _MEASURED.get(str(document.get("kind")), REACHABLE)


PRESENTATION = Presentation(
    (
        Picture("surface", _SURFACE, "", ("meshes.workspace",), ("tables.surfaces",), options={"mesh": "workspace"}),
        Picture("orientations", f"{_HERE}:orientations", needs=("tables.orientations",)),
    ),
    facts,
    measured=measured,
)
