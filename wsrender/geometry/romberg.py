"""Limits of what chords or facets of ever smaller size give (Romberg 1955)."""

from typing import Any


def extrapolated(values: Any) -> tuple[Any, Any]:
    """The limit of three values or arrays, for steps of one, a half and a quarter the size, and its last change.

    Their errors are in even powers of the size.
    """
    coarse, middle, fine = values
    once, twice = (4 * middle - coarse) / 3, (4 * fine - middle) / 3
    best = (16 * twice - once) / 15
    return best, abs(best - twice)
