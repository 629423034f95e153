"""Closed meshes as convex pieces: cut along planes of their faces until every piece is as good as its hull.

A piece P whose faces' planes bound a kernel K, from which all of P is seen, holds K. Where no corner of P is further
than δ above a face's plane, K holds a ball of radius r about k, and the hull of P lies within D of k, a point of the
hull moved towards k by δ D / (r + δ) is in K: the hull goes beyond P by no more than that.
"""

import manifold3d
import numpy as np
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, QhullError

from wsrender.errors import InputError
from wsrender.robots.hulls import LEAST_M3

MOST_PIECES = 100
MOST_TRIANGLES = 5_000  # each face is looked at from each corner: 100 MB
THIN_M = 1e-6  # pieces with no ball of that radius within are left out, and those smaller than MuJoCo takes
# Of a mesh's size, by which a cut is away from the face whose plane it follows: one along it leaves folds of no volume.
SHIFT = 1e-8
FOLD = 1e-9  # of a part's volume, below which a cut has cut nothing off
ROUNDING = 5e-8  # of the size of a mesh, by which corners may be off a plane that they are on


def convex_pieces(vertices: np.ndarray, faces: np.ndarray, tolerance_m: float, field: str) -> list[np.ndarray]:
    """Corners (V, 3) [m] of convex pieces that hold a solid and go at most ``tolerance_m`` beyond it.

    ``vertices`` (V, 3) [m], ``faces`` (F, 3): its closed surface. Raises InputError for a surface that is not closed,
    encloses no volume, is too thin for its size or has too many triangles, and where MOST_PIECES do not suffice.
    """
    left, found = [_solid(vertices, faces, field)], []
    size = float(np.ptp(vertices, axis=0).max())
    while left:
        part = left.pop()
        cut = _Part(part, size, tolerance_m, field)
        if cut.thin:
            continue
        if cut.good:
            found.append(cut.corners)
        else:
            left += [each for half in cut.halves for each in _apart(half)]
        if len(found) + len(left) > MOST_PIECES:
            message = f"takes more than {MOST_PIECES} convex pieces that keep to tolerance_m, {tolerance_m:g}"
            raise InputError(field, f"{message}: allow more, or give a simpler mesh")
    if not found:
        raise InputError(field, "encloses no volume")
    return found


def _solid(vertices: np.ndarray, faces: np.ndarray, field: str) -> manifold3d.Manifold:
    vertices, own = np.unique(vertices, axis=0, return_inverse=True)
    faces = own.reshape(-1)[faces]
    if len(faces) > MOST_TRIANGLES:
        raise InputError(field, f"has {len(faces)} triangles; a solid may have {MOST_TRIANGLES}")
    try:
        ConvexHull(vertices)
    except QhullError as error:
        raise InputError(field, "encloses no volume") from error
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    _, uses = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    if (uses != 2).any():
        raise InputError(field, f"is not closed: {int((uses != 2).sum())} edges are not those of two triangles")
    corners = vertices[faces]
    if np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) < 0:
        faces = faces[:, ::-1]
    mesh = manifold3d.Mesh64(np.ascontiguousarray(vertices), np.ascontiguousarray(faces, np.uint64))
    solid = manifold3d.Manifold(mesh)
    if solid.status() != manifold3d.Error.NoError:
        raise InputError(field, f"is not the surface of a solid: {solid.status().name}")
    if solid.is_empty() or solid.volume() <= 0:
        raise InputError(field, "encloses no volume")
    return solid


def _apart(part: manifold3d.Manifold) -> list[manifold3d.Manifold]:
    """The parts of one that do not hang together; it as a whole where one of them bounds a void."""
    parts = part.decompose()
    return parts if all(each.volume() > 0 for each in parts) else [part]


class _Part:
    """What is known of a part: whether its hull will do (``good``), or else the ``halves`` of a cut."""

    def __init__(self, part: manifold3d.Manifold, size: float, tolerance_m: float, field: str):
        mesh = part.to_mesh64()
        points, faces = np.array(mesh.vert_properties)[:, :3], np.array(mesh.tri_verts).astype(int)
        a, b, c = points[faces].transpose(1, 0, 2)
        across = np.cross(b - a, c - a)
        areas = np.linalg.norm(across, axis=1)
        longest = np.linalg.norm([b - a, c - b, a - c], axis=2).max(axis=0)
        flat = areas > 4 * SHIFT * size * longest  # slivers are what cuts beside planes have left
        normals, at, areas = across[flat] / areas[flat, None], a[flat], areas[flat]
        offsets = np.einsum("ij,ij->i", normals, at)
        above = (normals @ points.T).max(axis=1) - offsets
        self.thin, self.good = True, False
        try:
            hull = ConvexHull(points)
        except QhullError:
            return
        in_it = _inner_ball(hull.equations[:, :3], -hull.equations[:, 3])[1]
        self.thin = in_it < THIN_M or hull.volume < LEAST_M3
        if self.thin:
            return
        self.corners = points[hull.vertices]
        while not self.good:
            if not len(normals):
                raise InputError(field, f"has a part too thin for its size, {size:g} m, to be cut: give a simpler mesh")
            center, radius = _inner_ball(normals, offsets)
            most = max(float(above.max()) - ROUNDING * size, 0.0)
            beyond = most / (radius + most) if radius > 0 else np.inf
            reach = np.linalg.norm(self.corners - center, axis=1).max()
            self.good = most == 0.0 or beyond * reach <= tolerance_m
            if self.good:
                break
            worst = int((above * areas).argmax())
            self.halves = part.split_by_plane(normals[worst], float(offsets[worst]) + SHIFT * size)
            if min(half.volume() for half in self.halves) > FOLD * part.volume():
                break
            # Boolean operations may leave folds without volume, whose faces bound nothing.
            same = (normals @ normals[worst] > 1 - ROUNDING) & (np.abs(offsets - offsets[worst]) < ROUNDING * size)
            normals, offsets, above, areas = normals[~same], offsets[~same], above[~same], areas[~same]


def _inner_ball(normals: np.ndarray, offsets: np.ndarray) -> tuple[np.ndarray, float]:
    """Centre (3,) and radius of the largest ball in normals · x ≤ offsets; a radius of 0 where there is none."""
    lhs = np.column_stack([normals, np.ones(len(normals))])
    found = linprog([0, 0, 0, -1], A_ub=lhs, b_ub=offsets, bounds=[(None, None)] * 3 + [(0, None)])
    return (found.x[:3], float(found.x[3])) if found.success else (np.zeros(3), 0.0)
