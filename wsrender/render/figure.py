"""A drawn scene with its numbers, colour bar and legend, as a matplotlib figure."""

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from wsrender.plots.style import DPI, GREY, add_color_bar, add_title, new_figure, paper_style
from wsrender.render.space import Space

_WIDTH, _HEIGHT = 7.0, 5.4  # of the figure [in]
_PANEL = (0.0, 0.0, 0.84, 0.93)  # of the drawn scene: left, bottom, width, height
_BAR = (0.87, 0.2, 0.02, 0.56)
_TICK_GAP, _LABEL_GAP = 0.055, 0.15  # of numbers and names from their edge, in half heights of the panel

PANEL_PIXELS = (round(_WIDTH * _PANEL[2] * DPI), round(_HEIGHT * _PANEL[3] * DPI))
POINT = DPI / 72  # pixels


@paper_style()
def figure_of(
    picture: np.ndarray,
    space: Space,
    *,
    title: str,
    notes: Sequence[str],
    handles: list[Artist],
    scale: tuple[Normalize, str] | None,
) -> Figure:
    """The picture (height, width, 3) with axes in metres, legend, and colour bar where there is a scale."""
    figure = new_figure(_WIDTH, _HEIGHT, layout=None)
    axes = figure.add_axes(_PANEL)
    axes.set_axis_off()
    height, width, _ = picture.shape
    wide = width / height
    axes.imshow(picture, extent=(-wide, wide, -1, 1), interpolation="none")
    for axis in range(3):
        _add_numbers(axes, space, axis)
    place = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.945), "ncols": 4}
    figure.legend(handles=handles, frameon=False, fontsize=8, columnspacing=1.5, **place)
    if scale is not None:
        norm, label = scale
        add_color_bar(figure, norm, label, cax=figure.add_axes(_BAR))
    for line, note in enumerate(reversed(["world frame", *notes])):
        figure.text(0.02, 0.02 + 0.03 * line, note, fontsize=7.5, color=GREY)
    add_title(figure, title)
    return figure


def _add_numbers(axes: Axes, space: Space, axis: int) -> None:
    """The round coordinates along an axis and its name, outside the box."""
    start, end = space.edge(axis)
    places = np.repeat(start[None], len(ticks := space.labelled_ticks(axis)), axis=0)
    places[:, axis] = ticks
    picture = space.camera.to_picture
    away = _outward(*picture(np.stack([start, end])))
    digits = _digits(ticks)
    for place, tick in zip(picture(places), ticks, strict=True):
        x, y = place + _TICK_GAP * away
        number = f"{tick + 0.0:.{digits}f}".replace("-", "−")  # + 0.0: no −0
        axes.text(x, y, number, fontsize=8, ha="center", va="center")
    x, y = picture((start + end)[None] / 2)[0] + _LABEL_GAP * away
    upright = 90 if axis == 2 else 0
    axes.text(x, y, f"{'xyz'[axis]} [m]", fontsize=9, ha="center", va="center", rotation=upright)


def _outward(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Unit vector across an edge of the picture, away from the middle of the picture."""
    along = end - start
    across = np.array([-along[1], along[0]]) / max(float(np.linalg.norm(along)), 1e-12)
    return across if across @ (start + end) > 0 else -across


def _digits(ticks: np.ndarray) -> int:
    """Decimals that tell the ticks apart."""
    step = float(np.diff(ticks).min()) if len(ticks) > 1 else 1.0
    return next(digits for digits in range(10) if abs(step - round(step, digits)) < 1e-6 * step)
