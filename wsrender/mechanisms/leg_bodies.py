"""Shapes of serial legs, and what each keeps apart from.

Their own pairs are those of their models, by MuJoCo's rules; of two legs, and of a leg and what stands around or with
the platform, those whose contact bits meet. The platform is what MuJoCo would have it be: fixed to the tip's body, or
its child across a spherical joint, and so never tested against that body, nor, if it is fixed, against the one before.
Of legs that share a joint the shapes next to it may touch.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from wsrender.collision.solids import BASE, Solid
from wsrender.documents.arm import dotted
from wsrender.errors import InputError, ResourceError
from wsrender.mechanisms.serial_leg import NumericLeg
from wsrender.robot.collisions import solid_of
from wsrender.robot.surroundings import Standing
from wsrender.robots.bodies import Bodies
from wsrender.robots.pairs import apart_from_child, meet

SAME_M = 1e-9  # [m]: joints that are no farther apart are one
MOST_PAIRS = 5000  # of a leg's shapes with others: each is asked by itself


@dataclass(frozen=True, eq=False)
class LegBodies:
    """Shapes of the serial leg ``number``, whose ``bodies`` stand in the mechanism's base frame.

    Pairs (P, 2) keep apart: ``own`` of places in ``solids``; of such a place and that of a shape of the ``platform``,
    of what is ``around``, and of each of the ``earlier`` serial legs. ``ends`` (2, 3): the joints at base and platform;
    ``next_to`` (2, S) bool: which shapes are next to each. ``joined``: leg in closed form, "link" or "crank", and place
    of a shape, of those that share a joint and may touch.
    """

    number: int
    bodies: Bodies
    solids: tuple[Solid, ...]
    own: np.ndarray
    platform: np.ndarray
    around: np.ndarray
    ends: np.ndarray
    next_to: np.ndarray
    joined: frozenset[tuple[int, str, int]]
    earlier: tuple[np.ndarray, ...] = ()

    @property
    def pairs(self) -> int:
        """How many keep apart, beside links and cranks of legs in closed form."""
        return sum(map(len, (self.own, self.platform, self.around, *self.earlier)))

    def frames(self, q: np.ndarray) -> np.ndarray:
        """Frames (N, S, 4, 4) of the solids in the base frame at configurations (N, n)."""
        return self.bodies.poses(q)

    def beside(self, leg: int, part: str) -> list[int]:
        """Places of the shapes that keep apart from the "link" or "crank" of a leg in closed form."""
        return [k for k in range(len(self.solids)) if (leg, part, k) not in self.joined]


def leg_bodies(
    leg: NumericLeg,
    platform: Sequence[Standing],
    around: Sequence[Standing],
    closed: Sequence[tuple[np.ndarray, np.ndarray]],
    earlier: Sequence[LegBodies],
    moves: bool,
) -> LegBodies:
    """The shapes of a leg, beside ``closed``, the joints of legs in closed form, and serial ones.

    ``moves``: whether the base moves past what is ``around``, else shapes that stand on it are not asked.

    Raises InputError for a robot without shapes that may collide, ModelError where one cannot be had, ResourceError for
    more pairs than are asked.
    """
    robot, field = leg.robot, dotted(("mechanism", "legs", leg.number), "robot")
    if robot.definition or not any(shape.frame != BASE for shape in robot.bodies.shapes):
        remedy = "give its links collision shapes (URDF collision, MJCF geoms), or a table of DH parameters link_radius"
        raise InputError(field, f"must have shapes that may collide where the mechanism has bodies; {remedy}")
    bodies, chain = robot.bodies, robot.bodies.chain
    shapes, name = bodies.shapes, f"leg {leg.number + 1}"
    others = len(platform) + len(around) + len(closed) + sum(len(each.solids) for each in earlier)
    if (count := len(bodies.pairs) + len(bodies.around) + len(shapes) * others) > MOST_PAIRS:
        message = f"would keep {count} pairs of shapes of {name} apart, more than {MOST_PAIRS}: give fewer shapes"
        raise ResourceError("mechanism.bodies", message)
    moving = np.array([shape.frame for shape in shapes])
    geoms = [shape.geom for shape in shapes]
    T_first = chain.T_world_base @ chain.T_joint[0]
    ends = np.stack([T_first[:3, 3], leg.T_platform_tip[:3, 3]])
    tip = np.array([each < 0 for each in geoms])  # what tools have
    on_tip = tip | _of_weld_group(bodies, geoms)
    next_to = np.stack([moving <= moving[moving != BASE].min(), on_tip])
    apart = apart_from_child(bodies.model, [max(each, 0) for each in geoms], bodies.tip, jointed=not leg.holds_pose)
    found = LegBodies(
        leg.number,
        bodies,
        tuple(replace(solid_of(shape), name=f"{name}/{shape.name}") for shape in shapes),
        np.concatenate([bodies.pairs, bodies.around]),
        _meeting(bodies, np.flatnonzero(apart & ~tip), [each.bits for each in platform]),
        _meeting(bodies, np.flatnonzero(moves | (moving != BASE)), [each.bits for each in around]),
        ends,
        next_to,
        frozenset(_joined(ends, next_to, closed)),
    )
    return replace(found, earlier=tuple(_of_two(found, other) for other in earlier))


def _of_weld_group(bodies: Bodies, geoms: Sequence[int]) -> np.ndarray:
    """Which geoms stand with the tip, (S,) bool."""
    model = bodies.model
    weld = model.body_weldid
    return np.array([weld[model.geom_bodyid[geom]] == weld[bodies.tip] for geom in geoms], bool)


def _meeting(bodies: Bodies, places: np.ndarray, bits: Sequence[tuple[int, int] | None]) -> np.ndarray:
    """Pairs (P, 2) of shapes at ``places`` and others with ``bits``, None of what meets everything."""
    pairs = [
        (int(k), other)
        for k in places
        for other, each in enumerate(bits)
        if each is None or meet(bodies.shapes[k].bits, each)
    ]
    return np.array(pairs, int).reshape(-1, 2)


def _same(a: np.ndarray, b: np.ndarray) -> bool:
    return bool(np.abs(a - b).max() <= SAME_M)


def _joined(ends: np.ndarray, next_to: np.ndarray, closed: Sequence[tuple[np.ndarray, np.ndarray]]):
    """(leg in closed form, part, place) of shapes next to a joint that the leg shares."""
    for number, (base, platform) in enumerate(closed):
        for place in np.flatnonzero(next_to[1]) if _same(ends[1], platform) else ():
            yield number, "link", int(place)
        for place in np.flatnonzero(next_to[0]) if _same(ends[0], base) else ():
            yield from ((number, part, int(place)) for part in ("link", "crank"))


def _of_two(leg: LegBodies, other: LegBodies) -> np.ndarray:
    """Pairs (P, 2) of both legs' shapes, but of those next to a joint that they share, and of two that stand still."""
    bits = [shape.bits for shape in other.bodies.shapes]
    pairs = _meeting(leg.bodies, np.arange(len(leg.solids)), bits)
    still, other_still = (np.array([solid.joint == BASE for solid in each.solids]) for each in (leg, other))
    kept = ~(still[pairs[:, 0]] & other_still[pairs[:, 1]])
    for end in range(2):
        if _same(leg.ends[end], other.ends[end]):
            kept &= ~(leg.next_to[end][pairs[:, 0]] & other.next_to[end][pairs[:, 1]])
    return pairs[kept]
