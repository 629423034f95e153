"""How the patches of a boundary are shown."""

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation

_HERE = __name__.rpartition(".")[0]


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How many patches of which kind, edges and corners the boundary of a spatial arm has, and its volume."""
    if "integrated" in document["volume_m3"]:
        yield "volume", f"{document['volume_m3']['integrated']:.10g} m³"
    counts = Counter(patch["kind"].replace("_", " ") for patch in document["patches"])
    kinds = ", ".join(f"{count} {kind}" for kind, count in counts.items())
    yield "patches", f"{kinds}; {len(document['edges'])} edges, {len(document['corners'])} corners"


PRESENTATION = Presentation(
    (Picture("patches", f"{_HERE}.pictures:patches", needs=("meshes.patches", "tables.patches")),),
    facts,
    view=f"{_HERE}.view:view",
)
