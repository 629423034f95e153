"""Planes through the volume data, coloured by a statistic; empty voxels stay blank. All have one scale."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from wsrender.errors import InputError
from wsrender.multi import NUMBER
from wsrender.results.drawing.color_scale import SIGNED, ColorScale, color_scale
from wsrender.results.drawing.style import INK, Heading, new_figure, paper_style, quantity
from wsrender.results.drawing.view import inches
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

NAMES = "xyz"
ACROSS = ((1, 2), (0, 2), (0, 1))  # horizontal and vertical axis of the plane normal to x, y, z
_PLAIN = ("center", "value")  # statistics that are the index itself
SPARSE = 0.25  # least share of the voxels of the fullest plane that the plane at 0 is shown with
_THINNEST = 0.25  # least extent of a drawn plane, relative to its longest: planar sets keep a legible panel
_LARGEST = (9.6, 4.0)  # width of all planes of a row together, and height of one [in]
_HIGHEST = 6.6  # height of the planes of all rows together [in]
_LEFT, _BELOW, _ABOVE = 0.68, 0.5, 0.3  # room for numbers and names of the axes, and for the title of a plane [in]
_TITLE = 1.75  # least width of a plane with the room beside it: that of its title [in]
_BAR = (0.22, 0.14, 0.95)  # room before a colour bar, its width, room for its numbers and label [in]


@dataclass(frozen=True)
class Field:
    """A scalar of each of a volume's ``voxels``, (V,), NaN where empty, with its colours, which span all its values.

    ``signed`` as in `color_scale`.
    """

    voxels: Voxels
    values: np.ndarray
    scale: ColorScale
    signed: bool = False

    @property
    def label(self) -> str:
        """Name and unit."""
        return self.scale.label

    def dense(self) -> np.ndarray:
        """The values as an array of the block, (nx, ny, nz)."""
        return self.voxels.dense(self.values)

    def plane(self, axis: int, layer: int) -> np.ndarray:
        """The values of one layer of voxels, NaN where empty, over its two axes."""
        return self.voxels.plane(self.values, axis, layer)


@paper_style()
def slice_plane(
    volume: VolumeData,
    *,
    x: float | None = None,
    y: float | None = None,
    z: float | None = None,
    axis: str = "z",
    index: str | None = None,
    statistic: str | None = None,
    title: Heading | str = "",
    frame: str = "world",
) -> Figure:
    """The voxels cut by one plane, given by its coordinate x, y or z [m] in the world frame.

    Without a coordinate: that normal to ``axis`` at 0, or with most voxels where it has less than a quarter of them.
    ``statistic`` is by default the maximum if the volume holds it; ``"count"`` shows the number of samples. ``index``
    is by default the first. Colours span the whole volume, so slices compare.

    Raises InputError for more than one coordinate, an unknown axis, a plane outside the volume, an unknown index or
    statistic, or a volume without occupied voxels.
    """
    field = voxel_field(volume, index, statistic)
    given = [(normal, at) for normal, at in enumerate((x, y, z)) if at is not None]
    if len(given) > 1:
        raise InputError("slice", "takes one of x, y, z; use slices for all three")
    if axis not in tuple(NAMES):
        raise InputError("axis", f"must be x, y or z, not {axis!r}")
    normal, at = given[0] if given else (NAMES.index(axis), None)
    layer = layer_at(volume, normal, at, field)
    figure, panels = new_planes(volume, field.scale, title, axes=(normal,))
    draw_plane(panels[0, 0], volume, field, normal, layer, frame)
    return figure


@paper_style()
def slices(
    volume: VolumeData,
    *,
    at: tuple[float | None, float | None, float | None] = (None, None, None),
    index: str | None = None,
    statistic: str | None = None,
    title: Heading | str = "",
    frame: str = "world",
) -> Figure:
    """Panels of the planes normal to x, y and z at the coordinates ``at`` [m]; see ``slice_plane``.

    Voxels that lie in one plane, or on one line, have one panel: others would show them edge-on.
    """
    field = voxel_field(volume, index, statistic)
    normals = plane_normals([volume], at)
    figure, panels = new_planes(volume, field.scale, title, axes=normals)
    for axes, axis in zip(panels[0], normals, strict=True):
        draw_plane(axes, volume, field, axis, layer_at(volume, axis, at[axis], field), frame)
    return figure


def plane_normals(volumes: Sequence[VolumeData], at: Sequence[float | None] = (None, None, None)) -> list[int]:
    """Normals of the planes that show voxels: all three, or the one of a set in a plane, or of a line.

    Volumes have one block. Planes at a coordinate ``at`` that is given are shown in any case.
    """
    shown = [volume.voxels.at[:, volume.voxels.count > 0] for volume in volumes]
    flat = np.ptp(np.concatenate(shown, axis=1), axis=1) == 0
    one = int(np.argmax(flat)) if flat.any() else None
    return [axis for axis in range(3) if one in (None, axis) or at[axis] is not None]


def new_planes(
    volume: VolumeData,
    scale: ColorScale,
    heading: Heading | str,
    *,
    axes: Sequence[int] = (0, 1, 2),
    rows: Sequence[str] = ("",),
) -> tuple[Figure, np.ndarray]:
    """A figure with the colour bar of a scale, and for each row a panel for the plane normal to each of ``axes``.

    A metre is equally long in all panels, (rows, axes). ``rows`` are names, written at their left.
    """
    extents = [plane_extents(volume, axis) for axis in axes]
    widths, heights = np.transpose(extents)
    across = _LARGEST[0] if len(axes) > 1 else 0.6 * _LARGEST[0]
    high = min(_LARGEST[1], _HIGHEST / len(rows))
    unit = min(across / widths.sum(), high / heights.max())  # inches of a metre
    widths, heights = widths * unit, heights * unit
    steps = np.maximum(_LEFT + widths, _TITLE)
    left = 0.35 if any(rows) else 0.0
    tall = _BELOW + heights.max() + _ABOVE
    bar_left = left + steps.sum() + _BAR[0]
    figure = new_figure(bar_left + _BAR[1] + _BAR[2], tall * len(rows), heading, layout=None)
    panels = np.empty((len(rows), len(axes)), object)
    for row, name in enumerate(rows):
        bottom = tall * (len(rows) - 1 - row) + _BELOW
        for k, start in enumerate(left + np.cumsum(steps) - steps + _LEFT):
            panels[row, k] = figure.add_axes(inches(figure, (start, bottom, widths[k], heights[k])))
        across, up = figure.get_size_inches()
        middle = (bottom + heights.max() / 2) / up
        figure.text(0.2 / across, middle, name, rotation=90, va="center", ha="center", color=INK, fontsize=10)
    length = min(tall * len(rows) - _BELOW - _ABOVE, 4.5)
    middle = (tall * len(rows) + _BELOW - _ABOVE) / 2
    scale.add_bar(figure, cax=figure.add_axes(inches(figure, (bar_left, middle - length / 2, _BAR[1], length))))
    return figure, panels


def voxel_field(volume: VolumeData, index: str | None, statistic: str | None) -> Field:
    """A statistic of an index per voxel: by default the maximum of the first, or the count of samples.

    Where the maximum is known of fewer indices than another statistic, that one is the default; of a volume that
    several robots share it is how many of them reach the voxel.

    Raises InputError for an unknown index or statistic, or a volume without occupied voxels.
    """
    if not volume.n_occupied:
        raise InputError("volume", "has no occupied voxel, so there is nothing to draw")
    voxels = volume.voxels
    if statistic == "count" or not (volume.statistics or statistic or index):
        values = np.where(voxels.count > 0, voxels.count, np.nan)
        once = np.nanmax(values) == 1  # as on a lattice of their centres
        return Field(voxels, values, color_scale(values, "Reached voxels" if once else "Samples per voxel"))
    name, values, label = _statistic(volume, index, statistic)
    signed = name.startswith(SIGNED)
    return Field(voxels, values, color_scale(values, label, signed), signed)


def shared_scale(fields: Sequence[Field]) -> ColorScale:
    """Colours that span the values of several fields of one quantity."""
    return color_scale(np.concatenate([field.values for field in fields]), fields[0].label, fields[0].signed)


def _statistic(volume: VolumeData, index: str | None, statistic: str | None) -> tuple[str, np.ndarray, str]:
    """Name of the index, its values (V,) and their label."""
    if statistic is None:
        # That of most indices: a field of forces has the maximum of the force alone, which is the device's peak.
        held = [name for name, of in volume.statistics.items() if index is None or index in of] or volume.statistics
        ranked = sorted(held, key=lambda name: (name != NUMBER, -len(volume.statistics[name]), name != "maximum"))
        statistic = next(iter(ranked), "maximum")
    if statistic not in volume.statistics:
        raise InputError("statistic", f"the volume has no {statistic!r}; it holds {_listed(volume.statistics)}")
    by_index = volume.voxels.statistics[statistic]
    if index is None:
        index = next(iter(by_index))
    if index not in by_index:
        raise InputError("index", f"the volume has no {index!r}; it holds {_listed(by_index)}")
    name = index if statistic in _PLAIN else f"{statistic} of {index}"
    return index, by_index[index], quantity(name, volume.units.get(index))


def _listed(names) -> str:
    return ", ".join([*names, "count"])


def layer_at(volume: VolumeData, axis: int, at: float | None, field: Field | None = None) -> int:
    """Number of the voxel layer cut at a coordinate [m] along an axis.

    Without a coordinate: the one at 0, or the one with most voxels (with a value of the ``field``) where that has less
    than a quarter of them. Raises InputError for a coordinate outside the volume.
    """
    size, layers = volume.voxel_size_m, volume.shape[axis]
    first = volume.first_voxel[axis]
    if at is None:
        shown = volume.voxels.count > 0 if field is None else ~np.isnan(field.values)
        occupied = np.bincount(volume.voxels.at[axis][shown], minlength=layers)
        zero = -first
        return zero if 0 <= zero < layers and occupied[zero] >= SPARSE * occupied.max() else int(occupied.argmax())
    cells = at / size - first
    if not -1e-9 <= cells <= layers + 1e-9:
        name, low, high = NAMES[axis], first * size, (first + layers) * size
        raise InputError(name, f"the plane {name} = {at:g} m misses the workspace, {low:g} … {high:g} m")
    return min(max(int(np.floor(cells + 1e-9)), 0), layers - 1)


def plane_extents(volume: VolumeData, axis: int) -> tuple[float, float]:
    """Width and height of the drawn plane [m]."""
    size = [volume.shape[across] * volume.voxel_size_m for across in ACROSS[axis]]
    width, height = (max(extent, _THINNEST * max(size)) * 1.04 for extent in size)
    return width, height


def draw_plane(axes: Axes, volume: VolumeData, field: Field, axis: int, layer: int, frame: str) -> None:
    """Draw one layer of voxels normal to an axis, with the labels of its axes."""
    horizontal, vertical = ACROSS[axis]
    edges = [
        volume.first_voxel[across] * volume.voxel_size_m + np.array([0, volume.shape[across]]) * volume.voxel_size_m
        for across in (horizontal, vertical)
    ]
    plane = field.plane(axis, layer)
    axes.imshow(
        np.ma.masked_invalid(plane).T,
        origin="lower",
        extent=(*edges[0], *edges[1]),
        cmap=field.scale.colors,
        norm=field.scale.norm,
        interpolation="nearest",
        zorder=2,
    )
    if field.scale.diverging:
        _draw_zero(axes, volume, plane, ACROSS[axis])
    extents = plane_extents(volume, axis)
    for (low, high), extent, ticks, limit in zip(
        edges, extents, (axes.xaxis, axes.yaxis), (axes.set_xlim, axes.set_ylim), strict=True
    ):
        limit((low + high - extent) / 2, (low + high + extent) / 2)
        ticks.set_major_locator(MaxNLocator(5 if extent > 0.6 * max(extents) else 2))
    axes.grid(zorder=0)
    axes.set_axisbelow(True)
    axes.set_xlabel(quantity(NAMES[horizontal], "m"))
    axes.set_ylabel(quantity(NAMES[vertical], "m"))
    axes.set_title(f"{NAMES[axis]} = {_layer_text(volume, axis, layer)} m ({frame})".replace("-", "−"))


def _layer_text(volume: VolumeData, axis: int, layer: int) -> str:
    """The coordinate of the middle of a layer; of the only one its ends: where in it samples lie is not known."""
    size = volume.voxel_size_m
    middle = float(volume.centers(axis)[layer])
    if volume.shape[axis] > 1:
        return _told(middle, size)
    return " … ".join(_told(middle + half, size) for half in (-size / 2, size / 2))


def _told(coordinate: float, voxel_size_m: float) -> str:
    """A coordinate with three digits, or as many as tell voxels apart far from the origin."""
    if abs(coordinate) < 1e-9 * voxel_size_m:
        return "0"
    return f"{coordinate:.{max(3, int(np.log10(abs(coordinate) / voxel_size_m)) + 1)}g}"


def _draw_zero(axes: Axes, volume: VolumeData, plane: np.ndarray, across: tuple[int, int]) -> None:
    """The line between the signs of a plane (a, b); NaN is neither."""
    known = plane[np.isfinite(plane)]
    if min(plane.shape) > 1 and len(known) and known.min() < 0 < known.max():
        x, y = (volume.centers(axis) for axis in across)
        axes.contour(x, y, np.ma.masked_invalid(plane).T, levels=[0.0], colors=[INK], linewidths=1.0, zorder=3)
