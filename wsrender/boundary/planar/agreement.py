"""Whether a boundary found from samples is the exact one, but for what its method takes off."""

from collections.abc import Iterator

import numpy as np

from wsrender.boundary.planar.cell_loops import MOST_SINGLE
from wsrender.boundary.planar.exact_boundary import ExactBoundary
from wsrender.boundary.planar.monte_carlo import MonteCarloBoundary

# Centroids lie 0.24–0.33 cell widths inside an outer loop (Alciatore & Ng 1994), less inside a hole or where samples
# crowd at the boundary; the rest is scatter. Twice that is what too few samples near the boundary do.
INWARD = (0.1, 0.4)
LARGEST_ERROR = 0.1  # of the area: cells that are as large beside the workspace tell little of it


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
        yield f"its area is {100 * error:+.1f} % off: it lies {inward:.2f} cell widths inside, 0.24–0.33 are usual"
    elif abs(error) > LARGEST_ERROR:
        yield f"its area is {100 * error:+.1f} % off: its cells, {width:.3g} m wide, are large beside the workspace"


def signed_area(loop: np.ndarray) -> float:
    """Area [m²] of a polygon (K, 2) [m]; negative of one that turns clockwise."""
    x, y = loop.T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def _holes(count: int) -> str:
    return "1 hole" if count == 1 else f"{count or 'no'} holes"
