"""A batch of ball regions of one make-up, scaled to unit size and its surfaces moved apart by a hair.

Which surfaces meet in which circles and vertices depends on the numbers of surfaces alone.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import combinations

import numpy as np

from wsrender.errors import InputError
from wsrender.mechanisms.ball_region import BallRegion

# Coincident, tangent and concurrent surfaces are told apart by moving each by its own share of this length, relative
# to the largest radius: the region becomes generic, its volume changes by as much times its area. Rounding of a point
# on three surfaces is 1e-15, or 1e-15 / √(this) where they nearly touch, far less than what the move then opens.
APART = 1e-11
POINTLIKE = 1e-8  # radius of a ball, relative to the largest, that has no surface worth looking at


@dataclass(frozen=True, eq=False)
class Combinatorics:
    """Index tables of K surfaces: first the spheres, then the planes.

    ``pairs`` (Q, 2), first below second, are the circles (lines between two planes; parallel planes have none).
    ``triples`` (T, 3), ascending, meet in at most two points where the first is a sphere; three planes of different
    axes meet in one. ``columns`` of candidate vertices (N): the + points of the sphere triples, their − points, then
    the corners. Of every column: ``circles`` (N, 3), the pairs (first, second), (first, third), (second, third);
    ``entering`` (N, 3), whether going along that circle the vertex is where one comes into what the remaining surface
    allows; ``own`` (N, K), the three surfaces. One goes along first normal × second normal, the normals pointing away
    from centres and out of half spaces.
    """

    pairs: np.ndarray
    is_line: np.ndarray
    sphere_circles: np.ndarray
    corners: np.ndarray
    circles: np.ndarray
    entering: np.ndarray
    own: np.ndarray
    pair_own: np.ndarray


@lru_cache(maxsize=64)
def combinatorics(side: tuple[int, ...], planes: tuple[tuple[int, int], ...]) -> Combinatorics:
    """Tables of spheres of these sides (+1: inside, −1: outside) and planes of (axis 0, 1 or 2, sign of the normal)."""
    spheres, count = len(side), len(side) + len(planes)
    sides = np.array((*side, *(1 for _ in planes)))
    normals = np.array([np.eye(3)[axis] * sign for axis, sign in planes]).reshape(-1, 3)

    def meet(*surfaces: int) -> bool:
        axes = [planes[k - spheres][0] for k in surfaces if k >= spheres]
        return len(set(axes)) == len(axes)

    pairs = np.array([pair for pair in combinations(range(count), 2) if meet(*pair)], int).reshape(-1, 2)
    number = np.full((count, count), -1)
    number[tuple(pairs.T)] = np.arange(len(pairs))
    triples = np.array([triple for triple in combinations(range(count), 3) if meet(*triple)], int).reshape(-1, 3)
    is_corner = triples[:, 0] >= spheres
    of_sphere, corners = triples[~is_corner], triples[is_corner]
    columns = np.concatenate([of_sphere, of_sphere, corners])
    at_corners = np.linalg.det(normals[corners - spheres]) if len(corners) else np.zeros(0)
    branch = np.sign(np.concatenate([np.ones(len(of_sphere)), -np.ones(len(of_sphere)), at_corners]))
    i, j, k = columns.T  # branch: sign of det(n_i, n_j, n_k)
    return Combinatorics(
        pairs,
        pairs[:, 0] >= spheres,
        _circles(number, of_sphere),
        corners,
        _circles(number, columns),
        # A point that goes along n_i × n_j leaves the k-th ball or half space at the rate det(n_i, n_j, n_k).
        np.stack([-branch * sides[k], branch * sides[j], -branch * sides[i]], axis=1) > 0,
        _membership(columns, count),
        _membership(pairs, count),
    )


def _circles(number: np.ndarray, triples: np.ndarray) -> np.ndarray:
    i, j, k = triples.T
    return np.stack([number[i, j], number[i, k], number[j, k]], axis=1)


def _membership(groups: np.ndarray, count: int) -> np.ndarray:
    own = np.zeros((len(groups), count), bool)
    own[np.arange(len(groups))[:, None], groups] = True
    return own


@dataclass(frozen=True, eq=False)
class Surfaces:
    """M regions of S spheres and P axis-aligned planes, each about its own ``origin`` in units of its ``scale`` [m].

    ``centres`` (M, S, 3), ``radii`` (M, S); ``side`` (S,) is +1 where the region is inside the sphere, −1 where
    outside. ``normals`` (P, 3) point out of the half spaces x·n ≤ ``offsets`` (M, P). ``moves`` (K,): how far each
    surface was moved into the region, scaled; 0: not at all.
    """

    centres: np.ndarray
    radii: np.ndarray
    side: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    origin: np.ndarray
    scale: np.ndarray
    moves: np.ndarray | float = 0.0

    def __len__(self) -> int:
        return len(self.centres)

    @property
    def spheres(self) -> int:
        """Number S of spheres of a region."""
        return len(self.side)

    @property
    def count(self) -> int:
        """Number K = S + P of surfaces of a region."""
        return len(self.side) + len(self.normals)

    @cached_property
    def sides(self) -> np.ndarray:
        """Sides (K,) of all surfaces; a half space counts as an inside."""
        return np.concatenate([self.side, np.ones(len(self.normals))])

    @cached_property
    def combinatorics(self) -> Combinatorics:
        """Which surfaces meet where."""
        axes = np.abs(self.normals).argmax(axis=1)
        signs = self.normals.sum(axis=1)
        planes = tuple((int(axis), int(sign)) for axis, sign in zip(axes, signs, strict=True))
        return combinatorics(tuple(int(s) for s in self.side), planes)

    @cached_property
    def is_curved(self) -> np.ndarray:
        """Whether a sphere (M, S) is more than a point."""
        return self.radii > POINTLIKE

    def allowed(self, points: np.ndarray) -> np.ndarray:
        """Whether points (M, N, 3) satisfy each constraint, (M, N, K)."""
        c, r = self.centres, self.radii
        powers = (points**2).sum(axis=2)[:, :, None] - 2 * points @ c.transpose(0, 2, 1)
        powers += ((c**2).sum(axis=2) - r**2)[:, None]
        return np.concatenate(
            [powers * self.side <= 0, points @ self.normals.T <= self.offsets[:, None]], axis=2, dtype=bool
        )

    def part(self, regions: np.ndarray) -> "Surfaces":
        """Some of the regions."""
        fields = (self.centres, self.radii, self.offsets, self.origin, self.scale)
        centres, radii, offsets, origin, scale = (field[regions] for field in fields)
        return Surfaces(centres, radii, self.side, self.normals, offsets, origin, scale, self.moves)

    def moved_apart(self, attempt: int = 0) -> "Surfaces":
        """The same surfaces, each moved into the region by its own small length; other lengths at each attempt."""
        # Random ones: a regular sequence has equal differences, and keeps symmetric surfaces concurrent.
        shares = np.random.default_rng(attempt).uniform(0.5, 1.0, self.count)
        moves = APART * 10**attempt * shares
        radii = self.radii - self.side * moves[: self.spheres]
        offsets = self.offsets - moves[self.spheres :]
        # Balls that are points stay points: a region inside one is empty, one outside is none the smaller.
        radii = np.where(self.is_curved, radii, 0.0)
        return Surfaces(self.centres, radii, self.side, self.normals, offsets, self.origin, self.scale, moves)


def make_up(region: BallRegion) -> tuple:
    """What regions of one batch have in common: numbers of balls and finite sides of the box."""
    finite = (*np.isfinite(region.lower), *np.isfinite(region.upper))
    return len(region.inside_radii), len(region.outside_radii), finite


def surfaces_of(regions: Sequence[BallRegion]) -> Surfaces:
    """The surfaces of regions of one make-up; InputError where they are unbounded."""
    first = regions[0]
    if not len(first.inside_radii) and not np.isfinite([first.lower, first.upper]).all():
        raise InputError("inside_radii", "is empty and the box is not finite: the region is unbounded")
    centres = np.array([np.concatenate([r.inside_centres, r.outside_centres]).reshape(-1, 3) for r in regions])
    radii = np.array([np.concatenate([r.inside_radii, r.outside_radii]) for r in regions])
    side = np.concatenate([np.ones(len(first.inside_radii)), -np.ones(len(first.outside_radii))])
    normals, _ = first.sides_of_box()
    bounds = np.array([region.sides_of_box()[1] for region in regions])
    inside = side > 0
    if inside.any():
        origin, scale = centres[:, inside].mean(axis=1), radii[:, inside].max(axis=1)
    else:
        lower, upper = (np.array([getattr(r, name) for r in regions]) for name in ("lower", "upper"))
        origin, scale = (lower + upper) / 2, np.linalg.norm(upper - lower, axis=1)
    scale = np.where(scale > 0, scale, 1.0)
    return Surfaces(
        (centres - origin[:, None]) / scale[:, None, None],
        np.maximum(radii / scale[:, None], 0.0),
        side,
        normals,
        (bounds - origin @ normals.T) / scale[:, None],
        origin,
        scale,
    )
