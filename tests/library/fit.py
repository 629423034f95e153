"""Shapes that contain a mesh: ``python -m tests.library.fit MESH …``; prints MJCF and by how much they exceed it.

About the axes of joints, where they are known, cylinders are tried; about what they do not contain up to three
capsules, cylinders or boxes in a row. Those that hold least together are taken. The mesh is cut into small triangles,
each of which is in one shape, so they contain it; numbers are rounded outwards, to 0.1 mm.
"""

import itertools
import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
import trimesh
from scipy.spatial import ConvexHull, QhullError, cKDTree

ROUND = 1e4  # per metre
EDGES = 25  # of small triangles along the mesh
RADII = 5  # of housings about an axis that are tried
ALIKE = 0.001  # [m] between radii of one housing's triangles
BEST = 3  # choices of housings about whose rest more than one shape is tried
CUTS = 6  # planes that are tried
SPLITS = 4  # planes across each axis that are tried where a part is cut in two
EACH = 0.02  # of the volume of one shape: what another must save
PROBES = 2048  # points by which the volume of shapes that overlap is measured
MARGIN = 0.05  # [m] around the mesh, where the probes are
SPACING = 0.008  # [m] edges of the triangles by which a shape is measured
SAMPLES = 30_000  # points of the mesh


@dataclass(frozen=True)
class Shape:
    """A capsule or cylinder (``size`` its radius and half length) or a box (half lengths), in the mesh's frame."""

    kind: str
    size: tuple[float, ...]  # [m]
    center: tuple[float, float, float]  # [m]
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)  # of a capsule or cylinder; boxes stand along the frame

    @property
    def volume(self) -> float:
        """In m³."""
        if self.kind == "box":
            return 8 * math.prod(self.size)
        radius, half = self.size
        return math.pi * radius**2 * (2 * half + (4 / 3 * radius if self.kind == "capsule" else 0.0))

    @cached_property
    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        """Of the segment of a capsule or cylinder, each (3,)."""
        c, d = np.array(self.center), np.array(self.axis) * self.size[1]
        return c - d, c + d

    def depth(self, points: np.ndarray) -> np.ndarray:
        """How far points (N, 3) are inside of what is written (N,) [m]; negative outside."""
        if self.kind == "box":
            return (np.array(self.size) - np.abs(points - np.array(self.center))).min(axis=1)
        a, b = self.ends
        length = np.dot(b - a, b - a)
        if self.kind == "cylinder":
            d = (b - a) / math.sqrt(length)
            along = (points - (a + b) / 2) @ d
            off = np.linalg.norm(points - (a + b) / 2 - along[:, None] * d, axis=1)
            return np.minimum(self.size[0] - off, math.sqrt(length) / 2 - np.abs(along))
        s = np.clip((points - a) @ (b - a) / length, 0, 1) if length else np.zeros(len(points))
        return self.size[0] - np.linalg.norm(points - a - s[:, None] * (b - a), axis=1)

    def mjcf(self) -> dict[str, str]:
        """Attributes of a ``<geom>``; a capsule without a length is a sphere."""
        if self.kind == "box":
            return {"type": "box", "size": _words(self.size), "pos": _words(self.center)}
        a, b = self.ends
        if np.allclose(a, b):
            return {"type": "sphere", "size": _words(self.size[:1]), "pos": _words(a)}
        return {"type": self.kind, "size": _words(self.size[:1]), "fromto": _words([*a, *b])}


def fit(mesh: trimesh.Trimesh, axes: Sequence[tuple[np.ndarray, np.ndarray]] = (), parts: int = 0) -> list[Shape]:
    """Shapes of which one or another contains each of the mesh's triangles, made small.

    ``axes``: of its joints, each a point and a direction (3,), about which housings are. ``parts``: what is no housing
    is besides cut in two again and again, across any axis, into at most so many parts: for a body that is not convex.
    """
    edge = float(np.max(mesh.extents)) / EDGES
    corners = np.asarray(mesh.subdivide_to_size(edge, max_iter=20).triangles)
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    probes = np.random.default_rng(0).uniform(low - MARGIN, high + MARGIN, (PROBES, 3))
    each = EACH * _held(_smallest(corners), probes).bit_count()

    def cost(shapes: list[Shape]) -> float:
        held = 0
        for shape in shapes:
            held |= _held(shape, probes)
        return held.bit_count() + each * len(shapes)

    starts = []
    for housings in itertools.product(*([None, *_housings(corners, *axis)] for axis in axes)):
        found = [shape for shape in housings if shape is not None]
        rest = corners
        for shape in found:
            rest = rest[~_inside(shape, rest)]
        starts.append((found, rest))
    starts.sort(key=lambda start: cost([*start[0], *([_smallest(start[1])] if len(start[1]) else [])]))
    ways = [[*found, *row] for found, rest in starts[:BEST] for row in _rows(rest)]
    if parts:
        ways += [[*starts[0][0], *cut] for cut in _cuts(starts[0][1], parts)]
        each /= parts
    return min(ways, key=cost)


