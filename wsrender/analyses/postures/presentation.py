"""How postures are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation

_HERE = __name__.rpartition(".")[0]


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How many postures there are, how many are free, and what says that they are all."""
    found = document["postures"]
    some = f", of which {found['families']:,} stand for families" if found["families"] else ""
    free = f", {found['free']:,} free" if "free" in found else ""
    yield "poses reached", f"{found['reached']:,} of {found['poses']:,}"
    yield "postures", f"{found['postures']:,}{some}{free}; {found['configurations']:,} with windings"
    if (curves := found["self_motions"])["count"]:
        yield "self-motions", f"{curves['count']:,}, {curves['closed']:,} of them closed"
    if aspects := found.get("aspects"):
        cuspidal = aspects["cuspidal_poses"]
        cuspidal = f"{cuspidal:,} pose{'s' * (cuspidal != 1)} with two postures in one aspect"
        yield "aspects", f"up to {aspects['most_of_a_pose']} of a pose; {cuspidal} (cuspidal)"
        yield "aspects proven", f"{aspects['proven']:,} of {found['poses']:,} poses: {aspects['evidence']}"
    yield "complete", f"{found['complete']:,} of {found['poses']:,} poses: {found['evidence']}"


PRESENTATION = Presentation(
    (
        Picture(
            "postures",
            f"{_HERE}.pictures:postures",
            "The arm in the postures of one pose",
            needs=("skeleton", "tables.postures"),
            uses=("meshes",),
        ),
    ),
    facts,
    measured="",
    view=f"{_HERE}.view:view",
)
