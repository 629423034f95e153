"""The sampled positions in space, coloured by an index."""

import numpy as np
from matplotlib.figure import Figure

from wsrender.results.drawing.cloud import scale_of, thinned
from wsrender.results.drawing.style import Heading, color_map, paper_style
from wsrender.results.drawing.view import BAR, inches, new_view
from wsrender.volume.distribution_map import DistributionMap


@paper_style()
def scatter(
    samples: DistributionMap, index: str | None = None, *, title: Heading | str = "", frame: str = "world"
) -> Figure:
    """Positions [m] of at most 30,000 samples, coloured by ``index`` (by default the map's first).

    A map without indices is drawn in one colour. Raises InputError for an unknown index.
    """
    figure, view = new_view(samples.position, title, frame)
    rows = thinned(len(samples))
    size = float(np.clip(9e4 / max(len(rows), 1), 2.0, 24.0))  # [pt²]
    scale = scale_of(samples, index)
    if scale is None:
        view.add_dots(samples.position[rows], color_map()(np.full(len(rows), 0.35)), size)
    else:
        view.add_dots(samples.position[rows], scale[0](scale[1][rows]), size)
        scale[0].add_bar(figure, cax=figure.add_axes(inches(figure, BAR)))
    return figure
