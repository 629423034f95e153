"""How the faces of a ball region join: shells, solid parts, voids, handles, and what there is of each kind."""

from dataclasses import dataclass

import numpy as np

from wsrender.geometry.components import components
from wsrender.mechanisms.exact.arcs import Arcs
from wsrender.mechanisms.exact.borders import Borders
from wsrender.mechanisms.exact.faces import Face

# Edges shorter than this, relative to the largest radius, come of moving concurrent and tangent surfaces apart by
# 1e-11 (they open by 1e-5 where they touch): they are counted as points.
SHORT = 2e-5


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
