"""The outline of a region in a plane: loops of lines and arcs."""

from collections.abc import Sequence

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from wsrender.geometry.planar.segments import Segment, drawn, segment_table
from wsrender.results.drawing.style import INK, Heading, new_figure, paper_style, quantity

INSIDE = "#dbe9f6"
LONGEST, LEAST = 4.8, 1.2  # edges of the axes [in]


@paper_style()
def outline(loops: Sequence[Sequence[Segment]], *, filled: bool = True, title: Heading | str = "") -> Figure:
    """Loops of segments [m] in the coordinates of their plane; what they enclose is ``filled``."""
    lines = [[drawn(table, row) for row in range(len(table))] for table in (segment_table([loop]) for loop in loops)]
    points = np.concatenate([points for loop in lines for points in loop])
    low, high = points.min(axis=0), points.max(axis=0)
    extent = np.maximum(high - low, 0.25 * max((high - low).max(), 1e-6))
    width, height = np.maximum(LONGEST * extent / extent.max(), LEAST)
    figure = new_figure(float(width) + 0.8, float(height) + 0.6, title)
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    if filled:
        axes.add_patch(PathPatch(Path.make_compound_path(*(Path(np.concatenate(loop)) for loop in lines)), fc=INSIDE))
    axes.add_collection(LineCollection([points for loop in lines for points in loop], colors=INK, lw=1.1))
    middle, half = (low + high) / 2, 0.54 * extent
    axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
    axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
    axes.set_xlabel(quantity("x", "m"))
    axes.set_ylabel(quantity("y", "m"))
    return figure
