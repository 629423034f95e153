"""The surface of a workspace in space: faces in their colours, edges and corners, axes in metres."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from mpl_toolkits.mplot3d.axes3d import Axes3D

from wsrender.errors import InputError
from wsrender.plots.faces import Faces
from wsrender.plots.space import AZIMUTH_DEG, ELEVATION_DEG, add_space
from wsrender.plots.style import GREY, INK, add_title, new_figure, paper_style

# (title, azimuth, elevation of the eye [deg], left side of the panel): every face is in sight in one of them.
_VIEWS = (
    ("from above", AZIMUTH_DEG, ELEVATION_DEG, 0.0),
    ("from the other side, below", AZIMUTH_DEG + 180, -ELEVATION_DEG, 0.41),
)
_LIGHT = np.array([0.35, -0.45, 0.82])  # direction from which the light comes, seen from above
_AMBIENT = 0.62  # brightness of a face that the light does not reach
_LIFTED = 2e-3  # of the picture's box: how far from a surface what it may hide is looked at
_AT_ONCE = 5_000_000  # rays × triangles
_EDGE: dict[str, Any] = {"color": INK, "linewidth": 1.2}
_CORNER: dict[str, Any] = {"ls": "", "marker": "o", "ms": 3.2, "mfc": "white", "mec": INK, "mew": 0.8}


@paper_style()
def surface_faces(faces: Faces, *, title: str = "", frame: str = "world") -> Figure:
    """The faces from two opposite sides, each surface in its colour, with the edges and corners that are in sight.

    Raises InputError for a surface without triangles.
    """
    if len(faces.triangles) == 0:
        raise InputError("mesh", "has no triangles: there is nothing to draw")
    sides, corners = faces.borders()
    figure = new_figure(11.6, 4.6, layout=None)
    figure.text(0.02, 0.02, f"{frame} frame", fontsize=8, color=GREY)
    for name, azimuth, elevation, left in _VIEWS:
        axes = add_space(figure, faces.vertices, (left, 0.06, 0.38, 0.83))
        axes.patch.set_visible(False)  # it would hide the labels of its neighbour
        axes.set_proj_type("ortho")  # one direction of sight, which decides what hides what
        axes.view_init(elevation, azimuth)
        axes.add_collection3d(shaded(faces, light=_LIGHT * np.sign(elevation)))
        _draw_borders(axes, faces, sides, corners, _direction(azimuth, elevation))
        figure.text(left + 0.19, 0.02, name, ha="center", fontsize=9, color=GREY)
    handles = [Patch(facecolor=faces.colors[k], label=label) for k, label in faces.labels.items()]
    edge, corner = Line2D([], [], **_EDGE, label="edge"), Line2D([], [], **_CORNER, label="vertex")
    handles += [handle for handle, found in ((edge, sides), (corner, corners)) if len(found)]
    figure.legend(handles=handles, loc="center right", bbox_to_anchor=(0.998, 0.5), frameon=False, fontsize=8)
    add_title(figure, title)
    return figure


def shaded(faces: Faces, alpha: float = 1.0, light: np.ndarray = _LIGHT) -> Poly3DCollection:
    """The triangles, lit from the direction ``light`` (3,)."""
    shine = _normals(faces.corners) @ (light / np.linalg.norm(light))
    bright = _AMBIENT + (1 - _AMBIENT) * np.maximum(shine, 0.0)
    palette = np.array([faces.colors.get(k, (0.5, 0.5, 0.5)) for k in range(int(faces.number.max()) + 1)])
    colors = np.column_stack([palette[faces.number] * bright[:, None], np.full(len(bright), alpha)])
    # Edges in the colour of their triangle close the hairlines between neighbours.
    edges: Any = colors if alpha == 1 else "none"
    return Poly3DCollection(
        faces.corners, facecolors=colors, edgecolors=edges, linewidths=0.4, rasterized=True, zorder=2
    )


def _draw_borders(axes: Axes3D, faces: Faces, sides: np.ndarray, corners: np.ndarray, eye: np.ndarray) -> None:
    """Edges and corners in sight, by their vertices."""
    ends, points = faces.vertices[sides], faces.vertices[corners]
    shown = ends[in_sight(ends.mean(axis=1), faces, eye)]
    if len(shown):
        axes.add_collection3d(Line3DCollection(shown, **_EDGE, capstyle="round", zorder=3))
    seen = points[in_sight(points, faces, eye)]
    axes.plot(*seen.T, **_CORNER, zorder=4)


def _direction(azimuth_deg: float, elevation_deg: float) -> np.ndarray:
    """Unit vector towards the eye, (3,)."""
    azimuth, elevation = np.deg2rad([azimuth_deg, elevation_deg])
    return np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])


def in_sight(points: np.ndarray, faces: Faces, eye: np.ndarray) -> np.ndarray:
    """Which points (N, 3) on the surface no triangle hides from the eye (3,) (Möller and Trumbore 1997)."""
    # What hides a point has a front in front of it.
    a, b, c = faces.corners[_normals(faces.corners) @ eye > 0].transpose(1, 0, 2)
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


def _normals(corners: np.ndarray) -> np.ndarray:
    """Unit normals (T, 3) of triangles (T, 3, 3); 0 of those without area."""
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(across, axis=1, keepdims=True)
    return across / np.where(length > 0, length, 1.0)
