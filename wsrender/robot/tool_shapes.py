"""Shapes of tool and payload, from the words of a document to those of a robot's bodies."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.documents.shapes import Box, Capsule, Cylinder, Ellipsoid, Mesh, Sphere, ToolShape
from wsrender.documents.transform import Transform
from wsrender.errors import InputError

if TYPE_CHECKING:
    from wsrender.robots.shapes import Shape

BODY = "tool"
GREY = (0.5, 0.5, 0.5, 1.0)


def attached(shapes: Sequence[ToolShape]) -> "tuple[Shape, ...]":
    """Shapes in the frame of the tip. Raises InputError, the field from ``tool_shapes`` on, for a mesh without one."""
    found = []
    for number, shape in enumerate(shapes):
        try:
            found.append(_attached(shape, shape.name or f"{BODY}/{number}"))
        except InputError as error:
            raise error.within(f"tool_shapes.{number}") from None
    return tuple(found)


def _attached(shape: ToolShape, name: str) -> "Shape":
    from wsrender.robots.shapes import ATTACHED, Shape

    size, more = np.zeros(3), dict[str, Any]()
    T = Transform(position_m=shape.position_m).matrix() if isinstance(shape, Sphere) else shape.matrix()
    match shape:
        case Sphere():
            size[0] = shape.radius_m
        case Box() | Ellipsoid():
            size = np.array(shape.size_m) / 2
        case Cylinder() | Capsule():
            size[:2] = shape.radius_m, shape.length_m / 2
        case Mesh():
            import trimesh

            from wsrender.world.meshes import hull_vertices

            hull = trimesh.convex.convex_hull(hull_vertices(shape))
            more = {"vertices": np.array(hull.vertices), "faces": np.array(hull.faces, np.int32)}
    return Shape(name, BODY, shape.shape, -1, T, size, ATTACHED, False, np.array(GREY), **more)
