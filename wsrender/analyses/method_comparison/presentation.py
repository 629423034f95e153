"""How comparisons of methods are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"
METHOD_LETTERS = {"grid": "A", "grid_by_subsystem": "B", "exact": "C", "solids": "D"}


def method_rows(document: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The runs of a comparison of methods with their times: Table 4 of [SNK], whose letters the methods get.

    Times are in ``timing_s`` alone, because equal jobs give equal files.
    """
    rows = []
    for run in document["methods"]:
        name = run["method"] if run["size_m"] is None else f"{run['method']} {run['size_m']:.3g} m"
        method = f"{METHOD_LETTERS[run['method']]} {run['method'].replace('_', ' ')}"
        rows.append({**run, "method": method, "time_s": document["timing_s"][name]})
    return rows


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Volume, error and time of every run."""
    for run in method_rows(document):
        size = "" if run["size_m"] is None else f" {run['size_m']:.3g} m"
        wrong = "" if run["relative_error"] is None else f", error {100 * run['relative_error']:+.3g} %"
        yield (
            f"{run['method'].replace('grid by', 'by')}{size}",
            f"{run['volume_m3']:.6g} m³{wrong}, {run['time_s']:.3g} s",
        )


PRESENTATION = Presentation(
    (
        Picture(
            "methods",
            f"{_HERE}:methods",
            "Errors of the methods by the size of their voxels and triangles",
            ("tables.methods",),
        ),
    ),
    facts,
    sections=lambda document: {"methods": method_rows(document)},
    view=f"{__name__.rpartition('.')[0]}.view:view",
)