def _cuts(corners: np.ndarray, parts: int) -> Iterator[list[Shape]]:
    """Shapes about two and more parts of all triangles: always the cut that saves most volume is made next.

    One that saves nothing too: the cut after it may.
    """
    if len(corners) == 0:
        return
    whole = _smallest(corners)
    held = [(whole, corners, _halves(whole, corners))]
    while len(held) < parts:
        k = max(range(len(held)), key=lambda i: held[i][2][0])
        _, halves = held.pop(k)[2]
        if not halves:
            return
        held += [(shape, part, _halves(shape, part)) for shape, part in halves]
        yield [shape for shape, _, _ in held]


def _halves(shape: Shape, corners: np.ndarray) -> tuple[float, list[tuple[Shape, np.ndarray]]]:
    """The most of a shape's volume that a cut across an axis saves [m³], and both halves with their shapes."""
    best, middles = (-math.inf, []), corners.mean(axis=1)
    for t in middles.T:
        for cut in np.linspace(t.min(), t.max(), SPLITS + 2)[1:-1]:
            low = t < cut
            if low.any() and not low.all():
                halves = [(_smallest(part), part) for part in (corners[low], corners[~low])]
                gain = shape.volume - sum(half.volume for half, _ in halves)
                best = max(best, (gain, halves), key=lambda found: found[0])
    return best


def _housings(corners: np.ndarray, point: np.ndarray, direction: np.ndarray) -> list[Shape]:
    """Cylinders about an axis that contain all triangles within one radius or another."""
    d = direction / np.linalg.norm(direction)
    t = (corners - point) @ d
    radii = np.linalg.norm(corners - point - t[..., None] * d, axis=2).max(axis=1)
    shapes = []
    for radius in _frequent(np.sort(radii)):
        radius = np.ceil(radius * ROUND + 1) / ROUND
        within = t[radii <= radius]
        a, b = within.min() - 1 / ROUND, within.max() + 1 / ROUND
        shapes.append(Shape("cylinder", (float(radius), (b - a) / 2), tuple(point + (a + b) / 2 * d), tuple(d)))
    return shapes


def _frequent(radii: np.ndarray) -> Iterator[float]:
    """Radii just below which most triangles end, as those of a housing do, and the greatest; ``radii`` are sorted."""
    yield radii[-1]
    counts = np.arange(len(radii)) - np.searchsorted(radii, radii - ALIKE)
    for _ in range(RADII - 1):
        radius = radii[np.argmax(counts)]
        yield radius
        counts[np.abs(radii - radius) < 5 * ALIKE] = 0


def _rows(corners: np.ndarray) -> Iterator[list[Shape]]:
    """Up to three shapes about all triangles: what planes across the longest axis part."""
    if len(corners) == 0:
        yield []
        return
    yield [_smallest(corners)]
    middles = corners.mean(axis=1)
    t = middles[:, int(np.argmax(np.ptp(middles, axis=0)))]
    cuts = np.linspace(t.min(), t.max(), CUTS + 2)[1:-1]
    slab = cache(lambda low, high: _smallest(corners[part]) if (part := (t >= low) & (t <= high)).any() else None)
    for inner in [*itertools.combinations(cuts, 1), *itertools.combinations(cuts, 2)]:
        shapes = [slab(*pair) for pair in itertools.pairwise((-math.inf, *inner, math.inf))]
        yield [shape for shape in shapes if shape is not None]


def _smallest(corners: np.ndarray) -> Shape:
    return _shapes_of(corners)[0]


def _held(shape: Shape, probes: np.ndarray) -> int:
    """Which of the probes a shape holds, a bit each."""
    return int.from_bytes(np.packbits(shape.depth(probes) > 0).tobytes(), "big")


def _inside(shape: Shape, corners: np.ndarray) -> np.ndarray:
    """Which triangles (N, 3, 3) a shape contains (N,)."""
    return (shape.depth(corners.reshape(-1, 3)) >= 0).reshape(-1, 3).all(axis=1)


def excess(mesh: trimesh.Trimesh, shapes: list[Shape]) -> float:
    """A bound of how far the shapes' surface is from the mesh anywhere [m].

    The greatest distance from points of the surface to points of the mesh, and how far apart the former are.
    """
    samples, _ = trimesh.sample.sample_surface(mesh, SAMPLES, seed=1)
    tree, farthest = cKDTree(np.vstack([samples, mesh.vertices])), 0.0
    for shape in shapes:
        points = _surface(shape)
        others = [other.depth(points) for other in shapes if other is not shape]
        outer = points[np.max(others, axis=0) < 0] if others else points
        if len(outer):
            farthest = max(farthest, tree.query(outer)[0].max())
    return farthest + SPACING / math.sqrt(3)


