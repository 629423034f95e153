"""Capsules around a solid, whose union holds it, and capsules inside it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from wsrender.collision.solids import Solid

SIDES = 48  # of the prisms that stand for cylinders
LEVELS = ((1, 2), (2, 3), (3, 4), (4, 6))  # numbers of capsules outside and inside, from coarse to fine
INNER_POINTS, TRIES = 2000, 200
# Where a search for a small capsule ends, of its first steps and of its volume; finer takes twice the time for 0.4 %.
FINE = (3e-2, 1e-3)
STEPS = 300  # of a search at most
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


def covers(solids: Sequence[Solid]) -> list[Cover]:
    """Covers of solids at all levels; together they take a fraction of the time that one by one they do."""
    outer, inner = zip(*LEVELS, strict=True)
    found, polytopes = [_own(solid) for solid in solids], [_polytopes(s) for s in solids if not s.is_round]
    around = iter(outer_capsules([each for each, _ in polytopes], outer))
    within = (inner_capsules(each, inner) for _, each in polytopes)
    return [own or Cover(next(around), next(within), exact=False) for own in found]


def _own(solid: Solid) -> Cover | None:
    """The cover of a round solid."""
    if not solid.is_round:
        return None
    ends = solid.points[[0, -1]]
    capsule = Capsules(ends[:1], ends[1:], np.array([solid.radius]))
    return Cover((capsule,), (capsule,), exact=True)


def outer_covers(solids: Sequence[Solid]) -> list[tuple[Capsules, Capsules]]:
    """Of each solid one capsule that holds it, and two that do; a round solid is its own."""
    found = iter(outer_capsules([_polytopes(solid)[0] for solid in solids if not solid.is_round], (1, 2)))
    covers = []
    for solid in solids:
        one, two = (own.outer * 2) if (own := _own(solid)) else next(found)
        covers.append((one, two))
    return covers


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


def _along(points: np.ndarray, axis: np.ndarray) -> tuple[np.ndarray, float]:
    """Ends (6,) of a capsule about points along an axis through their middle, and its volume [m³]."""
    center = points.mean(axis=0)
    beside = points - center
    along = beside @ axis
    radius = np.linalg.norm(beside - along[:, None] * axis, axis=1).max()
    low, high = along.min() + 0.8 * radius, along.max() - 0.8 * radius
    if low > high:
        low = high = (low + high) / 2
    ends = np.r_[center + low * axis, center + high * axis]
    return ends, _volume(ends[:3], ends[3:], from_segment(points, ends[:3], ends[3:]).max())


def _axes(points: np.ndarray) -> np.ndarray:
    """Principal axes (3, 3) of points, from the longest, in rows."""
    beside = points - points.mean(axis=0)
    return np.linalg.eigh(beside.T @ beside)[1].T[::-1]


def _around(parts: Sequence[np.ndarray]) -> list[tuple[np.ndarray, np.ndarray, float]]:
    """A small capsule around the points of each part: of those along two principal axes, the ends moved, the better."""
    if not parts:
        return []
    farthest = [each[np.unique((_ball() @ each.T).argmax(1))] if len(each) > len(_ball()) else each for each in parts]
    starts = np.array([_along(each, axis)[0] for each in farthest for axis in _axes(each)[:2]])
    spread = np.repeat([0.1 * max(np.ptp(each, axis=0).max(), 1e-6) for each in farthest], 2)
    # Points that are repeated change no capsule.
    filled = np.stack([np.pad(each, ((0, len(_ball()) - len(each)), (0, 0)), mode="edge") for each in farthest])
    ends = _least_volumes(np.repeat(filled.transpose(0, 2, 1), 2, axis=0), starts, spread)
    found = []
    for points, both in zip(parts, ends.reshape(-1, 2, 6), strict=True):
        radii = [float(from_segment(points, each[:3], each[3:]).max()) + TIGHT for each in both]
        capsules = [(each[:3], each[3:], radius) for each, radius in zip(both, radii, strict=True)]
        found.append(min(capsules, key=lambda capsule: _volume(*capsule)))
    return found


def _least_volumes(points: np.ndarray, ends: np.ndarray, spread: np.ndarray) -> np.ndarray:
    """Ends (K, 6) of small capsules around sets of points (K, 3, V), from ``ends`` and steps ``spread`` (K,).

    All at once by the method of Nelder and Mead (1965), as SciPy has it.
    """
    squares = np.einsum("kiv,kiv->kv", points, points)

    def volumes(ends: np.ndarray, of: np.ndarray) -> np.ndarray:
        # As `from_segment` with fewer arrays; what it finds is measured anew.
        a, along = ends[:, :3], ends[:, 3:] - ends[:, :3]
        square, offset = np.maximum((along**2).sum(axis=1), 1e-18)[:, None], (a * along).sum(axis=1)[:, None]
        with_along, with_a = (np.stack([along, a], axis=1) @ points[of]).transpose(1, 0, 2)
        projected = with_along - offset
        t = np.clip(projected / square, 0, 1)
        apart = squares[of] - 2 * with_a - t * (2 * projected - t * square)
        radius = np.sqrt(np.maximum(apart.max(axis=1) + (a**2).sum(axis=1), 0))
        return math.pi * radius**2 * (np.linalg.norm(along, axis=1) + 4 / 3 * radius)

    best, of = ends.copy(), np.arange(len(ends))
    corners = ends[:, None] + spread[:, None, None] * np.vstack([np.zeros(6), np.eye(6)])
    values = volumes(corners.reshape(-1, 6), np.repeat(of, 7)).reshape(-1, 7)
    fine_steps, fine_values = FINE[0] * spread, FINE[1] * values[:, 0]
    for step in range(STEPS + 1):
        order = values.argsort(axis=1)
        values, corners = np.take_along_axis(values, order, 1), np.take_along_axis(corners, order[..., None], 1)
        small = np.abs(corners[:, 1:] - corners[:, :1]).max(axis=(1, 2)) <= fine_steps[of]
        done = small & (values[:, -1] - values[:, 0] <= fine_values[of]) | (step == STEPS)
        best[of[done]] = corners[done, 0]
        corners, values, of = corners[~done], values[~done], of[~done]
        if not len(of):
            break
        middle, worst = corners[:, :-1].mean(axis=1), corners[:, -1]
        mirrored = 2 * middle - worst
        value = volumes(mirrored, of)
        farther, nearer = value < values[:, 0], value >= values[:, -2]
        # How far from the middle, in what the worst corner is from it: on beyond, half the way, or half back.
        by = np.where(farther, 2.0, np.where(value < values[:, -1], 0.5, -0.5))
        tried = middle + by[:, None] * (middle - worst)
        other = np.full(len(of), np.inf)
        asked = farther | nearer
        other[asked] = volumes(tried[asked], of[asked])
        taken = asked & (other < np.where(by < 0, values[:, -1], value))
        shrunk = nearer & ~taken
        corners[:, -1] = np.where(taken[:, None], tried, mirrored)
        values[:, -1] = np.where(taken, other, value)
        if shrunk.any():
            corners[shrunk, -1] = worst[shrunk]
            corners[shrunk] = (corners[shrunk] + corners[shrunk, :1]) / 2
            own = volumes(corners[shrunk, 1:].reshape(-1, 6), np.repeat(of[shrunk], 6))
            values[shrunk, 1:] = own.reshape(-1, 6)
    return best


def _edges(points: np.ndarray) -> np.ndarray:
    """Edges (E, 2) of the hull of points, by their numbers."""
    try:
        edges = np.sort(ConvexHull(points).simplices[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        return np.unique(edges, axis=0)
    except QhullError:  # a part without volume: any two of its points are an edge
        return np.stack(np.triu_indices(len(points), 1), axis=1)


def _cut(points: np.ndarray, edges: np.ndarray, height: np.ndarray, offset: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices of the parts of a polytope on the two sides of a plane, above which its vertices are by ``height``."""
    above = height - offset
    first, second = edges[above[edges[:, 0]] * above[edges[:, 1]] < 0].T
    share = (above[first] / (above[first] - above[second]))[:, None]
    crossing = points[first] * (1 - share) + points[second] * share
    return np.vstack([points[above <= 0], crossing]), np.vstack([points[above > 0], crossing])


