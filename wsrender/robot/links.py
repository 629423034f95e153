"""The bodies of a robot's links, for pictures."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender import notices
from wsrender.errors import ModelError
from wsrender.notices import Notice
from wsrender.robot.model_robot import Robot, configuration_rows
from wsrender.robots.model_warning import ModelWarning

if TYPE_CHECKING:
    import trimesh

    from wsrender.robots.shapes import Shape


@dataclass(frozen=True, eq=False)
class LinkShape:
    """Triangles of one geometry in the world frame: ``vertices`` (V, 3) [m], ``faces`` (F, 3); colour 0 … 1."""

    vertices: np.ndarray
    faces: np.ndarray
    color: tuple[float, float, float]


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


def _placed(shape: "Shape", T: np.ndarray) -> LinkShape:
    mesh = _mesh(shape)
    red, green, blue = (float(part) for part in shape.rgba[:3])
    return LinkShape(mesh.vertices @ T[:3, :3].T + T[:3, 3], np.asarray(mesh.faces), (red, green, blue))


def _mesh(shape: "Shape") -> "trimesh.Trimesh":
    """A shape in its own frame."""
    import trimesh

    a, b, c = shape.size.tolist()
    if shape.kind == "sphere":
        return trimesh.creation.icosphere(3, a)
    if shape.kind == "capsule":
        return _centered(trimesh.creation.capsule(2 * b, a))
    if shape.kind == "cylinder":
        return trimesh.creation.cylinder(a, 2 * b)
    if shape.kind == "ellipsoid":
        ball = trimesh.creation.icosphere(3)
        ball.apply_scale((a, b, c))
        return ball
    if shape.kind == "box":
        return trimesh.creation.box((2 * a, 2 * b, 2 * c))
    return trimesh.Trimesh(shape.vertices, shape.faces, process=False)


def _centered(mesh: "trimesh.Trimesh") -> "trimesh.Trimesh":
    mesh.apply_translation(-mesh.bounds.mean(axis=0))
    return mesh
