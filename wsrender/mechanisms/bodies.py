"""Solids of a mechanism: links and cranks as capsules, what the platform carries, and what stands around.

They keep apart as MuJoCo's shapes do: a crank from its own link never, nor legs that share a joint. A link that ends at
the platform touches it there: of it what is farther along than a gap keeps apart, or nothing without a gap.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.collision.distance import Distances
from wsrender.collision.solids import BASE, Solid
from wsrender.documents.environment import Environment
from wsrender.documents.mechanism import MechanismBodies
from wsrender.errors import InputError
from wsrender.mechanisms.surfaces import between_surfaces, from_surface
from wsrender.pipeline.constraints.leg_distance import segment_distance
from wsrender.robot.collisions import standing_solid
from wsrender.robot.surroundings import shapes_around

BEYOND = 1e-3  # [m] beyond the margin up to which distances are asked
TRIANGLES, PAIRS = 1.4e3, 1.5e5  # of surfaces, and of two of them, that take as long as all other bodies of a mechanism


@dataclass(frozen=True, eq=False)
class Solids:
    """Solids in the frames of the ``platform`` and of the base, ``around``; capsules of ``radius_m`` along the legs.

    ``apart``: pairs of legs that share no joint; ``gap_m``: None where links may touch the platform.
    """

    radius_m: float
    margin_m: float
    gap_m: float | None
    platform: tuple[Solid, ...]
    around: tuple[Solid, ...]
    apart: tuple[tuple[int, int], ...]
    name: str = "collision"

    @property
    def effort(self) -> float:
        """How many times as long a pose takes as of bodies without surfaces."""
        own, other = (
            sum(len(solid.faces) for solid in solids if solid.faces is not None)
            for solids in (self.platform, self.around)
        )
        return 1 + (own + other) / TRIANGLES + own * other / PAIRS

    def collisions(self, legs: Sequence[dict[str, np.ndarray]], poses: np.ndarray) -> tuple[np.ndarray, list[str]]:
        """Number, from 1, of the first pair of bodies that collides at poses (N, 4, 4), base frame, or 0, (N,); names.

        ``legs``: of each leg its "link" and perhaps its "crank", (N, 2, 3) [m], the link towards the platform.
        """
        found, names = np.zeros(len(poses), np.int64), list[str]()
        capsule = Solid("", "capsule", BASE, np.eye(4), np.array([self.radius_m, 1.0, 0.0]))
        distances = Distances((capsule, *self.platform, *self.around))
        first_around, solids = 1 + len(self.platform), distances.solids

        def frames(k: int, at: np.ndarray) -> np.ndarray:
            return poses[at] @ solids[k].T if k < first_around else np.tile(solids[k].T, (len(at), 1, 1))

        def ask(pair: str, gaps: Any) -> None:
            left = np.flatnonzero(found == 0)
            names.append(pair)
            found[left[gaps(left) < self.margin_m]] = len(names)

        for a, b in self.apart:
            for (of_a, one), (of_b, other) in ((p, q) for p in legs[a].items() for q in legs[b].items()):
                ask(
                    f"the {of_a} of leg {a + 1} and the {of_b} of leg {b + 1}",
                    lambda at, p=one, q=other: (
                        segment_distance(p[at, 0], p[at, 1], q[at, 0], q[at, 1]) - 2 * self.radius_m
                    ),
                )
        for number, leg in enumerate(legs):
            for part, segment in leg.items():
                for k in range(1, len(solids)):
                    own = self._short_of_gap(segment) if part == "link" and k < first_around else segment
                    if own is not None:
                        ask(
                            f"the {part} of leg {number + 1} and {solids[k].name}",
                            lambda at, k=k, own=own: self._to_capsules(distances, k, own[at], frames(k, at)),
                        )
        for a in range(1, first_around):
            for b in range(first_around, len(solids)):
                ask(
                    f"{solids[a].name} and {solids[b].name}",
                    lambda at, a=a, b=b: self._between(distances, a, b, frames(a, at), frames(b, at)),
                )
        return found, names

    def _short_of_gap(self, link: np.ndarray) -> np.ndarray | None:
        """The links (N, 2, 3) up to the gap before their ends at the platform; None where they may touch it."""
        if self.gap_m is None:
            return None
        along = link[:, 1] - link[:, 0]
        kept = np.maximum(1 - self.gap_m / np.linalg.norm(along, axis=1), 0)
        return np.stack([link[:, 0], link[:, 0] + kept[:, None] * along], axis=1)

    def _to_capsules(self, distances: Distances, k: int, segments: np.ndarray, T: np.ndarray) -> np.ndarray:
        """Distances (N,) of a solid with frames (N, 4, 4) from capsules along segments (N, 2, 3), far ones cut."""
        solid, r = distances.solids[k], self.radius_m
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
            return distances.between(a, b, T_a, T_b, limit)
        return np.array(
            [between_surfaces(one.corners, other.corners @ each[:3, :3].T + each[:3, 3], limit) for each in T]
        )


def _along(segment: np.ndarray) -> np.ndarray:
    """A frame (4, 4) in the middle of a segment (2, 3), z along it."""
    T, along = np.eye(4), segment[1] - segment[0]
    z = along / np.linalg.norm(along) if along.any() else T[:3, 2]
    x = np.cross(z, np.eye(3)[np.abs(z).argmin()])
    x /= np.linalg.norm(x)
    T[:3, :3], T[:3, 3] = np.column_stack([x, np.cross(z, x), z]), segment.mean(axis=0)
    return T


def bodies_of(
    choice: MechanismBodies | None, T_world_base: np.ndarray, apart: Sequence[tuple[int, int]]
) -> Solids | None:
    """The bodies of a document; raises InputError and ModelError for shapes that cannot be had."""
    if choice is None:
        return None
    platform, around = (
        tuple(standing_solid(each, T) for each in _standing(environment, field))
        for environment, field, T in (
            (choice.platform, "platform", np.eye(4)),
            (choice.environment, "environment", T_world_base),
        )
    )
    return Solids(choice.link_radius_m, choice.margin_m, choice.platform_gap_m, platform, around, tuple(apart))


def _standing(environment: Environment | None, field: str) -> tuple[Any, ...]:
    try:
        return shapes_around(environment.items) if environment else ()
    except InputError as error:
        raise error.within(f"mechanism.bodies.{field}") from None
