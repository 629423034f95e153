"""Shapes of a robot's links: geoms of a compiled model, each in the frame that carries it."""

from dataclasses import dataclass, field
from functools import partial
from typing import Literal, get_args

import mujoco
import numpy as np

from wsrender.documents.shapes import MOST_HEIGHTS
from wsrender.errors import ModelError
from wsrender.robots.frames import body_name
from wsrender.robots.triangles import ground
from wsrender.short_repr import short_repr

Kind = Literal["plane", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "hfield"]
_GEOMS = {getattr(mujoco.mjtGeom, f"mjGEOM_{kind.upper()}"): kind for kind in get_args(Kind)}

ATTACHED = -1  # number of a shape that the model does not have, but its tip carries


def _none() -> np.ndarray:
    return np.zeros((0, 3))


@dataclass(frozen=True, eq=False)
class Shape:
    """A shape that stands still in a frame of a chain: in that of its joint ``frame``, or for -1 in the base's.

    ``size`` (3,) [m] means what MuJoCo's does: of a sphere its radius; of a capsule or cylinder, which lie along z,
    radius and half the length between the ends or caps; of an ellipsoid or box half its axes or edges. Of a mesh that
    may collide, ``vertices`` (V, 3) [m] and ``faces`` (F, 3) are those of its convex hull, as MuJoCo computes it; of
    one that is only seen, its own; of an hfield, which stands still, those of the ground down to its base. A plane is
    the half-space below its z.
    """

    name: str  # the geom's own, or <body>/<its number on the body>
    body: str
    kind: Kind
    frame: int
    T_frame_shape: np.ndarray  # (4, 4)
    size: np.ndarray
    geom: int  # its number in the compiled model, or ATTACHED
    surroundings: bool  # it belongs to the world of the model's file, not to the robot
    rgba: np.ndarray  # (4,) 0 … 1
    bits: tuple[int, int] = (1, 1)  # contype and conaffinity, which are 1 by default
    vertices: np.ndarray = field(default_factory=_none)
    faces: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), np.int32))

    __repr__ = short_repr


def shape_of(
    model: mujoco.MjModel, geom: int, frame: int, T_frame_shape: np.ndarray, hull: bool, model_field: str
) -> Shape:
    """The shape of a geom; ``hull``: as it may collide, of a mesh its hull. Raises ModelError where there is none."""
    body, name = int(model.geom_bodyid[geom]), geom_name(model, geom)
    kind = _GEOMS.get(mujoco.mjtGeom(model.geom_type[geom]))
    if kind is None:
        other = mujoco.mjtGeom(model.geom_type[geom]).name.removeprefix("mjGEOM_").lower()
        raise ModelError(model_field, f"shape {name!r} is of the kind {other!r}; allowed: {', '.join(get_args(Kind))}")
    if hull and kind == "hfield" and frame != -1:
        raise ModelError(model_field, f"shape {name!r}, a height field, must not move")
    vertices, faces = _none(), _none().astype(int)
    if kind in ("mesh", "hfield"):
        read = partial(_ground, model_field=model_field) if kind == "hfield" else hull_of if hull else _surface
        vertices, faces = read(model, geom)
    material = int(model.geom_matid[geom])
    rgba = model.mat_rgba[material] if material >= 0 else model.geom_rgba[geom]
    size = model.geom_size[geom].copy() if kind not in ("mesh", "hfield") else np.zeros(3)
    return Shape(
        name, body_name(model, body), kind, frame, T_frame_shape, size, geom, body == 0,
        rgba.astype(float), (int(model.geom_contype[geom]), int(model.geom_conaffinity[geom])), vertices, faces,
    )  # fmt: skip


def geom_name(model: mujoco.MjModel, geom: int) -> str:
    """Name of a geom, or where it has none <body>/<number on the body>."""
    body = int(model.geom_bodyid[geom])
    number = geom - int(model.body_geomadr[body])
    return model.geom(geom).name or f"{body_name(model, body)}/{number}"


def _surface(model: mujoco.MjModel, geom: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 3) and faces (F, 3) of the mesh of a geom, in the geom's frame."""
    mesh = int(model.geom_dataid[geom])
    vertex, face = int(model.mesh_vertadr[mesh]), int(model.mesh_faceadr[mesh])
    vertices = model.mesh_vert[vertex : vertex + model.mesh_vertnum[mesh]]
    return vertices.astype(float), model.mesh_face[face : face + model.mesh_facenum[mesh]].copy()


def _ground(model: mujoco.MjModel, geom: int, model_field: str) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 3) and faces (F, 3) of a height field and its base, in the geom's frame."""
    field = int(model.geom_dataid[geom])
    first, rows, columns = (int(each[field]) for each in (model.hfield_adr, model.hfield_nrow, model.hfield_ncol))
    half_x, half_y, rise, base = model.hfield_size[field].tolist()
    share = model.hfield_data[first : first + rows * columns].reshape(rows, columns).astype(float)
    if share.size > MOST_HEIGHTS:
        message = (
            f"height field {model.hfield(field).name!r} has {share.size} heights; at most {MOST_HEIGHTS} are taken"
        )
        raise ModelError(model_field, message)
    vertices, faces = ground(rise * share + base, (2 * half_x, 2 * half_y))
    return vertices - [0, 0, base], faces


def hull_of(model: mujoco.MjModel, geom: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 3) and faces (F, 3) of the convex hull of the mesh of a geom, in the geom's frame.

    MuJoCo's ``mesh_graph``: numbers of vertices and faces, V addresses, V vertices, V + 3F edges, 3F vertices of faces.
    """
    surface, _ = _surface(model, geom)
    first = int(model.mesh_graphadr[model.geom_dataid[geom]])
    count, faces = model.mesh_graph[first : first + 2].tolist()
    numbers = model.mesh_graph[first + 2 + count : first + 2 + 2 * count]
    corners = model.mesh_graph[first + 2 + 3 * count + 3 * faces :][: 3 * faces].reshape(-1, 3)
    local = np.full(len(surface), -1, np.int32)
    local[numbers] = np.arange(count)
    return surface[numbers], local[corners]
