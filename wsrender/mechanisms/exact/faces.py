"""Faces of a ball region: the polylines that border them, flat triangulations, areas, and how they join to shells."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from manifold3d import triangulate

from wsrender.geometry.components import components
from wsrender.mechanisms.exact.arcs import Arcs, cross
from wsrender.mechanisms.exact.measure import HalfEdges, solid_angles
from wsrender.mechanisms.exact.surfaces import Surfaces

LEAST_PIECES = 12  # of a whole circle
LARGEST_ANGLE = 0.1  # rad that an edge of a mesh spans on its sphere
# Edges shorter than this, relative to the largest radius, come of moving concurrent and tangent surfaces apart by
# 1e-11 (they open by 1e-5 where they touch): they are counted as points.
SHORT = 2e-5


@dataclass(frozen=True, eq=False)
class Borders:
    """Points along the edges of one region, scaled, and of every face's loops.

    ``points`` (P, 3): first the vertices. ``lines``: of each edge the points from start to end, of a whole circle the
    first again at the end. ``loops``: of each surface the loops, each a list of half edges in the order in which they
    surround a face, anticlockwise seen from outside.
    """

    arcs: Arcs
    half_edges: HalfEdges
    points: np.ndarray
    lines: list[np.ndarray]
    loops: list[list[list[int]]]

    def polygon(self, loop: list[int]) -> np.ndarray:
        """Points along a loop, each once."""
        edges = len(self.lines)
        lines = [self.lines[half % edges][:: 1 if _is_forward(self.half_edges, half, edges) else -1] for half in loop]
        return np.concatenate([line[:-1] for line in lines])


def borders(arcs: Arcs, half_edges: HalfEdges, step: float) -> Borders:
    """Polylines of the edges of a single region, in steps of at most ``step`` (scaled) and as `steps_of` says."""
    steps = steps_of(arcs.surfaces, step)[arcs.both].min(axis=1)
    points, lines, total = [arcs.vertices], [], len(arcs.vertices)
    for edge, (start, end) in enumerate(zip(arcs.start, arcs.end, strict=True)):
        inner = _inner_points(arcs, edge, steps[edge])
        ids = np.arange(total, total + len(inner))
        lines.append(np.append(ids, ids[0]) if start < 0 else np.concatenate([[start], ids, [end]]))
        points.append(inner)
        total += len(inner)
    return Borders(arcs, half_edges, np.concatenate(points), lines, list(_loops(arcs, half_edges)))


def steps_of(surfaces: Surfaces, step: float) -> np.ndarray:
    """Longest edges (K,) of the mesh of each surface of a single region, scaled: small spheres have shorter ones."""
    radii = np.concatenate([surfaces.radii[0], np.full(len(surfaces.normals), np.inf)])
    return np.minimum(step, LARGEST_ANGLE * radii)


def _inner_points(arcs: Arcs, edge: int, step: float) -> np.ndarray:
    """Points of an edge between its ends, (n, 3); of a whole circle all."""
    region, pair, rings = arcs.region[edge], arcs.pair[edge], arcs.circles
    sweep, whole = arcs.sweep[edge], arcs.start[edge] < 0
    if arcs.is_line[edge]:
        pieces = int(np.ceil(sweep / step))
        shares = np.arange(1, pieces)[:, None] / pieces
        return arcs.first_point[edge] + shares * (arcs.last_point[edge] - arcs.first_point[edge])
    radius = rings.radius[region, pair]
    pieces = max(int(np.ceil(sweep * max(radius / step, LEAST_PIECES / (2 * np.pi)))), 2)
    angle = (arcs.angle[edge] + sweep * np.arange(0 if whole else 1, pieces) / pieces)[:, None]
    turned = np.cos(angle) * rings.across[region, pair] + np.sin(angle) * rings.up[region, pair]
    return rings.middle[region, pair] + radius * turned


def _is_forward(half_edges: HalfEdges, half: int, edges: int) -> bool:
    """Whether a half edge goes along its edge from start to end: the second surface sees its axis from behind."""
    return (half_edges.sign[half] > 0) == (half < edges)


def _loops(arcs: Arcs, half_edges: HalfEdges) -> Iterator[list[list[int]]]:
    edges = len(arcs.region)
    ends = []
    for half in range(2 * edges):
        both = (int(arcs.start[half % edges]), int(arcs.end[half % edges]))
        ends.append(both if _is_forward(half_edges, half, edges) else both[::-1])
    for surface in range(arcs.surfaces.count):
        halves = np.flatnonzero(half_edges.surface == surface).tolist()
        loops = [[half] for half in halves if ends[half][0] < 0]
        leaving = {ends[half][0]: half for half in halves if ends[half][0] >= 0}
        while leaving:
            first, half = leaving.popitem()
            loop = [half]
            while ends[half][1] != first:
                half = leaving.pop(ends[half][1])
                loop.append(half)
            loops.append(loop)
        yield loops


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


@dataclass(frozen=True)
class Topology:
    """Numbers of vertices, edges (a whole circle is one, without vertex), faces, loops of edges around faces, parts.

    ``components`` are the separate solid parts, ``voids`` the hollows in them, ``genus`` the number of handles of all
    shells together. Edges and faces narrower than 2e-5 of the largest radius are not counted.
    """

    vertices: int
    edges: int
    faces: int
    loops: int
    components: int
    voids: int
    genus: int


def topology(borders: Borders, faces: list[Face]) -> Topology:
    """Counts of one region; a shell of negative volume is a void."""
    arcs, edges = borders.arcs, len(borders.lines)
    shell_of_face, count = _shells(faces, edges)
    volumes = np.bincount(shell_of_face, [face_flux(arcs, face) for face in faces], count)
    long = arcs.lengths > SHORT
    kept = [face for face in faces if not face.loops or any(long[h % edges] for loop in face.loops for h in loop)]
    return Topology(
        vertices=_vertices(arcs, long),
        edges=int(long.sum()),
        faces=len(kept),
        loops=sum(any(long[h % edges] for h in loop) for face in kept for loop in face.loops),
        components=int((volumes > 0).sum()),
        voids=int((volumes <= 0).sum()),
        genus=_genus(arcs, faces, count),
    )


def _vertices(arcs: Arcs, long: np.ndarray) -> int:
    """Ends of long edges, those joined by short edges once."""
    has_ends = arcs.start >= 0
    ends = np.stack([arcs.start, arcs.end], axis=1)
    place = components(len(arcs.vertices), *ends[has_ends & ~long].T)
    return len(np.unique(place[ends[has_ends & long]]))


def face_flux(arcs: Arcs, face: Face) -> float:
    """A face's share of 3 V, scaled: ∫ x·n dA with the normal out of the region."""
    surfaces, k = arcs.surfaces, face.surface
    if k >= surfaces.spheres:
        k -= surfaces.spheres
        return float(surfaces.offsets[0, k] * (face.facing @ surfaces.normals[k]))
    r = surfaces.radii[0, k]
    return float(surfaces.side[k] * (r**3 * face.angle + surfaces.centres[0, k] @ face.facing))


def _shells(faces: list[Face], edges: int) -> tuple[np.ndarray, int]:
    """Number of the closed surface to which each face belongs, and how many there are."""
    seen: dict[int, int] = {}
    pairs = []
    for number, face in enumerate(faces):
        for half in (half for loop in face.loops for half in loop):
            pairs.append((number, seen.setdefault(half % edges, number)))
    shell = components(len(faces), *np.array(pairs, int).reshape(-1, 2).T)
    return shell, int(shell.max(initial=-1)) + 1


def _genus(arcs: Arcs, faces: list[Face], shells: int) -> int:
    """Handles from Euler's characteristic Σ (2 − 2g) = V − E + Σ (2 − loops of a face); a whole circle counts 0."""
    characteristic = len(arcs.vertices) - int((arcs.start >= 0).sum()) + sum(2 - len(face.loops) for face in faces)
    return shells - characteristic // 2
