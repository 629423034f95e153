"""Watertight triangle meshes of ball regions: every vertex lies on the exact surfaces, borders are shared.

Flat triangulations are refined by halving long edges and by flips to Delaunay triangles. Places are those of
stereographic charts, which keep circles circles: a triangulation that is Delaunay in the chart is so on the sphere.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import trimesh

from wsrender.mechanisms.exact.arcs import dot
from wsrender.mechanisms.exact.faces import LARGEST_ANGLE, Borders, Chart, Face, FacesOnSurface, steps_of

LONGER = 1.3  # edges inside faces than those along borders, without which halving near a border does not end
MOST_HALVINGS = 60  # a face that is a sphere but for a pinhole takes some 40
FIRST_FLIPS, LATER_FLIPS = 15, 1  # rounds, where triangles are few and where they are many
SLACK = 1e-9  # relative, of the test whether a flip helps: four points of one circle are left alone

Lift = Callable[[np.ndarray, np.ndarray], np.ndarray]


def region_mesh(borders: Borders, patches: list[FacesOnSurface], faces: list[Face], step: float) -> trimesh.Trimesh:
    """Closed mesh [m], normals out of the region, its edges inside faces at most about ``step`` (scaled) long.

    The attribute ``surface`` of its triangles numbers the surface on which each lies.
    """
    surfaces = borders.arcs.surfaces
    points, triangles, owners = [borders.points], [], []
    if patches:
        inner, covering = _covered(patches, LONGER * steps_of(surfaces, step), len(borders.points))
        points.append(inner)
        triangles += [_outwards(own, surfaces.sides[patch.surface]) for patch, own in covering]
        owners += [np.full(len(own), patch.surface) for patch, own in covering]
    for sphere in (face.surface for face in faces if not face.loops):
        radius, total = float(surfaces.radii[0, sphere]), sum(map(len, points))
        ball = trimesh.creation.icosphere(_subdivisions(min(step / radius, LARGEST_ANGLE)), radius)
        triangles.append(_outwards(ball.faces + total, surfaces.side[sphere]))
        owners.append(np.full(len(ball.faces), sphere))
        points.append(ball.vertices + surfaces.centres[0, sphere])
    triangles = np.concatenate([np.zeros((0, 3), int), *triangles])
    used, renumbered = np.unique(triangles, return_inverse=True)
    vertices = surfaces.origin[0] + surfaces.scale[0] * np.concatenate(points)[used]
    metadata = {"frame": "base", "unit": "m", "up": "z"}
    numbers: dict[str, Any] = {"surface": np.concatenate([np.zeros(0, int), *owners]).astype(np.int32)}
    return trimesh.Trimesh(
        vertices, renumbered.reshape(-1, 3), face_attributes=numbers, process=False, metadata=metadata
    )


def _outwards(triangles: np.ndarray, side: float) -> np.ndarray:
    return triangles if side > 0 else triangles[:, ::-1]


def _subdivisions(step: float) -> int:
    """How often the edges of an icosahedron, 1.05 of its radius, are halved to be at most ``step``."""
    return int(np.clip(np.ceil(np.log2(1.05 / step)), 1, 7))


def _covered(
    patches: list[FacesOnSurface], steps: np.ndarray, first: int
) -> tuple[np.ndarray, list[tuple[FacesOnSurface, np.ndarray]]]:
    """Points (n, 3) inside faces, to be numbered from ``first``, and the triangles (t, 3) of every patch."""
    counts = [len(patch.ids) for patch in patches]
    before = np.cumsum([0, *counts[:-1]])
    charts = [patch.chart for patch in patches]
    flat, owner, triangles = refined(
        np.concatenate([patch.flat for patch in patches]),
        np.repeat(np.arange(len(patches)), counts),
        np.concatenate([patch.triangles + start for patch, start in zip(patches, before, strict=True)]),
        lambda flat, owner: _lifted(charts, flat, owner),
        # A chart of a plane is flat: no edge is too long for it.
        np.array([steps[patch.surface] if patch.chart.radius else np.inf for patch in patches]),
    )
    borders = sum(counts)
    ids = np.concatenate([*(patch.ids for patch in patches), first + np.arange(len(flat) - borders)])
    of = owner[triangles[:, 0]]
    covering = [(patch, ids[triangles[of == k]]) for k, patch in enumerate(patches)]
    return _lifted(charts, flat[borders:], owner[borders:]), covering


def _lifted(charts: list[Chart], flat: np.ndarray, owner: np.ndarray) -> np.ndarray:
    """Points (n, 3) at places (n, 2) of the charts numbered by ``owner`` (n,)."""
    points = np.empty((len(flat), 3))
    for number, chart in enumerate(charts):
        own = owner == number
        points[own] = chart.lifted(flat[own])
    return points


def refined(
    flat: np.ndarray, owner: np.ndarray, triangles: np.ndarray, lift: Lift, step: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (n, 2), owners (n,) and triangles (t, 3) with inner edges at most about as long as their owner's step.

    ``owner`` (n,) numbers the chart of every place, ``lift(flat, owner)`` gives the points, ``step`` (charts,) the
    lengths. The given places come first; borders, edges of one triangle, stay as they are.
    """
    borders = len(flat)
    triangles = _flipped(triangles, flat, FIRST_FLIPS, borders=0)
    points = lift(flat, owner)
    for _ in range(MOST_HALVINGS):
        ends, edge_of, inner = _edges(triangles, len(flat))
        low, high = ends[inner].T
        new = (flat[low] + flat[high]) / 2
        lifted = lift(new, owner[low])
        way = _distance(lifted, points[low]) + _distance(lifted, points[high])
        # Two faces might have the same edge between points of the border that they share.
        halved = (way > step[owner[low]]) | (high < borders)
        if not halved.any():
            break
        middle = np.full(len(ends), -1)
        middle[np.flatnonzero(inner)[halved]] = len(flat) + np.arange(halved.sum())
        flat, owner = np.concatenate([flat, new[halved]]), np.concatenate([owner, owner[low[halved]]])
        points = np.concatenate([points, lifted[halved]])
        triangles = _flipped(_split(triangles, middle[edge_of], points), flat, LATER_FLIPS, borders)
    return flat, owner, triangles


