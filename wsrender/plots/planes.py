"""Planes through the volume data, coloured by a statistic; empty voxels stay blank."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from wsrender.errors import InputError
from wsrender.plots.style import (
    add_color_bar,
    add_title,
    color_map,
    new_figure,
    paper_style,
    quantity,
    value_range,
)
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

NAMES = "xyz"
ACROSS = ((1, 2), (0, 2), (0, 1))  # horizontal and vertical axis of the plane normal to x, y, z
_SPARSE = 0.25  # least share of the voxels of the fullest plane that the plane at 0 is shown with
_THINNEST = 0.25  # least extent of a drawn plane, relative to its longest: planar sets keep a legible panel


@dataclass(frozen=True)
class Field:
    """A scalar of each of a volume's ``voxels``, (V,), NaN where empty, with its label; colours span all its values."""

    voxels: Voxels
    values: np.ndarray
    label: str
    norm: Normalize

    def dense(self) -> np.ndarray:
        """The values as an array of the block, (nx, ny, nz)."""
        return self.voxels.dense(self.values)

    def plane(self, axis: int, layer: int) -> np.ndarray:
        """The values of one layer of voxels, NaN where empty, over its two axes."""
        return self.voxels.plane(self.values, axis, layer)

    @property
    def ticks(self) -> MaxNLocator | None:
        """Whole numbers on the colour bar of what is counted; None leaves them to matplotlib."""
        known = self.values[~np.isnan(self.values)]
        return MaxNLocator(integer=True) if np.array_equal(known, np.floor(known)) else None


@paper_style()
def slice_plane(
    volume: VolumeData,
    *,
    x: float | None = None,
    y: float | None = None,
    z: float | None = None,
    index: str | None = None,
    statistic: str | None = None,
    title: str = "",
    frame: str = "world",
) -> Figure:
    """The voxels cut by one plane, given by its coordinate x, y or z [m] in the world frame.

    Without a coordinate: z = 0, or the plane with most voxels where that has less than a quarter of them. ``statistic``
    is by default the maximum if the volume holds it; ``"count"`` shows the number of samples. ``index`` is by
    default the first. Colours span the whole volume, so slices compare.

    Raises InputError for more than one coordinate, a plane outside the volume, an unknown index or
    statistic, or a volume without occupied voxels.
    """
    field = voxel_field(volume, index, statistic)
    given = [(axis, at) for axis, at in enumerate((x, y, z)) if at is not None]
    if len(given) > 1:
        raise InputError("slice", "takes one of x, y, z; use slices for all three")
    axis, at = given[0] if given else (2, None)
    layer = layer_at(volume, axis, at, field)
    width, height = plane_extents(volume, axis)
    scale = min(4.6 / width, 4.4 / height)
    figure = new_figure(width * scale + 1.8, max(height * scale + 1.0, 2.6))
    axes = figure.add_subplot()
    draw_plane(axes, volume, field, axis, layer, frame)
    add_color_bar(figure, field.norm, field.label, ax=axes, shrink=0.9, aspect=28, ticks=field.ticks)
    add_title(figure, title)
    return figure


@paper_style()
def slices(
    volume: VolumeData,
    *,
    at: tuple[float | None, float | None, float | None] = (None, None, None),
    index: str | None = None,
    statistic: str | None = None,
    title: str = "",
    frame: str = "world",
) -> Figure:
    """Three panels: the planes normal to x, y and z at the coordinates ``at`` [m]; see ``slice_plane``."""
    field = voxel_field(volume, index, statistic)
    extents = [plane_extents(volume, axis) for axis in range(3)]
    widths = [width for width, _ in extents]
    scale = min(9.6 / sum(widths), 4.0 / max(height for _, height in extents))
    tallest = max(height for _, height in extents) * scale
    figure = new_figure(max(sum(widths) * scale + 2.6, 6.0), max(tallest + 1.0, 2.4))
    panels = figure.subplots(1, 3, width_ratios=widths)
    for axis, (axes, coordinate) in enumerate(zip(panels, at, strict=True)):
        draw_plane(axes, volume, field, axis, layer_at(volume, axis, coordinate, field), frame)
    place = {"ax": list(panels), "shrink": 0.8, "aspect": 28, "pad": 0.02}
    add_color_bar(figure, field.norm, field.label, ticks=field.ticks, **place)
    add_title(figure, title)
    return figure


def voxel_field(volume: VolumeData, index: str | None, statistic: str | None) -> Field:
    """A statistic of an index per voxel: by default the maximum of the first, or the count of samples.

    Raises InputError for an unknown index or statistic, or a volume without occupied voxels.
    """
    if not volume.n_occupied:
        raise InputError("volume", "has no occupied voxel, so there is nothing to draw")
    voxels = volume.voxels
    if statistic == "count" or not (volume.statistics or statistic or index):
        values, label = np.where(voxels.count > 0, voxels.count, np.nan), "Samples per voxel"
    else:
        values, label = _statistic(volume, index, statistic)
    return Field(voxels, values, label, value_range(np.nanmin(values), np.nanmax(values)))


def _statistic(volume: VolumeData, index: str | None, statistic: str | None) -> tuple[np.ndarray, str]:
    if statistic is None:
        statistic = next(iter(sorted(volume.statistics, key=lambda name: name != "maximum")), "maximum")
    if statistic not in volume.statistics:
        raise InputError("statistic", f"the volume has no {statistic!r}; it holds {_listed(volume.statistics)}")
    by_index = volume.voxels.statistics[statistic]
    if index is None:
        index = next(iter(by_index))
    if index not in by_index:
        raise InputError("index", f"the volume has no {index!r}; it holds {_listed(by_index)}")
    return by_index[index], quantity(f"{statistic} of {index}", volume.units.get(index))


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
        return zero if 0 <= zero < layers and occupied[zero] >= _SPARSE * occupied.max() else int(occupied.argmax())
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
    plane = np.ma.masked_invalid(field.plane(axis, layer))
    axes.imshow(
        plane.T,
        origin="lower",
        extent=(*edges[0], *edges[1]),
        cmap=color_map(),
        norm=field.norm,
        interpolation="nearest",
        zorder=2,
    )
    extents = plane_extents(volume, axis)
    for (low, high), extent, ticks, limit in zip(
        edges, extents, (axes.xaxis, axes.yaxis), (axes.set_xlim, axes.set_ylim), strict=True
    ):
        limit((low + high - extent) / 2, (low + high + extent) / 2)
        ticks.set_major_locator(MaxNLocator(5 if extent > 0.6 * max(extents) else 2))
    axes.grid(zorder=0)
    axes.set_axisbelow(True)
    axes.set_xlabel(f"{NAMES[horizontal]} [m]")
    axes.set_ylabel(f"{NAMES[vertical]} [m]")
    axes.set_title(f"{NAMES[axis]} = {_told(volume.centers(axis)[layer], volume.voxel_size_m)} m ({frame})")


def _told(coordinate: float, voxel_size_m: float) -> str:
    """A coordinate with three digits, or as many as tell voxels apart far from the origin."""
    return f"{coordinate:.{max(3, int(np.log10(abs(coordinate) / voxel_size_m)) + 1)}g}"
