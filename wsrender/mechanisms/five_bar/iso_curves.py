"""Iso-conditioning curves: where κ of A, B or J has a given value ([CB])."""

from collections.abc import Sequence

import numpy as np
from skimage.measure import find_contours

from wsrender.mechanisms.five_bar.condition_numbers import conditioning
from wsrender.mechanisms.five_bar.maps import PlaneLattice
from wsrender.mechanisms.five_bar.mechanism import FiveBar

ON_CURVE = 1e-9  # of 1/κ: vertices are moved until they are this near to their level
SHORTEST = 4  # vertices of a curve; what is left of one along a boundary is noise
STEPS = 5  # of Newton's method along the gradient, from where a straight line between cells has the level
_DIFFERENCE = 1e-6  # step of the gradient, in cells


def iso_curves(
    five_bar: FiveBar,
    working_mode: str,
    lattice: PlaneLattice,
    values: np.ndarray,
    quantity: str,
    kappas: Sequence[float],
) -> list[tuple[float, np.ndarray]]:
    """(κ, postures θ1 … θ4 (N, 4) [rad] of the vertices in order) of every curve of the levels ``kappas``.

    ``values`` (nx, ny) is the map of ``quantity`` (an inverse_kappa) in the mode, NaN outside. Contours between the
    cell centres are found first; then each vertex is moved onto the curve. Curves end up to a cell before the boundary.
    """
    known = ~np.isnan(values)
    if min(lattice.shape) < 2 or not known.any():
        return []
    filled = np.where(known, values, 0.0)
    contours = [(kappa, line) for kappa in kappas for line in find_contours(filled, 1.0 / kappa, mask=known)]
    if not contours:
        return []
    points = (np.array(lattice.first) + np.concatenate([line for _, line in contours]) + 0.5) * lattice.cell_m
    levels = np.concatenate([np.full(len(line), 1.0 / kappa) for kappa, line in contours])
    points, found = _moved(five_bar, working_mode, points, quantity, levels, lattice.cell_m)
    angles = five_bar.inverse_kinematics(points, working_mode)
    ends = np.cumsum([len(line) for _, line in contours])
    curves = []
    for (kappa, line), end in zip(contours, ends, strict=True):
        rows = np.arange(end - len(line), end)
        runs = np.split(rows, np.flatnonzero(~found[rows]))
        curves += [(kappa, angles[run[found[run]]]) for run in runs if np.count_nonzero(found[run]) >= SHORTEST]
    return curves


def _moved(
    five_bar: FiveBar, working_mode: str, points: np.ndarray, quantity: str, levels: np.ndarray, cell_m: float
) -> tuple[np.ndarray, np.ndarray]:
    """The points moved onto their levels, and whether each came to lie there within a cell of where it was."""

    def field(at: np.ndarray) -> np.ndarray:
        return getattr(conditioning(five_bar, five_bar.inverse_kinematics(at, working_mode)), quantity)

    start, step = points, _DIFFERENCE * cell_m
    here = field(points)
    for _ in range(STEPS):
        gradient = np.stack([(field(points + d) - here) / step for d in step * np.eye(2)], axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            move = (levels - here)[:, None] * gradient / (gradient**2).sum(axis=1)[:, None]
        points = points + np.where(np.isfinite(move), np.clip(move, -cell_m, cell_m), 0.0)
        here = field(points)
    return points, (np.abs(points - start).max(axis=1) <= cell_m) & (np.abs(here - levels) <= ON_CURVE)
