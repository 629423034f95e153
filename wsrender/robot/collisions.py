"""Collision constraints of a robot: its shapes and what stands around it as solids, and which of them keep apart."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from wsrender.collision.clearance import Clearance
from wsrender.collision.program import lookups_of
from wsrender.collision.solids import BASE, Pairs, Solid
from wsrender.collision.store import stored_program
from wsrender.documents.constraints import Apart, Constraints
from wsrender.documents.environment import Box, Capsule, ConvexMesh, Cylinder, Ellipsoid, Environment, HalfSpace, Sphere
from wsrender.documents.shapes import half_sizes
from wsrender.errors import InputError, ResourceError
from wsrender.pipeline.constraints.collision import CollisionConstraint, labelling
from wsrender.robot.model_robot import Robot
from wsrender.robot.surroundings import Standing, shapes_around
from wsrender.robots.chain import Chain
from wsrender.robots.moving_base import MovingBase
from wsrender.robots.pairs import meet, without
from wsrender.robots.shapes import Shape
from wsrender.world.surfaces import ClosedSurface

if TYPE_CHECKING:
    from wsrender.robots.bodies import Bodies

SELF, AROUND = "self_collision", "environment"
MOST_PAIRS = 2000  # of both constraints: each may take a table of 256 KiB, and a second to make it
MOST_LISTED = 100 * MOST_PAIRS  # of shapes and what stands around, before those that are excluded: 60 MB
KINDS: dict[str, Any] = {
    "mesh": "hull",
    "convex_mesh": "hull",
    "plane": "half_space",
    "hfield": "surface",
}  # of shapes, by what solids call them

STANDING = ("half_space", "surface")  # kinds that no joint carries

NEVER_MEET = (
    "would keep nothing apart: contype and conaffinity of the robot's shapes have no bit in common with those of what "
    "they are to keep apart from"
)
LARGEST_M = 1e9  # of a shape's place, size and corners: single precision holds products of four such numbers
FARTHEST = 8.0  # angles [rad] that float32 is trusted with
ENDLESS = (
    np.pi,
    1.0,
)  # what tables hold of a joint without limits, or with farther ones, that turns [rad] or slides [m]; beyond: float64


def collision_constraints(
    robot: Robot, choice: Constraints | None, environment: Environment | None, base: MovingBase | None = None
) -> tuple[CollisionConstraint, ...]:
    """What ``choice`` asks of the robot's shapes; an environment is kept out of, unless it is only drawn.

    Tables are made here, in seconds, where this robot's are not on disk yet. Raises InputError where the robot has no
    shapes, for names that name nothing, a margin beyond the robot's size, and where pairs collide in every
    configuration.
    """
    own = choice.self_collision if choice else None
    around = choice.environment if choice else None
    if around is None and environment is not None:
        around = Apart()
    if own is None and not around:
        return ()
    found = _kept_apart(robot, own, around, environment, base)
    refuse_always(found)
    return found


def clearance_of(
    robot: Robot, choice: Constraints | None, environment: Environment | None, base: MovingBase | None = None
) -> Clearance:
    """Distances of the robot's own shapes, and from its environment unless that is only drawn.

    Pairs that constraints exclude do not count; configurations begin with the coordinates of a ``base`` that moves.
    Raises InputError where the robot has no shapes.
    """
    own = (choice.self_collision if choice else None) or Apart()
    around = choice.environment if choice else None
    around = Apart() if around is None and environment is not None else around
    try:
        found = _kept_apart(robot, own, around, environment, base)
    except InputError as error:
        raise InputError("indices", f"must not ask for clearance: {error.field} {error.message}") from error
    pairs = Pairs.of(found[0].solids, *((each.pairs, 0.0, each.name == AROUND) for each in found))
    chain, distances = found[0].chain, found[0].distances
    program = stored_program(pairs, chain, distances)
    return Clearance(pairs, chain, distances, frozenset(program.never.tolist()), lookups_of(program))


def _kept_apart(
    robot: Robot,
    own: Apart | None,
    around: Apart | Literal[False] | None,
    environment: Environment | None,
    base: MovingBase | None = None,
) -> tuple[CollisionConstraint, ...]:
    """The constraints of the robot's surroundings and of its own shapes, of which at least one is asked for.

    Where the ``base`` moves, its coordinates come before those of the chain.
    """
    bodies = robot_bodies(robot, SELF if own else AROUND)
    chain = limited(base.carrying(bodies.chain) if base else bodies.chain)
    shapes = [solid_of(shape) for shape in bodies.shapes]
    if base:
        shapes = [_carried(solid, base) for solid in shapes]
    standing = _standing(environment) if around else ()
    items = [standing_solid(each, chain.T_world_base) for each in standing]
    solids = tuple(shapes + items)
    for solid in solids:
        if not max(np.abs(numbers).max() for numbers in (solid.T, solid.size, solid.points)) <= LARGEST_M:
            message = f"has a shape {solid.name!r} of a place or size beyond {LARGEST_M:g} m, the largest allowed"
            raise InputError("environment" if solid in items else f"constraints.{SELF if own else AROUND}", message)
    found = []
    if around:
        still = [k for k, shape in enumerate(bodies.shapes) if shape.surroundings]
        still += range(len(shapes), len(solids))
        if not still:
            if environment:
                raise InputError("environment.items", "must not be empty: nothing stands around")
            raise InputError(f"constraints.{AROUND}", "must not be given without an environment: nothing stands around")
        moving = {k for k, shape in enumerate(bodies.shapes) if shape.frame != BASE}
        if (count := len(moving) * len(still)) > MOST_LISTED:
            message = f"would look at {count} pairs of shapes, more than {MOST_LISTED}: give fewer shapes"
            raise ResourceError(f"constraints.{AROUND}", message)
        named = (*bodies.shapes, *(replace(bodies.shapes[0], name=each.name, body=each.item) for each in standing))
        meeting = [pair for pair in _meeting(bodies, standing) if pair[0] in moving]
        if moving and not meeting:
            raise InputError(f"constraints.{AROUND}", NEVER_MEET)
        pairs = _pairs(meeting, named, around, AROUND)
        found.append(CollisionConstraint(AROUND, chain, solids, pairs, around.margin_m))
    if own:
        pairs = _pairs(bodies.pairs.tolist(), bodies.shapes, own, SELF)
        found.append(CollisionConstraint(SELF, chain, solids, pairs, own.margin_m))
    for constraint in found:
        if constraint.margin_m > (size := size_of(bodies)):
            message = f"must be at most the robot's size, {size:.3g} m, not {constraint.margin_m:g}"
            raise InputError(f"constraints.{constraint.name}.margin_m", message)
    if (count := sum(len(constraint.pairs) for constraint in found)) > MOST_PAIRS:
        message = f"would keep {count} pairs of shapes apart, more than {MOST_PAIRS}: exclude some"
        raise ResourceError(f"constraints.{found[0].name}", message)
    return tuple(found)


def _carried(solid: Solid, base: MovingBase) -> Solid:
    """A robot's solid in the frames of a chain that begins with the joints of its base."""
    joints = len(base.varying)
    if solid.joint != BASE:
        return replace(solid, joint=solid.joint + joints)
    if joints and solid.kind in STANDING:
        message = f"of a base that moves must stand in the job: the robot's file has {solid.name!r} in its world"
        raise InputError("environment", message)
    return replace(solid, joint=joints - 1, T=base.base_on_last @ solid.T) if joints else solid


