"""Distance of a ball around the end effector to obstacles, by MuJoCo's geometry."""

import math

import mujoco
import numpy as np
from scipy.spatial import ConvexHull, QhullError

from wsrender.documents.kinetostatics import BoxObstacle, MeshObstacle, Obstacle, ObstacleForce, SphereObstacle
from wsrender.documents.robot import Transform
from wsrender.errors import InputError
from wsrender.robots.compiled_model import MUJOCO_ERRORS, quiet

FAR = 1e3  # [m] beyond which MuJoCo need not look
POINT = 1e-6  # radius of the ball that stands for a point [m]: MuJoCo has none without
CLOSE = 1e-12  # [m] from the surface within which its side has no direction


class ObstacleDistance:
    """Signed distance of the tip's ball to the nearest obstacle; meshes count as their convex hulls.

    A point is moved, and the radius of its ball subtracted: directions are then well defined where the ball touches.
    Raises InputError for a mesh that encloses no volume.
    """

    def __init__(self, choice: ObstacleForce):
        self._radius = choice.tip_radius_m
        spec = mujoco.MjSpec()
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[POINT, 0, 0])
        for number, item in enumerate(choice.items):
            _add(spec, item, number)
        try:
            with quiet():
                self._model = spec.compile()
        except MUJOCO_ERRORS as error:
            raise InputError("obstacles.items", f"are refused by MuJoCo: {error}") from error
        self._model.opt.ccd_tolerance, self._model.opt.ccd_iterations = 1e-10, 200
        self._data = mujoco.MjData(self._model)
        mujoco.mj_kinematics(self._model, self._data)
        self._ends = np.zeros(6)

    def at(self, position: np.ndarray) -> tuple[float, np.ndarray]:
        """(distance [m] of the ball at ``position`` (3,), its gradient (3,)); negative where they overlap."""
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
        return distance - self._radius, gradient


def _add(spec: "mujoco.MjSpec", item: Obstacle, number: int) -> None:
    world = spec.worldbody
    if isinstance(item, SphereObstacle):
        world.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[item.radius_m, 0, 0], pos=item.center_m)
    elif isinstance(item, BoxObstacle):
        half = [edge / 2 for edge in item.size_m]
        world.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=half, **_place(item.pose))
    else:
        _add_mesh(spec, item, number)


def _add_mesh(spec: "mujoco.MjSpec", item: MeshObstacle, number: int) -> None:
    """The convex hull of the vertices, which MuJoCo's distances mean by a mesh."""
    vertices = np.array(item.vertices_m)
    try:
        hull = ConvexHull(vertices)
    except QhullError as error:
        raise InputError(f"obstacles.items.{number}.vertices_m", "enclose no volume: they lie in a plane") from error
    mesh = spec.add_mesh(name=f"obstacle{number}")
    mesh.uservert = vertices[hull.vertices].ravel().tolist()
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name, **_place(item.pose))


def _place(pose: Transform) -> dict[str, list[float]]:
    T, quat_wxyz = pose.matrix(), np.empty(4)
    mujoco.mju_mat2Quat(quat_wxyz, T[:3, :3].ravel())
    return {"pos": T[:3, 3].tolist(), "quat": quat_wxyz.tolist()}