def _surface(shape: Shape) -> np.ndarray:
    if shape.kind == "box":
        solid = trimesh.creation.box(2 * np.array(shape.size))
        return solid.subdivide_to_size(SPACING).vertices + np.array(shape.center)
    a, b = shape.ends
    if shape.kind == "cylinder":
        solid = trimesh.creation.cylinder(shape.size[0], np.linalg.norm(b - a), sections=24)
    else:
        solid = trimesh.creation.capsule(np.linalg.norm(b - a), shape.size[0], count=[24, 24])
    turn = trimesh.geometry.align_vectors([0, 0, 1], b - a) if np.linalg.norm(b - a) else np.eye(4)
    points = solid.subdivide_to_size(SPACING).vertices
    return (points - points.mean(axis=0)) @ turn[:3, :3].T + (a + b) / 2


def _shapes_of(corners: np.ndarray) -> list[Shape]:
    """A box along the frame, and capsules and cylinders along its axes, that contain points, the smallest first."""
    points = corners.reshape(-1, 3)
    try:
        points = points[ConvexHull(points).vertices]
    except QhullError:
        points = np.unique(points, axis=0)  # flat
    round_ones = [shape for direction in np.eye(3) for shape in _round(points, direction)]
    return sorted([_box(points), *round_ones], key=lambda shape: shape.volume)


def _box(points: np.ndarray) -> Shape:
    low, high = np.floor(points.min(axis=0) * ROUND - 0.01), np.ceil(points.max(axis=0) * ROUND + 0.01)
    return Shape("box", tuple((high - low) / (2 * ROUND)), tuple((high + low) / (2 * ROUND)))


def _round(points: np.ndarray, direction: np.ndarray) -> list[Shape]:
    """The shortest capsule and cylinder along a direction about the smallest circle around the points seen along it."""
    u, v, d = _frame(direction)
    flat, t = points @ np.stack([u, v]).T, points @ d
    circle, radius = _circle(flat)
    outwards = np.ceil(radius * ROUND + 1.01) / ROUND  # rounded ends are up to 0.09 mm off
    rest = np.sqrt(np.maximum(radius**2 - ((flat - circle) ** 2).sum(axis=1), 0.0))
    shapes = []
    for kind, low, high in (
        ("capsule", (t + rest).min(), (t - rest).max()),
        ("cylinder", t.min() - 1 / ROUND, t.max() + 1 / ROUND),
    ):
        if high > low:
            center = circle[0] * u + circle[1] * v + (high + low) / 2 * d
            shapes.append(Shape(kind, (float(outwards), float(high - low) / 2), tuple(center), tuple(d)))
    return shapes


def _frame(direction: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    d = direction / np.linalg.norm(direction)
    u = np.cross(d, np.eye(3)[np.argmin(np.abs(d))])
    u /= np.linalg.norm(u)
    return u, np.cross(d, u), d


def _circle(points: np.ndarray) -> tuple[np.ndarray, float]:
    """Welzl 1991's smallest circle around points (N, 2), by moving to the front of those that it must hold."""
    try:
        points = points[ConvexHull(points).vertices]
    except QhullError:
        points = np.unique(points, axis=0)  # on a line
    points = np.random.default_rng(0).permutation(points)
    center, radius = points[0], 0.0
    for i in range(1, len(points)):
        if _outside(points[i], center, radius):
            center, radius = points[i], 0.0
            for j in range(i):
                if _outside(points[j], center, radius):
                    center, radius = (points[i] + points[j]) / 2, np.linalg.norm(points[i] - points[j]) / 2
                    for k in range(j):
                        if _outside(points[k], center, radius):
                            center, radius = _through(points[i], points[j], points[k])
    return center, float(np.linalg.norm(points - center, axis=1).max())


def _outside(point: np.ndarray, center: np.ndarray, radius: float) -> bool:
    return math.dist(point, center) > radius + 1e-9


def _through(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, float]:
    A = 2 * np.stack([b - a, c - a])
    if abs(np.linalg.det(A)) < 1e-15:
        far = max(itertools.combinations((a, b, c), 2), key=lambda pair: math.dist(*pair))
        return (far[0] + far[1]) / 2, math.dist(*far) / 2
    center = np.linalg.solve(A, [b @ b - a @ a, c @ c - a @ a])
    return center, math.dist(center, a)


def _words(values) -> str:
    return " ".join(f"{round(float(value), 6) + 0.0:g}" for value in values)


def main(paths: list[str]) -> None:
    """Print shapes for meshes."""
    for path in paths:
        mesh = trimesh.load(path, force="mesh")
        shapes = fit(mesh)
        print(f"<!-- {path}: exceeded by {1000 * excess(mesh, shapes):.1f} mm at most -->")
        for shape in shapes:
            print(f"<geom {' '.join(f'{key}={value!r}' for key, value in shape.mjcf().items())}/>".replace("'", '"'))


if __name__ == "__main__":
    main(sys.argv[1:])
