"""A drawn scene with its numbers, colour bar and legend, as a matplotlib figure."""

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from wsrender.results.drawing.box import SeenBox
from wsrender.results.drawing.color_scale import ColorScale
from wsrender.results.drawing.style import DPI, Heading, new_figure, paper_style
from wsrender.results.drawing.view import inches, note, write_labels

_SIZE = (7.0, 5.11)  # of the figure below its heading [in]
_PANEL = (0.0, 0.28, 5.88, 4.8)  # left, bottom, width, height of the drawn scene, above the notes [in]
_BAR = (6.09, 1.08, 0.14, 3.02)  # left, bottom, width, height [in]
_COLUMNS, _ROWS, _ROW = 4, 2, 0.17  # of the legend, the rows that the scene leaves room for, height of one [in]

PANEL_PIXELS = (round(_PANEL[2] * DPI), round(_PANEL[3] * DPI))
POINT = DPI / 72  # pixels


@paper_style()
def figure_of(
    picture: np.ndarray,
    space: SeenBox,
    *,
    title: Heading | str,
    notes: Sequence[str],
    handles: list[Artist],
    scale: ColorScale | None,
) -> Figure:
    """The picture (height, width, 3) with axes in metres, legend, and colour bar where there is a scale."""
    rows = -(-len(handles) // _COLUMNS)
    height = _SIZE[1] + _ROW * max(rows - _ROWS, 0)
    figure = new_figure(_SIZE[0], height, title, layout=None)
    axes = figure.add_axes(inches(figure, _PANEL))
    axes.set_axis_off()
    wide = picture.shape[1] / picture.shape[0]
    axes.imshow(picture, extent=(-wide, wide, -1, 1), interpolation="none")
    write_labels(axes, space)
    place = {"loc": "upper center", "bbox_to_anchor": (0.5, height / float(figure.get_size_inches()[1]))}
    by_rows = [handle for k in range(_COLUMNS) for handle in handles[k::_COLUMNS]]  # matplotlib fills columns
    figure.legend(handles=by_rows, frameon=False, fontsize=8, columnspacing=1.5, ncols=_COLUMNS, **place)
    if scale is not None:
        scale.add_bar(figure, cax=figure.add_axes(inches(figure, _BAR)))
    for line, text in enumerate(reversed(["world frame", *notes])):
        note(figure, 0.14, 0.1 + 0.16 * line, text, fontsize=7.5)
    return figure
