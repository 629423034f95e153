"""Shapes of URDF links as geoms of a MuJoCo model."""

import mujoco
import numpy as np

from wsrender.errors import ModelError
from wsrender.robots.compiled_model import Purpose
from wsrender.robots.mesh_files import ReadMesh, not_there, triangles
from wsrender.robots.urdf import Link, UrdfShape
from wsrender.robots.xml_source import numbers

FEWEST_VERTICES = 4  # that MuJoCo takes

PRIMITIVES = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "capsule": mujoco.mjtGeom.mjGEOM_CAPSULE,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "ellipsoid": mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
}


def add_primitives(spec: mujoco.MjSpec, body: mujoco.MjsBody, link: Link) -> None:
    """Adds what a link needs no file for, as geoms that collide with nothing."""
    for shape in (*link.visuals, *link.collisions):
        if shape.kind in PRIMITIVES and min(shape.size) > 0.0:
            _add_primitive(body, shape)


def add_shapes(
    purpose: Purpose,
    which: str,
    read_mesh: ReadMesh,
    missing: list[str],
    field: str,
    spec: mujoco.MjSpec,
    body: mujoco.MjsBody,
    link: Link,
) -> None:
    """Adds ``which`` shapes of a link for a purpose; ``missing`` then tells those only seen that cannot be had.

    Raises ModelError for one that may collide and cannot be had.
    """
    for shape in getattr(link, which):
        where = f"link {link.name!r}: its {purpose} <{shape.kind}>"
        try:
            geom = _added(spec, body, shape, where, purpose, read_mesh, field)
        except ModelError as error:
            if purpose == "collision":
                raise
            missing.append(error.message)
            continue
        geom.contype = geom.conaffinity = int(purpose == "collision")
        if shape.rgba is not None:
            geom.rgba = shape.rgba


def _added(
    spec: mujoco.MjSpec,
    body: mujoco.MjsBody,
    shape: UrdfShape,
    where: str,
    purpose: Purpose,
    read_mesh: ReadMesh,
    field: str,
) -> mujoco.MjsGeom:
    if shape.kind in PRIMITIVES:
        if min(shape.size) <= 0.0:
            raise ModelError(field, f"{where} has size {shape.size}; sizes must be positive")
        return _add_primitive(body, shape)
    if shape.kind != "mesh":
        raise ModelError(field, f"{where} is of no known kind; allowed: {', '.join((*PRIMITIVES, 'mesh'))}")
    if (content := read_mesh(shape.file)) is None:
        raise ModelError(field, f"{where}: {not_there(shape.file)}")
    scale = numbers(shape.scale or "1 1 1", 3, field, f"{where}: scale")
    vertices, faces = triangles(content, shape.file, field)
    if len(vertices) < FEWEST_VERTICES:
        raise ModelError(field, f"{where}: {shape.file!r} has {len(vertices)} vertices; at least 4 enclose a volume")
    mesh = spec.add_mesh(name=f"mesh{len(spec.meshes)}", inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL)
    mesh.scale = scale
    mesh.uservert = vertices.ravel()
    if purpose == "visual":
        mesh.userface = faces.ravel()
    elif _flat(vertices * mesh.scale):
        raise ModelError(field, f"{where}: {shape.file!r} encloses no volume: its vertices lie in a plane")
    else:
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX  # MuJoCo makes the hull of the vertices alone
    return _add_geom(body, shape, mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name)


def _flat(vertices: np.ndarray) -> bool:
    """Whether vertices (V, 3) span no volume, as far as single precision tells."""
    spread = np.linalg.svd(vertices - vertices.mean(axis=0), compute_uv=False)
    return bool(spread[2] <= 1e-6 * spread[0])


def _add_primitive(body: mujoco.MjsBody, shape: UrdfShape) -> mujoco.MjsGeom:
    size = np.zeros(3)
    if shape.kind in ("cylinder", "capsule"):
        size[:2] = shape.size[0], shape.size[1] / 2
    else:
        size[: len(shape.size)] = np.array(shape.size) / (2 if shape.kind == "box" else 1)
    return _add_geom(body, shape, PRIMITIVES[shape.kind], size=size)


def _add_geom(body: mujoco.MjsBody, shape: UrdfShape, kind: mujoco.mjtGeom, **what) -> mujoco.MjsGeom:
    pose = {"pos": shape.pose.position, "quat": shape.pose.quat_wxyz}
    return body.add_geom(type=kind, contype=0, conaffinity=0, **pose, **what)
