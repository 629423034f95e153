"""The views: what each draws of its subjects."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from wsrender.errors import InputError
from wsrender.geometry.surfaces import level_surface, occupied_surface
from wsrender.results.drawing.cloud import checked_index
from wsrender.results.drawing.color_scale import SIGNED, ColorScale, color_scale
from wsrender.results.drawing.planes import NAMES, Field, layer_at, plane_normals, shared_scale, voxel_field
from wsrender.results.drawing.stick_figure import ROBOTS
from wsrender.results.drawing.style import quantity
from wsrender.results.render.scene import Cloud, Color, Dots, DrawnSurface, Layer, Lines, Plates
from wsrender.results.render.subject import Subject
from wsrender.volume.volume_data import VolumeData

ROBOT_COLORS: list[Color] = [to_rgb(color) for color in ROBOTS]
VEIL = 0.1  # opacity of translucent surfaces and of the mist of a voxel
BLENDED = "colours blend with those behind: read values off the slices"
DOT = 2.2  # diameter of a sample in pixels
_SHELL_GREY: Color = (0.55, 0.6, 0.66)
_EDGE_COLOR: Color = (0.13, 0.13, 0.13)
_EDGE_WIDTH = 2.0  # of edges between faces, in pixels


@dataclass(frozen=True)
class Choice:
    """What a view shows.

    ``index`` and ``statistic`` are its colours (None: the first, the maximum), ``threshold`` is the iso-surface's share
    of the maximum, ``alpha`` the opacity (None: that of the view), ``at`` the planes x, y, z [m]; views are cut open
    towards ``azimuth_deg``, the direction of the eye.
    """

    index: str | None
    statistic: str | None
    threshold: float
    alpha: float | None
    at: tuple[float | None, float | None, float | None]
    azimuth_deg: float

    @property
    def veil(self) -> float:
        """Opacity of what must not hide what is behind it: that of [WSR] Table II, where none is asked for."""
        return VEIL if self.alpha is None else self.alpha


@dataclass
class Drawing:
    """What a view adds to a picture: layers, legend entries, colour scale, remarks."""

    layers: list[Layer] = field(default_factory=list)
    handles: list[Artist] = field(default_factory=list)
    scale: ColorScale | None = None
    notes: list[str] = field(default_factory=list)


def boundary(subjects: Sequence[Subject], choice: Choice) -> Drawing:
    """Translucent surfaces of the occupied voxels, each robot's in a colour of its own.

    Where an index or a statistic is asked for they are in its colours, and opaque unless ``alpha`` is given: through
    each other, colours are not those of the bar.
    """
    if all(subject.faces for subject in subjects):
        return _faces(subjects, choice.veil)
    volumes = [subject.dense_voxels() for subject in subjects]
    if choice.index is None and choice.statistic is None:
        return _plain_boundaries(subjects, volumes, choice.veil)
    alpha = 1.0 if choice.alpha is None else choice.alpha
    fields, scale, drawing = _fields(volumes, choice)
    for volume, shown in zip(volumes, fields, strict=True):
        mesh = occupied_surface(volume)
        colors = _vertex_colors(mesh.vertices, volume, shown.dense(), scale)
        drawing.layers.append(DrawnSurface(mesh.vertices, mesh.faces, colors=colors, alpha=alpha, smooth=True))
    drawing.handles.append(Patch(facecolor=scale.colors(0.5), alpha=max(alpha, 0.3), label="workspace boundary"))
    drawing.notes.append(_lattice_note(volumes))
    if alpha < 1:
        drawing.notes.append(BLENDED)
    return drawing


def solid(subjects: Sequence[Subject], choice: Choice) -> Drawing:
    """Opaque bodies of occupied voxels, cut open towards the eye and coloured by an index.

    Workspaces that are known by their surfaces are drawn whole, every face in its colour.
    """
    if all(subject.faces for subject in subjects):
        return _faces(subjects, 1.0)
    volumes = [_cut_open(subject, choice.azimuth_deg) for subject in subjects]
    fields, scale, drawing = _fields(volumes, choice)
    for volume, shown in zip(volumes, fields, strict=True):
        mesh = occupied_surface(volume)
        colors = _vertex_colors(mesh.vertices, volume, shown.dense(), scale)
        drawing.layers.append(DrawnSurface(mesh.vertices, mesh.faces, colors=colors, smooth=True))
    drawing.handles.append(Patch(facecolor=scale.colors(0.5), label="workspace"))
    drawing.notes.append(_lattice_note(volumes))
    return drawing


def scatter(subjects: Sequence[Subject], choice: Choice) -> Drawing:
    """The sampled positions, cut open towards the eye and coloured by an index."""
    clouds = [subject.cloud() for subject in subjects]
    if not all(cloud.indices for cloud in clouds):
        raise InputError("view", "scatter needs a map that holds an index")
    name = checked_index(clouds[0], choice.index)
    for cloud in clouds:
        checked_index(cloud, name)
    values = [cloud.indices[name] for cloud in clouds]
    scale = color_scale(np.concatenate(values), quantity(name, clouds[0].units.get(name)), name.startswith(SIGNED))
    drawing = Drawing(scale=scale)
    label = "samples"
    for subject, cloud, value in zip(subjects, clouds, values, strict=True):
        kept = ~_towards_eye(cloud.position, subject, choice.azimuth_deg)
        label = label if kept.all() else "samples, cut open"
        drawing.layers.append(Dots(cloud.position[kept], _colors(scale, value[kept]), DOT))
    drawing.handles.append(Line2D([], [], ls="", marker="o", ms=3, color=scale.colors(0.5), label=label))
    return drawing


def volume(subjects: Sequence[Subject], choice: Choice) -> Drawing:
    """Voxels as coloured mist whose transparency is alpha per voxel."""
    volumes = [subject.dense_voxels() for subject in subjects]
    fields, scale, drawing = _fields(volumes, choice)
    table = np.ones((256, 4))
    table[1:, :3] = scale.colors(np.linspace(0, 1, 255))[:, :3]
    table[:, 3] = choice.veil
    table[0] = 0
    for voxels, shown in zip(volumes, fields, strict=True):
        shares = np.nan_to_num(scale.places(np.nan_to_num(shown.dense())))
        levels = np.where(voxels.occupied, 1 + np.round(254 * shares), 0)
        drawing.layers.append(Cloud(levels.astype(np.uint8), table, voxels.origin_m, voxels.voxel_size_m))
    drawing.handles.append(Patch(facecolor=scale.colors(0.5), alpha=0.6, label="voxels"))
    drawing.notes += [_lattice_note(volumes), BLENDED]
    return drawing


def slice(subjects: Sequence[Subject], choice: Choice) -> Drawing:
    """Planes of voxels in the translucent boundary, coloured by an index; all robots share them.

    Where a plane is not given it is the one at 0, or the fullest of the first robot if that misses its workspace.
    """
    volumes = [subject.voxels() for subject in subjects]
    fields, scale, drawing = _fields(volumes, choice)
    normals = plane_normals(volumes[:1], choice.at)
    layers = {axis: layer_at(volumes[0], axis, choice.at[axis]) for axis in normals}
    planes = {axis: float(volumes[0].centers(axis)[layer]) for axis, layer in layers.items()}
    for voxels, shown in zip(volumes, fields, strict=True):
        for axis, at in planes.items():
            if abs(at - voxels.centers(axis).mean()) < voxels.shape[axis] * voxels.voxel_size_m / 2:
                drawing.layers.append(_plates(voxels, shown, axis, layer_at(voxels, axis, at), scale))
    drawing.layers += _shells(subjects, choice.veil)
    drawing.handles.append(Patch(facecolor=scale.colors(0.5), label="slices"))
    drawing.handles.append(Patch(facecolor=_SHELL_GREY, alpha=0.3, label="workspace boundary"))
    where = ", ".join(f"{NAMES[axis]} = {at:.3g}" for axis, at in planes.items())
    drawing.notes.append(f"slices at {where} m")
    return drawing


def isosurface(subjects: Sequence[Subject], choice: Choice) -> Drawing:
    """Surface of where the values are at least a share of the maximum, in the translucent boundary."""
    volumes = [subject.dense_voxels() for subject in subjects]
    fields, scale, drawing = _fields(volumes, choice)
    for voxels, shown in zip(volumes, fields, strict=True):
        values = shown.dense()
        largest = float(np.nanmax(values))
        if largest <= 0:
            raise InputError(
                "index",
                f"an iso-surface is a share of the maximum, and that of {shown.label} is {largest:.3g}, not above 0",
            )
        level = choice.threshold * largest
        values = np.where(voxels.occupied, values, np.nan)
        mesh = level_surface(voxels, values, level)
        colors = _vertex_colors(mesh.vertices, voxels, np.where(values >= level, values, np.nan), scale)
        drawing.layers.append(DrawnSurface(mesh.vertices, mesh.faces, colors=colors, smooth=True))
    drawing.layers += _shells(subjects, choice.veil)
    label = f"at least {choice.threshold:g} of the maximum"
    drawing.handles.append(Patch(facecolor=scale.colors((1 + choice.threshold) / 2), label=label))
    drawing.handles.append(Patch(facecolor=_SHELL_GREY, alpha=0.3, label="workspace boundary"))
    drawing.notes.append(_lattice_note(volumes))
    return drawing


VIEWS: dict[str, Callable[[Sequence[Subject], Choice], Drawing]] = {
    "boundary": boundary,
    "solid": solid,
    "scatter": scatter,
    "volume": volume,
    "slice": slice,
    "isosurface": isosurface,
}


def _fields(volumes: Sequence[VolumeData], choice: Choice) -> tuple[list[Field], ColorScale, Drawing]:
    """The values per voxel of each volume, and a scale that spans them all, with a drawing that holds it."""
    fields = [voxel_field(volume, choice.index, choice.statistic) for volume in volumes]
    if len({field.label for field in fields}) > 1:
        labels = ", ".join(field.label for field in fields)
        raise InputError("index", f"the results show different quantities ({labels}); name an index that all hold")
    scale = shared_scale(fields)
    return fields, scale, Drawing(scale=scale)


def _plain_boundaries(subjects: Sequence[Subject], volumes: Sequence[VolumeData], alpha: float) -> Drawing:
    drawing = Drawing(notes=[_lattice_note(volumes)])
    for k, (subject, voxels) in enumerate(zip(subjects, volumes, strict=True)):
        color = ROBOT_COLORS[k % len(ROBOT_COLORS)]
        mesh = occupied_surface(voxels)
        drawing.layers.append(DrawnSurface(mesh.vertices, mesh.faces, color, alpha=alpha, smooth=True))
        drawing.handles.append(Patch(facecolor=color, alpha=max(alpha, 0.3), label=f"boundary of {subject.name}"))
    return drawing


def _faces(subjects: Sequence[Subject], alpha: float) -> Drawing:
    """Surfaces face by face, and the edges between the faces."""
    drawing = Drawing()
    for faces in (subject.faces for subject in subjects if subject.faces):
        for number, color in faces.colors.items():
            drawing.layers.append(
                DrawnSurface(faces.vertices, faces.triangles[faces.number == number], color, alpha=alpha)
            )
        sides, _ = faces.borders()
        if len(sides):
            drawing.layers.append(Lines(faces.vertices[sides], _EDGE_COLOR, _EDGE_WIDTH))
        labels = faces.labels or dict.fromkeys(faces.colors, "workspace boundary")
        drawing.handles += [
            Patch(facecolor=faces.colors[number], alpha=max(alpha, 0.3), label=label)
            for number, label in labels.items()
        ]
    return drawing


def _shells(subjects: Sequence[Subject], alpha: float) -> list[Layer]:
    meshes = [occupied_surface(subject.dense_voxels()) for subject in subjects]
    return [DrawnSurface(mesh.vertices, mesh.faces, _SHELL_GREY, alpha=alpha, smooth=True) for mesh in meshes]


def _vertex_colors(vertices: np.ndarray, volume: VolumeData, values: np.ndarray, scale: ColorScale) -> np.ndarray:
    """Colours (V, 3) of the nearest voxels' values, blended between them."""
    from scipy.ndimage import distance_transform_edt, map_coordinates

    padded = np.pad(values, 1, constant_values=np.nan)
    nearest: Any = distance_transform_edt(np.isnan(padded), return_distances=False, return_indices=True)
    filled = padded[tuple(nearest)].astype(np.float64)
    places = vertices / volume.voxel_size_m - np.array(volume.first_voxel) + 0.5
    return _colors(scale, map_coordinates(filled, places.T, order=1, mode="nearest"))


