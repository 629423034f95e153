"""The exact boundary of what a planar arm reaches: segments, loops, area, and answers about points."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.errors import InputError
from wsrender.geometry.planar.curves import unit
from wsrender.geometry.planar.distances import point_distances
from wsrender.geometry.planar.inverse_solutions import (
    NumberRegions,
    inverse_solutions,
    self_motion_regions,
    self_motions,
    solution_regions,
)
from wsrender.geometry.planar.planar_chain import PlanarChain, Plane, planar_chain
from wsrender.geometry.planar.planar_set import Loop, PlanarSet, loops_of, postures
from wsrender.geometry.planar.segments import ExactSegment
from wsrender.geometry.planar.sweep import swept_sets
from wsrender.keywords import keywords
from wsrender.notebook import mime_bundle
from wsrender.pipeline.sampling import held_chain
from wsrender.robot import model_chain
from wsrender.robots.chain import Chain
from wsrender.short_repr import short_repr

# A joint value this near to a limit, relative to its range, is at the limit: far above the rounding of postures.
_AT_LIMIT = 1e-7


@dataclass(frozen=True, eq=False)
class Nearest:
    """Where N points lie.

    For each: whether it is ``inside`` (N,), the nearest boundary ``point`` (N, 2) [m], its ``distance`` (N,) [m], never
    negative, and the number of its ``segment`` (N,) in the order of the loops.
    """

    inside: np.ndarray
    point: np.ndarray
    distance: np.ndarray
    segment: np.ndarray

    __repr__ = short_repr


class ExactBoundary:
    """The boundary of the positions that a planar arm reaches within its joint limits, exact to rounding.

    Coordinates are those of ``plane`` [m]: x and y of the world for an arm that moves in that plane. ``dimension`` is
    2; 1 where the arm reaches a curve only (then ``segments`` are that curve) and 0 where it reaches one point.
    """

    def __init__(self, chain: PlanarChain):
        self.chain = chain
        self.sets = swept_sets(chain.joints, chain.tip, chain.size)

    def __repr__(self) -> str:
        size = f"{len(self.loops)} loops, {self.area:.6g} m²" if self.dimension == 2 else f"{self.dimension} dimensions"
        return f"<ExactBoundary: {size}>"

    _repr_mimebundle_ = mime_bundle

    @classmethod
    def of(cls, chain: Chain) -> "ExactBoundary":
        """The boundary of an arm's chain. Raises ModelError, naming the joint, where it is not planar."""
        return cls(planar_chain(chain))

    @property
    def plane(self) -> Plane:
        """The plane that the end effector stays in."""
        return self.chain.plane

    @property
    def reached(self) -> PlanarSet:
        """The set reached, in coordinates less `PlanarChain.shift`."""
        return self.sets[0]

    @property
    def dimension(self) -> int:
        """2 of a region, 1 of a curve, 0 of a point."""
        return self.reached.dimension

    @cached_property
    def loops(self) -> list[Loop]:
        """Outer loop and holes of a region; none otherwise."""
        return loops_of(self.reached) if self.dimension == 2 else []

    @property
    def area(self) -> float:
        """Area reached [m²]."""
        return float(sum(loop.signed_area for loop in self.loops))

    @property
    def perimeter(self) -> float:
        """Length of all loops, or of the curve [m]."""
        return float(self.reached.curves.length.sum())

    @property
    def vertices(self) -> np.ndarray:
        """Corners of the boundary, ends of the curve, or the point, (V, 2) [m]."""
        return self.reached.vertices + self.chain.shift

    @cached_property
    def order(self) -> np.ndarray:
        """Rows of pieces in the order of ``segments``: loop by loop."""
        rows = [loop.rows for loop in self.loops]
        return np.concatenate(rows) if rows else np.arange(len(self.reached.curves))

    @cached_property
    def segments(self) -> list[list[ExactSegment]]:
        """Lines and arcs of each loop, run through with the inside on the left; of a curve, those of the curve."""
        loops = [loop.rows for loop in self.loops] or [self.order]
        return [[self._segment(row) for row in rows] for rows in loops if len(rows)]

    def _segment(self, row: int) -> ExactSegment:
        reached, shift = self.reached, self.chain.shift
        own = reached.curves[np.array([row])]
        forward = reached.sign[row] > 0
        ends = [self._vertex(row, k) + shift for k in (0, 1)]
        start, end = ends if forward else ends[::-1]
        found = self._postures(row)
        round_ = bool(own.arc[0])
        return ExactSegment(
            start=start,
            end=end,
            center=own.base[0] + shift if round_ else None,
            radius=float(own.radius[0]) if round_ else None,
            sweep=float(own.span[0] if forward else -own.span[0]) if round_ else None,
            generated_by=tuple({frozenset(at.items()): at for at in map(self._limits, found)}.values()),
            postures=tuple(self._coordinates(q) for q in found),
        )

    def _vertex(self, row: int, side: int) -> np.ndarray:
        vertex, curves = self.reached.ends[row, side], self.reached.curves
        return self.reached.vertices[vertex] if vertex >= 0 else (curves.start, curves.end)[side][row]

    def _postures(self, row: int) -> list[list[float]]:
        """Different displacements that reach the middle of a piece."""
        curves = self.reached.curves
        found = postures(self.reached, row, float(curves.low[row] + curves.span[row] / 2))
        return list({tuple(np.round(q, 9)): q for q in found}.values())

    def _limits(self, displacements: list[float]) -> dict[str, str]:
        """Which joints are at which limit of their coordinate."""
        out = {}
        for joint, value in zip(self.chain.joints, displacements, strict=True):
            near = _AT_LIMIT * (joint.high - joint.low)
            at_low, at_high = value - joint.low <= near, joint.high - value <= near
            if (at_low or at_high) and not joint.full:
                out[joint.name] = "lower" if at_low == (joint.scale > 0) else "upper"
        return out

    def _coordinates(self, displacements: list[float]) -> np.ndarray:
        return np.array([j.coordinate(value) for j, value in zip(self.chain.joints, displacements, strict=True)]) + 0.0

    @cached_property
    def inverse_solution_regions(self) -> list[NumberRegions] | None:
        """Regions by number of inverse solutions; None unless two joints move the tip over an area.

        Raises NumericalError where curves nearly coincide and cannot be told apart.
        """
        return solution_regions(self.reached, self.chain.size) if self.has_inverse_solutions else None

    @cached_property
    def self_motion_regions(self) -> list[NumberRegions] | None:
        """Regions by number of separate self-motions; None unless three joints move the tip, two of them over an area.

        A self-motion is a connected set of postures that all reach a point. The two are the last ones. Raises
        NumericalError where curves nearly coincide and cannot be told apart.
        """
        return self_motion_regions(self.reached, self.chain.size) if self.has_self_motions else None

    def inverse_solutions(self, points: Any) -> np.ndarray:
        """Number of inverse solutions, whole turns left aside, at points (N, 2) [m] of a two-joint arm, (N,) int.

        On a curve where the number changes, that of either side. Raises InputError for other arms.
        """
        if not self.has_inverse_solutions:
            raise InputError("robot", "has no number of inverse solutions: two joints must move the tip over an area")
        return inverse_solutions(self.reached, plane_points(points) - self.chain.shift)

    def self_motions(self, points: Any) -> np.ndarray:
        """Number of separate self-motions at points (N, 2) [m] of a three-joint arm, (N,) int.

        On a curve where the number changes, that of either side. Raises InputError for other arms.
        """
        if not self.has_self_motions:
            what = "three joints must move the tip, the last two over an area"
            raise InputError("robot", f"has no number of self-motions: {what}")
        return self_motions(self.reached, plane_points(points) - self.chain.shift, self.chain.size)

    @property
    def has_inverse_solutions(self) -> bool:
        """Whether two joints move the tip, over an area: then finitely many postures reach a point."""
        return self._sweeps(2)

    @property
    def has_self_motions(self) -> bool:
        """Whether three joints move the tip, the last two over an area: then curves of postures reach a point."""
        return self._sweeps(3)

    def _sweeps(self, joints: int) -> bool:
        """Whether so many joints move the tip, the last two of them over an area."""
        return len(self.chain.joints) == joints and self.sets[-3].dimension == 2

    def contains(self, points: Any) -> np.ndarray:
        """Whether points (N, 2) [m] can be reached, (N,) bool; those on the boundary to rounding are."""
        return self.nearest(points).inside

    def nearest(self, points: Any) -> Nearest:
        """The boundary point nearest to each of ``points`` (N, 2) [m], and whether the points can be reached."""
        points = plane_points(points) - self.chain.shift
        reached = self.reached
        if self.dimension == 0:
            gap = np.linalg.norm(points - reached.vertices[0], axis=1)
            nearest, rows = np.tile(reached.vertices, (len(points), 1)), np.full(len(points), -1)
        else:
            apart = point_distances(points, reached.curves)[:, self.order]
            place = apart.argmin(axis=1)
            gap, rows = apart[np.arange(len(points)), place], place
            nearest = _projected(reached, self.order[place], points)
        inside = gap <= 1e-12 * self.chain.size
        inside |= reached.contains(points)
        return Nearest(inside, nearest + self.chain.shift, gap, rows)


