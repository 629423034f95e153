"""Exact workspaces of ball regions: volume, area, vertices, faces, bounds, topology, mesh (method C of [SNK])."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from wsrender.errors import InputError
from wsrender.mechanisms.ball_region import BallRegion
from wsrender.mechanisms.exact.arcs import Arcs, arcs
from wsrender.mechanisms.exact.faces import Borders, Face, FacesOnSurface, Topology, borders, faces, patches, topology
from wsrender.mechanisms.exact.measure import HalfEdges, RegionMeasures, bounds, half_edges, measures, probes_inside
from wsrender.mechanisms.exact.mesh import region_mesh
from wsrender.mechanisms.exact.surfaces import make_up, surfaces_of

if TYPE_CHECKING:
    import trimesh

CHUNK = 256  # regions at a time: some 100 MB of candidate vertices
STEPS_PER_DIAGONAL = 40  # of a mesh's edges in its bounding box


@dataclass(frozen=True, eq=False)
class ExactWorkspace:
    """The exact boundary of one ball region; lengths in metres, base frame.

    Surfaces are numbered: first the balls inside of which the region lies, then those outside of which, then the
    finite sides of the box, lower before upper.
    """

    arcs: Arcs
    half_edges: HalfEdges
    measures: RegionMeasures

    @classmethod
    def of(cls, region: BallRegion) -> "ExactWorkspace":
        """The workspace of a region.

        InputError where it is unbounded; NumericalError where edges do not close, or it is too thin for float64.
        """
        found = arcs(surfaces_of([region]))
        halves = half_edges(found)
        measured = measures(found, halves)
        measured.check_resolved()
        return cls(found, halves, measured)

    @property
    def volume_m3(self) -> float:
        """Volume [m³]."""
        return float(self.measures.volume[0])

    @property
    def area_m2(self) -> float:
        """Area of all faces [m²]."""
        return float(self.measures.area.sum())

    @property
    def vertices(self) -> np.ndarray:
        """Vertices (V, 3) [m]; several at the same place where more than three surfaces meet."""
        return self._in_metres(self.arcs.vertices)

    @cached_property
    def bounds_m(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Least and largest x, y, z [m]; None of an empty workspace."""
        return self.bounds_along(np.eye(3))

    def bounds_along(self, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """Least and largest coordinates along unit vectors (A, 3), base frame [m]; None of an empty workspace."""
        return bounds(self.arcs, axes)

    @cached_property
    def topology(self) -> Topology:
        """Numbers of vertices, edges, faces, parts, voids."""
        return topology(self.borders, self.faces)

    @cached_property
    def borders(self) -> Borders:
        """Points along the edges, and the loops that surround the faces."""
        return borders(self.arcs, self.half_edges, self._step)

    @cached_property
    def patches(self) -> list[FacesOnSurface]:
        """Triangulated faces by surface."""
        return patches(self.borders)

    @cached_property
    def faces(self) -> list[Face]:
        """All faces."""
        return faces(self.borders, self.patches, probes_inside(self.arcs)[0])

    @cached_property
    def mesh(self) -> "trimesh.Trimesh":
        """Watertight mesh [m] with its vertices on the exact faces; without faces where the workspace is empty."""
        return region_mesh(self.borders, self.patches, self.faces, self._step)

    @property
    def _step(self) -> float:
        """Length of a mesh's edges, scaled."""
        if self.bounds_m is None:
            return 1.0
        diagonal = np.linalg.norm(np.subtract(*self.bounds_m))
        return float(diagonal / self.arcs.surfaces.scale[0] / STEPS_PER_DIAGONAL)

    def _in_metres(self, points: np.ndarray) -> np.ndarray:
        return self.arcs.surfaces.origin[0] + self.arcs.surfaces.scale[0] * points


@dataclass(frozen=True, eq=False)
class ExactVolumes:
    """Volumes (M,) [m³] of regions, and their derivatives by each region's centres, radii and finite bounds [m²].

    ``by_centre`` (M, S, 3) and ``by_radius`` (M, S): inside balls first, then outside balls. ``by_bound`` (M, P): the
    finite lower bounds, then the upper. The volume is NaN where a region is too thin for float64.
    """

    volume: np.ndarray
    by_centre: np.ndarray
    by_radius: np.ndarray
    by_bound: np.ndarray


def exact_volumes(regions: Sequence[BallRegion]) -> ExactVolumes:
    """Volumes of regions with the same numbers of balls and sides of the box, many at a time.

    A ball whose radius grows moves its face outwards by as much: dV/dr = ± its area, dV/dc = ± its vector area.
    InputError where there is no region or their numbers differ.
    """
    if len({make_up(region) for region in regions}) != 1:
        raise InputError("regions", "must be one or more, all with the same numbers of balls and sides of the box")
    found = [_volumes(regions[k : k + CHUNK]) for k in range(0, len(regions), CHUNK)]
    return ExactVolumes(*(np.concatenate(parts) for parts in zip(*found, strict=True)))


def _volumes(regions: Sequence[BallRegion]) -> tuple[np.ndarray, ...]:
    found = arcs(surfaces_of(regions))
    measured, spheres = measures(found, half_edges(found)), found.surfaces.spheres
    side = found.surfaces.side
    by_bound = measured.area[:, spheres:] * found.surfaces.normals.sum(axis=1)
    volume = np.where(measured.resolved, measured.volume, np.nan)
    return volume, measured.facing[:, :spheres] * side[:, None], measured.area[:, :spheres] * side, by_bound
