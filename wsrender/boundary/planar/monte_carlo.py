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

from wsrender.boundary.fits import fit_circle, fit_line
from wsrender.boundary.planar.cell_loops import CellLoops, cell_loops
from wsrender.boundary.planar.planar_chain import PlanarChain
from wsrender.boundary.planar.segments import Segment

SCATTER = 0.3  # of centroids about the boundary, in cell widths: what the tolerances allow by default
CELLS = tuple(int(2500 / 2 ** (k / 2)) for k in range(10))  # as published, or as few as the samples fill: 110


@dataclass(frozen=True, eq=False)
class MonteCarloBoundary:
    """Loops of ``segments``, the inside on the left, with what they were fitted to.

    ``cells`` are the loops of cells and whether the samples fill them. ``loops`` hold the centroids (K, 2) of boundary
    cells, those next to ``critical`` (C, 2) replaced: points with all joints at limits that lie on the boundary [m].
    """

    segments: list[list[Segment]]
    cells: CellLoops
    loops: list[np.ndarray]
    critical: np.ndarray
    cell_width_m: float
    line_tolerance_m2: float
    arc_tolerance_m4: float


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
    tolerance in m⁴ would allow more, fit by the same scatter.
    """
    found = _filled(points, CELLS if cells is None else (cells,))
    scatter = SCATTER * found.width_m
    farthest = scatter if arc_tolerance_m4 is None else np.inf
    toll = scatter**2 if line_tolerance_m2 is None else line_tolerance_m2
    tola = (scatter * np.ptp(points, axis=0).max()) ** 2 if arc_tolerance_m4 is None else arc_tolerance_m4
    limits = _at_limits(chain)
    loops, critical, segments = [], [], []
    for loop in found.loops:
        corners, places = _critical(loop, limits, found.width_m)
        loop = loop.copy()
        loop[places] = corners
        critical.append(corners)
        loops.append(loop)
        segments.append(_segments(loop, np.sort(places), toll, tola, farthest))
    places = np.concatenate(critical or [np.empty((0, 2))])
    return MonteCarloBoundary(segments, found, loops, places, found.width_m, float(toll), float(tola))


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


def _segments(loop: np.ndarray, critical: np.ndarray, toll: float, tola: float, farthest: float) -> list[Segment]:
    """Lines and arcs along a closed loop, split at its critical points."""
    first = int(critical[0]) if len(critical) else 0
    closed = np.roll(loop, -first, axis=0)
    closed = np.concatenate([closed, closed[:1]])
    splits = [*(critical - first).tolist(), len(loop)] if len(critical) else [0, len(loop)]
    out = []
    for begin, end in pairwise(splits):
        out += _run(closed[begin : end + 1], toll, tola, farthest)
    return out


def _run(points: np.ndarray, toll: float, tola: float, farthest: float) -> list[Segment]:
    """Lines and arcs, each as long as it fits; the length is found by bisection."""
    out, at, last = [], 0, len(points) - 1
    while at < last:
        fits, fails = at + 1, last + 1
        end = last
        while fails - fits > 1:
            if _fitted(points[at : end + 1], toll, tola, farthest) is None:
                fails = end
            else:
                fits = end
            end = (fits + fails) // 2
        out.append(_fitted(points[at : fits + 1], toll, tola, farthest))
        at = fits
    return out


def _fitted(points: np.ndarray, toll: float, tola: float, farthest: float) -> Segment | None:
    """The line through points if it fits, else the arc; None where neither does. Two points always have a line.

    An arc fits if the mean of (r² − R²)² is at most ``tola`` and the points lie about ``farthest`` [m] off: a mean of
    (r² − R²)² ≈ 4 R² (r − R)².
    """
    if len(points) == 2 or fit_line(points) <= toll:
        return Segment(points[0], points[-1], None, None, None)
    circle = fit_circle(points)
    if circle.error > min(tola, (2 * circle.radius * farthest) ** 2):
        return None
    offset = points - circle.center
    angle = np.arctan2(offset[:, 1], offset[:, 0])
    sweep = float((np.mod(np.diff(angle) + np.pi, 2 * np.pi) - np.pi).sum())
    return Segment(points[0], points[-1], circle.center, circle.radius, sweep)
