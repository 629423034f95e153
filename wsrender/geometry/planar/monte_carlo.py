"""The boundary from samples: boundary cells of a grid, critical points, lines and arcs by least squares.

Alciatore & Ng 1994. The centroid of a boundary cell lies inside the boundary, by 0.24–0.33 cell widths on average over
an outer loop, however many samples there are: least where they crowd at a singular boundary, and less around small
holes (0.15 at a radius of six cells). Where a line goes over into an arc smoothly the joint cannot be located; bands
thinner than a cell are not seen.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np

from wsrender.geometry.planar.cell_loops import CellLoops, cell_loops
from wsrender.geometry.planar.fitted_segments import FittedSegment, FitTolerances, fitted_segments, joined_segments
from wsrender.geometry.planar.planar_chain import PlanarChain

SCATTER = 0.3  # of centroids about the boundary, in cell widths: what the tolerances allow by default
CELLS = tuple(int(2500 / 2 ** (k / 2)) for k in range(10))  # as published, or as few as the samples fill: 110


@dataclass(frozen=True, eq=False)
class MonteCarloBoundary:
    """Loops of ``segments``, the inside on the left, with what they were fitted to.

    ``cells`` are the loops of cells and whether the samples fill them. ``loops`` hold the centroids (K, 2) of boundary
    cells, those next to ``critical`` (C, 2) replaced: points with all joints at limits that lie on the boundary [m].
    """

    segments: list[list[FittedSegment]]
    cells: CellLoops
    loops: list[np.ndarray]
    critical: np.ndarray
    cell_width_m: float
    tolerances: FitTolerances


def monte_carlo_boundary(
    chain: PlanarChain,
    points: np.ndarray,
    cells: int | None = None,
    line_tolerance_m2: float | None = None,
    arc_tolerance_m4: float | None = None,
) -> MonteCarloBoundary:
    """The boundary of sampled points (N, 2) [m] of a chain, coordinates of its plane.

    ``cells`` is N_g; None: 2500, or the most down to 110 that the points fill. The tolerances are TOLL and TOLA:
    largest mean squared perpendicular distance from a line, and mean of (r² − R²)² of an arc. By default both allow a
    scatter of 0.3 cell widths, the latter of arcs with a radius of half the workspace's width; smaller ones, which a
    tolerance in m⁴ would allow more, fit by the same scatter. Then no centroid is farther than a cell width from its
    segment, and what bends is an arc.
    """
    found = _filled(points, CELLS if cells is None else (cells,))
    extent = float(np.ptp(points, axis=0).max())
    tolerances = FitTolerances.of(line_tolerance_m2, arc_tolerance_m4, SCATTER * found.width_m, found.width_m, extent)
    limits = _at_limits(chain)
    loops, critical, segments = [], [], []
    for loop in found.loops:
        corners, places = _critical(loop, limits, found.width_m)
        loop = loop.copy()
        loop[places] = corners
        critical.append(corners)
        loops.append(loop)
        segments.append(_segments(loop, np.sort(places), tolerances, found.width_m))
    places = np.concatenate(critical or [np.empty((0, 2))])
    return MonteCarloBoundary(segments, found, loops, places, found.width_m, tolerances)


def _filled(points: np.ndarray, counts: Sequence[int]) -> CellLoops:
    """The loops of the first number of cells that the points fill, else of the last."""
    for count in counts[:-1]:
        found = cell_loops(points, count)
        if found.whole:
            return found
    return cell_loops(points, counts[-1])


def _at_limits(chain: PlanarChain) -> np.ndarray:
    """Positions (2^k, 2) [m] with each joint that has limits at one of them; whole turns have none."""
    points = [chain.tip]
    for joint in reversed(chain.joints):
        limits = (0.0,) if joint.full else (joint.low, joint.high)
        points = [joint.move(point, limit) for point, limit in product(points, limits)]
    return np.array(points) + chain.shift


def _critical(loop: np.ndarray, limits: np.ndarray, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions at joint limits that lie on a loop, and the places of the centroids that they replace."""
    apart = np.linalg.norm(limits[:, None] - loop, axis=-1)
    near, at_place = apart.min(axis=1), apart.argmin(axis=1)
    order = np.argsort(near, kind="stable")
    order = order[near[order] <= width]
    _, first = np.unique(at_place[order], return_index=True)
    chosen = order[np.sort(first)]
    return limits[chosen], at_place[chosen]


def _segments(loop: np.ndarray, critical: np.ndarray, tolerances: FitTolerances, width_m: float) -> list[FittedSegment]:
    """Lines and arcs along a closed loop, split at its critical points, each from where it meets its neighbours."""
    first = int(critical[0]) if len(critical) else 0
    closed = np.roll(loop, -first, axis=0)
    closed = np.concatenate([closed, closed[:1]])
    splits = [*(critical - first).tolist(), len(loop)] if len(critical) else [0, len(loop)]
    out = []
    for begin, end in pairwise(splits):
        out += fitted_segments(closed[begin : end + 1], tolerances)
    return joined_segments(out, width_m)
