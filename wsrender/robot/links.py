"""The bodies of a robot's links, for pictures."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.robot.model_robot import Robot, configuration_rows

if TYPE_CHECKING:
    import mujoco
    import trimesh

_VISIBLE_GROUPS = 3  # MuJoCo shows groups 0, 1, 2 unless told otherwise


@dataclass(frozen=True, eq=False)
class LinkShape:
    """Triangles of one geometry in the world frame: ``vertices`` (V, 3) [m], ``faces`` (F, 3); colour 0 … 1."""

    vertices: np.ndarray
    faces: np.ndarray
    color: tuple[float, float, float]


def link_shapes(robot: Robot, q: Any) -> list[LinkShape]:
    """The geometries of a robot's model at configuration ``q`` (n,); none for a model without, or a Python class.

    Geometries in groups above 2 (collision shapes, by custom) are left out where the model has others; planes and
    height fields always are.
    """
    if robot.definition:
        return []
    import mujoco

    from wsrender.robots import frames

    loaded, model = robot._loaded, robot.model
    data = mujoco.MjData(model)
    loaded.set_configuration(data, configuration_rows(q, robot.chain.n)[0])
    mujoco.mj_kinematics(model, data)
    base, _ = frames.choose(model, robot.base, robot.tip)
    T_world_model = robot.chain.T_world_base @ np.linalg.inv(base.pose(data))
    shapes = []
    for geom in _shown(model):
        mesh = _mesh(model, geom)
        if mesh is not None:
            T = T_world_model @ frames.transform(data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3))
            red, green, blue = (float(part) for part in _rgba(model, geom)[:3])
            shapes.append(LinkShape(mesh.vertices @ T[:3, :3].T + T[:3, 3], np.asarray(mesh.faces), (red, green, blue)))
    return shapes


def _shown(model: "mujoco.MjModel") -> list[int]:
    clear = [geom for geom in range(model.ngeom) if _rgba(model, geom)[3] > 0]
    visible = [geom for geom in clear if model.geom_group[geom] < _VISIBLE_GROUPS]
    return visible or clear


def _rgba(model: "mujoco.MjModel", geom: int) -> np.ndarray:
    material = model.geom_matid[geom]
    return model.mat_rgba[material] if material >= 0 else model.geom_rgba[geom]


def _mesh(model: "mujoco.MjModel", geom: int) -> "trimesh.Trimesh | None":
    """A geometry in its own frame; its ``size`` means what MuJoCo's reference says of each type."""
    import mujoco
    import trimesh

    kind, (a, b, c) = mujoco.mjtGeom(model.geom_type[geom]), model.geom_size[geom].tolist()
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        return trimesh.creation.icosphere(3, a)
    if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        return _centered(trimesh.creation.capsule(2 * b, a))
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        return trimesh.creation.cylinder(a, 2 * b)
    if kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
        ball = trimesh.creation.icosphere(3)
        ball.apply_scale((a, b, c))
        return ball
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        return trimesh.creation.box((2 * a, 2 * b, 2 * c))
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
        face, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
        triangles = model.mesh_face[face : face + faces].copy()
        return trimesh.Trimesh(model.mesh_vert[first : first + count].copy(), triangles, process=False)
    return None


def _centered(mesh: "trimesh.Trimesh") -> "trimesh.Trimesh":
    mesh.apply_translation(-mesh.bounds.mean(axis=0))
    return mesh
