"""Workspaces of ball regions by boolean operations on meshes of balls (method D of [SNK]), with manifold3d."""

from functools import lru_cache

import manifold3d
import numpy as np
import trimesh

from wsrender.errors import InputError
from wsrender.parallel.ball_region import BallRegion

SUBDIVISIONS = 5  # of an icosahedron: 20,480 triangles, edges of 0.034 of the radius


def solid_workspace(region: BallRegion, subdivisions: int = SUBDIVISIONS) -> trimesh.Trimesh:
    """Closed mesh of a region [m], without faces where it is empty; InputError where the region is unbounded.

    Every ball is an icosahedron, its edges halved ``subdivisions`` times, of the ball's own volume: its vertices lie
    outside the sphere by as much as its faces lie inside, so errors of intersections cancel too.
    """
    if not len(region.inside_radii) and not np.isfinite([region.lower, region.upper]).all():
        raise InputError("inside_radii", "is empty and the box is not finite: the region is unbounded")
    inside = _balls(region.inside_centres, region.inside_radii, subdivisions)
    outside = _balls(region.outside_centres, region.outside_radii, subdivisions)
    solid = manifold3d.Manifold.batch_boolean(inside or [_box(region)], manifold3d.OpType.Intersect)
    for axis in range(3):
        for bound, sign in ((region.lower[axis], 1), (region.upper[axis], -1)):
            if np.isfinite(bound):
                solid = solid.trim_by_plane((sign * np.eye(3)[axis]).tolist(), float(sign * bound))
    if outside:
        solid = manifold3d.Manifold.batch_boolean([solid, *outside], manifold3d.OpType.Subtract)
    mesh = solid.to_mesh64()
    metadata = {"frame": "base", "unit": "m", "up": "z"}
    vertices = np.asarray(mesh.vert_properties)[:, :3]
    return trimesh.Trimesh(vertices, np.asarray(mesh.tri_verts), process=False, metadata=metadata)


@lru_cache(maxsize=4)
def _unit_ball(subdivisions: int) -> manifold3d.Manifold:
    ball = trimesh.creation.icosphere(subdivisions)
    vertices = ball.vertices * np.cbrt(4 * np.pi / 3 / ball.volume)
    return manifold3d.Manifold(manifold3d.Mesh64(vertices, ball.faces.astype(np.uint64)))


def _balls(centres: np.ndarray, radii: np.ndarray, subdivisions: int) -> list[manifold3d.Manifold]:
    """Balls, equal ones once: they take a boolean operation longest."""
    unit = _unit_ball(subdivisions)
    different = np.unique(np.column_stack([centres, radii]), axis=0)
    return [unit.scale((radius,) * 3).translate(centre) for *centre, radius in different.tolist()]


def _box(region: BallRegion) -> manifold3d.Manifold:
    """The box of a region that has no inside ball."""
    size = np.subtract(region.upper, region.lower)
    return manifold3d.Manifold.cube(size.tolist()).translate(np.asarray(region.lower, np.float64).tolist())
