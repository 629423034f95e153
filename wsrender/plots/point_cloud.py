"""The sampled positions in space, coloured by an index."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from wsrender.plots.space import color_points, new_space, thinned
from wsrender.plots.style import add_title, paper_style
from wsrender.volume.distribution_map import DistributionMap


@paper_style()
def scatter(samples: DistributionMap, index: str | None = None, *, title: str = "", frame: str = "world") -> Figure:
    """Positions [m] of at most 30,000 samples, coloured by ``index`` (by default the map's first).

    A map without indices is drawn in one colour. Raises InputError for an unknown index.
    """
    figure, axes = new_space(samples.position, frame)
    rows = thinned(len(samples))
    points = samples.position[rows]
    colors = color_points(figure, samples, index, rows)
    size: Any = np.clip(9e4 / max(len(rows), 1), 2.0, 24.0)  # [pt²]; annotated as int in matplotlib
    axes.scatter(*points.T, s=size, c=colors, linewidths=0, depthshade=False, rasterized=True)
    add_title(figure, title)
    return figure
