"""Volume, areas and derivatives of ball regions, exactly, from their edges.

By the divergence theorem 3 V = ∮ x·n dA. On a sphere of centre c and radius r, with the outward unit normal n,
∮ x·n dA = r A + c·N, where N = ∫ n dA is, by Stokes, ½ ∮ (x − c) × dx along the edges. The area A of a face on a unit
sphere is, modulo 4π, the sum over its edges of the signed area between the edge and a fixed point P of the sphere: the
sector that the edge cuts from the cap about its circle's pole a, Δ (1 − h), less the triangle (a, start, end), plus the
triangle (P, start, end); triangles by Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983), eq. 8.
"""

from dataclasses import dataclass

import numpy as np

from wsrender.errors import NumericalError
from wsrender.mechanisms.exact.arcs import Arcs, cross, dot

# Points P by which areas are measured, and by which an almost empty sphere is told from an almost full one.
PROBES = np.array([[0.3608, 0.4817, 0.7986], [-0.7529, 0.1632, -0.6376], [0.2173, -0.9361, 0.2767]])
PROBES /= np.linalg.norm(PROBES, axis=1)[:, None]
ALMOST = 1e-6  # solid angle [sr] within which an area may be 0 or 4π
UNCERTAIN = 1e-6  # of a volume: a region so thin that less of it is sure has no exact volume


@dataclass(frozen=True, eq=False)
class RegionMeasures:
    """Of M regions, in metres: ``volume`` (M,), ``area`` (M, K) and vector area ``facing`` (M, K, 3) by surface.

    The vector area is the integral of the normal that points away from the centre, or out of a half space.
    ``uncertain`` (M,) [m³]: what rounding and the surfaces' small moves may have changed of the volume.
    """

    volume: np.ndarray
    uncertain: np.ndarray
    area: np.ndarray
    facing: np.ndarray

    @property
    def resolved(self) -> np.ndarray:
        """Whether float64 resolves the volume of each region, (M,) bool: thin ones are differences of large numbers."""
        return self.uncertain <= UNCERTAIN * np.abs(self.volume)

    def check_resolved(self) -> None:
        """Raise NumericalError, with the numbers, where a volume is not resolved."""
        for row in np.flatnonzero(~self.resolved)[:1]:
            raise NumericalError(
                f"the workspace is too thin for an exact volume: {self.volume[row]:.3g} m³ is uncertain by "
                f"{self.uncertain[row]:.1g} m³, more than {UNCERTAIN:g} of it; use wider limits, a thousandth of the "
                'leg\'s length or more, or the method "grid" with a refined volume'
            )


@dataclass(frozen=True, eq=False)
class HalfEdges:
    """Every edge seen from each of its two surfaces (2E entries: the first surfaces, then the second).

    ``surface`` (2E,), ``sign`` (2E,): whether the face lies to the left of the edge seen from outside, ``angle``
    (2E,): solid angle on the unit sphere that it cuts off, 0 on planes; ``facing`` (2E, 3): its share of the vector
    area, scaled.
    """

    surface: np.ndarray
    sign: np.ndarray
    angle: np.ndarray
    facing: np.ndarray


def half_edges(arcs: Arcs) -> HalfEdges:
    """The edges as borders of faces."""
    surfaces, sides = arcs.surfaces, arcs.surfaces.sides
    both = arcs.both
    axis, heights = arcs.of_circle("axis"), (arcs.of_circle("height"), arcs.of_circle("other_height"))
    signs = np.concatenate([sides[both[:, 1]], sides[both[:, 0]]])
    surface = both.T.ravel()
    angle, facing = np.zeros(len(surface)), np.zeros((len(surface), 3))
    for end, direction in ((0, 1), (1, -1)):
        rows = slice(end * len(both), (end + 1) * len(both))
        from_to = (arcs.first_point, arcs.last_point)[::direction]
        on_sphere = both[:, end] < surfaces.spheres
        own = np.flatnonzero(on_sphere)
        angle[rows][own], facing[rows][own] = _on_spheres(
            arcs, own, both[own, end], direction * axis[own], heights[end][own], from_to
        )
        own = np.flatnonzero(~on_sphere)
        facing[rows][own] = _on_planes(arcs, own, direction)
    return HalfEdges(surface, signs, signs * angle, signs[:, None] * facing)