def _projected(reached: PlanarSet, rows: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The point of a piece, by row, nearest to each point (K, 2)."""
    own = reached.curves[rows]
    t = own.parameter(points)
    to_ends = [np.linalg.norm(points - end, axis=1) for end in (own.start, own.end)]
    end = np.where((to_ends[0] <= to_ends[1])[:, None], own.start, own.end)
    on_line = own.at(np.clip(t, own.low, own.high))
    offset = points - own.base
    length = np.hypot(offset[:, 0], offset[:, 1])
    # Every point of a circle is nearest to its centre.
    towards = np.where((length > 0)[:, None], offset / np.where(length > 0, length, 1.0)[:, None], unit(own.low))
    on_arc = np.where(own.holds(t)[:, None], own.base + own.radius[:, None] * towards, end)
    return np.where(own.arc[:, None], on_arc, on_line)


def plane_points(points: Any) -> np.ndarray:
    """Points as float64 (N, 2); InputError names what is wrong."""
    try:
        rows = np.asarray(points, np.float64)
    except (TypeError, ValueError) as error:
        raise InputError("points", f"is not an array of numbers: {error}") from error
    if rows.ndim != 2 or rows.shape[1] != 2:
        raise InputError("points", f"has shape {np.shape(points)}; (N, 2) is needed, coordinates in the plane")
    if not np.isfinite(rows).all():
        raise InputError("points", "has a value that is not finite")
    return rows


@keywords
def exact_boundary(robot: Any, *, locked: Mapping[str, float] | None = None) -> ExactBoundary:
    """The exact boundary alone, with ``area``, ``segments``, ``contains(points)`` and ``nearest(points)``.

    ``locked`` holds joints, by name, at a value [rad or m]. Raises ModelError, naming the joint, for an arm that is not
    planar; InputError for an unknown joint or a value beyond its limits.

    >>> rows = [{"a": 0.3, "limits_deg": [-180, 180]}, {"a": 0.2, "limits_deg": [-180, 180]}]
    >>> boundary = ws.exact_boundary(ws.DHTable(convention="standard", rows=rows))
    >>> round(boundary.area / np.pi, 9)  # a ring of radii 0.1 and 0.5 m: π (0.25 − 0.01)
    0.24
    >>> boundary.contains([[0.05, 0.0], [0.3, 0.0]]).tolist()
    [False, True]
    """
    return ExactBoundary.of(held_chain(model_chain(robot), locked or {}))
