"""Several robots side by side: the same planes, the same axes, one colour scale."""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from wsrender.plots.planes import draw_plane, plane_extents, voxel_field
from wsrender.plots.style import INK, add_color_bar, add_title, new_figure, paper_style, value_range
from wsrender.volume.registration import registered
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels


@paper_style()
def side_by_side(
    volumes: dict[str, VolumeData],
    *,
    index: str | None = None,
    statistic: str | None = None,
    title: str = "",
    frame: str = "world",
) -> Figure:
    """A row of three planes for each volume, by name: normal to x, y, z, where all volumes together have most voxels.

    Colours span the values of all volumes. Raises InputError for volumes of different voxel sizes, an unknown index or
    statistic, or a volume without occupied voxels.
    """
    placed = registered(list(volumes.values()))
    fields = [voxel_field(volume, index, statistic) for volume in placed]
    values = np.concatenate([field.values[np.isfinite(field.values)] for field in fields])
    norm = value_range(float(values.min()), float(values.max()))
    extents = [plane_extents(placed[0], axis) for axis in range(3)]
    reached = np.unique(np.concatenate([volume.voxels.cells[volume.voxels.count > 0] for volume in placed]))
    together = Voxels(placed[0].shape, reached, np.ones_like(reached))
    widths, tallest = [width for width, _ in extents], max(height for _, height in extents)
    scale = min(9.6 / sum(widths), 3.2 / tallest)
    figure = new_figure(max(sum(widths) * scale + 2.8, 6.0), max((tallest * scale + 0.8) * len(placed) + 0.4, 2.8))
    panels = figure.subplots(len(placed), 3, width_ratios=widths, squeeze=False)
    for row, name, volume, field in zip(panels, volumes, placed, fields, strict=True):
        for axis, axes in enumerate(row):
            layer = int(np.bincount(together.at[axis]).argmax())
            draw_plane(axes, volume, replace(field, norm=norm), axis, layer, frame)
        row[0].annotate(
            name, (-0.42, 0.5), xycoords="axes fraction", rotation=90, va="center", ha="center", color=INK, fontsize=10
        )
    add_color_bar(figure, norm, fields[0].label, ax=list(panels.flat), shrink=0.8, aspect=30, pad=0.02)
    add_title(figure, title)
    return figure
