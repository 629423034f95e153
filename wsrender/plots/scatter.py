"""The sampled positions in space, coloured by an index."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from wsrender.errors import InputError
from wsrender.plots.space import add_space, thinned
from wsrender.plots.style import (
    add_color_bar,
    add_title,
    color_map,
    new_figure,
    paper_style,
    quantity,
    value_range,
)
from wsrender.volume.distribution_map import DistributionMap


@paper_style()
def scatter(
    samples: DistributionMap, index: str | None = None, *, title: str = "", frame: str = "world"
) -> Figure:
    """Positions [m] of at most 30,000 samples, coloured by ``index`` (by default the map's first).

    A map without indices is drawn in one colour. Raises InputError for an unknown index.
    """
    figure = new_figure(6.4, 5.2)
    axes = add_space(figure, samples.position, frame)
    rows = thinned(len(samples))
    points = samples.position[rows]
    size: Any = np.clip(9e4 / max(len(rows), 1), 2.0, 24.0)  # [pt²]; annotated as int in matplotlib
    if samples.indices:
        index = checked_index(samples, index)
        values = samples.indices[index]
        norm = value_range(values.min(initial=np.inf), values.max(initial=-np.inf))
        colors = color_map()(norm(values[rows]))
        label = quantity(index, samples.units.get(index))
        add_color_bar(figure, norm, label, axes, shrink=0.7, pad=0.1, aspect=28)
    else:
        colors = color_map()(np.full(len(rows), 0.35))
    axes.scatter(*points.T, s=size, c=colors, linewidths=0, depthshade=False, rasterized=True)
    add_title(figure, title)
    return figure


def checked_index(samples: DistributionMap, index: str | None) -> str:
    """The index itself, or the map's first; InputError where the map does not hold it."""
    if index is None:
        return next(iter(samples.indices))
    if index not in samples.indices:
        raise InputError("index", f"the map has no {index!r}; it holds {', '.join(samples.indices)}")
    return index
