"""How indices and polytopes at configurations are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.indices.units import pretty_unit
from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"


def _has_meshes(plot: Any) -> bool:
    return any("_polytope_" in name for name in plot.meshes)


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How many configurations there are, and between which values the first index lies."""
    yield "configurations", f"{document['sampling']['samples']:,}"
    for name, values in list((document.get("indices") or {}).items())[:1]:
        unit = pretty_unit(values["unit"]) if values["unit"] != "1" else ""
        if values["minimum"] is not None:
            yield name.replace("_", " "), f"{values['minimum']:.4g} … {values['maximum']:.4g} {unit}".rstrip()


PRESENTATION = Presentation(
    (
        Picture(
            "polytopes",
            f"{_HERE}:polytopes",
            "What the tip can do in each direction, at the first configuration that has a polytope",
            needs=("tables.polytopes", "skeleton"),
            uses=("meshes", "samples", "tables"),
            where=_has_meshes,
        ),
    ),
    facts,
    measured="",
)