def _meeting(bodies: "Bodies", standing: Sequence[Standing]) -> list[tuple[int, int]]:
    """Shapes of the robot with those of its model's world and of what stands around that MuJoCo tests them against."""
    still, found = [shape.surroundings for shape in bodies.shapes], list[tuple[int, int]]()
    with_world = {(a, b) if still[b] else (b, a) for a, b in bodies.around.tolist()}
    for k, shape in enumerate(bodies.shapes):
        found += [(k, item) for item in range(len(still)) if (k, item) in with_world]
        bits = ((number, each.bits) for number, each in enumerate(standing, len(still)))
        found += [(k, number) for number, of in bits if of is None or meet(shape.bits, of)]
    return found


def robot_bodies(robot: Robot, name: str) -> "Bodies":
    """What a constraint of that name keeps apart. Raises InputError for a robot without shapes that may collide."""
    field = f"constraints.{name}"
    if robot.definition:
        raise InputError(field, "is not available for a robot that is defined by a class: it has no shapes")
    bodies = robot.bodies
    if not any(shape.frame != BASE for shape in bodies.shapes):
        remedy = "give its links collision shapes (URDF collision, MJCF geoms), or a table of DH parameters link_radius"
        raise InputError(field, f"must not be given: {robot.name} has no shapes that may collide; {remedy}")
    return bodies


