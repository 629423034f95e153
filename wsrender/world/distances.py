"""Distance of a point to shapes: to half-spaces and triangles in closed form, to all others by MuJoCo's geometry."""

import math
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

from wsrender.documents.environment import ConvexMesh, HalfSpace, Mesh, Shape
from wsrender.documents.shapes import HeightField, half_sizes
from wsrender.errors import InputError
from wsrender.robots.compiled_model import MUJOCO_ERRORS, quiet
from wsrender.robots.triangles import closest_points, winding_numbers
from wsrender.world.meshes import hull_vertices
from wsrender.world.surfaces import ClosedSurface

FAR = 1e3  # [m] beyond which MuJoCo need not look
POINT = 1e-6  # radius of the ball that stands for a point [m]: MuJoCo has none without
MOST_SOLIDS = 500  # each is looked at in every step of a stream
CLOSE = 1e-12  # [m] from the surface within which its side has no direction


class NearestShape:
    """Signed distance of a point to the nearest of shapes; meshes count as their convex hulls, surfaces as they are.

    Raises InputError for a mesh that encloses no volume, its field below ``items``, and for more than MOST_SOLIDS.
    """

    def __init__(self, shapes: Sequence[Shape | ClosedSurface]):
        if len(shapes) > MOST_SOLIDS:
            raise InputError("items", f"are {len(shapes)} shapes and convex pieces; at most {MOST_SOLIDS} may push")
        self._surfaces = [_Triangles(shape) for shape in shapes if isinstance(shape, ClosedSurface)]
        planes = [shape for shape in shapes if isinstance(shape, HalfSpace)]
        normals = np.array([shape.normal for shape in planes]).reshape(-1, 3)
        self._normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
        self._offsets = np.einsum("ij,ij->i", self._normals, np.array([s.point_m for s in planes]).reshape(-1, 3))
        self._model = _compiled(shapes)
        self._model.opt.ccd_tolerance, self._model.opt.ccd_iterations = 1e-10, 200
        self._data = mujoco.MjData(self._model)
        mujoco.mj_kinematics(self._model, self._data)
        self._ends = np.zeros(6)

    def at(self, position: np.ndarray) -> tuple[float, np.ndarray]:
        """(distance [m] of ``position`` (3,), its gradient (3,)); negative inside, `FAR` and zeros far from all."""
        distance, gradient = self._to_solids(position)
        for surface in self._surfaces:
            distance, gradient = min((distance, gradient), surface.at(position), key=lambda each: each[0])
        if len(self._normals):
            heights = self._normals @ position - self._offsets
            lowest = int(heights.argmin())
            if heights[lowest] < distance:
                return float(heights[lowest]), self._normals[lowest].copy()
        return distance, gradient

    def _to_solids(self, position: np.ndarray) -> tuple[float, np.ndarray]:
        self._data.geom_xpos[0] = position
        nearest, foot, ends = FAR, position, self._ends
        for geom in range(1, self._model.ngeom):
            distance = mujoco.mj_geomDistance(self._model, self._data, 0, geom, nearest, ends)
            if distance < nearest:
                nearest, foot = distance, ends[3:].copy()
        if nearest >= FAR:
            return FAR, np.zeros(3)
        away = position - foot
        size = math.sqrt(away.dot(away))
        distance = nearest + POINT
        gradient = away * ((1 if distance > 0 else -1) / size) if size > CLOSE else np.zeros(3)
        return distance, gradient


class _Triangles:
    """The triangles of a surface, with a ball around each."""

    def __init__(self, surface: ClosedSurface):
        vertices = surface.vertices @ surface.T[:3, :3].T + surface.T[:3, 3]
        self.corners = vertices[surface.faces]
        self.centers = self.corners.mean(axis=1)
        self.radii = np.linalg.norm(self.corners - self.centers[:, None], axis=2).max(axis=1)

    def at(self, position: np.ndarray) -> tuple[float, np.ndarray]:
        """See `NearestShape.at`."""
        away = np.linalg.norm(self.centers - position, axis=1)
        near = self.corners[away - self.radii <= (away + self.radii).min()]
        feet = closest_points(near, np.tile(position, (len(near), 1)))
        distances = np.linalg.norm(position - feet, axis=1)
        k = int(distances.argmin())
        side = -1 if winding_numbers(self.corners, position[None])[0] > 0.5 else 1
        gradient = (position - feet[k]) * (side / distances[k]) if distances[k] > CLOSE else np.zeros(3)
        return side * float(distances[k]), gradient


def _compiled(shapes: Sequence[Shape | ClosedSurface]) -> mujoco.MjModel:
    """A model whose first geom is the point, and the others all shapes but half-spaces."""
    spec = mujoco.MjSpec()
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[POINT, 0, 0])
    for number, shape in enumerate(shapes):
        try:
            _add(spec, shape, number)
        except InputError as error:
            raise error.within(f"items.{number}") from None
    try:
        with quiet():
            return spec.compile()
    except MUJOCO_ERRORS as error:
        raise InputError("items", f"are refused by MuJoCo: {error}") from error


def _add(spec: Any, shape: Shape | ClosedSurface, number: int) -> None:
    if isinstance(shape, HalfSpace | ClosedSurface):
        return
    assert not isinstance(shape, HeightField)  # whose surface is asked instead
    kind = "mesh" if isinstance(shape, ConvexMesh) else shape.shape
    geom = {
        "type": getattr(mujoco.mjtGeom, f"mjGEOM_{kind.upper()}"),
        "size": half_sizes(shape),
        **_place(shape.matrix()),
    }
    if isinstance(shape, ConvexMesh | Mesh):
        mesh = spec.add_mesh(name=f"shape{number}")
        mesh.uservert = hull_vertices(shape).ravel().tolist()
        geom["meshname"] = mesh.name
    spec.worldbody.add_geom(**geom)


def _place(T: np.ndarray) -> dict[str, list[float]]:
    quat_wxyz = np.empty(4)
    mujoco.mju_mat2Quat(quat_wxyz, T[:3, :3].ravel())
    return {"pos": T[:3, 3].tolist(), "quat": quat_wxyz.tolist()}
