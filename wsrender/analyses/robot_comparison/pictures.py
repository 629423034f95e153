"""Several robots side by side: the same planes, the same axes, one colour scale."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from wsrender.results.drawing.planes import SPARSE, draw_plane, new_planes, plane_normals, shared_scale, voxel_field
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.style import Heading, paper_style
from wsrender.volume.volume_data import VolumeData, registered


@paper_style()
def side_by_side(
    volumes: dict[str, VolumeData],
    *,
    index: str | None = None,
    statistic: str | None = None,
    title: Heading | str = "",
    frame: str = "world",
) -> Figure:
    """A row of planes for each volume, by name: the same planes, which cut all of them.

    Colours span the values of all volumes. Raises InputError for volumes of different voxel sizes, an unknown index or
    statistic, or a volume without occupied voxels.
    """
    placed = registered(list(volumes.values()))
    fields = [voxel_field(volume, index, statistic) for volume in placed]
    scale = shared_scale(fields)
    normals = plane_normals(placed)
    figure, panels = new_planes(placed[0], scale, title, axes=normals, rows=list(volumes))
    layers = [common_layer(placed, axis) for axis in normals]
    for row, volume, field in zip(panels, placed, fields, strict=True):
        for axis, layer, axes in zip(normals, layers, row, strict=True):
            draw_plane(axes, volume, replace(field, scale=scale), axis, layer, frame)
    return figure


def common_layer(volumes: Sequence[VolumeData], axis: int) -> int:
    """The layer of voxels of one block along an axis that cuts all volumes: each has a quarter of its fullest there.

    It is the one at 0; where that cuts less, the one which leaves the least of the volumes the most, on average too.
    """
    layers = volumes[0].shape[axis]
    shown = [volume.voxels.at[axis][volume.voxels.count > 0] for volume in volumes]
    filled = np.array([np.bincount(at, minlength=layers) for at in shown], float)
    filled /= filled.max(axis=1, keepdims=True)
    zero = -volumes[0].first_voxel[axis]
    if 0 <= zero < layers and filled[:, zero].min() >= SPARSE:
        return zero
    return int(np.lexsort([filled.mean(axis=0), filled.min(axis=0)])[-1])


def comparison(plot: ResultPlots, index: str | None = None, *, statistic: str | None = None) -> Figure:
    """The robots of a comparison in the same planes, with the same axes and one colour scale."""
    robots = {name.removeprefix("robot_"): volume for name, volume in plot.volumes.items()}
    return side_by_side(robots, index=index, statistic=statistic, title=plot.heading("volume"))
