"""Alpha shapes of point sets (Edelsbrunner and Mücke, *Three-dimensional alpha shapes*, 1994)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh
from scipy.spatial import Delaunay

from wsrender.errors import InputError

_SHAKE = 1e-9
_FLATTEST = 1e-6  # least to largest extent of points that enclose a volume
_ROUNDING = 1e-14  # extent of one point's copies, to its coordinates
# Corners of the face opposite to each corner of a tetrahedron.
_FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])


@dataclass(frozen=True, eq=False)
class AlphaShape:
    """The solid part of an alpha shape: tetrahedra whose circumspheres have a radius of at most ``alpha_m``.

    They are those of the Delaunay triangulation that ``kept`` (T,) says; ``points`` (N, 3) are the corners [m].
    """

    points: np.ndarray
    delaunay: Delaunay
    kept: np.ndarray
    alpha_m: float

    @classmethod
    def of(cls, points: np.ndarray, alpha_m: float | None = None) -> "AlphaShape":
        """The shape of points (N, 3) [m], by default of twice the smallest radius with which all of them belong to it.

        Twice, so that chance gaps between samples do not look like voids.

        Raises InputError where they lie in a plane or the radius keeps nothing.
        """
        points = spatial(points)
        if alpha_m is not None and not (np.isfinite(alpha_m) and alpha_m > 0):
            raise InputError("alpha_shape", f"{alpha_m!r} is not allowed; a radius above 0 [m] is")
        delaunay = Delaunay(_in_general_position(points))
        radii = _circumradii(delaunay)
        if alpha_m is None:
            alpha_m = 2 * _covering_radius(delaunay, radii)
        kept = radii <= alpha_m
        if not kept.any():
            smallest = f"the smallest tetrahedron has {radii.min():.3g} m"
            raise InputError("alpha_shape", f"{alpha_m:g} m is too small; {smallest}")
        return cls(points, delaunay, kept, float(alpha_m))

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether each point (N, 3) [m] lies in the shape, (N,) bool."""
        inside = self.located.find_simplex(points)
        return (inside >= 0) & self.kept[inside]

    @cached_property
    def located(self) -> Delaunay:
        """The triangulation with its ``transform``, which SciPy makes with a call of LAPACK for each tetrahedron.

        Its threads wait for one another: a second becomes ten where other programs run.
        """
        self.delaunay._transform = _barycentric(self.delaunay)  # type: ignore[attr-defined]
        return self.delaunay

    @property
    def sixfold_m3(self) -> np.ndarray:
        """Six times the volume of each of the kept tetrahedra, (K,)."""
        a, b, c, d = np.moveaxis(self.points[self.delaunay.simplices[self.kept]], 1, 0)
        return np.abs(np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a)))

    @property
    def volume_m3(self) -> float:
        """Volume of the kept tetrahedra."""
        return float(self.sixfold_m3.sum() / 6)

    def mesh(self) -> trimesh.Trimesh:
        """The boundary as a closed mesh with outward normals; its volume is that of the tetrahedra.

        Where the solid touches itself along an edge, more than two triangles meet there: each further wedge of the
        solid gets a vertex of its own in the middle of the edge, so that every edge of the mesh has two triangles and
        no point moves. ``metadata["split_edges"]`` counts these.
        """
        tetrahedron, opposite = np.nonzero(self.kept[:, None] & ~self._kept_neighbours)
        faces = self._oriented(tetrahedron, opposite)
        surface = _Surface(self, tetrahedron, opposite, faces)
        vertices, triangles, split = surface.manifold()
        metadata = {"frame": "world", "unit": "m", "up": "z", "alpha_m": self.alpha_m, "split_edges": split}
        mesh = trimesh.Trimesh(vertices, triangles, process=False, metadata=metadata)
        mesh.remove_unreferenced_vertices()
        return mesh

    @cached_property
    def _kept_neighbours(self) -> np.ndarray:
        neighbours = self.delaunay.neighbors
        return (neighbours >= 0) & self.kept[neighbours]

    def _oriented(self, tetrahedron: np.ndarray, opposite: np.ndarray) -> np.ndarray:
        """Corners (F, 3) of faces, counter-clockwise seen from outside."""
        corners = self.delaunay.simplices[tetrahedron]
        faces = np.take_along_axis(corners, _FACES[opposite], axis=1)
        a, b, c = np.moveaxis(self.delaunay.points[faces], 1, 0)
        inner = self.delaunay.points[corners[np.arange(len(corners)), opposite]]
        inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), inner - a) > 0
        faces[inward] = faces[inward][:, ::-1]
        return faces


