"""What constraints leave of a workspace, in planes: voxels that stay free, and what blocks the others."""

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from wsrender.errors import InputError
from wsrender.results.drawing.color_scale import ColorScale
from wsrender.results.drawing.okabe_ito import BLUE, GREEN, ORANGE, PURPLE, SKY_BLUE, VERMILION
from wsrender.results.drawing.planes import Field, draw_plane, layer_at, new_planes, plane_normals
from wsrender.results.drawing.style import Heading, paper_style
from wsrender.volume.volume_data import VolumeData

FREE, UNDECIDED, BEYOND = "#d9d9d9", "#000000", "#fafafa"
BLOCKED = (VERMILION, BLUE, PURPLE, GREEN, ORANGE, SKY_BLUE)  # further reasons begin anew, paler


@paper_style()
def blocked_planes(
    volume: VolumeData,
    *,
    at: tuple[float | None, float | None, float | None] = (None, None, None),
    title: Heading | str = "",
    frame: str = "world",
) -> Figure:
    """Voxels of the planes normal to x, y and z at the coordinates ``at`` [m] by what blocks them.

    Of a ``volume`` with "samples" by reason, those "admitted" first: a voxel is free where one is admitted, else
    blocked by the reason of most of its samples. Raises InputError for a volume without these.
    """
    samples = volume.voxels.statistics.get("samples", {})
    if "admitted" not in samples or not volume.n_occupied:
        raise InputError("volume", "does not hold the samples that constraints admit and reject")
    rejected = {name: values for name, values in samples.items() if name != "admitted"}
    code = np.where(samples["admitted"] > 0, 0, 1 + np.argmax(list(rejected.values()), axis=0))
    return _planes(volume, code, {"free": FREE} | _blocked(list(rejected)), at, title, frame)


@paper_style()
def label_planes(
    volume: VolumeData,
    *,
    at: tuple[float | None, float | None, float | None] = (None, None, None),
    title: Heading | str = "",
    frame: str = "world",
) -> Figure:
    """Voxels of the planes normal to x, y and z at the coordinates ``at`` [m] by their labels.

    Of a ``volume`` as `wsrender.reach.voxel_labels.label_voxels` makes it: reachable, blocked by which constraint,
    undecided, unreachable. Raises InputError for a volume without labels.
    """
    center = volume.voxels.statistics.get("center", {})
    if "label" not in center or not volume.n_occupied:
        raise InputError("volume", "does not hold labels of voxels")
    label, reason = center["label"], center["reason"]
    reasons = [each.partition(" ")[2] for each in volume.units["reason"].split(", ")]
    blocking = [int(each) for each in np.unique(reason[label == 2])]
    found = _blocked([reasons[each] for each in blocking])
    colors = {"free" if blocking else "reachable": FREE} | found | {"undecided": UNDECIDED, "unreachable": BEYOND}
    code = np.where(label == 1, 0, np.where(label == -1, len(found) + 1, len(found) + 2))
    code = np.where(label == 2, 1 + np.searchsorted(blocking, reason), code)
    return _planes(volume, np.where(np.isnan(label), np.nan, code), colors, at, title, frame)


def _blocked(reasons: list[str]) -> dict[str, str]:
    """Colours by what stands beside them."""
    return {f"blocked by\n{name.replace('_', ' ')}": BLOCKED[k % len(BLOCKED)] for k, name in enumerate(reasons)}


def _planes(
    volume: VolumeData,
    code: np.ndarray,
    colors: dict[str, str],
    at: tuple[float | None, float | None, float | None],
    title: Heading | str,
    frame: str,
) -> Figure:
    """Voxels by the place of their colour."""
    norm, names = BoundaryNorm(np.arange(len(colors) + 1) - 0.5, len(colors)), tuple(colors)
    scale = ColorScale(norm, ListedColormap(list(colors.values())), "", ticks=range(len(names)), names=names)
    field = Field(volume.voxels, code.astype(np.float64), scale)
    normals = plane_normals([volume], at)
    figure, panels = new_planes(volume, field.scale, title, axes=normals)
    for axes, axis in zip(panels[0], normals, strict=True):
        draw_plane(axes, volume, field, axis, layer_at(volume, axis, at[axis], field), frame)
    return figure
