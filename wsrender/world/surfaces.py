"""Solids by their closed surface: what the triangles of a mesh enclose, and the ground under a field of heights."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull

from wsrender.documents.shapes import MOST_HEIGHTS, HeightField, Mesh
from wsrender.errors import InputError
from wsrender.robots.array_files import content_of, of_npy
from wsrender.robots.hulls import LEAST_M3, MOST_VERTICES
from wsrender.robots.mesh_files import Triangles
from wsrender.robots.triangles import ground
from wsrender.world.meshes import triangles_of

MOST_TRIANGLES = 100_000  # grids and trees of so many take seconds
MOST_HEIGHT_BYTES = 64 * MOST_HEIGHTS
CONVEX = 1e-9  # of the hull's volume, which a convex solid may lack by rounding


@dataclass(frozen=True, eq=False)
class ClosedSurface:
    """What triangles ``faces`` (F, 3) of ``vertices`` (V, 3) [m] enclose; its own frame stands at ``T`` (4, 4)."""

    vertices: np.ndarray
    faces: np.ndarray
    T: np.ndarray
    shape: str = "surface"

    def matrix(self) -> np.ndarray:
        """Its frame in the world, as other shapes say it."""
        return self.T

    @property
    def is_convex(self) -> bool:
        """Whether it is its own convex hull, and one of few corners."""
        hull = ConvexHull(self.vertices)
        return len(hull.vertices) <= MOST_VERTICES and hull.volume - _volume(self.vertices, self.faces) <= (
            CONVEX * hull.volume
        )


def surface_of(item: Mesh | HeightField) -> ClosedSurface:
    """The solid of an item itself.

    Raises InputError, naming the field, for what cannot be read, is not closed, encloses no volume or is too large.
    """
    if isinstance(item, HeightField):
        return ClosedSurface(*ground(_heights(item), item.size_m), item.matrix())
    field, (vertices, faces) = "path" if item.model is None else "model", triangles_of(item)
    return ClosedSurface(*closed(vertices, faces, field), item.matrix())


def closed(vertices: np.ndarray, faces: np.ndarray, field: str) -> Triangles:
    """The triangles of a closed surface (V, 3) [m], (F, 3), turned outwards, without those of no area.

    Raises InputError for a surface that is not closed, whose triangles do not turn alike, that encloses no volume, and
    for one of more than MOST_TRIANGLES.
    """
    if len(faces) > MOST_TRIANGLES:
        raise InputError(field, f"has {len(faces)} triangles; a solid may have {MOST_TRIANGLES}: give a simpler mesh")
    vertices, own = np.unique(vertices, axis=0, return_inverse=True)
    faces = own.reshape(-1)[faces]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    undirected, which = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    turns = np.bincount(which.reshape(-1), np.where(edges[:, 0] < edges[:, 1], 1, -1), len(undirected))
    uses = np.bincount(which.reshape(-1), minlength=len(undirected))
    remedy = 'mend it, or give it as a "convex_mesh", its hull'
    if (uses % 2).any():
        message = f"is not closed: {int((uses % 2).sum())} edges are not those of two triangles; {remedy}"
        raise InputError(field, message)
    if turns.any():
        message = f"has {int((turns != 0).sum())} edges whose triangles do not turn alike; {remedy}"
        raise InputError(field, message)
    volume = _volume(vertices, faces)
    if abs(volume) < LEAST_M3:
        raise InputError(field, f"encloses {abs(volume):.2g} m³; at least {LEAST_M3:g} m³ are needed")
    faces = faces[:, ::-1] if volume < 0 else faces
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return vertices, np.ascontiguousarray(faces[np.cross(b - a, c - a).any(axis=1)])


def _heights(item: HeightField) -> np.ndarray:
    if item.heights_m is not None:
        return np.array(item.heights_m)
    field = "path" if item.model is None else "model"
    return item.length_unit_m * _read(content_of(item.path, item.model, field), field)


def _read(content: bytes, field: str) -> np.ndarray:
    """Heights of a .npy file, which may come from strangers: nothing is unpickled."""
    allowed = f"it must hold at least 2 rows of at least 2 positive numbers, at most {MOST_HEIGHTS} in all"
    if len(content) > MOST_HEIGHT_BYTES:
        raise InputError(field, f"has {len(content)} bytes; {allowed}")
    heights = of_npy(content, field, "the file", allowed)
    if min(heights.shape) < 2 or heights.size > MOST_HEIGHTS:
        raise InputError(field, f"has the shape {heights.shape}; {allowed}")
    if not (np.isfinite(heights).all() and (heights > 0).all()):
        raise InputError(field, f"holds heights that are not positive numbers; {allowed}")
    return heights.astype(np.float64)


def _volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = (vertices - vertices.mean(axis=0))[faces].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6
