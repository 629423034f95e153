"""Shapes of tool and payload, from the words of a document to those of a robot's bodies."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.documents.shapes import ConvexMesh, Mesh, ToolShape, half_sizes
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
            found += _attached(shape, shape.name or f"{BODY}/{number}")
        except InputError as error:
            raise error.within(f"tool_shapes.{number}") from None
    return tuple(found)


def _attached(shape: ToolShape, name: str) -> "Iterator[Shape]":
    from wsrender.robots.shapes import ATTACHED, Shape

    kind: Any = "mesh" if shape.shape == "convex_mesh" else shape.shape
    own = Shape(name, BODY, kind, -1, shape.matrix(), np.array(half_sizes(shape)), ATTACHED, False, np.array(GREY))
    if not isinstance(shape, ConvexMesh | Mesh):
        yield own
        return
    import trimesh

    from wsrender.world.meshes import convex_parts

    several = isinstance(shape, Mesh) and shape.convex is False
    for number, corners in enumerate(convex_parts(shape)):
        hull = trimesh.convex.convex_hull(corners)
        called = f"{name}/{number}" if several else name
        yield replace(own, name=called, vertices=np.array(hull.vertices), faces=np.array(hull.faces, np.int32))
