"""Edges, where two patches of a boundary meet, and corners, where three or more do."""

from dataclasses import dataclass

import numpy as np

from wsrender.geometry.components import components
from wsrender.geometry.fits import fit_circle
from wsrender.geometry.romberg import extrapolated
from wsrender.geometry.spatial.patch_mesh import PatchMesh

_LEAST_SIDES = 3  # of an edge: what is shorter the cells do not resolve
# Share of the longest edge between the same patches: shorter loops are around what the cells do not resolve.
_LOOP = 0.2
_EXACT = 1e-9  # relative to the points' extent
_BENT = 1e3  # times as far as that circles are from a line: what is straighter may be any curve


@dataclass(frozen=True, eq=False)
class Edge:
    """A curve between two patches, from corner to corner or closed.

    ``kind`` line, circle or free_form; ``center`` and ``axis`` (3,), ``radius`` [m] of a circle; ``residual`` [m] of
    the points from it, or from the nearer of both. ``angle``: least and largest between the outward normals [rad].
    ``corners``: indices of the corners at its ends; ``points`` (K, 3) [m].
    """

    patches: tuple[int, int]
    corners: tuple[int, ...]
    points: np.ndarray
    length: float
    angle: tuple[float, float]
    kind: str
    residual: float
    center: np.ndarray | None
    axis: np.ndarray | None
    radius: float | None


@dataclass(frozen=True, eq=False)
class Corner:
    """A point (3,) [m] where three or more patches meet."""

    point: np.ndarray
    patches: tuple[int, ...]


def edges_and_corners(mesh: PatchMesh, exact: float = _EXACT) -> tuple[list[Edge], list[Corner]]:
    """The edges, longest first, and the corners at which they end.

    ``exact``: distance from a line or circle, relative to the points' extent, up to which an edge is one.
    """
    sharp = mesh.sharp
    meeting = np.unique(np.stack([mesh.faces.ravel(), np.repeat(mesh.patch, 3)], axis=1), axis=0)
    is_corner = np.bincount(meeting[:, 0], minlength=len(mesh.vertices)) > 2
    groups = [rows for rows in _chains(sharp.vertices, sharp.patches, is_corner) if len(rows) >= _LEAST_SIDES]
    ends = [np.unique(sharp.vertices[rows][is_corner[sharp.vertices[rows]]]) for rows in groups]
    used = np.unique(np.concatenate([*ends, np.empty(0, int)])).astype(int)
    corners = [Corner(mesh.vertices[v], tuple(meeting[meeting[:, 0] == v, 1].tolist())) for v in used]
    edges = [
        _edge(mesh, rows, tuple(np.searchsorted(used, vertices).tolist()), exact)
        for rows, vertices in zip(groups, ends, strict=True)
    ]
    edges.sort(key=lambda edge: -float(f"{edge.length:.9g}"))  # those of equal length keep their order, whatever rounds
    return [edge for k, edge in enumerate(edges) if not any(_repeats(edge, longer) for longer in edges[:k])], corners


def _repeats(edge: Edge, longer: Edge) -> bool:
    """Whether a loop without corners is around a hole in what the cells see of a thin part: it runs along its edge."""
    if edge.corners or edge.patches != longer.patches:
        return False
    if edge.length < _LOOP * longer.length:
        return True
    if edge.center is None or longer.center is None or edge.radius is None or longer.radius is None:
        return False
    apart = np.linalg.norm(edge.center - longer.center) + abs(edge.radius - longer.radius)
    return bool(apart <= 1e-6 * longer.radius)


def _chains(sides: np.ndarray, patches: np.ndarray, is_corner: np.ndarray) -> list[np.ndarray]:
    """Rows of the sides of each edge: connected but through corners, between the same patches."""
    touching = [
        (k, vertex, *pair)
        for k, (ends, pair) in enumerate(zip(sides.tolist(), patches.tolist(), strict=True))
        for vertex in ends
        if not is_corner[vertex]
    ]
    of: dict[tuple[int, ...], int] = {}
    joined = [(k, of.setdefault(key, k)) for k, *rest in touching for key in [tuple(rest)]]
    a, b = np.array(joined, int).reshape(-1, 2).T
    part = components(len(sides), a, b)
    return [np.flatnonzero(part == k) for k in range(part.max(initial=-1) + 1)]


def _edge(mesh: PatchMesh, rows: np.ndarray, corners: tuple[int, ...], exact: float) -> Edge:
    sharp = mesh.sharp
    start, end = mesh.vertices[sharp.vertices[rows]].transpose(1, 0, 2)
    curve = np.concatenate([start[:, None], sharp.points[rows], end[:, None]], axis=1)
    kind, residual, circle = _fitted(curve.reshape(-1, 3), exact)
    a, b = sharp.patches[rows[0]].tolist()
    angle = sharp.angle[rows]
    return Edge(
        (a, b),
        corners,
        curve.reshape(-1, 3),
        _length(kind, curve, circle, closed=not corners),
        (float(angle.min()), float(angle.max())),
        kind,
        residual,
        *circle,
    )


def _length(kind: str, curve: np.ndarray, circle: tuple, closed: bool) -> float:
    """Length [m] of sides ``curve`` (E, 5, 3) in any order; those of a thin part may go back and forth."""
    points = curve.reshape(-1, 3)
    if kind == "line":
        along = points - points[0]
        along = along @ along[np.linalg.norm(along, axis=1).argmax()] / np.linalg.norm(along, axis=1).max()
        return float(np.ptp(along))
    if kind == "circle":
        center, axis, radius = circle
        x = points[0] - center
        angle = np.sort(np.arctan2((points - center) @ np.cross(axis, x), (points - center) @ x))
        widest = np.diff(angle, append=angle[0] + 2 * np.pi).max()
        return float(radius * (2 * np.pi if closed and widest < 1 else 2 * np.pi - widest))
    lengths = [np.linalg.norm(np.diff(curve[:, ::step], axis=1), axis=2).sum() for step in (4, 2, 1)]
    return float(extrapolated(lengths)[0])


def _fitted(
    points: np.ndarray, exact: float
) -> tuple[str, float, tuple[np.ndarray | None, np.ndarray | None, float | None]]:
    """line, circle or free_form, the residual [m], and (centre, axis, radius) of a circle."""
    middle = points.mean(axis=0)
    local = points - middle
    size = np.linalg.norm(local, axis=1).max()
    along, across, normal = np.linalg.svd(local, full_matrices=False)[2]
    off_line = float(np.linalg.norm(local - np.outer(local @ along, along), axis=1).max())
    if off_line <= exact * size:
        return "line", off_line, (None, None, None)
    plane = np.stack([along, across])
    circle = fit_circle(local @ plane.T)
    center = circle.center @ plane
    off_ring = np.linalg.norm((local - center) @ plane.T, axis=1) - circle.radius
    off_circle = np.hypot(off_ring, local @ normal).max()
    if off_circle <= exact * max(size, circle.radius) and off_line > _BENT * exact * size:
        return "circle", float(off_circle), (middle + center, normal, circle.radius)
    return "free_form", float(min(off_line, off_circle)), (None, None, None)
