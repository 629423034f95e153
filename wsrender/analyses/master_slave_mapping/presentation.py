"""How mappings of a slave to its master are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """The mapping that was found, the volumes, and how near the search came."""
    mapping = document["mapping"]
    scale, offset = (", ".join(f"{number:.4g}" for number in mapping[name]) for name in ("scale", "offset_m"))
    why = ", ".join(f"{count:,} {reason}" for reason, count in mapping.get("reasons", {}).items() if count)
    outside = "all points inside" if mapping["succeeded"] else f"{mapping['failing_points']:,} points outside"
    outside += f" ({why})" if why else ""
    yield "mapping", f"{outside}; scale {scale}; offset {offset} m; efficiency {mapping['efficiency']:.4g}"
    volumes = ", ".join(f"{name} {value:.4g} m³" for name, value in document["volume_m3"].items())
    yield "volumes", f"{volumes}: of shapes around points, without an interval"
    search = document.get("search") or {"found": True}
    if not search["found"]:
        at = search.get("at_scale", search.get("at_factor"))  # a factor on the job's scale before version 0.2
        most = f"{100 * search['most_inside']:.3g} % are inside at {at:.3g}"
        yield "search", f"no scale fits; at most {most}. The mapping is the job's own"


PRESENTATION = Presentation(
    (Picture("mapping", f"{_HERE}:mapping", needs=("tables.mapping",)),),
    facts,
    measured="",
    view=f"{__name__.rpartition('.')[0]}.view:view",
)
