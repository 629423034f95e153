"""How polytopes at configurations are shown."""

from typing import Any

from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"


def _has_meshes(plot: Any) -> bool:
    return any("_polytope_" in name for name in plot.meshes)


PRESENTATION = Presentation(
    (
        Picture(
            "polytopes",
            f"{_HERE}:polytopes",
            "What the tip can do in each direction, at the first configuration that has a polytope",
            needs=("tables.polytopes", "skeleton"),
            where=_has_meshes,
        ),
    )
)
