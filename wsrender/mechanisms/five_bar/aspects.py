"""Aspects: the parts of a working mode's workspace between its type-2 singularities ([CB]; Wenger & Chablat 1998)."""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from wsrender.errors import NumericalError
from wsrender.geometry.romberg import extrapolated
from wsrender.mechanisms.five_bar.condition_numbers import conditioning
from wsrender.mechanisms.five_bar.loci import BESIDE, BoundaryMeeting, LocusPiece, end_point
from wsrender.mechanisms.five_bar.mechanism import FiveBar
from wsrender.mechanisms.five_bar.region import Arc, ArcRegion

SEGMENTS = 4096  # of a piece of a locus; its area is extrapolated from this many and fewer
DRAWN = 512  # segments of a piece in an outline
ARC_SEGMENT = np.deg2rad(1.0)
TIED = 1e-6  # [rad] nearer ends of loci on the boundary are ordered by the directions in which they leave it
ASIDE = 1e-6  # of the mechanism's size: where the inside of a boundary is looked at


@dataclass(frozen=True, eq=False)
class Aspect:
    """A connected part of a workspace without type-2 singularities, all of it in one working and assembly mode.

    ``loops`` are closed polylines (N, 2) [m] with the interior on their left, the outline first, then holes;
    ``area_error_m2`` bounds what the quadrature along the loci leaves of the area [m²].
    """

    working_mode: str
    assembly_mode: str
    area_m2: float
    area_error_m2: float
    loops: tuple[np.ndarray, ...]


@dataclass(frozen=True, eq=False)
class _Edge:
    """An oriented piece of boundary: polyline, ½ ∫ x dy − y dx with its error, edge that follows it around a face."""

    points: np.ndarray
    area: float
    error: float = 0.0


def aspects(five_bar: FiveBar, working_mode: str, region: ArcRegion, pieces: Iterable[LocusPiece]) -> list[Aspect]:
    """The aspects of a working mode, the largest first; ``pieces`` are those of the type-2 loci in that mode.

    Within a working mode a posture belongs to each point, so the loci do not cross: faces follow from the order in
    which their ends lie along the boundary, not from distances.
    """
    bounding = {arc.name for loop in region.loops for arc in loop}
    # A piece that ends on no arc of the boundary lies where rounding leaves no workspace.
    pieces = [each for each in pieces if all(_meets(event, bounding) for event in (each.start, each.stop) if event)]
    loops = _boundary_loops(five_bar, region, [piece for piece in pieces if not piece.closed])
    for piece in pieces:
        if piece.closed:
            loops += [[edge] for edge in _both_ways(five_bar, piece)]
    return _faces(five_bar, working_mode, loops)


def _meets(event: BoundaryMeeting, bounding: set[str]) -> bool:
    return any(name in bounding for name, _ in event.arcs)