def outer_capsules(polytopes: Sequence[np.ndarray], counts: tuple[int, ...]) -> list[tuple[Capsules, ...]]:
    """For each of the ascending counts so many capsules that together hold the convex hull of ``points`` (V, 3).

    Of each of the polytopes. It is cut by planes; a capsule is convex, so that one which holds the vertices of a part
    holds the part.
    """
    parts = [[each] for each in zip(polytopes, _around(polytopes), strict=True)]
    found: list[list[Capsules]] = [[] for _ in parts]
    for count in range(1, max(counts) + 1):
        if count > 1:
            cuts = [each for own in parts for each in _halves(_largest(own))]
            for number, each in enumerate(zip(cuts, _around(cuts), strict=True)):
                parts[number // 2].append(each)
        for own, capsules in zip(parts, found, strict=True):
            capsules += [_stacked([capsule for _, capsule in own])] * counts.count(count)
    return [tuple(each) for each in found]


def _largest(parts: list[tuple[np.ndarray, tuple[np.ndarray, np.ndarray, float]]]) -> np.ndarray:
    """The points of the part with the largest capsule, which is taken out of the list."""
    return parts.pop(int(np.argmax([_volume(*capsule) for _, capsule in parts])))[0]


def _halves(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two parts of a polytope that small capsules hold, of cuts across its principal axes."""
    edges, cuts = _edges(points), []
    for normal in _axes(points):
        height = points @ normal
        for share in (0.35, 0.5, 0.65):
            two = _cut(points, edges, height, height.min() + share * np.ptp(height))
            if all(map(len, two)):
                cuts.append((sum(_along(part, _axes(part)[0])[1] for part in two), two))
    return min(cuts, key=lambda each: each[0])[1]


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

    # Which points a capsule holds is asked of many, for which single precision is enough; its radius in double.
    middle = (low + high) / 2
    single = (drawn - middle).astype(np.float32)

    def depth(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return (offsets - np.maximum(a @ normals.T, b @ normals.T)).min(axis=-1) - TIGHT

    def held(a: np.ndarray, b: np.ndarray, pool: np.ndarray) -> np.ndarray:
        ends = ((end - middle).astype(np.float32) for end in (a, b))
        return (_segment_distances(pool, *ends) <= depth(a, b)[:, None].astype(np.float32)).sum(axis=1)

    while len(capsules) < max(counts) and left.any():
        pool = single[left]
        ends = [each[random.integers(len(each), size=TRIES)] for each in (drawn, drawn[left])]
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
    """Distances (S, N) of points (N, 3) from segments between a and b (S, 3), to 1e-7 of where they are in float64."""
    along = b - a
    square, offset = np.maximum((along**2).sum(axis=1), 1e-18)[:, None], (a * along).sum(axis=1)[:, None]
    projected = along @ points.T
    projected -= offset
    t = projected / square
    np.minimum(np.maximum(t, 0, out=t), 1, out=t)
    # Of |p - a - t along|²: no array (S, N, 3).
    found = t * square
    found -= 2 * projected
    found *= t
    found -= 2 * a @ points.T
    found += (points**2).sum(axis=1)
    found += (a**2).sum(axis=1)[:, None]
    return np.sqrt(np.maximum(found, 0, out=found), out=found)


def _stacked(capsules: list[tuple[np.ndarray, np.ndarray, float]]) -> Capsules:
    if not capsules:
        return Capsules(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0))
    a, b, radius = zip(*capsules, strict=True)
    return Capsules(np.array(a), np.array(b), np.array(radius))
