"""Shapes as triangles, for pictures."""

import numpy as np
import trimesh

from wsrender.documents.environment import (
    Box,
    Capsule,
    ConvexMesh,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    HeightField,
    Mesh,
    Sphere,
)
from wsrender.world.meshes import hull_vertices
from wsrender.world.surfaces import ClosedSurface, surface_of

Solid = Sphere | Box | Cylinder | Capsule | Ellipsoid | ConvexMesh | Mesh | HeightField | ClosedSurface
"""A shape that is bounded."""

# Faces of a box whose corners are numbered by the bits x y z, outward.
_FACES = [
    [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
]  # fmt: skip
_SIDES = 48  # of a cylinder
_HALVINGS = 3  # of the edges of the icosahedron that stands for a ball
_THICKNESS = 0.004  # of a half-space's plate, relative to the longest edge of what it covers


def triangles(shape: Solid) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 3) [m, world frame] and outward faces (F, 3) of a shape; flat sides stand for round ones.

    Raises InputError for a mesh that encloses no volume, or whose file cannot be read.
    """
    if isinstance(shape, Box):
        return _box(np.array(shape.size_m), shape.matrix())
    if isinstance(shape, HeightField):
        shape = surface_of(shape)
    if isinstance(shape, ClosedSurface):
        return _placed(shape.vertices, shape.T), shape.faces
    mesh = _mesh(shape)
    return _placed(np.asarray(mesh.vertices), shape.matrix()), np.asarray(mesh.faces)


def plate(half_space: HalfSpace, lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The surface of a half-space as a thin plate that covers the box lower … upper (3,) [m], as `triangles`.

    It lies behind the plane. Along the world's axes it is as large as the box, else large enough.
    """
    R = _frame(np.array(half_space.normal))
    bits = np.array([[k >> 2 & 1, k >> 1 & 1, k & 1] for k in range(8)])
    corners = (lower + bits * (upper - lower)) @ R  # along the plate's own axes
    low, high = corners.min(axis=0), corners.max(axis=0)
    high[2] = np.array(half_space.point_m) @ R[:, 2]
    low[2] = high[2] - _THICKNESS * float((upper - lower).max())
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, R @ ((low + high) / 2)
    return _box(high - low, T)


def foot(half_space: HalfSpace, point: np.ndarray) -> np.ndarray:
    """The point (3,) [m] of a half-space's plane that is nearest to ``point``."""
    normal = np.array(half_space.normal) / np.linalg.norm(half_space.normal)
    return point - (point - np.array(half_space.point_m)) @ normal * normal


def _frame(normal: np.ndarray) -> np.ndarray:
    """Rotation (3, 3) whose third column is along the normal, the others along world axes where they can be."""
    z = normal / np.linalg.norm(normal)
    axis = np.eye(3)[int(np.abs(z).argmin())]
    x = axis - axis @ z * z
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)


def _mesh(shape: Sphere | Cylinder | Capsule | Ellipsoid | ConvexMesh | Mesh) -> trimesh.Trimesh:
    """A shape in its own frame."""
    match shape:
        case Sphere():
            return trimesh.creation.icosphere(subdivisions=_HALVINGS, radius=shape.radius_m)
        case Ellipsoid():
            ball = trimesh.creation.icosphere(subdivisions=_HALVINGS)
            return ball.apply_scale(np.array(shape.size_m) / 2)
        case Cylinder():
            return trimesh.creation.cylinder(radius=shape.radius_m, height=shape.length_m, sections=_SIDES)
        case Capsule():
            return trimesh.creation.capsule(radius=shape.radius_m, height=shape.length_m, count=(_SIDES, _SIDES))
    return trimesh.convex.convex_hull(hull_vertices(shape))


def _box(size: np.ndarray, T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    bits = np.array([[k >> 2 & 1, k >> 1 & 1, k & 1] for k in range(8)])
    return _placed((bits - 0.5) * size, T), np.array(_FACES)


def _placed(points: np.ndarray, T: np.ndarray) -> np.ndarray:
    return points @ T[:3, :3].T + T[:3, 3]