def _both_ways(five_bar: FiveBar, piece: LocusPiece) -> tuple[_Edge, _Edge]:
    points = end_point(five_bar, piece.angles(SEGMENTS))
    if not piece.closed:  # it begins and ends a little beside the boundary
        share = BESIDE * SEGMENTS / (piece.high - piece.low)
        points[[0, -1]] += share * (points[[0, -1]] - points[[1, -2]])
    area, error = extrapolated([_polygon_area(points[::step]) for step in (4, 2, 1)])
    drawn = points[:: SEGMENTS // DRAWN]
    return _Edge(drawn, area, error), _Edge(drawn[::-1], -area, error)


def _polygon_area(points: np.ndarray) -> float:
    """½ ∫ x dy − y dx along a polyline."""
    (x, y), (x1, y1) = points[:-1].T, points[1:].T
    return 0.5 * float(np.sum(x * y1 - x1 * y))


def _boundary_loops(five_bar: FiveBar, region: ArcRegion, pieces: list[LocusPiece]) -> list[list[_Edge]]:
    """Loops around the faces that the pieces cut from the region.

    Around a face, the boundary is followed up to the next end of a piece, then that piece to its other end.
    """
    edges: list[_Edge] = []
    follower: dict[int, int] = {}
    ends = _placed_ends(five_bar, region, pieces)
    leaving: dict[tuple[int, bool], int] = {}  # (piece, whether from its start) → edge
    for k, piece in enumerate(pieces):
        for from_start, edge in zip((True, False), _both_ways(five_bar, piece), strict=True):
            leaving[k, from_start] = len(edges)
            edges.append(edge)
    for number, loop in enumerate(region.loops):
        chain: list[int | tuple[int, bool]] = []  # edges of the boundary, and ends of pieces between them
        for position, arc in enumerate(loop):
            cuts = ends.get((number, position), [])
            shares = [0.0, *(share for share, *_ in cuts), 1.0]
            for k, (low, high) in enumerate(pairwise(shares)):
                chain.append(len(edges))
                edges.append(_arc_edge(arc.part(low, high)))
                if k < len(cuts):
                    chain.append(cuts[k][1:])
        for item, following in zip(chain, [*chain[1:], chain[0]], strict=True):
            if isinstance(item, tuple):  # a piece that comes in here, from its other end, goes on along the boundary
                follower[leaving[item[0], not item[1]]] = following  # type: ignore[assignment]
            else:
                follower[item] = leaving[following] if isinstance(following, tuple) else following
    return _traced(edges, follower)


def _traced(edges: list[_Edge], follower: dict[int, int]) -> list[list[_Edge]]:
    left, loops = set(follower), []
    while left:
        at = first = min(left)
        loop = []
        while at in left:
            left.remove(at)
            loop.append(edges[at])
            at = follower[at]
        if at != first:
            raise NumericalError("the singular loci and the boundary of the workspace do not fit together")
        loops.append(loop)
    return loops


def _arc_edge(arc: Arc) -> _Edge:
    count = max(2, int(np.ceil(abs(arc.sweep) / ARC_SEGMENT)))
    return _Edge(arc.points(np.linspace(0.0, 1.0, count + 1)), arc.area)


def _placed_ends(
    five_bar: FiveBar, region: ArcRegion, pieces: list[LocusPiece]
) -> dict[tuple[int, int], list[tuple[float, int, bool]]]:
    """(share, piece, whether its start) of the ends on each arc (loop, position), in the order along it."""
    found: dict[tuple[int, int], list[tuple[float, float, int, bool]]] = {}
    for k, piece in enumerate(pieces):
        for from_start in (True, False):
            loop, position, share = _place(five_bar, region, piece, from_start)
            arc = region.loops[loop][position]
            at = round(share * abs(arc.last - arc.first) / TIED) * TIED
            turn = _direction(five_bar, piece, arc, share, from_start)
            found.setdefault((loop, position), []).append((at, -turn, share, k, from_start))  # type: ignore[arg-type]
    return {arc: [entry[2:] for entry in sorted(entries)] for arc, entries in found.items()}  # type: ignore[misc]


def _place(five_bar: FiveBar, region: ArcRegion, piece: LocusPiece, from_start: bool) -> tuple[int, int, float]:
    """Loop, position in it and share of the arc on which an end of a piece lies.

    Where the boundary touches itself several ends of arcs lie there: the one is taken whose loop has the piece on its
    inside, and from which the piece leaves along the arc, not against it.
    """
    event = piece.start if from_start else piece.stop
    assert event is not None
    middle = piece.curve.positions(np.array([(piece.low + piece.high) / 2]))[0]
    candidates = []
    for number, loop in enumerate(region.loops):
        for position, arc in enumerate(loop):
            span = arc.last - arc.first
            values = [value for name, value in event.arcs if name == arc.name]
            for value in (value + turns * 2 * np.pi for value in values for turns in (-2, -1, 0, 1, 2)):
                share = (value - arc.first) / span
                beyond = round(max(-share, share - 1, 0.0) * abs(span) / TIED)
                candidates.append((beyond, number, position, min(max(share, 0.0), 1.0)))
    nearest = [candidate for candidate in candidates if candidate[0] == min(candidates)[0]]
    if len(nearest) > 1:
        nearest.sort(key=lambda found: _unfit(five_bar, region, piece, from_start, middle, found))
    return nearest[0][1:]


def _unfit(
    five_bar: FiveBar,
    region: ArcRegion,
    piece: LocusPiece,
    from_start: bool,
    middle: np.ndarray,
    found: tuple[int, int, int, float],
) -> tuple[bool, bool]:
    """Whether the loop does not have the piece on its inside; whether the piece leaves an end of the arc backwards."""
    _, number, position, share = found
    loop = region.loops[number]
    line = np.concatenate([_arc_edge(arc).points[:-1] for arc in loop])
    outside = _contains(line, middle) != (sum(arc.area for arc in loop) > 0)
    turn = _direction(five_bar, piece, loop[position], share, from_start) - np.pi / 2
    return outside, bool(np.cos(turn) < 0) == (share < 0.5)


def _direction(five_bar: FiveBar, piece: LocusPiece, arc: Arc, share: float, from_start: bool) -> float:
    """Angle from the boundary's direction to that in which the piece leaves it [rad], seen a little way along."""
    step = 0.01 * (piece.high - piece.low)
    t = piece.low + step if from_start else piece.high - step
    angle = arc.start + share * arc.sweep + np.sign(arc.sweep) * np.pi / 2
    x, y = (piece.curve.positions(np.array([t])) - arc.points(np.array([share])))[0]
    return float(np.remainder(np.arctan2(y, x) - angle + np.pi / 2, 2 * np.pi))


def _faces(five_bar: FiveBar, working_mode: str, loops: list[list[_Edge]]) -> list[Aspect]:
    """Outlines with the holes that lie in them."""
    size = five_bar.size_m
    areas = [sum(edge.area for edge in loop) for loop in loops]
    lines = [np.concatenate([edge.points[:-1] for edge in loop]) for loop in loops]
    outlines = [k for k, area in enumerate(areas) if area > 1e-12 * size**2]
    holes: dict[int, list[int]] = {k: [] for k in outlines}
    for k, area in enumerate(areas):
        if area < -1e-12 * size**2 and outlines:
            inside = _inside_point(loops[k], size)
            # None contains it where the workspace is thinner than the look aside: the largest then has the hole.
            around = [outline for outline in outlines if _contains(lines[outline], inside)] or [
                max(outlines, key=areas.__getitem__)
            ]
            holes[min(around, key=areas.__getitem__)].append(k)
    found = []
    for k in outlines:
        parts = [k, *holes[k]]
        error = sum(edge.error for part in parts for edge in loops[part])
        angles = five_bar.inverse_kinematics(_inside_point(loops[k], size), working_mode)
        sign = "+" if conditioning(five_bar, angles).det_a[0] > 0 else "-"
        area = float(sum(areas[part] for part in parts))
        found.append(Aspect(working_mode, sign, area, float(error), tuple(lines[part] for part in parts)))
    # Equal areas, of symmetric mechanisms, by their assembly mode: rounding does not decide the order.
    return sorted(found, key=lambda aspect: (-round(aspect.area_m2 / size**2, 9), aspect.assembly_mode))


def _inside_point(loop: list[_Edge], size: float) -> np.ndarray:
    """A point just to the left of the middle of a loop's longest edge, (2,)."""
    points = max((edge.points for edge in loop), key=lambda line: np.hypot(*np.diff(line, axis=0).T).sum())
    middle = len(points) // 2
    along = points[middle + 1] - points[middle - 1]
    return points[middle] + ASIDE * size * np.array([-along[1], along[0]]) / np.hypot(*along)


def _contains(line: np.ndarray, point: np.ndarray) -> bool:
    """Whether a closed polyline (N, 2) winds around a point."""
    angles = np.unwrap(np.arctan2(*(np.concatenate([line, line[:1]]) - point).T[::-1]))
    return abs(angles[-1] - angles[0]) > np.pi