def _distance(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.sqrt(dot(a - b, a - b))


def _edges(triangles: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ends (e, 2) of all edges, the edge of each side ab, bc, ca of each triangle (t, 3), and which have two."""
    sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    key, edge_of, uses = np.unique(sides @ [count, 1], return_inverse=True, return_counts=True)
    return np.stack(np.divmod(key, count), axis=1), edge_of.reshape(-1, 3), uses == 2


def _split(triangles: np.ndarray, middle: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Triangles (t, 3) divided at the middles (t, 3) of their sides, −1 where a side stays whole."""
    halved = middle >= 0
    count = halved.sum(axis=1)
    parts = [triangles[count == 0]]
    a, b, c, ab, _, _ = _turned(triangles, middle, count == 1, halved.argmax(axis=1))
    parts += [np.stack([a, ab, c], 1), np.stack([ab, b, c], 1)]
    a, b, c, ab, bc, _ = _turned(triangles, middle, count == 2, (~halved).argmax(axis=1) + 1)
    short = dot(points[ab] - points[c], points[ab] - points[c]) < dot(points[a] - points[bc], points[a] - points[bc])
    far, near = np.where(short, c, bc), np.where(short, ab, a)
    parts += [np.stack([ab, b, bc], 1), np.stack([a, ab, far], 1), np.stack([near, bc, c], 1)]
    a, b, c, ab, bc, ca = _turned(triangles, middle, count == 3, np.zeros(len(count), int))
    parts += [np.stack(corners, 1) for corners in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    return np.concatenate(parts)


def _turned(triangles: np.ndarray, middle: np.ndarray, chosen: np.ndarray, first: np.ndarray) -> tuple:
    """Corners a, b, c and middles ab, bc, ca of the chosen triangles, turned so that side ``first`` is ab."""
    order = (first[chosen, None] + np.arange(3)) % 3
    corners = np.take_along_axis(triangles[chosen], order, 1)
    return (*corners.T, *np.take_along_axis(middle[chosen], order, 1).T)


def _flipped(triangles: np.ndarray, flat: np.ndarray, rounds: int, borders: int) -> np.ndarray:
    """The triangles with edges flipped whose circles hold the point opposite (Lawson 1977), so many times.

    No flip joins two of the first ``borders`` points.
    """
    triangles = triangles.copy()
    for _ in range(rounds):
        side, twin = _twins(triangles, len(flat))
        (t, k), (u, m) = np.divmod(side, 3), np.divmod(twin, 3)
        a, b, p = (triangles[t, (k + turn) % 3] for turn in range(3))
        q = triangles[u, (m + 2) % 3]
        wrong = np.flatnonzero(_in_circle(flat[a], flat[b], flat[p], flat[q]) & (np.maximum(p, q) >= borders))
        chosen = wrong[_apart(t[wrong], u[wrong], len(triangles))]
        if not len(chosen):
            break
        a, b, p, q, t, u = (each[chosen] for each in (a, b, p, q, t, u))
        triangles[t], triangles[u] = np.stack([a, q, p], 1), np.stack([q, b, p], 1)
    return triangles


def _twins(triangles: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The two sides, numbered 3 triangle + side, of every edge that two triangles share."""
    sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1) @ [count, 1]
    order = np.argsort(sides, kind="stable")
    same = np.flatnonzero(sides[order[1:]] == sides[order[:-1]])
    return order[same], order[same + 1]


def _in_circle(a: np.ndarray, b: np.ndarray, p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Whether q lies in the circle through a, b, p (anticlockwise), and both triangles of the flip turn as they do."""
    a, b, p = a - q, b - q, p - q
    pa, pb, pp = dot(a, a), dot(b, b), dot(p, p)
    bp, ap, ab = _wedge(b, p), _wedge(p, a), _wedge(a, b)
    inside = pa * bp + pb * ap + pp * ab > SLACK * (pa * np.abs(bp) + pb * np.abs(ap) + pp * np.abs(ab))
    return inside & (ap > 0) & (bp > 0)


def _wedge(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def _apart(t: np.ndarray, u: np.ndarray, count: int) -> np.ndarray:
    """Which of the pairs of triangles (t, u) can be flipped together: the first that each triangle belongs to."""
    first = np.full(count, len(t))
    np.minimum.at(first, np.concatenate([t, u]), np.tile(np.arange(len(t)), 2))
    return (first[t] == np.arange(len(t))) & (first[u] == np.arange(len(t)))
