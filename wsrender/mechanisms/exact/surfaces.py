"""A batch of ball regions of one make-up, scaled to unit size and its surfaces moved apart by a hair."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wsrender.errors import InputError
from wsrender.mechanisms.ball_region import BallRegion
from wsrender.mechanisms.exact.combinatorics import Combinatorics, combinatorics

# Coincident, tangent and concurrent surfaces are told apart by moving each by its own share of this length, relative
# to the largest radius: the region becomes generic, its volume changes by as much times its area. Rounding of a point
# on three surfaces is 1e-15, or 1e-15 / √(this) where they nearly touch, far less than what the move then opens.
APART = 1e-11
POINTLIKE = 1e-8  # radius of a ball, relative to the largest, that has no surface worth looking at


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
