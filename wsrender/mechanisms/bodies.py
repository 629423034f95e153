"""Solids of a mechanism: capsules along links and cranks, shapes of serial legs, of the platform and of what is around.

They keep apart as MuJoCo's shapes do: a crank from its own link never, nor legs that share a joint. A link that ends at
the platform touches it there: of it what is farther along than a gap keeps apart, or nothing without a gap.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from wsrender.collision.distance import Distances
from wsrender.collision.solids import BASE, Solid
from wsrender.documents.environment import Environment
from wsrender.documents.mechanism import MechanismBodies
from wsrender.errors import InputError
from wsrender.mechanisms.leg_bodies import LegBodies, leg_bodies
from wsrender.mechanisms.serial_leg import NumericLeg
from wsrender.mechanisms.surfaces import between_surfaces, from_surface
from wsrender.pipeline.constraints.leg_distance import segment_distance
from wsrender.robot.collisions import standing_solid
from wsrender.robot.surroundings import Standing, shapes_around
from wsrender.robots.frames import inverse_of_rigid

BEYOND = 1e-3  # [m] beyond the margin up to which distances are asked
TRIANGLES, PAIRS = 1.4e3, 1.5e5  # of surfaces, and of two of them, that take as long as all other bodies of a mechanism
OF_LEGS = 400.0  # pairs of serial legs' shapes that take as long
THIN = 1e-3  # [m]: radius of a capsule that no leg has

Segments = dict[str, np.ndarray]
"""Of a leg in closed form its "link" and perhaps its "crank", (N, 2, 3) [m], the link towards the platform."""


class FirstPair:
    """Of the pairs that are asked one after the other the first that is nearer than a margin, at N poses.

    ``number`` (N,): from 1, or 0 where none is; ``names``: of all that were asked.
    """

    def __init__(self, poses: int, margin_m: float):
        self.number, self.names, self.margin_m = np.zeros(poses, np.int64), list[str](), margin_m

    def ask(self, pair: str, gaps: Callable[[np.ndarray], np.ndarray]) -> None:
        """A pair with ``gaps`` [m] at poses by number, asked where no other pair is too near."""
        left = np.flatnonzero(self.number == 0)
        self.names.append(pair)
        if len(left):
            self.number[left[gaps(left) < self.margin_m]] = len(self.names)


@dataclass(frozen=True, eq=False)
class Solids:
    """Solids in the frames of the ``platform`` and of the base, ``around``; capsules of ``radius_m`` along the legs.

    ``apart``: pairs of legs in closed form that share no joint; ``gap_m``: None where links may touch the platform.
    ``serial``: shapes of the other legs.
    """

    radius_m: float | None
    margin_m: float
    gap_m: float | None
    platform: tuple[Solid, ...]
    around: tuple[Solid, ...]
    apart: tuple[tuple[int, int], ...]
    serial: tuple[LegBodies, ...] = ()
    name: str = "collision"

    def carried(self, T_before: np.ndarray, T_after: np.ndarray) -> "Solids":
        """As seen from a base that serial joints carry, and from the end of those after the platform, (4, 4) each."""
        return replace(
            self,
            platform=_seen_from(T_after, self.platform),
            around=_seen_from(T_before, self.around),
        )

    @property
    def effort(self) -> float:
        """How many times as long a pose takes as of bodies without surfaces."""
        own, other = (
            sum(len(solid.faces) for solid in solids if solid.faces is not None)
            for solids in (self.platform, self.around)
        )
        pairs = sum(leg.pairs for leg in self.serial)
        return 1 + (own + other) / TRIANGLES + own * other / PAIRS + pairs / OF_LEGS

    def collisions(
        self,
        legs: Sequence[Segments],
        poses: np.ndarray,
        serial: Sequence[np.ndarray] = (),
        fixed: np.ndarray | None = None,
    ) -> tuple[np.ndarray, list[str]]:
        """Number, from 1, of the first pair of bodies that collides at poses (N, 4, 4), base frame, or 0, (N,); names.

        ``legs``: those in closed form; ``serial``: frames (N, S, 4, 4) of the shapes of each of the others, base frame;
        ``fixed``: frames (N, 4, 4) in it of the one in which what is ``around`` stands, None where they coincide.
        """
        found = self.alone(legs, poses, fixed)
        for k, T in enumerate(serial):
            self.of_leg(found, k, T, legs, poses, fixed)
            for other in range(k):
                self.of_two(found, other, k, serial[other], T)
        return found.number, found.names

    def alone(self, legs: Sequence[Segments], poses: np.ndarray, fixed: np.ndarray | None = None) -> FirstPair:
        """Of what does not belong to serial legs, as of `collisions`."""
        found, first_around, solids = FirstPair(len(poses), self.margin_m), 1 + len(self.platform), self._solids
        numbers, distances = self.numbers(len(legs)), Distances(solids[: first_around + len(self.around)])

        def frames(k: int, at: np.ndarray) -> np.ndarray:
            return poses[at] @ solids[k].T if k < first_around else _standing_at(fixed, solids[k], at)

        for a, b in self.apart:
            for (of_a, one), (of_b, other) in ((p, q) for p in legs[a].items() for q in legs[b].items()):
                found.ask(
                    f"the {of_a} of leg {numbers[a] + 1} and the {of_b} of leg {numbers[b] + 1}",
                    lambda at, p=one, q=other: (
                        segment_distance(p[at, 0], p[at, 1], q[at, 0], q[at, 1]) - 2 * self._radius
                    ),
                )
        for number, leg in zip(numbers, legs, strict=True):
            for part, segment in leg.items():
                for k in range(1, len(distances.solids)):
                    own = self._short_of_gap(segment) if part == "link" and k < first_around else segment
                    if own is not None:
                        found.ask(
                            f"the {part} of leg {number + 1} and {solids[k].name}",
                            lambda at, k=k, own=own: self._to_capsules(distances, k, own[at], frames(k, at)),
                        )
        for a in range(1, first_around):
            for b in range(first_around, len(distances.solids)):
                found.ask(
                    f"{solids[a].name} and {solids[b].name}",
                    lambda at, a=a, b=b: self._between(distances, a, b, frames(a, at), frames(b, at)),
                )
        return found

    def of_leg(
        self,
        found: FirstPair,
        k: int,
        T: np.ndarray,
        legs: Sequence[Segments],
        poses: np.ndarray,
        fixed: np.ndarray | None = None,
    ) -> FirstPair:
        """Of the shapes of serial leg ``k``, at frames ``T`` (N, S, 4, 4), with all but other serial legs."""
        leg, solids, numbers = self.serial[k], self._solids, self.numbers(len(legs))
        first, platform, around = self._first[k], 1, 1 + len(self.platform)

        def frames(number: int, at: np.ndarray) -> np.ndarray:
            if number >= first:
                return T[at, number - first]
            return poses[at] @ solids[number].T if number < around else _standing_at(fixed, solids[number], at)

        pairs = [np.add(leg.own, first), np.add(leg.platform, [first, platform]), np.add(leg.around, [first, around])]
        for a, b in np.concatenate(pairs).tolist():
            found.ask(
                f"{solids[a].name} and {solids[b].name}",
                lambda at, a=a, b=b: self._between(self._distances, a, b, frames(a, at), frames(b, at)),
            )
        distances = None
        for number, segments in enumerate(legs):
            for part, line in segments.items():
                for place in leg.beside(number, part):
                    distances = distances or Distances(solids)  # a capsule's length is written into the model
                    found.ask(
                        f"{solids[first + place].name} and the {part} of leg {numbers[number] + 1}",
                        lambda at, place=place, line=line, own=distances: self._to_capsules(
                            own, first + place, line[at], T[at, place]
                        ),
                    )
        return found

    def of_two(self, found: FirstPair, a: int, b: int, T_a: np.ndarray, T_b: np.ndarray) -> FirstPair:
        """Of the shapes of serial legs ``a`` < ``b`` at frames (N, S, 4, 4)."""
        for one, other in self.serial[b].earlier[a].tolist():
            first, second = self._first[a] + other, self._first[b] + one
            found.ask(
                f"{self._solids[first].name} and {self._solids[second].name}",
                lambda at, p=first, q=second, i=other, j=one: self._between(
                    self._distances, p, q, T_a[at, i], T_b[at, j]
                ),
            )
        return found

    def numbers(self, closed: int) -> list[int]:
        """Places of so many legs in closed form among all legs of the document."""
        serial = {leg.number for leg in self.serial}
        return [k for k in range(closed + len(serial)) if k not in serial]

    @property
    def _radius(self) -> float:
        return THIN if self.radius_m is None else self.radius_m

    @cached_property
    def _solids(self) -> tuple[Solid, ...]:
        """A capsule of legs, what the platform carries, what is around, and the shapes of serial legs."""
        capsule = Solid("", "capsule", BASE, np.eye(4), np.array([self._radius, 1.0, 0.0]))
        return (capsule, *self.platform, *self.around, *(solid for leg in self.serial for solid in leg.solids))

    @cached_property
    def _distances(self) -> Distances:
        return Distances(self._solids)

    @cached_property
    def _first(self) -> list[int]:
        """Places of each serial leg's first shape among all solids."""
        counts = [1 + len(self.platform) + len(self.around), *(len(leg.solids) for leg in self.serial)]
        return np.cumsum(counts).tolist()

    def _short_of_gap(self, link: np.ndarray) -> np.ndarray | None:
        """The links (N, 2, 3) up to the gap before their ends at the platform; None where they may touch it."""
        if self.gap_m is None:
            return None
        along = link[:, 1] - link[:, 0]
        kept = np.maximum(1 - self.gap_m / np.linalg.norm(along, axis=1), 0)
        return np.stack([link[:, 0], link[:, 0] + kept[:, None] * along], axis=1)

    def _to_capsules(self, distances: Distances, k: int, segments: np.ndarray, T: np.ndarray) -> np.ndarray:
        """Distances (N,) of a solid with frames (N, 4, 4) from capsules along segments (N, 2, 3), far ones cut."""
        solid, r = distances.solids[k], self._radius
        if solid.kind == "half_space":
            return np.einsum("nei,ni->ne", segments - T[:, None, :3, 3], T[:, :3, 2]).min(axis=1) - r
        limit = self.margin_m + BEYOND
        if solid.kind == "surface":
            own = np.einsum("nji,nej->nei", T[:, :3, :3], segments - T[:, None, :3, 3])
            return from_surface(solid.corners, own, limit + r) - r
        middle, half = segments.mean(axis=1), np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1) / 2
        found = np.full(len(T), limit)
        near = np.linalg.norm(middle - T[:, :3, 3], axis=1) < half + r + solid.bounding_radius + limit
        model = distances.model
        for i in np.flatnonzero(near).tolist():
            distances.solids[0].size[1] = model.geom_size[0, 1] = half[i]
            model.geom_rbound[0] = half[i] + r
            found[i] = distances.between(0, k, _along(segments[i])[None], T[i : i + 1], limit)[0]
        return found

    def _between(self, distances: Distances, a: int, b: int, T_a: np.ndarray, T_b: np.ndarray) -> np.ndarray:
        """Distances (N,) of two solids with frames (N, 4, 4), far ones cut."""
        if distances.solids[b].kind == "surface":
            a, b, T_a, T_b = b, a, T_b, T_a
        one, other, limit = distances.solids[a], distances.solids[b], self.margin_m + BEYOND
        T = np.linalg.inv(T_a) @ T_b  # of b, seen from a
        if one.kind == "surface" and other.kind == "half_space":
            return (T[:, None, :3, 2] * (one.corners.reshape(-1, 3) - T[:, None, :3, 3])).sum(axis=2).min(axis=1)
        if one.kind != "surface" or other.kind != "surface":
            found, far = np.full(len(T), limit), limit + one.bounding_radius + other.bounding_radius
            near = np.flatnonzero(np.linalg.norm(T[:, :3, 3], axis=1) < far)
            found[near] = distances.between(a, b, T_a[near], T_b[near], limit)
            return found
        return np.array(
            [between_surfaces(one.corners, other.corners @ each[:3, :3].T + each[:3, 3], limit) for each in T]
        )