def _standing(environment: Environment | None) -> tuple[Standing, ...]:
    try:
        return shapes_around(environment.items) if environment else ()
    except InputError as error:
        raise error.within("environment") from None


def limited(chain: Chain) -> Chain:
    """A chain with ends where it has none that tables can hold: see ENDLESS."""
    ends, source = np.where(chain.revolute, *ENDLESS), chain.joint_source
    limits = np.stack([chain.lower_limits, chain.upper_limits])
    moved = np.where(chain.joint_is_revolute, np.abs(chain.joint_scale * limits[:, source] + chain.joint_offset), 0)
    near = moved.max(axis=0) <= FARTHEST
    held = np.isfinite(limits).all(axis=0) & ~np.isin(np.arange(chain.n), source[~near])
    return replace(chain, lower_limits=np.where(held, limits[0], -ends), upper_limits=np.where(held, limits[1], ends))


def solid_of(shape: Shape) -> Solid:
    """A robot's shape as a solid."""
    kind: Any = KINDS.get(shape.kind, shape.kind)
    vertices = shape.vertices if kind in ("hull", "surface") else None
    faces = shape.faces if kind == "surface" else None
    return Solid(shape.name, kind, shape.frame, shape.T_frame_shape, shape.size, vertices, faces)


def standing_solid(standing: Standing, T_world_base: np.ndarray) -> Solid:
    """A shape of the world as a solid that stands with a base (4, 4)."""
    shape, size, T, vertices, faces = standing.shape, np.zeros(3), np.eye(4), None, None
    match shape:
        case HalfSpace():
            T[:3, :3], T[:3, 3] = _turned_to(np.array(shape.normal)), shape.point_m
        case Sphere() | Box() | Ellipsoid() | Cylinder() | Capsule():
            size, T = np.array(half_sizes(shape)), shape.matrix()
        case ConvexMesh():
            vertices, T = np.array(shape.vertices_m), shape.matrix()
        case ClosedSurface():
            vertices, faces, T = shape.vertices, shape.faces, shape.matrix()
    kind: Any = KINDS.get(shape.shape, shape.shape)
    T_base: np.ndarray = np.linalg.inv(T_world_base) @ T
    if kind == "half_space":  # its point nearest to the base: what is far costs precision
        T_base[:3, 3] = T_base[:3, 2] * (T_base[:3, 2] @ T_base[:3, 3])
    return Solid(standing.name, kind, BASE, T_base, size, vertices, faces)


def _turned_to(normal: np.ndarray) -> np.ndarray:
    """A rotation (3, 3) whose z is along a normal."""
    z = normal / np.linalg.norm(normal)
    x = np.cross(z, np.eye(3)[np.abs(z).argmin()])
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def _pairs(pairs: Sequence[Sequence[int]], shapes: Sequence[Shape], choice: Apart, name: str) -> np.ndarray:
    return without(np.array(pairs, int).reshape(-1, 2), shapes, choice.exclude, f"constraints.{name}.exclude")


def size_of(bodies: "Bodies") -> float:
    """Upper bound of how far the robot's shapes are from its first joint [m]."""
    chain = bodies.chain
    links = (
        np.linalg.norm(chain.T_joint[1:, :3, 3], axis=1).sum()
        + np.where(np.isfinite(chain.largest_slide), chain.largest_slide, 0.0).sum()
    )
    own = [
        np.linalg.norm(s.T_frame_shape[:3, 3]) + solid_of(s).bounding_radius for s in bodies.shapes if s.frame != BASE
    ]
    return float(links + max(own))


def refuse_always(constraints: tuple[CollisionConstraint, ...]) -> None:
    """Raises InputError for pairs that are proven to collide in every configuration."""
    first, *_ = labelling(constraints)
    together = Pairs.of(first.solids, *(each.group for each in constraints))
    always = stored_program(together, first.chain, first.distances).always
    for reason, constraint in enumerate(constraints):
        pairs = [together.pairs[k] for k in always if together.reason[k] == reason]
        if pairs:
            names = [[first.solids[k].name for k in pair] for pair in pairs]
            told = "; ".join(" and ".join(pair) for pair in names)
            remedy = f"constraints.{constraint.name}.exclude = {names} lets them, or move what stands there"
            raise InputError(
                f"constraints.{constraint.name}",
                f"would admit nothing: {told} collide in every configuration; {remedy}",
            )
