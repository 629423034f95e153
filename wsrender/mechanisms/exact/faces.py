"""Faces of a ball region: flat triangulations of each, their areas, and how they join."""

from dataclasses import dataclass

import numpy as np
from manifold3d import triangulate

from wsrender.geometry.components import components
from wsrender.mechanisms.exact.borders import Borders
from wsrender.mechanisms.exact.circles import cross
from wsrender.mechanisms.exact.measure import solid_angles


@dataclass(frozen=True, eq=False)
class Chart:
    """A map of a surface to the plane, anticlockwise seen from outside: stereographic of a sphere, a plane's own.

    ``frame`` (3, 3): rows across, up, and the direction ``away`` of the point from which a sphere is projected,
    outside all faces, or the plane's normal. ``radius`` 0: a plane.
    """

    centre: np.ndarray
    radius: float
    frame: np.ndarray

    def flat(self, points: np.ndarray) -> np.ndarray:
        """Points (n, 3) of the surface in the chart, (n, 2)."""
        local = (points - self.centre) @ self.frame.T
        if not self.radius:
            return local[:, :2]
        local /= self.radius
        return local[:, :2] / (1 - local[:, 2:])

    def lifted(self, flat: np.ndarray) -> np.ndarray:
        """Points (n, 3) of the surface at places (n, 2) of the chart."""
        if not self.radius:
            return self.centre + flat @ self.frame[:2]
        square = (flat**2).sum(axis=1)[:, None]
        return self.centre + self.radius * np.hstack([2 * flat, square - 1]) @ self.frame / (square + 1)


@dataclass(frozen=True, eq=False)
class FacesOnSurface:
    """All faces on one surface: places ``flat`` (n, 2) in the chart of the points ``ids`` (n,) along the borders.

    ``triangles`` (t, 3) of them cover the faces; ``face_of_loop`` numbers the face of each of the surface's loops.
    """

    surface: int
    chart: Chart
    ids: np.ndarray
    flat: np.ndarray
    triangles: np.ndarray
    face_of_loop: np.ndarray


@dataclass(frozen=True, eq=False)
class Face:
    """A face: its surface, its loops of half edges, solid angle of a sphere's face and vector area, scaled."""

    surface: int
    loops: list[list[int]]
    angle: float
    facing: np.ndarray


def patches(borders: Borders) -> list[FacesOnSurface]:
    """The triangulated faces of every surface that has borders."""
    return [_patch(borders, surface) for surface, loops in enumerate(borders.loops) if loops]


def _patch(borders: Borders, surface: int) -> FacesOnSurface:
    chart = _chart(borders, surface)
    polygons = [borders.polygon(loop) for loop in borders.loops[surface]]
    flat = [chart.flat(borders.points[polygon]) for polygon in polygons]
    triangles = triangulate(flat)
    number = components(sum(map(len, polygons)), *triangles[:, [0, 1, 0, 2]].reshape(-1, 2).T)
    first_points = np.cumsum([0, *(len(polygon) for polygon in polygons[:-1])])
    face_of_loop = np.unique(number[first_points], return_inverse=True)[1]
    return FacesOnSurface(surface, chart, np.concatenate(polygons), np.concatenate(flat), triangles, face_of_loop)


def _chart(borders: Borders, surface: int) -> Chart:
    arcs, half_edges = borders.arcs, borders.half_edges
    surfaces = arcs.surfaces
    if surface >= surfaces.spheres:
        normal = surfaces.normals[surface - surfaces.spheres]
        return Chart(normal * surfaces.offsets[0, surface - surfaces.spheres], 0.0, _frame(normal, 1))
    centre, radius = surfaces.centres[0, surface], float(surfaces.radii[0, surface])
    edges = len(arcs.region)
    halves = np.flatnonzero(half_edges.surface == surface)
    first = halves < edges
    axis = np.where(first[:, None], 1, -1) * arcs.of_circle("axis")[halves % edges]
    height = np.where(first, arcs.of_circle("height")[halves % edges], arcs.of_circle("other_height")[halves % edges])
    sign = half_edges.sign[halves]
    widest = np.argmax(sign * height)  # of the caps that the edges' circles cut off, the largest
    return Chart(centre, radius, _frame(-sign[widest] * axis[widest], -1))


def _frame(away: np.ndarray, turn: int) -> np.ndarray:
    """Rows across, up, away; across × up is ``turn`` times away."""
    across = cross(away, np.eye(3)[np.abs(away).argmin()])
    across /= np.linalg.norm(across)
    return np.array([across, turn * cross(away, across), away])


def faces(borders: Borders, surface_patches: list[FacesOnSurface], probed: np.ndarray) -> list[Face]:
    """All faces, whole spheres included; ``probed`` (S, 3) as in `solid_angles`."""
    found, half_edges = [], borders.half_edges
    for patch in surface_patches:
        loops = borders.loops[patch.surface]
        count = patch.face_of_loop.max() + 1
        for face in range(count):
            own = [loops[k] for k in np.flatnonzero(patch.face_of_loop == face)]
            halves = [half for loop in own for half in loop]
            angle = 0.0
            if patch.chart.radius:
                # Only the one face of a sphere can be almost all of it.
                seen = probed[patch.surface] if count == 1 else np.zeros(3, bool)
                angle = float(solid_angles(half_edges.angle[halves].sum(), np.array(True), seen))
            found.append(Face(patch.surface, own, angle, half_edges.facing[halves].sum(axis=0)))
    for sphere in range(borders.arcs.surfaces.spheres):
        if not borders.loops[sphere] and probed[sphere].all():
            found.append(Face(sphere, [], 4 * np.pi, np.zeros(3)))
    return found
