"""Edges of a ball region as polylines that its faces share, and the loops in which they surround the faces."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from wsrender.mechanisms.exact.arcs import Arcs
from wsrender.mechanisms.exact.measure import HalfEdges
from wsrender.mechanisms.exact.surfaces import Surfaces

LEAST_PIECES = 12  # of a whole circle
LARGEST_ANGLE = 0.1  # rad that an edge of a mesh spans on its sphere


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
