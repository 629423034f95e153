"""Which samples of a map are drawn, and in what colours."""

import numpy as np

from wsrender.errors import InputError
from wsrender.results.drawing.box import AZIMUTH_DEG, THINNEST
from wsrender.results.drawing.color_scale import SIGNED, ColorScale, color_scale
from wsrender.results.drawing.style import quantity
from wsrender.volume.distribution_map import DistributionMap

CLOUD_POINTS = 30_000  # more only hide each other


def scale_of(samples: DistributionMap, index: str | None) -> tuple[ColorScale, np.ndarray] | None:
    """Colours of an index (by default the map's first), which span all its rows, and its values.

    None for a map without indices. Raises InputError for an unknown index.
    """
    if index is None and not samples.indices:
        return None
    index = checked_index(samples, index)
    values = samples.indices[index]
    return color_scale(values, quantity(index, samples.units.get(index)), index.startswith(SIGNED)), values


def checked_index(samples: DistributionMap, index: str | None) -> str:
    """The index itself, or the map's first; InputError where the map does not hold it."""
    if index is None:
        return next(iter(samples.indices))
    if index not in samples.indices:
        held = ", ".join(samples.indices) or "no index"
        raise InputError("index", f"the map has no {index!r}; it holds {held}")
    return index


def thinned(rows: int, most: int = CLOUD_POINTS) -> np.ndarray:
    """Indices of at most ``most`` of ``rows`` rows, evenly spaced: the same at every run."""
    return np.unique(np.linspace(0, rows - 1, min(rows, most)).astype(np.int64))


def far_half(points: np.ndarray) -> np.ndarray:
    """Whether a point (N, 3) lies beyond the vertical plane through the middle of all, seen by the eye.

    All points do where they form a thin sheet: half of it would hide, not show.
    """
    span = np.ptp(points, axis=0)
    if span.min() < THINNEST * span.max():
        return np.ones(len(points), bool)
    azimuth = np.deg2rad(AZIMUTH_DEG)
    towards_eye = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    return (points - middle) @ towards_eye <= 0
