"""Convex hulls of many vertices, simplified outwards: what is called free then stays free."""

import mujoco
import numpy as np
from scipy.spatial import ConvexHull, HalfspaceIntersection

from wsrender.errors import ModelError
from wsrender.notices import Notice
from wsrender.robots.compiled_model import MUJOCO_ERRORS, quiet, refusal
from wsrender.robots.shapes import geom_name, hull_of

MOST_VERTICES = 1000  # of a hull: a test of a pair looks at each; nine in ten meshes of robots have fewer
LEAST_M3 = 1e-14  # volume of a mesh; MuJoCo refuses less than a tenth of it [m³]
FARTHEST = 5e-3  # of the longest edge of a box around it, a simplified hull goes beyond it at most


def with_small_hulls(
    spec: mujoco.MjSpec, model: mujoco.MjModel, field: str
) -> tuple[mujoco.MjModel, tuple[Notice, ...]]:
    """The compiled ``model`` of ``spec``, hulls of more than MOST_VERTICES replaced by such that hold them.

    Raises ModelError where so many vertices cannot keep to FARTHEST.
    """
    large = {}
    for geom in np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_MESH).tolist():
        mesh = int(model.geom_dataid[geom])
        if model.mesh_graphadr[mesh] >= 0 and len(hull_of(model, geom)[0]) > MOST_VERTICES:
            large[mesh] = geom
    if not large:
        return model, ()
    said = []
    for mesh, geom in large.items():
        vertices, _ = hull_of(model, geom)
        simpler = simplified(vertices)
        if simpler is None:
            message = (
                f"the hull of shape {geom_name(model, geom)!r} has {len(vertices)} vertices; {MOST_VERTICES} that hold "
                f"it go more than {100 * FARTHEST:g} % of its size beyond it: give it a simpler mesh"
            )
            raise ModelError(field, message)
        said.append(f"{geom_name(model, geom)} {len(vertices)} → {len(simpler)} vertices")
        R = np.empty(9)
        mujoco.mju_quat2Mat(R, model.mesh_quat[mesh])
        _replace(spec, model.mesh(mesh).name, simpler @ R.reshape(3, 3).T + model.mesh_pos[mesh])
    try:
        with quiet():
            model = spec.compile()
    except MUJOCO_ERRORS as error:
        raise refusal(error, field) from error
    message = f"hulls are simplified, by at most {100 * FARTHEST:g} % of their size outwards: {', '.join(said)}"
    return model, (Notice("hulls_simplified", message),)


def _replace(spec: mujoco.MjSpec, mesh: str, vertices: np.ndarray) -> None:
    """Gives the geoms of a mesh another, of ``vertices`` (V, 3) in the axes that the file's have in the model."""
    other = spec.add_mesh(name=f"{mesh}, simplified", inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX)
    other.scale, other.refpos, other.refquat = [1, 1, 1], [0, 0, 0], [1, 0, 0, 0]  # not those of a default class
    other.uservert = vertices.ravel()
    for geom in spec.geoms:
        if geom.meshname == mesh and geom.type == mujoco.mjtGeom.mjGEOM_MESH:
            geom.meshname = other.name


def simplified(vertices: np.ndarray) -> np.ndarray | None:
    """At most MOST_VERTICES corners (W, 3) of a polytope that holds all ``vertices`` (V, 3) [m] and keeps to FARTHEST.

    None where none is found. Planes that touch the hull cut a box: each is square to the way from a corner, of those
    that are too far, to the nearest point of the hull (outer approximation, Kamenev 1992).
    """
    center, most = vertices.mean(axis=0), FARTHEST * float(np.ptp(vertices, axis=0).max())
    nearest = _Nearest(vertices)
    normals = np.concatenate([np.eye(3), -np.eye(3)])
    while True:
        corners = _corners(normals, (vertices @ normals.T).max(axis=0), center)
        ways = corners - np.array([nearest(corner) for corner in corners])
        far = np.linalg.norm(ways, axis=1)
        if (far <= most).all():
            return corners if len(corners) <= MOST_VERTICES else None
        if len(normals) > MOST_VERTICES:
            return None
        worst = far > max(most, far.max() / 2)
        normals = np.concatenate([normals, ways[worst] / far[worst, None]])


def _corners(normals: np.ndarray, offsets: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """Corners (W, 3) of the polytope normals (P, 3) · x ≤ offsets (P,)."""
    found = HalfspaceIntersection(np.column_stack([normals, -offsets]), inside).intersections
    return found[ConvexHull(found).vertices]


class _Nearest:
    """The point of the hull of vertices that is nearest to a point outside, by MuJoCo (to 1e-6 m)."""

    def __init__(self, vertices: np.ndarray):
        spec = mujoco.MjSpec()
        mesh = spec.add_mesh(name="hull", inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX)
        mesh.uservert = vertices.ravel()
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="hull")
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[1e-9, 0, 0])
        self._model = spec.compile()
        self._data = mujoco.MjData(self._model)
        mujoco.mj_kinematics(self._model, self._data)
        self._ends = np.empty(6)

    def __call__(self, point: np.ndarray) -> np.ndarray:
        self._data.geom_xpos[1] = point
        distance = mujoco.mj_geomDistance(self._model, self._data, 0, 1, 1e3, self._ends)
        return self._ends[:3].copy() if distance > 0 else point
