"""Two arms that keep apart from each other: one chain from the one's last link over both bases to the other's tip.

Where shapes of the two stand to each other depends on the joints between them alone. Seen from the last link of the
first arm its joints come in reverse order, each undone, then those of the second: a serial chain, of which everything
that collisions of one arm are decided by holds.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from wsrender.collision.distance import Distances
from wsrender.collision.solids import BASE, Solid
from wsrender.documents.constraints import Apart
from wsrender.errors import InputError, ResourceError
from wsrender.pipeline.constraints.collision import CollisionConstraint
from wsrender.robot.collisions import (
    MOST_PAIRS,
    NEVER_MEET,
    limited,
    refuse_always,
    robot_bodies,
    size_of,
    solid_of,
)
from wsrender.robot.model_robot import Robot
from wsrender.robots.bodies import Bodies
from wsrender.robots.chain import Chain
from wsrender.robots.moving_base import MovingBase
from wsrender.robots.pairs import meet, without
from wsrender.robots.shapes import Shape

ARMS = "arms_collision"
# Of what stands with a tip the distance is the same in all configurations that are tried; a tip lies on what is near.
TRIED, RIGID_M, ON_M, POINT_M, FAR_M = 16, 1e-9, 1e-6, 1e-4, 1.0


@dataclass(frozen=True, eq=False)
class ArmsApart:
    """What keeps two arms apart; ``order``: the coordinates of its chain by their places in those of both arms."""

    constraint: CollisionConstraint
    order: np.ndarray

    @property
    def chain(self) -> Chain:
        """From the last link of the first arm to the tip of the second."""
        return self.constraint.chain

    def configurations(self, q_a: np.ndarray, q_b: np.ndarray) -> np.ndarray:
        """Those (N, n) of the chain at configurations (N, n_a), (N, n_b) of both arms."""
        return np.concatenate([q_a, q_b], axis=1)[:, self.order]


def arms_apart(
    robots: Sequence[Robot],
    names: Sequence[str],
    choice: Apart,
    *,
    one_model: bool = False,
    bases: Sequence[MovingBase] | None = None,
) -> ArmsApart:
    """Two robots that keep apart, whose shapes ``choice`` calls by the robot's name, a stroke, and their own.

    Every shape that moves with a joint of one against all of the other whose contact bits it meets; of two arms of
    ``one_model`` against those that move. ``bases``: of robots that may stand elsewhere; their joints lead those of the
    arms, and nothing is said of how the tips meet. Tables are made here, in seconds, where they are not on disk yet.
    Raises InputError for a robot without shapes, joints that both arms share, names that name nothing, a margin beyond
    both robots, height fields, and pairs that meet in every configuration, or wherever the tips do.
    """
    field = f"constraints.{ARMS}"
    a, b = (robot_bodies(robot, ARMS) for robot in robots)
    shared = set(robots[0].joint_names) & set(robots[1].joint_names)
    if one_model and shared:
        raise InputError(field, f"must not be given: both arms have the joints {', '.join(sorted(shared))}")
    chains = [limited(each.chain) for each in (a, b)]
    of_a, of_b = (_own(name, bodies) for name, bodies in zip(names, (a, b), strict=True))
    if bases:
        chains = [base.carrying(each) for base, each in zip(bases, chains, strict=True)]
        of_a, of_b = (_carried(own, base) for own, base in zip((of_a, of_b), bases, strict=True))
    chain, order = _joined(*chains)
    moves = [np.array([shape.frame != BASE for shape in own]) for own in (of_a, of_b)]
    asked = moves[0][:, None] & moves[1] if one_model else moves[0][:, None] | moves[1]
    asked &= np.array([[meet(one.bits, other.bits) for other in of_b] for one in of_a], bool).reshape(asked.shape)
    if not asked.any():
        raise InputError(field, NEVER_MEET)
    pairs = without(np.argwhere(asked) + np.array([0, len(of_a)]), (*of_a, *of_b), choice.exclude, f"{field}.exclude")
    if len(pairs) > MOST_PAIRS:
        raise ResourceError(
            field, f"would keep {len(pairs)} pairs of shapes apart, more than {MOST_PAIRS}: exclude some"
        )
    if choice.margin_m > (size := size_of(a) + size_of(b)):
        raise InputError(
            f"{field}.margin_m", f"must be at most the robots' size, {size:.3g} m, not {choice.margin_m:g}"
        )
    solids = (*(_of_first(shape, chains[0]) for shape in of_a), *(_of_second(shape, *chains) for shape in of_b))
    if fields := [solid.name for k, solid in enumerate(solids) if solid.kind == "surface" and k in pairs]:
        message = f"must list all pairs of {', '.join(fields)}: arms keep apart from no height field of the other"
        raise InputError(f"{field}.exclude", message)
    constraint = CollisionConstraint(ARMS, chain, solids, pairs, choice.margin_m)
    refuse_always((constraint,))
    if not bases:
        _refuse_where_tips_meet(constraint, [_from_tip(robots[0], a, of_a), _from_tip(robots[1], b, of_b)])
    return ArmsApart(constraint, order)


def _own(name: str, bodies: Bodies) -> list[Shape]:
    """A robot's shapes without what stands around, they and their bodies by names that say whose they are."""
    own = (shape for shape in bodies.shapes if not shape.surroundings)
    return [replace(shape, name=f"{name}/{shape.name}", body=f"{name}/{shape.body}") for shape in own]


