"""Capsules around a solid, whose union holds it, and capsules inside it."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.optimize import minimize
from scipy.spatial import ConvexHull, QhullError

from wsrender.collision.solids import Solid

SIDES = 48  # of the prisms that stand for cylinders
LEVELS = ((1, 2), (2, 3), (3, 4), (4, 6))  # numbers of capsules outside and inside, from coarse to fine
INNER_POINTS, TRIES = 2000, 200
# Where a search for a small capsule ends, of its first steps and of its volume; finer takes twice the time for 0.4 %.
FINE = (3e-2, 1e-3)
TIGHT = 1e-9  # by which capsules outside are widened and those inside are narrowed, for rounding [m]


@dataclass(frozen=True, eq=False)
class Capsules:
    """Ends ``a`` and ``b`` (C, 3) of their axes and ``radius`` (C,) [m], in the frame of the solid."""

    a: np.ndarray
    b: np.ndarray
    radius: np.ndarray

    def __len__(self) -> int:
        return len(self.radius)


@dataclass(frozen=True, eq=False)
class Cover:
    """Of a solid, by level: capsules that hold it, and capsules that it holds. A round one is its own cover."""

    outer: tuple[Capsules, ...]
    inner: tuple[Capsules, ...]
    exact: bool


def cover(solid: Solid) -> Cover:
    """Covers of a solid at all levels."""
    if solid.is_round:
        ends = solid.points[[0, -1]]
        own = Capsules(ends[:1], ends[1:], np.array([solid.radius]))
        return Cover((own,), (own,), exact=True)
    around, within = _polytopes(solid)
    outer, inner = zip(*LEVELS, strict=True)
    return Cover(outer_capsules(around, outer), inner_capsules(within, inner), exact=False)


def outer_cover(solid: Solid) -> tuple[Capsules, Capsules]:
    """One capsule that holds a solid, and two that do; a round solid is its own."""
    if solid.is_round:
        (own,) = cover(solid).outer
        return own, own
    one, two = outer_capsules(_polytopes(solid)[0], (1, 2))
    return one, two


def _polytopes(solid: Solid) -> tuple[np.ndarray, np.ndarray]:
    """Vertices of a polytope around a solid and of one within it."""
    if solid.kind == "cylinder":
        angle = 2 * np.pi * np.arange(SIDES) / SIDES
        ring = np.column_stack([np.cos(angle), np.sin(angle)]) * solid.size[0]
        ends = [np.column_stack([ring, np.full(SIDES, z)]) for z in (-solid.size[1], solid.size[1])]
        within = np.concatenate(ends)
        return within * [1 / np.cos(np.pi / SIDES)] * np.array([1, 1, np.cos(np.pi / SIDES)]), within
    if solid.kind == "ellipsoid":
        ball = _ball()
        depth = -ConvexHull(ball).equations[:, 3].max()
        return ball * solid.size / depth, ball * solid.size
    hull = ConvexHull(solid.points)
    return solid.points[hull.vertices], solid.points[hull.vertices]


@cache
def _ball() -> np.ndarray:
    """162 points on the unit sphere (Fibonacci's lattice)."""
    k = np.arange(162) + 0.5
    z, angle = 1 - 2 * k / 162, np.pi * (1 + 5**0.5) * k
    across = np.sqrt(1 - z**2)
    return np.column_stack([across * np.cos(angle), across * np.sin(angle), z])


def from_segment(points: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Distances (N,) of points (N, 3) from the segment between a and b (3,)."""
    along = b - a
    t = np.clip((points - a) @ along / max(along @ along, 1e-18), 0, 1)
    apart = points - a - t[:, None] * along
    return np.sqrt(np.einsum("ni,ni->n", apart, apart))


def _volume(a: np.ndarray, b: np.ndarray, radius: float) -> float:
    return math.pi * float(radius) ** 2 * (math.dist(a, b) + 4 / 3 * float(radius))


def _around(points: np.ndarray, thorough: bool) -> tuple[np.ndarray, np.ndarray, float]:
    """A small capsule around points: from those along their principal axes, the ends moved (Nelder and Mead 1965)."""
    all_points, center = points, points.mean(axis=0)
    axes, found = np.linalg.svd(points - center, full_matrices=False)[2], []
    if len(points) > len(_ball()):
        points = points[np.unique((_ball() @ points.T).argmax(axis=1))]

    # As `from_segment` in fewer calls, for a search asks thousands of times; its answer is measured anew.
    squares = np.einsum("ni,ni->n", points, points)

    def volume(ends: np.ndarray) -> float:
        a, b = ends[:3], ends[3:]
        along = b - a
        square, offset = max(float(along @ along), 1e-18), a @ along
        projected = points @ along - offset
        t = np.minimum(np.maximum(projected / square, 0), 1)
        apart = squares - 2 * (points @ a) + a @ a - t * (2 * projected - t * square)
        return _volume(a, b, max(float(apart.max()), 0.0) ** 0.5)

    for axis in axes[: 2 if thorough else 1]:
        along = (points - center) @ axis
        radius = np.linalg.norm(points - center - along[:, None] * axis, axis=1).max()
        low, high = along.min() + 0.8 * radius, along.max() - 0.8 * radius
        if low > high:
            low = high = (low + high) / 2
        ends = np.r_[center + low * axis, center + high * axis]
        if thorough:
            spread = 0.1 * max(np.ptp(points, axis=0).max(), 1e-6)
            simplex = np.vstack([ends, ends + spread * np.eye(6)])
            fine = {"xatol": FINE[0] * spread, "fatol": FINE[1] * volume(ends)}
            options = {"maxiter": 300, "initial_simplex": simplex} | fine
            ends = minimize(volume, ends, method="Nelder-Mead", options=options).x
        found.append((volume(ends), ends))
    ends = min(found, key=lambda each: each[0])[1]
    return ends[:3], ends[3:], float(from_segment(all_points, ends[:3], ends[3:]).max()) + TIGHT


def _cut(points: np.ndarray, normal: np.ndarray, offset: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices of the parts of a polytope on the two sides of a plane."""
    try:
        edges = np.sort(ConvexHull(points).simplices[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges = np.unique(edges, axis=0)
    except QhullError:  # a part without volume: any two of its points are an edge
        edges = np.stack(np.triu_indices(len(points), 1), axis=1)
    height = points @ normal - offset
    first, second = edges[height[edges[:, 0]] * height[edges[:, 1]] < 0].T
    share = (height[first] / (height[first] - height[second]))[:, None]
    crossing = points[first] * (1 - share) + points[second] * share
    return np.vstack([points[height <= 0], crossing]), np.vstack([points[height > 0], crossing])


def outer_capsules(points: np.ndarray, counts: tuple[int, ...]) -> tuple[Capsules, ...]:
    """For each of the ascending counts so many capsules that together hold the convex hull of ``points`` (V, 3).

    The hull is cut by planes; a capsule is convex, so that one which holds the vertices of a part holds the part.
    """
    parts, found = [(points, _around(points, True))], []
    for count in counts:
        while len(parts) < count:
            sizes = [_volume(*capsule) for _, capsule in parts]
            largest, _ = parts.pop(int(np.argmax(sizes)))
            cuts = []
            for normal in np.linalg.svd(largest - largest.mean(axis=0), full_matrices=False)[2]:
                height = largest @ normal
                for share in (0.35, 0.5, 0.65):
                    two = _cut(largest, normal, height.min() + share * np.ptp(height))
                    quick = [_around(part, False) for part in two if len(part)]
                    if len(quick) == 2:
                        cuts.append((sum(_volume(*capsule) for capsule in quick), two))
            parts += [(part, _around(part, True)) for part in min(cuts, key=lambda each: each[0])[1]]
        found.append(_stacked([capsule for _, capsule in parts]))
    return tuple(found)


def inner_capsules(points: np.ndarray, counts: tuple[int, ...]) -> tuple[Capsules, ...]:
    """For each of the counts at most so many capsules within the hull of ``points``: their ends as deep as their radii.

    Each holds as many as it can of points that no other holds, by random tries and steps that shrink.
    """
    hull, random = ConvexHull(points), np.random.default_rng(0)
    normals, offsets = hull.equations[:, :3], -hull.equations[:, 3]
    low, high = points.min(axis=0), points.max(axis=0)
    drawn = low + (high - low) * random.random((4 * INNER_POINTS, 3))
    drawn = drawn[(drawn @ normals.T <= offsets).all(axis=1)][:INNER_POINTS]
    left, capsules = np.ones(len(drawn), bool), []

    def depth(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return (offsets - np.maximum(a @ normals.T, b @ normals.T)).min(axis=-1) - TIGHT

    def held(a: np.ndarray, b: np.ndarray, pool: np.ndarray) -> np.ndarray:
        inside = _segment_distances(pool, a, b) <= depth(a, b)[:, None]
        return inside.sum(axis=1)

    while len(capsules) < max(counts) and left.any():
        pool = drawn[left]
        ends = [each[random.integers(len(each), size=TRIES)] for each in (drawn, pool)]
        a, b = np.where(random.random((TRIES, 1)) < 0.5, *ends), drawn[random.integers(len(drawn), size=TRIES)]
        score = held(a, b, pool)
        best, step = score.argmax(), 0.2 * (high - low).max()
        a, b, most = a[best], b[best], score[best]
        for _ in range(20):
            near_a, near_b = (end + step * random.normal(size=(20, 3)) for end in (a, b))
            score = held(near_a, near_b, pool)
            if score.max() > most:
                best = score.argmax()
                a, b, most = near_a[best], near_b[best], score[best]
            else:
                step *= 0.75
        radius = float(depth(a, b))
        if radius <= 0 or most <= 0:
            break
        capsules.append((a, b, radius))
        left &= from_segment(drawn, a, b) > radius
    return tuple(_stacked(capsules[:count]) for count in counts)


def _segment_distances(points: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Distances (S, N) of points (N, 3) from segments between a and b (S, 3), to 1e-7 of where they are."""
    along = b - a
    square, offset = np.maximum((along**2).sum(axis=1), 1e-18)[:, None], (a * along).sum(axis=1)[:, None]
    projected = along @ points.T - offset
    t = np.clip(projected / square, 0, 1)
    # Of |p - a - t along|²: no array (S, N, 3).
    from_a = (points**2).sum(axis=1) - 2 * a @ points.T + (a**2).sum(axis=1)[:, None]
    return np.sqrt(np.maximum(from_a - t * (2 * projected - t * square), 0))


def _stacked(capsules: list[tuple[np.ndarray, np.ndarray, float]]) -> Capsules:
    if not capsules:
        return Capsules(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0))
    a, b, radius = zip(*capsules, strict=True)
    return Capsules(np.array(a), np.array(b), np.array(radius))
