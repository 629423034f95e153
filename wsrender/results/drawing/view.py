"""Pictures of space: lines, dots and surfaces in a box with numbers in metres; surfaces hide what is behind them."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from skimage.measure import find_contours

from wsrender.results.drawing.box import AZIMUTH_DEG, ELEVATION_DEG, NAME_SIZE, NUMBER_SIZE, SeenBox, space_around
from wsrender.results.drawing.depth import DepthBuffer
from wsrender.results.drawing.style import DPI, GREY, Heading, new_figure

GRID, FRAME = "#dedede", "#999999"
PLACE = (0.0, 0.1, 5.3, 4.75)  # left, bottom, width, height of the box with its numbers [in]
BAR = (5.5, 0.95, 0.13, 3.1)  # the same of a colour bar
_SIZE = (6.4, 4.85)
_PIECES = 120  # of a line, each in sight or hidden
_HIDDEN, _SURFACE = 1.5, 2.0  # heights (zorder) of what surfaces hide, and of surfaces


@dataclass(eq=False)
class DrawnAxes:
    """Axes in half heights of the picture, in which a ``space`` is drawn; ``size`` in pixels."""

    axes: Axes
    space: SeenBox
    size: tuple[int, int]
    buffers: list[DepthBuffer] = field(default_factory=list)

    def add_numbers(self) -> None:
        """The grid of the far sides, the numbers of the axes and their names."""
        for lines, color, width in zip(self.space.panes(), (GRID, FRAME), (0.5, 0.6), strict=True):
            self.axes.add_collection(LineCollection(self._seen(lines), colors=color, linewidths=width, zorder=0))
        write_labels(self.axes, self.space)

    def add_surface(
        self, corners: np.ndarray, colors: np.ndarray, alpha: float = 1.0, zorder: float = _SURFACE
    ) -> None:
        """Triangles with corners (T, 3, 3) [m] in colours (T, 3, 3): at each pixel the one nearest to the eye."""
        buffer = DepthBuffer.of(self.space.camera, self.size, corners)
        self.buffers.append(buffer)
        wide = self.size[0] / self.size[1]
        image = buffer.image(colors, alpha)
        self.axes.imshow(image, extent=(-wide, wide, -1, 1), interpolation="none", zorder=zorder, aspect="auto")
        self._set_limits()

    def add_outline(self, **style: Any) -> None:
        """The outline of the surface added last, as it is seen: whole, whether an edge or a smooth side lies there."""
        covered = (self.buffers[-1].nearest >= 0).astype(float)
        height, width = covered.shape
        padded = _rounded(np.pad(covered, 1))  # a surface at the border of the picture ends there
        # Not by Axes.contour, which holds the field, 100 MiB and more, for as long as the figure is there.
        rows = [(line - 0.5) / height * 2 for line in find_contours(padded, 0.5)]  # half heights, of the padding too
        lines = [np.column_stack([line[:, 1] - width / height, 1 - line[:, 0]]) for line in rows]
        self.axes.add_collection(LineCollection(lines, **style), autolim=False)
        self._set_limits()

    def add_dots(self, points: np.ndarray, colors: Any, size: float, **style: Any) -> None:
        """Points (N, 3) [m] as discs of ``size`` [pt²], the nearest last; one colour, or (N, 4) of them."""
        order = np.argsort(self.space.camera.nearness(points), kind="stable")
        colors = colors if isinstance(colors, str) else np.asarray(colors)[order]
        x, y = self._seen(points[order]).T
        area: Any = size  # annotated as int in matplotlib
        self.axes.scatter(x, y, s=area, c=colors, **{"linewidths": 0, "rasterized": True, "zorder": 3, **style})

    def add_line(self, points: np.ndarray, *, zorder: float, **style: Any) -> None:
        """A line through points (N, 3) [m]; what a surface hides lies below that."""
        fine, links = _pieces(points)
        hidden = self._hidden((fine[1:] + fine[:-1]) / 2)
        for rows in np.split(np.arange(len(hidden)), np.flatnonzero(np.diff(hidden)) + 1):
            ends = np.append(rows, rows[-1] + 1)
            kept = ends[(ends == ends[0]) | (ends == ends[-1]) | links[ends]]
            self.axes.plot(*self._seen(fine[kept]).T, zorder=_below(bool(hidden[rows[0]]), zorder), **style)

    def add_marks(self, points: np.ndarray, *, zorder: float, through: bool = False, **style: Any) -> None:
        """A mark at each of points (N, 3) [m]; those that a surface hides lie below it, unless seen ``through`` it."""
        hidden = np.zeros(len(points), bool) if through else self._hidden(points)
        for rows, below in ((~hidden, False), (hidden, True)):
            if rows.any():
                self.axes.plot(*self._seen(points[rows]).T, ls="", zorder=_below(below, zorder), **style)

    def add_segments(self, ends: np.ndarray, **style: Any) -> None:
        """Straight lines (N, 2, 3) [m], all in sight."""
        self.axes.add_collection(LineCollection(self._seen(ends), **style))

    def _seen(self, points: np.ndarray) -> Any:
        return self.space.camera.to_picture(points.reshape(-1, 3)).reshape(*points.shape[:-1], 2)

    def _hidden(self, points: np.ndarray) -> np.ndarray:
        hidden = np.zeros(len(points), bool)
        for buffer in self.buffers:
            hidden |= buffer.hides(points)
        return hidden

    def _set_limits(self) -> None:
        wide = self.size[0] / self.size[1]
        self.axes.set(xlim=(-wide, wide), ylim=(-1, 1))


def new_view(
    points: np.ndarray, heading: Heading | str, frame: str, size: tuple[float, float] = _SIZE
) -> tuple[Figure, DrawnAxes]:
    """A figure with room for a colour bar, and a view whose box holds points (N, 3) [m]."""
    figure = new_figure(*size, heading, layout=None)
    note(figure, 0.18, 0.12, f"{frame} frame")
    return figure, add_view(figure, points, PLACE)


def add_view(
    figure: Figure,
    points: np.ndarray,
    place: tuple[float, float, float, float],
    azimuth_deg: float = AZIMUTH_DEG,
    elevation_deg: float = ELEVATION_DEG,
    **axes_of: Any,
) -> DrawnAxes:
    """A view at left, bottom, width and height [in] of a figure, whose box holds points (N, 3) [m].

    ``axes_of``: ``stretch`` and ``names`` of a `Space`.
    """
    axes = figure.add_axes(inches(figure, place))
    axes.set_axis_off()
    pixels = round(place[2] * DPI), round(place[3] * DPI)
    view = DrawnAxes(axes, space_around(points, pixels, azimuth_deg, elevation_deg, **axes_of), pixels)
    view._set_limits()
    view.add_numbers()
    return view


def add_legend(figure: Figure, handles: Sequence[Any], title: str | None = None) -> None:
    """A legend where the colour bar of `new_view` would be, beside the box and not on it."""
    place: dict[str, Any] = {"loc": "upper right", "bbox_to_anchor": (1.0, 0.94)}
    figure.legend(handles=handles, title=title, frameon=False, fontsize=8, title_fontsize=8, **place)


def write_labels(axes: Axes, space: SeenBox) -> None:
    """The numbers of the box and the names of its axes, in axes in half heights of the picture."""
    for label in space.labels():
        size = NAME_SIZE if label.text in space.names else NUMBER_SIZE
        style: dict[str, Any] = {"ha": "center", "va": "center", "rotation": 90 if label.upright else 0}
        axes.text(label.x, label.y, label.text, fontsize=size, **style)


def inches(figure: Figure, place: Sequence[float]) -> tuple[float, float, float, float]:
    """Left, bottom, width, height [in] as parts of a figure."""
    left, bottom, width, height = place
    across, up = figure.get_size_inches()
    return left / across, bottom / up, width / across, height / up


def note(figure: Figure, x: float, y: float, text: str, **style: Any) -> None:
    """A small grey text at x, y [in] from the lower left of a figure."""
    across, up = figure.get_size_inches()
    figure.text(x / across, y / up, text, **{"fontsize": 8, "color": GREY, **style})


def _rounded(covered: np.ndarray) -> np.ndarray:
    """A mask without the steps of its pixels."""
    from scipy.ndimage import gaussian_filter

    return gaussian_filter(covered, 1.5)


def _pieces(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A line cut into pieces, (M, 3), and which of its points are the line's own."""
    count = max(_PIECES // max(len(points) - 1, 1), 8)
    share = np.arange(count)[:, None] / count
    links = [start + share * (end - start) for start, end in pairwise(points)]
    fine = np.concatenate([*links, points[-1:]])
    return fine, np.arange(len(fine)) % count == 0


def _below(hidden: bool, zorder: float) -> float:
    """Height of a hidden mark: below surfaces, in the order of those in sight."""
    return _HIDDEN + 0.01 * zorder if hidden else zorder
