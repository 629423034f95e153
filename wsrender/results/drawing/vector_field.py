"""A vector per voxel as stream lines in three planes, over its size."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from wsrender.errors import InputError
from wsrender.results.drawing.color_scale import color_scale
from wsrender.results.drawing.planes import ACROSS, Field, draw_plane, layer_at, new_planes, plane_normals
from wsrender.results.drawing.style import INK, Heading, paper_style, quantity
from wsrender.volume.volume_data import VolumeData

_FELT = 0.02  # of the largest size: shorter vectors show no line
_ARROWS = 22  # along the longer side of a plane too narrow for lines
_STREAMS: dict[str, Any] = {"density": 2.2, "linewidth": 0.7, "arrowsize": 0.7, "minlength": 0.015, "zorder": 3}
_FEWEST_CELLS = 6  # across a plane for stream lines


@paper_style()
def vector_planes(
    volume: VolumeData,
    name: str | None = None,
    *,
    at: tuple[float | None, float | None, float | None] = (None, None, None),
    title: Heading | str = "",
    frame: str = "world",
) -> Figure:
    """Planes as of `slices`, normal to x, y and z at ``at`` [m] (default: with most voxels): stream lines of a vector.

    Lines follow the vector's part in the plane, colours are its whole size. Raises InputError for a volume without
    vectors, without the one asked or without occupied voxels, and a plane outside.
    """
    if not volume.vectors:
        raise InputError("volume", "holds no vectors")
    name = next(iter(volume.vectors)) if name is None else name
    if name not in volume.vectors:
        raise InputError("vector", f"the volume has no {name!r}; it holds {', '.join(volume.vectors)}")
    if not volume.n_occupied:
        raise InputError("volume", "has no occupied voxel, so there is nothing to draw")
    vectors = volume.voxels.vectors[name].astype(np.float64)
    size = np.linalg.norm(vectors, axis=1)
    largest = float(np.nanmax(size))
    label = quantity(f"mean {name}", volume.units.get(name))
    field = Field(volume.voxels, size, color_scale(size, label))
    normals = plane_normals([volume], at)
    figure, panels = new_planes(volume, field.scale, title, axes=normals)
    for axes, axis in zip(panels[0], normals, strict=True):
        fullest = volume.centers(axis)[np.bincount(volume.voxels.at[axis][volume.voxels.count > 0]).argmax()]
        layer = layer_at(volume, axis, float(fullest) if at[axis] is None else at[axis])
        draw_plane(axes, volume, field, axis, layer, frame)
        plane = volume.voxels.plane(vectors, axis, layer)
        _draw_lines(axes, volume, plane, axis, largest)
    return figure


def _draw_lines(axes: Axes, volume: VolumeData, plane: np.ndarray, axis: int, largest: float) -> None:
    """Stream lines of the part of vectors (a, b, 3) in the plane; arrows where it has too few cells for lines."""
    along, across = ACROSS[axis]
    u, v = plane[..., along].T, plane[..., across].T
    felt = np.hypot(u, v) > _FELT * largest
    if not felt.any():
        return
    x, y = volume.centers(along), volume.centers(across)
    limits = axes.get_xlim(), axes.get_ylim()
    if min(len(x), len(y)) >= _FEWEST_CELLS:
        u, v = (np.ma.masked_array(np.nan_to_num(part), ~felt) for part in (u, v))
        axes.streamplot(x, y, u, v, color=INK, **_STREAMS)
    else:
        step = max(1, max(len(x), len(y)) // _ARROWS)
        rows, columns = np.nonzero(felt)
        kept = (rows % step == 0) & (columns % step == 0)
        rows, columns = rows[kept], columns[kept]
        parts = u[rows, columns], v[rows, columns]
        axes.quiver(x[columns], y[rows], *parts, color=INK, angles="xy", width=0.005, zorder=3)
    axes.set_xlim(*limits[0])
    axes.set_ylim(*limits[1])
