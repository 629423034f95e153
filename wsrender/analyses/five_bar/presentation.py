"""How results of five-bars are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation, where_measured

MODE_VOLUMES = {"++": "plus_plus", "+-": "plus_minus", "-+": "minus_plus", "--": "minus_minus"}
"""Names of the volumes of the working modes."""
_HERE = f"{__name__.rpartition('.')[0]}.pictures"
_OVER = {
    "cartesian": "the points of each working mode",
    "joint": "the actuated angles of each working and assembly mode",
}


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Area and aspects of each working mode."""
    for found in document["workspaces"]:
        mode = found["working_mode"]
        own = [each for each in document["aspects"] if each["working_mode"] == mode]
        yield (
            f"working mode {mode}",
            f"{found['area_m2']:.8g} m² (exact), {len(own)} aspects without type 2 singularities",
        )


PRESENTATION = Presentation(
    (
        Picture("aspects", f"{_HERE}:aspects", "Parts of each working mode without type 2 singularities", ("tables",)),
        *(
            Picture(
                f"kappa_{matrix}_{space}",
                f"{_HERE}:conditioning",
                f"κ({matrix.upper()}) over {over}",
                ("tables",),
                ("volumes",),
                options={"matrix": matrix, "space": space},
            )
            for space, over in _OVER.items()
            for matrix in "abj"
        ),
        Picture("conditioning", f"{_HERE}:conditioning", "", ("tables",), ("volumes",), saved=False),
    ),
    facts,
    measured=where_measured,
    view=f"{__name__.rpartition('.')[0]}.view:view",
)
