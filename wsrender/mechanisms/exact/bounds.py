"""Bounding boxes of ball regions: from vertices, extremes of circles, and poles of spheres."""

import numpy as np

from wsrender.mechanisms.exact.arcs import Arcs


def bounds(arcs: Arcs, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Least and largest coordinates of a single region along unit vectors ``axes`` (A, 3) [m], each (A,).

    None of an empty region.
    """
    points = np.concatenate([arcs.vertices, _extremes_of_edges(arcs, axes), _poles(arcs, axes)])
    if not len(points):
        return None
    (origin,), (scale,) = arcs.surfaces.origin, arcs.surfaces.scale
    along = (origin + scale * points) @ axes.T
    return along.min(axis=0), along.max(axis=0)


def _extremes_of_edges(arcs: Arcs, axes: np.ndarray) -> np.ndarray:
    """Points (n, 3) of circular edges that lie furthest along an axis on their circles."""
    curved = np.flatnonzero(~arcs.is_line)
    across, up, middle, radius = (arcs.of_circle(name)[curved] for name in ("across", "up", "middle", "radius"))
    along = np.arctan2(up @ axes.T, across @ axes.T)  # (n, A): angle of the point furthest along each axis
    found = []
    for angle in (along, along + np.pi):
        edge, axis = np.nonzero((angle - arcs.angle[curved, None]) % (2 * np.pi) <= arcs.sweep[curved, None])
        at = angle[edge, axis][:, None]
        found.append(middle[edge] + radius[edge, None] * (np.cos(at) * across[edge] + np.sin(at) * up[edge]))
    return np.concatenate(found)


def _poles(arcs: Arcs, axes: np.ndarray) -> np.ndarray:
    """Points (n, 3) of the spheres furthest along an axis that bound the region."""
    surfaces = arcs.surfaces
    steps = np.concatenate([axes, -axes])
    points = (surfaces.centres[0][:, None] + surfaces.radii[0][:, None, None] * steps).reshape(1, -1, 3)
    own = np.eye(surfaces.spheres, surfaces.count, dtype=bool).repeat(len(steps), axis=0)
    return points[0][(surfaces.allowed(points)[0] | own).all(axis=1)]