def _carried(shapes: list[Shape], base: MovingBase) -> list[Shape]:
    """A robot's shapes in the frames of a chain that begins with the joints of its base."""
    joints = len(base.varying)

    def moved(shape: Shape) -> Shape:
        T = base.base_on_last @ shape.T_frame_shape if joints and shape.frame == BASE else shape.T_frame_shape
        return replace(shape, frame=shape.frame + joints, T_frame_shape=T)

    return [moved(shape) for shape in shapes]


def _joined(a: Chain, b: Chain) -> tuple[Chain, np.ndarray]:
    """The chain, and its coordinates by their places in those of both, in the order of the joints that they move."""
    first = np.linalg.inv(a.T_joint)[::-1]  # from behind a joint to the one before it
    across = first[-1] @ np.linalg.inv(a.T_world_base) @ b.T_world_base @ b.T_joint[0]
    T_joint = np.concatenate([np.eye(4)[None], first[:-1], across[None], b.T_joint[1:]])
    sources = np.concatenate([a.joint_source[::-1], a.n + b.joint_source])
    order = np.array(list(dict.fromkeys(sources.tolist())))

    def of_coordinates(name: str) -> np.ndarray:
        return np.concatenate([getattr(a, name), getattr(b, name)])[order]

    count = len(sources)
    chain = replace(
        b,
        joint_names=tuple((*a.joint_names, *b.joint_names)[k] for k in order),
        lower_limits=of_coordinates("lower_limits"),
        upper_limits=of_coordinates("upper_limits"),
        periodic=of_coordinates("periodic"),
        leader_is_revolute=of_coordinates("revolute"),
        joint_is_revolute=np.concatenate([a.joint_is_revolute[::-1], b.joint_is_revolute]),
        joint_source=np.argsort(order)[sources],
        joint_scale=np.concatenate([-a.joint_scale[::-1], b.joint_scale]),
        joint_offset=np.concatenate([-a.joint_offset[::-1], b.joint_offset]),
        T_joint=T_joint,
        T_world_base=np.eye(4),
        mass=np.zeros(count),
        center_of_mass=np.zeros((count, 3)),
        inertia=np.zeros((count, 3, 3)),
        armature=np.zeros(count),
        has_inertia=False,
        with_branches=None,
    )
    return chain, order


def _of_first(shape: Shape, a: Chain) -> Solid:
    """A shape of the first arm; what joint j carries stands with what has undone joint j + 1."""
    last, after = len(a.joint_source) - 1, shape.frame + 1  # after 0 what stands with the base
    if shape.frame == last:
        return solid_of(replace(shape, frame=BASE))
    T = np.linalg.inv(a.T_joint[after]) @ shape.T_frame_shape
    return solid_of(replace(shape, frame=last - after, T_frame_shape=T))


def _of_second(shape: Shape, a: Chain, b: Chain) -> Solid:
    """A shape of the second arm; what stands with its base stands with the first arm's."""
    joints = len(a.joint_source)
    if shape.frame != BASE:
        return solid_of(replace(shape, frame=joints + shape.frame))
    T = np.linalg.inv(a.T_world_base @ a.T_joint[0]) @ b.T_world_base @ shape.T_frame_shape
    return solid_of(replace(shape, frame=joints - 1, T_frame_shape=T))


def _from_tip(robot: Robot, bodies: Bodies, shapes: Sequence[Shape]) -> np.ndarray:
    """Signed distances (S,) [m] of the tip's point from shapes that stand with it; infinite from others."""
    chain, point = robot.chain, Solid("tip", "sphere", BASE, np.eye(4), np.full(3, POINT_M))
    lower, upper = limited(bodies.chain).lower_limits, limited(bodies.chain).upper_limits
    q = lower + np.random.default_rng(0).random((TRIED, chain.n)) * (upper - lower)
    distances = Distances((point, *map(solid_of, shapes)))
    tips, poses = chain.poses(q), replace(bodies, shapes=tuple(shapes)).poses(q)
    found = np.array([distances.between(0, k + 1, tips, poses[:, k], FAR_M) + POINT_M for k in range(len(shapes))])
    return np.where(np.ptp(found, axis=1) < RIGID_M, found.max(axis=1), np.inf)


def _refuse_where_tips_meet(constraint: CollisionConstraint, from_tips: list[np.ndarray]) -> None:
    """Raises InputError for pairs that are too near wherever the tips are at one point: see `_from_tip`."""
    apart = np.concatenate(from_tips)[constraint.pairs].sum(axis=1)
    close = constraint.pairs[apart <= max(constraint.margin_m, ON_M)]
    if len(close):
        names = [[constraint.solids[k].name for k in pair] for pair in close]
        told = "; ".join(" and ".join(pair) for pair in names)
        message = (
            f"would admit nothing: {told} meet wherever the tips do; give the robots a tool whose point is ahead of"
        )
        raise InputError(f"constraints.{ARMS}", f"{message} their shapes, or constraints.{ARMS}.exclude = {names}")
