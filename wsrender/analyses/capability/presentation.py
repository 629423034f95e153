"""How capability maps are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How many voxels are reached and what they make, the mean index, and where all directions are reached."""
    found = document["capability"]
    voxels, whole = f"{found['voxels']:,} of {document['voxel_size_m']:g} m", f"{found['reachable_volume_m3']:.4g} m³"
    yield "reached voxels", f"{voxels}, in all {whole}, without an interval"
    open_ = f"; {found['undecided_pairs']:,} pairs of voxel and direction undecided" if found["undecided_pairs"] else ""
    yield "reachability index", f"{found['mean_index']:.4g} of the directions on average{open_}"
    share = f"{100 * found['dexterous_threshold']:.4g} % of the directions"
    yield "dexterous volume", f"{found['dexterous_volume_m3']:.4g} m³ of them, from {share} or more"
    if postures := found.get("postures"):
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
    measured="",
    view=f"{__name__.rpartition('.')[0]}.view:view",
)
