"""Titles of pictures, with the warnings of a result that concern them."""

from collections.abc import Iterable, Mapping
from typing import Any, Literal

from wsrender.results.drawing.style import Heading

Kind = Literal["samples", "volume", "surface", "boundary", "other"]
"""What a picture shows: sampled positions, voxels, a surface without voxels, the boundary of a planar arm, or else."""
# Warnings that concern some kinds of pictures only, by their code; every other concerns all.
_CONCERNED: dict[str, frozenset[str]] = {
    "few_samples": frozenset({"samples", "volume"}),
    "occupied_differs": frozenset({"volume"}),
    "monte_carlo_not_converged": frozenset({"boundary"}),
}
_MOST = 2  # warnings written out on a picture


def heading(title: str, warnings: Iterable[Mapping[str, Any]], kind: Kind) -> Heading:
    """A title with the messages of the warnings of a result document that concern a kind of pictures.

    None is said twice, as of one robot that stands in two places; those of different codes come first.
    """
    concerned = [entry for entry in warnings if kind in _CONCERNED.get(str(entry["code"]), {kind})]
    first = {str(entry["code"]): str(entry["message"]) for entry in reversed(concerned)}
    found = list(dict.fromkeys([*reversed(first.values()), *(str(entry["message"]) for entry in concerned)]))
    more = len(found) - _MOST
    if more > 0:
        found[_MOST - 1] += f" (and {more} more in the result's warnings)"
    return Heading(title, tuple(found[:_MOST]))