def _colors(scale: ColorScale, values: np.ndarray) -> np.ndarray:
    """Colours (N, 3) uint8 of values (N,)."""
    return scale.colors(scale.norm(values), bytes=True)[:, :3]


def _plates(volume: VolumeData, field: Field, axis: int, layer: int, scale: ColorScale) -> Plates:
    """The occupied voxels of a layer as squares through their centres."""
    plane = field.plane(axis, layer)
    cells = np.argwhere(np.isfinite(plane))
    across = [k for k in range(3) if k != axis]
    corners = np.empty((len(cells), 4, 3))
    corners[:, :, axis] = volume.first_voxel[axis] + layer + 0.5
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    corners[:, :, across] = cells[:, None] + square + np.array(volume.first_voxel)[across]
    colors = _colors(scale, plane[tuple(cells.T)])
    return Plates(corners * volume.voxel_size_m, colors)


def _cut_open(subject: Subject, azimuth_deg: float) -> VolumeData:
    """The volume without the voxels between the arm and the eye."""
    volume = subject.dense_voxels()
    voxels = volume.voxels.among(volume.voxels.count > 0)
    centers = (voxels.at.T + volume.first_voxel + 0.5) * volume.voxel_size_m
    kept = voxels.among(~_towards_eye(centers, subject, azimuth_deg))
    return VolumeData.of_voxels(volume.voxel_size_m, volume.first_voxel, kept, volume.units)


def _towards_eye(points: np.ndarray, subject: Subject, azimuth_deg: float) -> np.ndarray:
    """Which points (N, 3) lie in the quarter that the eye looks into, around the upright line through the base.

    None do where they form a thin sheet, or where nothing would be left.
    """
    span = np.ptp(points, axis=0)
    none = np.zeros(len(points), bool)
    if span.min() < 0.1 * span.max():
        return none
    middle = (points.min(axis=0) + points.max(axis=0)) / 2 if subject.arm is None else subject.arm[0]
    offset = points[:, :2] - middle[:2]
    azimuth = np.arctan2(offset[:, 1], offset[:, 0]) - np.deg2rad(azimuth_deg)
    quarter = np.cos(azimuth) > np.cos(np.pi / 4)
    return none if quarter.all() else quarter


def _lattice_note(volumes: Sequence[VolumeData]) -> str:
    sizes = sorted({round(volume.voxel_size_m, 9) for volume in volumes})
    return f"drawn with voxels of {' and '.join(f'{1000 * size:.3g}' for size in sizes)} mm"
