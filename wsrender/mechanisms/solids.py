"""Workspaces of ball regions by boolean operations on meshes of balls (method D of [SNK]), with manifold3d."""

from functools import lru_cache

import manifold3d
import numpy as np
import trimesh

from wsrender.errors import InputError
from wsrender.mechanisms.ball_region import BallRegion

SUBDIVISIONS = 5  # of an icosahedron: 20,480 triangles, edges of 0.034 of the radius


def solid_workspace(region: BallRegion, subdivisions: int = SUBDIVISIONS) -> trimesh.Trimesh:
    """Closed mesh of a region [m], without faces where it is empty; InputError where the region is unbounded.

    Every ball is an icosahedron, its edges halved ``subdivisions`` times, of the ball's own volume: its vertices lie
    outside the sphere by as much as its faces lie inside, so errors of intersections cancel too. The attribute
    ``surface`` of the triangles numbers the surface of each, as in `surface_table`; of equal balls it is the first's.
    """
    if not len(region.inside_radii) and not np.isfinite([region.lower, region.upper]).all():
        raise InputError("inside_radii", "is empty and the box is not finite: the region is unbounded")
    balls = _balls(region, subdivisions)
    inside = [ball for number, ball in balls.items() if number < len(region.inside_radii)]
    outside = [ball for number, ball in balls.items() if number >= len(region.inside_radii)]
    solid = manifold3d.Manifold.batch_boolean(inside or [_box(region)], manifold3d.OpType.Intersect)
    for normal, offset in zip(*region.sides_of_box(), strict=True):
        solid = solid.trim_by_plane((-normal).tolist(), float(-offset))
    if outside:
        solid = manifold3d.Manifold.batch_boolean([solid, *outside], manifold3d.OpType.Subtract)
    mesh = solid.to_mesh64()
    metadata = {"frame": "base", "unit": "m", "up": "z"}
    vertices = np.asarray(mesh.vert_properties)[:, :3]
    found = trimesh.Trimesh(vertices, np.asarray(mesh.tri_verts), process=False, metadata=metadata)
    found.face_attributes["surface"] = _surface_numbers(region, balls, mesh, found)
    return found


def _surface_numbers(
    region: BallRegion, balls: dict[int, manifold3d.Manifold], mesh: manifold3d.Mesh64, found: trimesh.Trimesh
) -> np.ndarray:
    """The surface of every triangle, (T,): the ball that it was part of, or the nearest side of the box."""
    number_of = {ball.original_id(): number for number, ball in balls.items()}
    triangles = np.diff(np.asarray(mesh.run_index, np.int64)) // 3
    owner = np.repeat(np.array([number_of.get(k, -1) for k in mesh.run_original_id], np.int32), triangles)
    flat = owner < 0
    if flat.any():
        normals, offsets = region.sides_of_box()
        apart = np.abs(found.triangles_center[flat] @ normals.T - offsets)
        owner[flat] = len(region.inside_radii) + len(region.outside_radii) + apart.argmin(axis=1)
    return owner


@lru_cache(maxsize=4)
def _unit_ball(subdivisions: int) -> manifold3d.Manifold:
    ball = trimesh.creation.icosphere(subdivisions)
    vertices = ball.vertices * np.cbrt(4 * np.pi / 3 / ball.volume)
    return manifold3d.Manifold(manifold3d.Mesh64(vertices, ball.faces.astype(np.uint64)))


def _balls(region: BallRegion, subdivisions: int) -> dict[int, manifold3d.Manifold]:
    """Balls by number, equal ones once: they take a boolean operation longest."""
    unit, count = _unit_ball(subdivisions), len(region.inside_radii)
    centres = np.concatenate([region.inside_centres, region.outside_centres]).reshape(-1, 3)
    rows = np.column_stack([centres, np.concatenate([region.inside_radii, region.outside_radii])])
    _, first = np.unique(np.column_stack([np.arange(len(rows)) < count, rows]), axis=0, return_index=True)
    balls = {}
    for number in np.sort(first).tolist():
        *centre, radius = rows[number].tolist()
        ball = unit.scale((radius,) * 3).translate(centre)
        balls[number] = ball.as_original()  # so that its triangles know it afterwards
    return balls


def _box(region: BallRegion) -> manifold3d.Manifold:
    """The box of a region that has no inside ball."""
    size = np.subtract(region.upper, region.lower)
    return manifold3d.Manifold.cube(size.tolist()).translate(np.asarray(region.lower, np.float64).tolist())
