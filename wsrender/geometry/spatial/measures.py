"""Areas and volume of a boundary whose cells' surfaces are known exactly, by extrapolation from flat facets.

Every triangle of the mesh is the image of a flat one: its points are moved onto the surface of its patch along
directions between the normals at its vertices, and onto the curve where two patches meet along its sharp sides. Facets
of that image of a half and a quarter the size have errors in even powers of their size (Romberg 1955).
"""

from dataclasses import dataclass

import numpy as np

from wsrender.geometry.romberg import extrapolated
from wsrender.geometry.spatial.patches import Patch

_LEVEL = 4  # facets along each side of a triangle
NODES = np.array([(i, j, _LEVEL - i - j) for i in range(_LEVEL + 1) for j in range(_LEVEL + 1 - i)]) / _LEVEL
_SIDES = ((0, 1), (1, 2), (2, 0))
_FARTHEST = 0.3  # of a triangle's longest side, from it to its surface; what is farther is another sheet of the surface
_TURNED = 0.7  # cosine between the normals there and between those of the corners, below which it is another sheet too
INNER = np.array([0.25, 0.5, 0.75])  # where a sharp side is known, between its ends


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
