"""Conditioning of a five-bar on lattices, of P for each working mode and of the actuated angles, and its iso-curves."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor

import numpy as np
from skimage.measure import find_contours

from wsrender.mechanisms.five_bar.condition_numbers import Conditioning, conditioning
from wsrender.mechanisms.five_bar.loci import postures
from wsrender.mechanisms.five_bar.mechanism import ASSEMBLY_MODES, WORKING_MODES, FiveBar

QUANTITIES = ("inverse_kappa_a", "inverse_kappa_b", "inverse_kappa_j", "det_a", "det_b")
ON_CURVE = 1e-9  # of 1/κ: vertices are moved until they are this near to their level
SHORTEST = 4  # vertices of a curve; what is left of one along a boundary is noise
STEPS = 5  # of Newton's method along the gradient, from where a straight line between cells has the level
_DIFFERENCE = 1e-6  # step of the gradient, in cells


@dataclass(frozen=True)
class PlaneLattice:
    """Cells of one edge [m], anchored at the origin: the first and how many along x and y."""

    cell_m: float
    first: tuple[int, int]
    shape: tuple[int, int]

    def centers(self, axis: int) -> np.ndarray:
        """Coordinates of the cell centres along x (0) or y (1) [m]."""
        return (self.first[axis] + np.arange(self.shape[axis]) + 0.5) * self.cell_m

    def points(self) -> np.ndarray:
        """All cell centres, (nx · ny, 2) [m], y running fastest."""
        x, y = np.meshgrid(self.centers(0), self.centers(1), indexing="ij")
        return np.stack([x.ravel(), y.ravel()], axis=1)


def plane_bounds(five_bar: FiveBar) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner (2,), (2,) [m] of a box around what both legs can reach; upper below lower: nothing."""
    (_, left), (_, right) = (five_bar.reach_m(leg) for leg in (0, 1))
    half = min(left, right)
    return np.array([max(-left, five_bar.base_m - right), -half]), np.array([min(left, five_bar.base_m + right), half])


def plane_lattice(five_bar: FiveBar, cell_m: float) -> PlaneLattice:
    """The cells that cover the box; none where it is empty."""
    lower, upper = plane_bounds(five_bar)
    first = [floor(low / cell_m) for low in lower]
    shape = [max(ceil(high / cell_m) - at, 0) for high, at in zip(upper, first, strict=True)]
    return PlaneLattice(cell_m, (first[0], first[1]), (shape[0], shape[1]))


def cartesian_map(five_bar: FiveBar, working_mode: str, lattice: PlaneLattice) -> Conditioning:
    """The indices at every cell centre, (nx · ny,), NaN where the mode does not reach."""
    return conditioning(five_bar, five_bar.inverse_kinematics(lattice.points(), working_mode))


@dataclass(frozen=True, eq=False)
class JointMap:
    """Postures on a lattice of the actuated angles: cell (N, 2), θ1 … θ4 (N, 4) [rad], P (N, 2) [m], modes (N,)."""

    cell: np.ndarray
    angles: np.ndarray
    position: np.ndarray
    working_mode: np.ndarray
    assembly_mode: np.ndarray
    conditioning: Conditioning


def joint_axis(five_bar: FiveBar, leg: int, per_turn: int) -> np.ndarray:
    """Centres of the cells of a base joint's range [rad]: a turn, −π … π, has ``per_turn``."""
    low, high = five_bar.limits_rad[leg] or (-np.pi, np.pi)
    count = max(round(per_turn * (high - low) / (2 * np.pi)), 1)
    return low + (np.arange(count) + 0.5) * (high - low) / count


def joint_map(five_bar: FiveBar, per_turn: int) -> JointMap:
    """All postures with θ1 and θ2 at cell centres, within limits; each is in one working and one assembly mode."""
    axes = [joint_axis(five_bar, leg, per_turn) for leg in (0, 1)]
    theta = np.stack([values.ravel() for values in np.meshgrid(*axes, indexing="ij")], axis=1)
    cell = np.stack([k.ravel() for k in np.indices((len(axes[0]), len(axes[1])))], axis=1)
    sheets = []
    for mode in ASSEMBLY_MODES:
        position = five_bar.forward_kinematics(theta, mode)
        kept = ~np.isnan(position[:, 0])
        angles = postures(five_bar, theta[kept], position[kept])
        sheets.append((cell[kept], angles, position[kept], np.full(int(kept.sum()), mode)))
    cells, angles, position, assembly = (np.concatenate(parts) for parts in zip(*sheets, strict=True))
    bends = (np.sin(angles[:, 2:] - angles[:, :2]) < 0).astype(int)
    working = np.array(WORKING_MODES)[2 * bends[:, 0] + bends[:, 1]]
    return JointMap(cells, angles, position, working, assembly, conditioning(five_bar, angles))


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
