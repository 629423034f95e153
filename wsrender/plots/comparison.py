"""Several robots side by side: the same planes, the same axes, one colour scale."""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from wsrender.plots.planes import draw_plane, new_planes, shared_scale, voxel_field
from wsrender.plots.style import Heading, paper_style
from wsrender.volume.registration import registered
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels


@paper_style()
def side_by_side(
    volumes: dict[str, VolumeData],
    *,
    index: str | None = None,
    statistic: str | None = None,
    title: Heading | str = "",
    frame: str = "world",
) -> Figure:
    """A row of three planes for each volume, by name: normal to x, y, z, where all volumes together have most voxels.

    Colours span the values of all volumes. Raises InputError for volumes of different voxel sizes, an unknown index or
    statistic, or a volume without occupied voxels.
    """
    placed = registered(list(volumes.values()))
    fields = [voxel_field(volume, index, statistic) for volume in placed]
    scale = shared_scale(fields)
    reached = np.unique(np.concatenate([volume.voxels.cells[volume.voxels.count > 0] for volume in placed]))
    together = Voxels(placed[0].shape, reached, np.ones_like(reached))
    figure, panels = new_planes(placed[0], scale, title, rows=list(volumes))
    for row, volume, field in zip(panels, placed, fields, strict=True):
        for axis, axes in enumerate(row):
            layer = int(np.bincount(together.at[axis]).argmax())
            draw_plane(axes, volume, replace(field, scale=scale), axis, layer, frame)
    return figure