@dataclass(frozen=True, eq=False)
class _Surface:
    """The boundary faces of a shape: face f is opposite to corner ``opposite[f]`` of ``tetrahedron[f]``."""

    shape: AlphaShape
    tetrahedron: np.ndarray  # (F,)
    opposite: np.ndarray  # (F,)
    faces: np.ndarray  # (F, 3)

    def manifold(self) -> tuple[np.ndarray, np.ndarray, int]:
        """Vertices, triangles in which every edge has two triangles, and the number of edges split for it."""
        points = self.shape.points
        extra: list[np.ndarray] = []
        middles: dict[int, dict[frozenset[int], int]] = {}  # by face: its split edges and their vertices
        for edge, touching in self._crowded_edges():
            wedges = {frozenset((face, self._across(face, edge))) for face in touching}
            for wedge in sorted(wedges, key=min)[1:]:
                for face in wedge:
                    middles.setdefault(face, {})[frozenset(edge)] = len(points) + len(extra)
                extra.append(points[list(edge)].mean(axis=0))
        split = len(extra)
        whole = np.ones(len(self.faces), bool)
        whole[list(middles)] = False
        triangles = [self.faces[whole]]
        for face, vertices in middles.items():
            corners = self.faces[face]
            ring = [v for a, b in zip(corners, np.roll(corners, -1), strict=True) for v in _side(a, b, vertices)]
            center = len(points) + len(extra)
            extra.append(points[corners].mean(axis=0))
            triangles.append(np.array([[a, b, center] for a, b in zip(ring, ring[1:] + ring[:1], strict=True)]))
        return np.concatenate([points, np.reshape(extra, (-1, 3))]), np.concatenate(triangles), split

    def _crowded_edges(self) -> list[tuple[tuple[int, int], list[int]]]:
        """Edges of more than two faces, and these."""
        edges = np.sort(self.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        unique, which, count = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
        order = np.argsort(which, kind="stable")
        ends = np.cumsum(count)
        return [
            ((int(unique[k, 0]), int(unique[k, 1])), (order[ends[k] - count[k] : ends[k]] // 3).tolist())
            for k in np.flatnonzero(count > 2)
        ]

    def _across(self, face: int, edge: tuple[int, int]) -> int:
        """The face at the other side of the wedge of the solid between a face and an edge of it."""
        corners, neighbours = self.shape.delaunay.simplices, self.shape.delaunay.neighbors
        t, behind = self.tetrahedron[face], self.opposite[face]
        ahead = next(k for k in range(4) if k != behind and corners[t, k] not in edge)
        while self.shape._kept_neighbours[t, ahead]:
            hinge = corners[t, behind]
            t = neighbours[t, ahead]
            ahead = int(np.flatnonzero(corners[t] == hinge)[0])
            behind = next(k for k in range(4) if k != ahead and corners[t, k] not in edge)
        return self._face_of[int(t), ahead]

    @cached_property
    def _face_of(self) -> dict[tuple[int, int], int]:
        places = zip(self.tetrahedron.tolist(), self.opposite.tolist(), strict=True)
        return {place: face for face, place in enumerate(places)}


def _covering_radius(delaunay: Delaunay, radii: np.ndarray) -> float:
    """The smallest radius of circumspheres with which every point is a corner of a kept, not flat tetrahedron."""
    a, b, c, d = np.moveaxis(delaunay.points[delaunay.simplices], 1, 0)
    sixfold = np.abs(np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a)))
    solid = sixfold > _FLATTEST * radii**3
    smallest = np.full(len(delaunay.points), np.inf)
    np.minimum.at(smallest, delaunay.simplices[solid].ravel(), np.repeat(radii[solid], 4))
    return float(smallest[np.isfinite(smallest)].max()) * (1 + _FLATTEST)  # points on one sphere, to rounding


def spatial(points: np.ndarray) -> np.ndarray:
    """The points as float64 (N, 3); InputError where they lie in a plane, or are no points."""
    points = np.asarray(points, np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise InputError("points", f"have shape {points.shape}; finite coordinates of shape (N, 3) are needed")
    extents = np.linalg.svd(points - points.mean(axis=0), compute_uv=False) if len(points) > 3 else np.zeros(3)
    rounding = _ROUNDING * np.linalg.norm(points)
    if not extents[2] > max(_FLATTEST * extents[0], rounding):
        raise InputError("points", f"are {len(points)} points in a plane, which enclose no volume")
    return points


def _barycentric(delaunay: Delaunay) -> np.ndarray:
    """`Delaunay.transform` (T, 4, 3)."""
    corners = np.moveaxis(delaunay.points[delaunay.simplices], 1, 0)
    edges = np.stack([corners[k] - corners[3] for k in range(3)], axis=2)
    found, solid = np.full((len(edges), 4, 3), np.nan), np.flatnonzero(np.linalg.det(edges))
    inverse = np.linalg.inv(edges[solid])
    found[solid] = np.concatenate([inverse, corners[3][solid][:, None]], axis=1)
    condition = np.linalg.norm(edges[solid], 1, axis=(1, 2)) * np.linalg.norm(inverse, 1, axis=(1, 2))
    found[solid[condition * 1000 * np.finfo(float).eps > 1]] = np.nan  # flat ones hold nothing, as SciPy has it
    return found


def _in_general_position(points: np.ndarray) -> np.ndarray:
    """The points moved by up to a billionth of their extent, always in the same way.

    Samples on a grid have many points on one sphere; then some tetrahedra are flat, and have no inside to turn away
    from.
    """
    amplitude = _SHAKE * np.ptp(points, axis=0).max()
    return points + np.random.default_rng(0).uniform(-amplitude, amplitude, points.shape)


def _side(a: int, b: int, middles: dict[frozenset[int], int]) -> list[int]:
    middle = middles.get(frozenset((int(a), int(b))))
    return [int(a)] if middle is None else [int(a), middle]


def _circumradii(delaunay: Delaunay) -> np.ndarray:
    """Radii of the circumspheres (T,) [m], from the facets of the lifted paraboloid."""
    normal, lift, offset = delaunay.equations[:, :3], delaunay.equations[:, 3], delaunay.equations[:, 4]
    with np.errstate(divide="ignore", invalid="ignore"):
        steepness = lift * delaunay.paraboloid_scale
        center = -normal / (2 * steepness)[:, None]
        squared = (center**2).sum(axis=1) - (offset + lift * delaunay.paraboloid_shift) / steepness
    return np.sqrt(np.where(np.isfinite(squared), np.maximum(squared, 0.0), np.inf))