def _on_spheres(arcs: Arcs, own, sphere, axis, height, from_to) -> tuple[np.ndarray, np.ndarray]:
    """Solid angles (n,) and vector areas (n, 3) of edges that go anticlockwise about an axis of their sphere."""
    surfaces, region = arcs.surfaces, arcs.region[own]
    centre, radius = surfaces.centres[region, sphere], surfaces.radii[region, sphere]
    start, end = ((points[own] - centre) / radius[:, None] for points in from_to)
    sweep = arcs.sweep[own]
    probe = np.broadcast_to(PROBES[0], start.shape)
    angle = sweep * (1 - height / radius) - _triangle(axis, start, end) + _triangle(probe, start, end)
    square = (radius - height) * (radius + height)
    chord = (end - start) * radius[:, None]
    return angle, (height[:, None] * cross(axis, chord) + (square * sweep)[:, None] * axis) / 2


def _on_planes(arcs: Arcs, own: np.ndarray, direction: int) -> np.ndarray:
    """Vector areas (n, 3) under edges seen from a plane: ½ ∫ x × dx."""
    start, end = arcs.first_point[own], arcs.last_point[own]
    axis, middle, radius = (arcs.of_circle(name)[own] for name in ("axis", "middle", "radius"))
    curved = cross(middle, end - start) + (radius**2 * arcs.sweep[own])[:, None] * axis
    return direction * np.where(arcs.is_line[own][:, None], cross(start, end), curved) / 2


def _triangle(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Signed solid angles of triangles of unit vectors (n, 3), modulo 4π."""
    return 2 * np.arctan2(dot(a, cross(b, c)), 1 + dot(a, b) + dot(b, c) + dot(c, a))


def measures(arcs: Arcs, edges: HalfEdges) -> RegionMeasures:
    """Volume, areas and vector areas of every region.

    The surfaces stand a hair inside the region (`Surfaces.moved_apart`): the volume is that where they were, to first
    order. The square of what that changed is left, and the rounding of solid angles, whose terms are of order 1
    however small the region is.
    """
    surfaces = arcs.surfaces
    count, shape = surfaces.count, (len(surfaces), surfaces.count)
    place = np.concatenate([arcs.region, arcs.region]) * count + edges.surface
    size = len(surfaces) * count
    angle = np.bincount(place, edges.angle, size).reshape(shape)
    touched = np.bincount(place, minlength=size).reshape(shape) > 0
    facing = np.stack([np.bincount(place, part, size) for part in edges.facing.T], axis=-1).reshape(*shape, 3)
    spheres = slice(0, surfaces.spheres)
    angle = solid_angles(angle[:, spheres], touched[:, spheres], probes_inside(arcs))
    r, c = surfaces.radii, surfaces.centres
    area = np.concatenate([angle * r**2, dot(facing[:, surfaces.spheres :], surfaces.normals)], axis=1)
    flux = surfaces.side * (r**3 * angle + dot(c, facing[:, spheres]))
    volume = (flux.sum(axis=1) + (surfaces.offsets * area[:, surfaces.spheres :]).sum(axis=1)) / 3
    moved = (np.abs(area) * surfaces.moves).sum(axis=1)
    edges_of = np.bincount(arcs.region, minlength=len(surfaces))
    rounding = np.finfo(float).eps * (np.sqrt(edges_of) + np.abs(flux).sum(axis=1))
    volume = volume + moved
    uncertain = rounding + moved**2 / np.maximum(np.abs(volume), np.finfo(float).tiny)
    scale = surfaces.scale
    lengths = scale[:, None] ** 2
    return RegionMeasures(volume * scale**3, uncertain * scale**3, area * lengths, facing * lengths[..., None])


def solid_angles(angle: np.ndarray, touched: np.ndarray, probed: np.ndarray) -> np.ndarray:
    """Solid angles between 0 and 4π from what is known modulo 4π, where an edge ``touched`` the sphere at all.

    ``probed`` (…, 3): whether the points PROBES of the sphere lie in its faces.
    """
    full = 4 * np.pi
    angle = angle % full
    mostly = probed.sum(axis=-1) >= 2
    angle = np.where((angle < ALMOST) & mostly, angle + full, angle)
    angle = np.where((angle > full - ALMOST) & ~mostly, angle - full, angle)
    return np.where(touched, angle, np.where(mostly, full, 0.0))


def probes_inside(arcs: Arcs) -> np.ndarray:
    """Whether the probes (M, S, 3) on each sphere belong to the region's boundary."""
    surfaces = arcs.surfaces
    points = surfaces.centres[:, :, None] + surfaces.radii[:, :, None, None] * PROBES
    regions, spheres = surfaces.radii.shape
    allowed = surfaces.allowed(points.reshape(regions, -1, 3)).reshape(regions, spheres, len(PROBES), -1)
    own = np.eye(spheres, surfaces.count, dtype=bool)[None, :, None]
    return (allowed | own).all(axis=3) & surfaces.is_curved[:, :, None]


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
