"""How capability maps are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """The mean index, and the volume where all directions are reached."""
    yield "reachability index", f"{document['capability']['mean_index']:.4g} on average"
    yield "dexterous volume", f"{document['capability']['dexterous_volume_m3']:.4g} m³"
    if postures := document["capability"].get("postures"):
        yield "postures of a pose", f"{postures['mean']:.3g} on average, {postures['most']} at most"


def title(document: Mapping[str, Any]) -> list[str]:
    """The directions that are counted."""
    found = document["capability"]
    return [f"{found['directions']} directions of approach by the tip's {found['approach_axis']} axis"]


_POSTURES = Picture(
    "posture_count",
    "wsrender.results.drawing.result_plots:ResultPlots.slices",
    "Postures of a pose, means of the poses at each voxel",
    needs=("volume",),
    where=lambda plot: "mean" in plot.volume.statistics,
    options={"statistic": "mean"},
)
PRESENTATION = Presentation(
    (_POSTURES,),
    facts,
    title,
    view=f"{__name__.rpartition('.')[0]}.view:view",
)
