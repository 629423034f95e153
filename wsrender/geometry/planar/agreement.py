"""Whether a boundary found from samples is the exact one, but for what its method takes off."""

from collections.abc import Iterator, Sequence

import numpy as np

from wsrender.geometry.planar.curves import Curves
from wsrender.geometry.planar.distances import point_distances
from wsrender.geometry.planar.exact_boundary import ExactBoundary
from wsrender.geometry.planar.monte_carlo import MOST_SINGLE, MonteCarloBoundary
from wsrender.geometry.planar.segments import Segment

# Centroids lie 0.24–0.33 cell widths inside an outer loop (Alciatore & Ng 1994), less inside a hole or where samples
# crowd at the boundary; the rest is scatter. Twice that is what too few samples near the boundary do.
INWARD = (0.1, 0.4)
USUALLY_INWARD = (0.24, 0.33)
LARGEST_ERROR = 0.1  # of the area: cells that are as large beside the workspace tell little of it
DRAWN_ERROR = 0.01  # of the area between lines and arcs, but for what cells that lie inside take off
FARTHEST_APART = 1.0  # cell widths, of segments from cells and from the exact boundary: a third inside, cut corners
_STEP = 0.25  # of a cell, between points at which the boundaries are compared


def disagreements(estimated: MonteCarloBoundary, exact: ExactBoundary) -> Iterator[str]:
    """What shows that too few samples were drawn; nothing for a boundary that has converged, or without an area."""
    if exact.dimension < 2:
        return
    cells, width = estimated.cells, estimated.cell_width_m
    if cells.single > MOST_SINGLE:
        yield f"{100 * cells.single:.0f} % of its cells hold one sample alone; at most {100 * MOST_SINGLE:.0f} % should"
    if cells.parts > 1:
        yield f"its cells fall into {cells.parts} parts"
    if cells.chance:
        yield f"{cells.chance} holes may be cells that no sample happened to hit"
    areas = np.array([signed_area(loop) for loop in estimated.loops])
    found, known = (int((areas < 0).sum()), sum(loop.hole for loop in exact.loops))
    if found != known:
        yield f"it has {_holes(found)}, the exact boundary {_holes(known)}"
    error = float(areas.sum() / exact.area - 1)
    inward = -error * exact.area / (exact.perimeter * width)
    if not INWARD[0] <= inward <= INWARD[1]:
        usual = "–".join(map(str, USUALLY_INWARD))
        yield f"its area is {100 * error:+.1f} % off: it lies {inward:.2f} cell widths inside, {usual} are usual"
    elif abs(error) > LARGEST_ERROR:
        yield f"its area is {100 * error:+.1f} % off: its cells, {width:.3g} m wide, are large beside the workspace"
    yield from _of_segments(estimated, exact)


def _of_segments(estimated: MonteCarloBoundary, exact: ExactBoundary) -> Iterator[str]:
    """What shows that lines and arcs are neither the cells' border nor the exact one."""
    width, segments = estimated.cell_width_m, [segment for loop in estimated.segments for segment in loop]
    if not segments:
        yield "it has no segments"
        return
    farthest = max(segment.farthest for segment in segments) / width
    if farthest > FARTHEST_APART:
        yield (
            f"a line or arc runs {farthest:.2f} cell widths beside cells it stands for; at most {FARTHEST_APART:g} "
            "should"
        )
    apart = _apart(segments, [segment for loop in exact.segments for segment in loop], width)
    if apart > FARTHEST_APART:
        yield (
            f"its lines and arcs are up to {apart:.2f} cell widths from the exact boundary, at most "
            f"{FARTHEST_APART:g} should be"
        )
    error = sum(segment.area for segment in segments) / exact.area - 1
    explained = -USUALLY_INWARD[1] * exact.perimeter * width / exact.area
    if not explained - DRAWN_ERROR <= error <= DRAWN_ERROR:
        yield (
            f"the area within its lines and arcs is {100 * error:+.1f} % off; that cells lie inside explains up to "
            f"{100 * explained:.1f} %"
        )


def _apart(one: Sequence[Segment], other: Sequence[Segment], width: float) -> float:
    """Largest distance of points of either boundary from the other [cell widths] (Hausdorff)."""
    distances = []
    for these, those in ((one, other), (other, one)):
        points = np.concatenate([segment.along(_STEP * width) for segment in these])
        curves = Curves.joined([segment.curve for segment in those])
        distances.append(point_distances(points, curves).min(axis=1).max())
    return float(max(distances) / width)


def signed_area(loop: np.ndarray) -> float:
    """Area [m²] of a polygon (K, 2) [m]; negative of one that turns clockwise."""
    x, y = loop.T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def _holes(count: int) -> str:
    return "1 hole" if count == 1 else f"{count or 'no'} holes"
