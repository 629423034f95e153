"""The bodies of a robot's links, for pictures."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender import notices
from wsrender.errors import ModelError
from wsrender.notices import Notice
from wsrender.robot.model_robot import Robot, configuration_rows
from wsrender.robots.model_warning import ModelWarning
from wsrender.short_repr import short_repr

if TYPE_CHECKING:
    import trimesh

    from wsrender.robots.shapes import Shape

COARSE_FACES = {"sphere": 320, "capsule": 288, "cylinder": 48, "ellipsoid": 320, "box": 12}


@dataclass(frozen=True, eq=False)
class LinkShape:
    """Triangles of one geometry in the world frame: ``vertices`` (V, 3) [m], ``faces`` (F, 3); colour 0 … 1.

    ``frame``: the joint whose frame carries it, -1 for the base's.
    """

    vertices: np.ndarray
    faces: np.ndarray
    color: tuple[float, float, float]
    frame: int = -1

    __repr__ = short_repr


def link_shapes(robot: Robot, q: Any) -> list[LinkShape]:
    """What is seen of a robot (see `Robot.visuals`) at configuration ``q`` (n,).

    None for a model without shapes or a Python class; nor, with a ModelWarning, for one whose shapes cannot be read.
    """
    if robot.definition:
        return []
    try:
        bodies = robot._loaded.visuals  # those without files were told of when the model was loaded
    except ModelError as error:
        notices.warn([Notice("bodies_not_drawn", f"the bodies of {robot.name} are not drawn: {error}")], ModelWarning)
        return []
    poses = bodies.poses(configuration_rows(q, robot.chain.n))[0]
    return [_placed(shape, T) for shape, T in zip(bodies.shapes, poses, strict=True)]


def bodies_in(robot: Robot, q: Any) -> "trimesh.Trimesh | None":
    """The shapes that may collide at configurations ``q`` (K, n), round ones coarse, as one mesh in the world [m].

    Its attribute ``surface`` of triangles is the row of ``q``. None for a model without shapes or a Python class.
    """
    import trimesh

    if robot.definition or not robot.bodies.shapes:
        return None
    bodies, parts = robot.bodies, []
    own = [(mesh, k) for k, mesh in enumerate(shape_mesh(shape, coarse=True) for shape in bodies.shapes)]
    for row, poses in enumerate(bodies.poses(configuration_rows(q, robot.chain.n))):
        for mesh, k in own:
            vertices = mesh.vertices @ poses[k, :3, :3].T + poses[k, :3, 3]
            number = np.full(len(mesh.faces), row, np.int32)
            parts.append(trimesh.Trimesh(vertices, mesh.faces, face_attributes={"surface": number}, process=False))
    whole = trimesh.util.concatenate(parts)
    assert isinstance(whole, trimesh.Trimesh)
    return whole


def coarse_faces(robot: Robot) -> int:
    """Triangles of what `bodies_in` makes of one configuration."""
    if robot.definition:
        return 0
    return sum(COARSE_FACES.get(shape.kind, len(shape.faces)) for shape in robot.bodies.shapes)


def _placed(shape: "Shape", T: np.ndarray) -> LinkShape:
    mesh = shape_mesh(shape)
    red, green, blue = (float(part) for part in shape.rgba[:3])
    return LinkShape(mesh.vertices @ T[:3, :3].T + T[:3, 3], np.asarray(mesh.faces), (red, green, blue), shape.frame)


def shape_mesh(shape: "Shape", coarse: bool = False) -> "trimesh.Trimesh":
    """The triangles of a shape in its own frame; ``coarse``: of few of them."""
    import trimesh

    halvings, sides = (2, 12) if coarse else (3, None)
    a, b, c = shape.size.tolist()
    if shape.kind == "sphere":
        return trimesh.creation.icosphere(halvings, a)
    if shape.kind == "capsule":
        return _centered(trimesh.creation.capsule(2 * b, a, count=sides and (sides, sides)))
    if shape.kind == "cylinder":
        return trimesh.creation.cylinder(a, 2 * b, sections=sides)
    if shape.kind == "ellipsoid":
        ball = trimesh.creation.icosphere(halvings)
        ball.apply_scale((a, b, c))
        return ball
    if shape.kind == "box":
        return trimesh.creation.box((2 * a, 2 * b, 2 * c))
    return trimesh.Trimesh(shape.vertices, shape.faces, process=False)


def _centered(mesh: "trimesh.Trimesh") -> "trimesh.Trimesh":
    mesh.apply_translation(-mesh.bounds.mean(axis=0))
    return mesh
