"""The surface of a workspace in space: faces in their colours, edges and corners, axes in metres."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from wsrender.errors import InputError
from wsrender.results.drawing.box import AZIMUTH_DEG, ELEVATION_DEG
from wsrender.results.drawing.camera import Camera
from wsrender.results.drawing.faces import Faces
from wsrender.results.drawing.style import INK, Heading, new_figure, paper_style
from wsrender.results.drawing.view import DrawnAxes, add_view, note

# (title, azimuth, elevation of the eye [deg]): every face is in sight in one of them.
_VIEWS = (("from above", AZIMUTH_DEG, ELEVATION_DEG), ("from the other side, below", AZIMUTH_DEG + 180, -ELEVATION_DEG))
_PANEL = (4.4, 4.1)  # width and height of a view [in]
_LEGEND = 2.9  # width of the names of faces [in]
_LOW = 0.35  # room below the views [in]
_LIGHT = np.array([0.35, -0.45, 0.82])  # direction from which the light comes, seen from above
_AMBIENT = 0.62  # brightness of a face that the light does not reach
_LIFTED = 2e-3  # of the picture's box: how far from a surface what it may hide is looked at
_AT_ONCE = 5_000_000  # rays × triangles
_EDGE: dict[str, Any] = {"color": INK, "linewidth": 1.2}
_CORNER: dict[str, Any] = {"marker": "o", "ms": 3.2, "mfc": "white", "mec": INK, "mew": 0.8}


@paper_style()
def surface_faces(faces: Faces, *, title: Heading | str = "", frame: str = "world") -> Figure:
    """The faces from two opposite sides, each surface in its colour, with the edges and corners that are in sight.

    Raises InputError for a surface without triangles.
    """
    if len(faces.triangles) == 0:
        raise InputError("mesh", "has no triangles: there is nothing to draw")
    sides, corners = faces.borders()
    width, height = _PANEL
    named = bool(faces.labels) or len(sides) > 0
    figure = new_figure(2 * width + (_LEGEND if named else 0.2), height + _LOW, title, layout=None)
    note(figure, 0.18, 0.1, f"{frame} frame")
    for k, (name, azimuth, elevation) in enumerate(_VIEWS):
        view = add_view(figure, faces.vertices, (k * width, _LOW, width, height), azimuth, elevation)
        view.add_surface(*shaded(faces, view.space.camera, _LIGHT * np.sign(elevation)))
        view.add_outline(colors=[INK], linewidths=_EDGE["linewidth"], zorder=2.9)
        _draw_borders(view, faces, sides, corners)
        note(figure, (k + 0.5) * width, 0.1, name, ha="center", fontsize=9)
    handles = [Patch(facecolor=faces.colors[k], label=label) for k, label in faces.labels.items()]
    edge, corner = Line2D([], [], **_EDGE, label="edge"), Line2D([], [], ls="", **_CORNER, label="vertex")
    handles += [handle for handle, found in ((edge, sides), (corner, corners)) if len(found)]
    across = float(figure.get_size_inches()[0])
    place: dict[str, Any] = {"loc": "center left", "bbox_to_anchor": (2 * width / across, 0.5)}
    figure.legend(handles=handles, frameon=False, fontsize=8, **place)
    return figure


def shaded(faces: Faces, camera: Camera, light: np.ndarray = _LIGHT) -> tuple[np.ndarray, np.ndarray]:
    """Corners (T, 3, 3) [m] and their colours (T, 3, 3) of what can be seen, lit from a direction ``light`` (3,).

    The back of a closed surface cannot: it has a front before it. Brightness changes smoothly within a face.
    """
    corners = faces.corners
    at_corners = faces.smooth_normals() if faces.normals is None else faces.normals
    lit = at_corners @ (light / np.linalg.norm(light))
    palette = np.array([faces.colors.get(k, (0.5, 0.5, 0.5)) for k in range(int(faces.number.max()) + 1)])
    colors = palette[faces.number][:, None] * (_AMBIENT + (1 - _AMBIENT) * np.maximum(lit, 0.0))[:, :, None]
    # By the mean of the corners: a sliver's own normal says little.
    shown = at_corners.mean(axis=1) @ camera.forward < 0 if faces.closed else np.ones(len(corners), bool)
    return corners[shown], colors[shown]


def _draw_borders(view: DrawnAxes, faces: Faces, sides: np.ndarray, corners: np.ndarray) -> None:
    """Edges and corners in sight, by their vertices."""
    eye = -view.space.camera.forward
    ends, points = faces.vertices[sides], faces.vertices[corners]
    shown = ends[in_sight(ends.mean(axis=1), faces, eye)]
    if len(shown):
        view.add_segments(shown, **_EDGE, capstyle="round", zorder=3)
    seen = points[in_sight(points, faces, eye)]
    if len(seen):
        view.axes.plot(*view.space.camera.to_picture(seen).T, ls="", zorder=4, **_CORNER)


def in_sight(points: np.ndarray, faces: Faces, eye: np.ndarray) -> np.ndarray:
    """Which points (N, 3) on the surface no triangle hides from the eye (3,) (Möller and Trumbore 1997)."""
    # What hides a point has a front in front of it.
    a, b, c = faces.corners[faces.facets() @ eye > 0].transpose(1, 0, 2)
    ab, ac = b - a, c - a
    p = np.cross(eye, ac)
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1 / (ab * p).sum(axis=1)
    lifted = _LIFTED * float(np.ptp(faces.vertices, axis=0).max())
    hidden = np.zeros(len(points), bool)
    step = max(_AT_ONCE // max(len(a), 1), 1)
    for first in range(0, len(points), step):
        away = points[first : first + step, None] + lifted * eye - a
        u = (away * p).sum(axis=2) * inverse
        q = np.cross(away, ab)
        v, t = q @ eye * inverse, (q * ac).sum(axis=2) * inverse
        hidden[first : first + step] = ((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)).any(axis=1)
    return ~hidden
