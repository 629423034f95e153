"""What an environment holds, as shapes in the world: those of its robots and scenes one by one."""

import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull

from wsrender.documents.environment import (
    Box,
    Capsule,
    ConvexMesh,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    HeightField,
    Item,
    Mesh,
    OtherRobot,
    Scene,
    Shape,
    Sphere,
)
from wsrender.documents.robot import Transform
from wsrender.errors import InputError
from wsrender.robot.model_robot import Robot, configuration_rows, robot_of_spec, transform_of
from wsrender.robots import shapes as models
from wsrender.robots.model_warning import ModelWarning
from wsrender.robots.plausibility import LENGTH
from wsrender.world.meshes import convex_parts
from wsrender.world.surfaces import ClosedSurface, surface_of

BEYOND = 1e-6  # rad or m by which a configuration may be beyond a limit: rounding


@dataclass(frozen=True)
class Standing:
    """A shape that stands in the world; ``name``: its own, or item/shape; ``item``: the name of its item.

    ``bits``: contype and conaffinity of what a model has; None: it meets everything.
    """

    name: str
    item: str
    shape: Shape | ClosedSurface
    bits: tuple[int, int] | None = None


def shapes_around(items: Iterable[Item]) -> tuple[Standing, ...]:
    """The shapes of an environment's items, in order; meshes as the corners of their convex parts, or as surfaces.

    Raises InputError, ModelError, the field from ``items`` on, for what cannot be had.
    """
    found = []
    for number, item in enumerate(items):
        name = item.name or f"{item.shape} {number + 1}"
        try:
            match item:
                case OtherRobot():
                    found += _robot(item, name)
                case Scene():
                    found += _scene(item, name)
                case ConvexMesh() | Mesh() | HeightField():
                    found += _solid(item, name)
                case _:
                    found.append(Standing(name, name, item))
        except InputError as error:
            raise error.within(f"items.{number}") from None
    return tuple(found)


def _robot(item: OtherRobot, name: str) -> Iterator[Standing]:
    robot = _loaded(item)
    q, chain = configuration_rows(item.configuration, robot.chain.n, "configuration"), robot.chain
    beyond = np.flatnonzero((q[0] < chain.lower_limits - BEYOND) | (q[0] > chain.upper_limits + BEYOND))
    if beyond.size:
        k = int(beyond[0])
        low, high = chain.lower_limits[k], chain.upper_limits[k]
        message = f"puts joint {chain.joint_names[k]!r} at {q[0, k]:g}, beyond its limits {low:g} … {high:g} [rad or m]"
        raise InputError("configuration", message)
    bodies = robot.bodies
    if not bodies.shapes:
        raise InputError("robot", f"{robot.name} has no shapes that may collide")
    for shape, T in zip(bodies.shapes, bodies.poses(q)[0], strict=True):
        yield Standing(f"{name}/{shape.name}", name, as_document(shape, T), shape.bits)


def _loaded(item: OtherRobot) -> Robot:
    """The robot of an item. Raises InputError where its lengths were probably millimetres."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*no usable limits", ModelWarning)  # it stands still
        robot = robot_of_spec(item.robot, item.base, item.tip)
    for notice in robot.notices:
        if notice.code == LENGTH:
            raise InputError(str(notice.field), f"{notice.message}; {notice.remedy}")
    return robot


def _scene(item: Scene, name: str) -> Iterator[Standing]:
    from wsrender.robots.scenes import scene_of_path, scene_of_text, uploaded_scene

    if item.path is not None:
        shapes = scene_of_path(item.path, item.length_unit_m, item.entry)
    elif item.mjcf is not None:
        shapes = scene_of_text(item.mjcf, item.length_unit_m)
    else:
        shapes = uploaded_scene(str(item.model), item.length_unit_m, item.entry)
    for shape in shapes:
        placed = as_document(shape, item.matrix() @ shape.T_frame_shape)
        yield Standing(f"{name}/{shape.name}", name, placed, shape.bits)


def _solid(item: ConvexMesh | Mesh | HeightField, name: str) -> Iterator[Standing]:
    if isinstance(item, HeightField) or (isinstance(item, Mesh) and item.convex is None and item.vertices_m is None):
        surface = surface_of(item)
        if not surface.is_convex:
            yield Standing(name, name, surface)
            return
        parts = [surface.vertices[ConvexHull(surface.vertices).vertices]]
    else:
        parts = convex_parts(item)
    place = item.model_dump(include=set(Transform.model_fields))
    several = isinstance(item, Mesh) and item.convex is False
    for number, corners in enumerate(parts):
        part = ConvexMesh(name=item.name, vertices_m=_points(corners), **place)
        yield Standing(f"{name}/{number}" if several else name, name, part)


def _points(vertices: np.ndarray) -> Any:
    return tuple(map(tuple, vertices.tolist()))


def as_document(shape: models.Shape, T: np.ndarray) -> Shape | ClosedSurface:
    """A robot's shape, its frame at ``T`` (4, 4) in the world [m], in the words of an environment."""
    radius, half, _ = shape.size
    placed = transform_of(T)
    assert placed is not None
    place, at, z = placed.model_dump(exclude_none=True), placed.position_m, tuple(T[:3, 2].tolist())
    edges: Any = tuple((2 * shape.size).tolist())
    match shape.kind:
        case "plane":
            return HalfSpace(point_m=at, normal=z)
        case "sphere":
            return Sphere(radius_m=radius, position_m=at)
        case "capsule":
            return Capsule(radius_m=radius, length_m=2 * half, **place)
        case "cylinder":
            return Cylinder(radius_m=radius, length_m=2 * half, **place)
        case "box":
            return Box(size_m=edges, **place)
        case "ellipsoid":
            return Ellipsoid(size_m=edges, **place)
        case "hfield":
            return ClosedSurface(shape.vertices, shape.faces, T)
    return ConvexMesh(vertices_m=_points(shape.vertices), **place)
