"""Areas and volume of a boundary whose cells' surfaces are known exactly, and the volume by an integral over joints.

Every triangle of the mesh is the image of a flat one: its points are moved onto the surface of its patch along
directions between the normals at its vertices, and onto the curve where two patches meet along its sharp sides. Facets
of that image of a half and a quarter the size have errors in even powers of their size (Romberg 1955).

A displacement of the second and third joint of a three-joint arm reaches an orbit of the first. Each of the N
displacements that reach the same orbit covers an interval of it; where they overlap the volume counts once. So
V = ∫∫ |det J| U / N dd₂ dd₃, where U is the length of the intervals' union [rad or m].
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from wsrender.geometry.romberg import extrapolated
from wsrender.geometry.spatial.inverse import ThreeJointInverse
from wsrender.geometry.spatial.patches import Patch
from wsrender.geometry.spatial.spatial_arm import TURN

_LEVEL = 4  # facets along each side of a triangle
NODES = np.array([(i, j, _LEVEL - i - j) for i in range(_LEVEL + 1) for j in range(_LEVEL + 1 - i)]) / _LEVEL
_SIDES = ((0, 1), (1, 2), (2, 0))
_FARTHEST = 0.3  # of a triangle's longest side, from it to its surface; what is farther is another sheet of the surface
_TURNED = 0.7  # cosine between the normals there and between those of the corners, below which it is another sheet too
INNER = np.array([0.25, 0.5, 0.75])  # where a sharp side is known, between its ends
TOLERANCE = 1e-8
MOST_LINES = 1000
# values (N,) and signatures (N,) of points (u, v) (N,): where the signature changes the values may jump.
Piecewise = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]

_FIRST_PANELS = 6
_OUTER, _INNER = np.polynomial.legendre.leggauss(7), np.polynomial.legendre.leggauss(12)
_SCANNED = 48  # points of each line among which jumps are looked for
_BISECTIONS = 40


@dataclass(frozen=True, eq=False)
class Triangles:
    """Triangles of a mesh whose sides may be curved.

    ``vertices``, ``normals`` (T, 3, 3): corners [m] and outward normals there; ``bulges`` (T, 3, 3, 3) [m]: how far the
    boundary is from each side (0-1, 1-2, 2-0) at a quarter, half and three quarters of it; ``patch`` (T,) and ``d``
    (T, n), displacements nearby.
    """

    vertices: np.ndarray
    normals: np.ndarray
    bulges: np.ndarray
    patch: np.ndarray
    d: np.ndarray


@dataclass(frozen=True, eq=False)
class PatchMeasures:
    """Volume [m³] and its last change by the extrapolation, area of each patch (P,) [m²]."""

    volume: float
    volume_error: float
    areas: np.ndarray


def measures(triangles: Triangles, patches: list[Patch]) -> PatchMeasures:
    """Measure what the triangles enclose."""
    nodes, normals = _nodes(triangles, patches)
    center = nodes.reshape(-1, 3).mean(axis=0) if len(nodes) else np.zeros(3)
    volumes, areas = [], []
    for size in (1, 2, 4):
        a, b, c = (nodes[:, ids] - center for ids in _facets(size).T)
        cross = np.cross(b - a, c - a)
        volumes.append((a * cross).sum() / 6)
        outward = np.sign((cross * normals[:, _facets(size)].sum(axis=2)).sum(axis=2))
        area = (np.linalg.norm(cross, axis=2) * outward).sum(axis=1) / 2
        areas.append(np.bincount(triangles.patch, area, len(patches)))
    volume, volume_error = extrapolated(volumes)
    return PatchMeasures(float(volume), float(volume_error), extrapolated(areas)[0])


def _nodes(triangles: Triangles, patches: list[Patch]) -> tuple[np.ndarray, np.ndarray]:
    """Positions and normals (T, 15, 3) on the surfaces; of the flat triangle where one meets another sheet of them."""
    flat = np.einsum("kc,tcx->tkx", NODES, triangles.vertices)
    for side, (i, j) in enumerate(_SIDES):
        weight = NODES[:, i] + NODES[:, j]
        t = NODES[:, j] / np.where(weight == 0, 1, weight)
        flat = flat + np.einsum("k,kb,tbx->tkx", weight, _bulge_basis(t), triangles.bulges[:, side])
    direction = np.einsum("kc,tcx->tkx", NODES, triangles.normals)
    direction /= np.maximum(np.linalg.norm(direction, axis=2, keepdims=True), 1e-300)
    s, normals = np.zeros(flat.shape[:2]), direction.copy()
    for k, patch in enumerate(patches):
        rows = np.flatnonzero(triangles.patch == k)
        start = np.repeat(triangles.d[rows], len(NODES), axis=0)
        meeting = patch.surface.meet(flat[rows].reshape(-1, 3), direction[rows].reshape(-1, 3), start)
        good = np.isfinite(meeting.s).reshape(len(rows), -1)
        s[rows] = np.where(good, meeting.s.reshape(good.shape), 0.0)
        normals[rows] = np.where(good[..., None], meeting.normal.reshape(*good.shape, 3), direction[rows])
    sides = np.linalg.norm(triangles.vertices - np.roll(triangles.vertices, 1, axis=1), axis=2).max(axis=1)
    own = np.abs(s).max(axis=1) <= _FARTHEST * sides
    own &= (normals * direction).sum(axis=2).min(axis=1) >= _TURNED
    s, normals = np.where(own[:, None], s, 0.0), np.where(own[:, None, None], normals, direction)
    return flat + s[..., None] * direction, normals


def _bulge_basis(t: np.ndarray) -> np.ndarray:
    """Polynomials (N, 3) that are 1 at one of the inner nodes and 0 at the others and both ends."""
    ends = np.array([0.0, *INNER, 1.0])
    basis = np.ones((len(t), 3))
    for k in range(3):
        for other in np.delete(ends, k + 1):
            basis[:, k] *= (t - other) / (ends[k + 1] - other)
    return basis


def _facets(parts: int) -> np.ndarray:
    """Nodes (F, 3) of the facets into which a triangle is divided, so many along each side, in its own order."""
    step = _LEVEL // parts
    number = {tuple(node): k for k, node in enumerate(np.rint(NODES * _LEVEL).astype(int).tolist())}

    def at(i: int, j: int) -> int:
        return number[(i * step, j * step, _LEVEL - (i + j) * step)]

    upright = [(at(i + 1, j), at(i, j + 1), at(i, j)) for i in range(parts) for j in range(parts - i)]
    turned = [(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i in range(parts) for j in range(parts - i - 1)]
    return np.array(upright + turned)


def joint_volume(
    inverse: ThreeJointInverse, report: Callable[[int], None], most_lines: int = MOST_LINES
) -> tuple[float, float]:
    """Volume [m³] and how much the last refinement changed it; ``report(points)``."""
    arm = inverse.arm
    length = min(arm.high[0] - arm.low[0], TURN) if arm.revolute[0] else arm.high[0] - arm.low[0]

    def integrand(d3: np.ndarray, d2: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        d = np.column_stack([np.full(len(d2), (arm.low[0] + arm.high[0]) / 2), d2, d3])
        points, J, _ = arm.motion(d)
        det = np.linalg.det(J)
        first = inverse.solutions(points, first_limited=False)[:, :, 0]
        report(len(points))
        covered, overlaps = _union(first, length, bool(arm.revolute[0]))
        count = np.maximum(np.isfinite(first).sum(axis=1), 1)
        return np.abs(det) * covered / count, (count * 16 + overlaps) * 2 + (det > 0)

    outer, inner = _range(inverse, 2), _range(inverse, 1)
    return piecewise_integral(integrand, outer, inner, TOLERANCE, most_lines)


def _range(inverse: ThreeJointInverse, joint: int) -> tuple[float, float]:
    low, high = float(inverse.arm.low[joint]), float(inverse.arm.high[joint])
    return (low, low + TURN) if inverse.arm.full[joint] else (low, high)


def _union(first: np.ndarray, length: float, turning: bool) -> tuple[np.ndarray, np.ndarray]:
    """Length (N,) of the union of intervals of one ``length`` that start at −first (N, 8), and how many overlap."""
    count = np.isfinite(first).sum(axis=1)
    starts = np.where(np.isfinite(first), (-first) % TURN if turning else -first, np.inf)
    starts.sort(axis=1)
    last = np.maximum(count - 1, 0)
    following = np.column_stack([starts[:, 1:], np.full(len(starts), np.inf)])
    if turning:
        following[np.arange(len(starts)), last] = starts[:, 0] + TURN
    with np.errstate(invalid="ignore"):
        gaps = following - starts
    gaps = np.where(np.isfinite(starts), gaps, 0.0)
    covered = np.minimum(gaps, length).sum(axis=1)
    return np.where(count > 0, covered, length), ((gaps < length) & np.isfinite(starts)).sum(axis=1)


def piecewise_integral(
    function: Piecewise, u: tuple[float, float], v: tuple[float, float], tolerance: float, most_lines: int
) -> tuple[float, float]:
    """∫∫ function du dv, and how much its last halving changed it.

    Gauss–Legendre quadrature on lines of constant u, divided where the signature changes; panels of lines are halved
    where that matters, until the change is below ``tolerance`` (relative) or there are ``most_lines``.
    """
    edges = np.linspace(*u, _FIRST_PANELS + 1)
    low, high = edges[:-1], edges[1:]
    whole = _panels(function, low, high, v)
    lines, total, settled_error = len(low) * len(_OUTER[0]), 0.0, 0.0
    while len(low):
        middle = (low + high) / 2
        halves = _panels(function, np.concatenate([low, middle]), np.concatenate([middle, high]), v).reshape(2, -1)
        lines += 2 * len(low) * len(_OUTER[0])
        error = np.abs(halves.sum(axis=0) - whole)
        scale = abs(total + halves.sum())
        share = tolerance * scale * (high - low) / (u[1] - u[0])
        open_ = (error > share) & (lines < most_lines)
        total += halves[:, ~open_].sum()
        settled_error += error[~open_].sum()
        low, high = np.concatenate([low[open_], middle[open_]]), np.concatenate([middle[open_], high[open_]])
        whole = halves[:, open_].ravel()
    return float(total), float(settled_error)


def _panels(function: Piecewise, low: np.ndarray, high: np.ndarray, v: tuple[float, float]) -> np.ndarray:
    """Integrals (P,) over u in low … high (P,)."""
    x, weight = _OUTER
    half = (high - low) / 2
    u = (low + high)[:, None] / 2 + half[:, None] * x
    return half * (_lines(function, u.ravel(), v).reshape(u.shape) @ weight)


def _lines(function: Piecewise, u: np.ndarray, v: tuple[float, float]) -> np.ndarray:
    """Integrals (N,) over v at u (N,)."""
    grid = np.linspace(*v, _SCANNED)
    inner = grid + np.concatenate([[1e-9], np.zeros(_SCANNED - 2), [-1e-9]]) * (v[1] - v[0])
    signature = function(np.repeat(u, _SCANNED), np.tile(inner, len(u)))[1].reshape(len(u), _SCANNED)
    line, k = np.nonzero(np.diff(signature, axis=1))
    left, right, before = grid[k], grid[k + 1], signature[line, k]
    for _ in range(_BISECTIONS):
        middle = (left + right) / 2
        same = function(u[line], middle)[1] == before
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    ends = np.full(len(u), v[1])
    lines = np.arange(len(u))
    start_line = np.concatenate([lines, line, lines])
    cuts = np.concatenate([np.full(len(u), v[0]), (left + right) / 2, ends])
    order = np.lexsort((cuts, start_line))
    cuts, start_line = cuts[order], start_line[order]
    piece = np.flatnonzero(np.diff(start_line) == 0)
    x, weight = _INNER
    half = (cuts[piece + 1] - cuts[piece]) / 2
    at = (cuts[piece + 1] + cuts[piece])[:, None] / 2 + half[:, None] * x
    values = function(np.repeat(u[start_line[piece]], len(x)), at.ravel())[0].reshape(at.shape)
    return np.bincount(start_line[piece], half * (values @ weight), len(u))