def _seen_from(T: np.ndarray, solids: Sequence[Solid]) -> tuple[Solid, ...]:
    return tuple(replace(solid, T=inverse_of_rigid(T[None])[0] @ solid.T) for solid in solids)


def _standing_at(fixed: np.ndarray | None, solid: Solid, at: np.ndarray) -> np.ndarray:
    """Frames (M, 4, 4) of a solid that stands around at poses ``at`` (M,), whose fixed frames are (N, 4, 4)."""
    return np.tile(solid.T, (len(at), 1, 1)) if fixed is None else fixed[at] @ solid.T


def _along(segment: np.ndarray) -> np.ndarray:
    """A frame (4, 4) in the middle of a segment (2, 3), z along it."""
    T, along = np.eye(4), segment[1] - segment[0]
    z = along / np.linalg.norm(along) if along.any() else T[:3, 2]
    x = np.cross(z, np.eye(3)[np.abs(z).argmin()])
    x /= np.linalg.norm(x)
    T[:3, :3], T[:3, 3] = np.column_stack([x, np.cross(z, x), z]), segment.mean(axis=0)
    return T


def bodies_of(
    choice: MechanismBodies | None,
    T_world_base: np.ndarray,
    apart: Sequence[tuple[int, int]],
    ends: Sequence[tuple[np.ndarray, np.ndarray]],
    numeric: Sequence[NumericLeg],
    moves: bool,
) -> Solids | None:
    """The bodies of a document; ``ends``: joints of the legs in closed form at the base and at the platform.

    ``moves``: whether serial joints carry the base, and shapes of legs that stand on it past what is around.

    Raises InputError and ModelError for shapes that cannot be had, and for a serial leg without any.
    """
    if choice is None:
        return None
    platform, around = (
        _standing(environment, field)
        for environment, field in ((choice.platform, "platform"), (choice.environment, "environment"))
    )
    serial = list[LegBodies]()
    for leg in numeric:
        serial.append(leg_bodies(leg, platform, around, ends, serial, moves))
    return Solids(
        choice.link_radius_m,
        choice.margin_m,
        choice.platform_gap_m,
        tuple(standing_solid(each, np.eye(4)) for each in platform),
        tuple(standing_solid(each, T_world_base) for each in around),
        tuple(apart),
        tuple(serial),
    )


def _standing(environment: Environment | None, field: str) -> tuple[Standing, ...]:
    try:
        return shapes_around(environment.items) if environment else ()
    except InputError as error:
        raise error.within(f"mechanism.bodies.{field}") from None
