"""A 3-D picture of one or several robots in their workspaces, as a matplotlib figure with its legend."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from wsrender.documents.environment import Environment
from wsrender.errors import InputError
from wsrender.results.drawing.box import AZIMUTH_DEG, ELEVATION_DEG, SeenBox, space_around
from wsrender.results.drawing.color_scale import ColorScale
from wsrender.results.drawing.stick_figure import SHARED_COLOR, SHARED_LABEL
from wsrender.results.drawing.style import DPI, INK, Heading, new_figure, paper_style
from wsrender.results.drawing.view import inches, note, write_labels
from wsrender.results.render import environment as surroundings
from wsrender.results.render.environment import Item
from wsrender.results.render.process import drawn
from wsrender.results.render.scene import Cloud, Color, Dots, DrawnScene, DrawnSurface, Layer, Lines, Plates, Rods
from wsrender.results.render.subject import Subject
from wsrender.results.render.views import ROBOT_COLORS, VIEWS, Choice
from wsrender.world.triangles import foot

if TYPE_CHECKING:
    import trimesh

_DARK: Color = (0.15, 0.15, 0.17)
_TIP: Color = (0.784, 0.063, 0.18)
_SHARED_ALPHA = 0.4
SHINING = "pale parts of the arm are hidden"
_ROD = 0.006  # radius of a rod, relative to the longest edge of the picture's box
_SIZE = (7.0, 5.11)  # of the figure below its heading [in]
_PANEL = (0.0, 0.28, 5.88, 4.8)  # left, bottom, width, height of the drawn scene, above the notes [in]
_BAR = (6.09, 1.08, 0.14, 3.02)  # left, bottom, width, height [in]
_COLUMNS, _ROWS, _ROW = 4, 2, 0.17  # of the legend, the rows that the scene leaves room for, height of one [in]

PANEL_PIXELS = (round(_PANEL[2] * DPI), round(_PANEL[3] * DPI))
POINT = DPI / 72  # pixels


def picture(
    subjects: Sequence[Subject],
    view: str = "boundary",
    *,
    index: str | None = None,
    statistic: str | None = None,
    threshold: float = 0.9,
    alpha: float | None = None,
    at: tuple[float | None, float | None, float | None] = (None, None, None),
    environment: Iterable[Item] | Environment = (),
    shared: "trimesh.Trimesh | None" = None,
    azimuth_deg: float = AZIMUTH_DEG,
    elevation_deg: float = ELEVATION_DEG,
    title: Heading | str = "",
) -> Figure:
    """Draw subjects in one box, with axes in metres, legend and colour bar; the defaults are those of [WSR] Table II.

    ``shared`` is the surface of what several subjects reach together, drawn where they differ by colour.

    Raises InputError for a view, index or number that is not allowed; MissingExtraError without PyVista; RenderError
    where it cannot draw.
    """
    _check(view, threshold, alpha, elevation_deg)
    if len(at) != 3:
        raise InputError("at", f"must be the three planes x, y, z, each a number [m] or None, not {at}")
    items = surroundings.items_of(environment)
    choice = Choice(index, statistic, threshold, alpha, at, azimuth_deg)
    drawing = VIEWS[view](subjects, choice)
    if shared is not None and drawing.scale is None:
        drawing.layers.append(
            DrawnSurface(shared.vertices, shared.faces, SHARED_COLOR, alpha=_SHARED_ALPHA, smooth=True)
        )
        drawing.handles.append(Patch(facecolor=SHARED_COLOR, alpha=_SHARED_ALPHA, label=SHARED_LABEL))
    if any(subject.arm is not None for subject in subjects) and any(_is_opaque(layer) for layer in drawing.layers):
        drawing.notes.append(SHINING)
    space = space_around(_extent(subjects, drawing.layers, items), PANEL_PIXELS, azimuth_deg, elevation_deg)
    grid, frame = space.panes()
    panes = [Lines(grid, (0.87, 0.87, 0.87), 1.0), Lines(frame, (0.6, 0.6, 0.6), 1.2)]
    layers = [*panes, *_around(items, space), *_robots(subjects, space), *drawing.layers]
    image = drawn(DrawnScene(space.camera, PANEL_PIXELS, layers))
    handles = [*_robot_handles(subjects), *drawing.handles, *_environment_handles(items)]
    return figure_of(image, space, title=title, notes=drawing.notes, handles=handles, scale=drawing.scale)


def _check(view: str, threshold: float, alpha: float | None, elevation_deg: float) -> None:
    if view not in VIEWS:
        raise InputError("view", f"{view!r} is not a view; allowed: {', '.join(VIEWS)}")
    if not 0 < threshold <= 1:
        raise InputError("threshold", f"is {threshold}; allowed are values above 0, up to 1")
    if alpha is not None and not 0 < alpha <= 1:
        raise InputError("alpha", f"is {alpha}; allowed are values above 0 (invisible), up to 1 (opaque)")
    if not -80 <= elevation_deg <= 80:
        raise InputError("elevation_deg", f"is {elevation_deg}; allowed are -80 … 80")


def _is_opaque(layer: Layer) -> bool:
    return isinstance(layer, DrawnSurface) and layer.alpha == 1


def _extent(subjects: Sequence[Subject], layers: Sequence[Layer], environment: Sequence[Item]) -> np.ndarray:
    """Points (N, 3) [m] that the picture must hold."""
    points = [_layer_points(layer) for layer in layers]
    points += [arm for subject in subjects for arm in subject.arms]
    points += [link.vertices for subject in subjects for link in subject.body]
    points += [surroundings.corners(item) for item in environment]
    ends = np.concatenate([np.stack([p.min(axis=0), p.max(axis=0)]) for p in points if len(p)])
    middle = ends.mean(axis=0)
    return np.concatenate([ends, *[foot(plane, middle)[None] for plane in surroundings.planes(environment)]])


def _layer_points(layer: Layer) -> np.ndarray:
    match layer:
        case DrawnSurface():
            return layer.vertices
        case Plates():
            return layer.corners.reshape(-1, 3)
        case Dots():
            return layer.positions
        case Cloud():
            return np.stack([layer.origin, layer.origin + np.array(layer.levels.shape) * layer.voxel_size])
    return np.empty((0, 3))


def _around(environment: Sequence[Item], space: SeenBox) -> list[DrawnSurface]:
    return [part for item in environment for part in surroundings.surfaces(item, space.lower, space.upper)]


def _robots(subjects: Sequence[Subject], space: SeenBox) -> list[Layer]:
    """The arms as rods, thin where the bodies of their links are known."""
    radius = _ROD * float((space.upper - space.lower).max())
    layers: list[Layer] = []
    for k, subject in enumerate(subjects):
        layers += subject.body
        for arm in subject.arms:
            layers.append(Rods(arm, radius * (0.5 if subject.body else 1.0), _color(k, subjects)))
    return layers


def _color(k: int, subjects: Sequence[Subject]) -> Color:
    return ROBOT_COLORS[k % len(ROBOT_COLORS)] if len(subjects) > 1 else _DARK


def _robot_handles(subjects: Sequence[Subject]) -> list[Artist]:
    arms = [(k, subject) for k, subject in enumerate(subjects) if subject.arm is not None]
    if not arms:
        return []
    handles: list[Artist] = [
        Line2D([], [], color=_color(k, subjects), lw=2.5, marker="s", markevery=[0], ms=6, label=subject.name)
        for k, subject in arms
    ]
    handles.append(Line2D([], [], ls="", marker="o", ms=5, mfc="white", mec=INK, mew=1.0, label="joint"))
    handles.append(Line2D([], [], ls="", marker="o", ms=6, mfc=_TIP, mec=_TIP, label="tip"))
    return handles


def _environment_handles(environment: Sequence[Item]) -> list[Artist]:
    kinds = dict.fromkeys((surroundings.color(item), surroundings.label(item)) for item in environment)
    return [Patch(facecolor=color, label=label) for color, label in kinds]


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
