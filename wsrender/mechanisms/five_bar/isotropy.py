"""Conditioning of a five-bar over the plane and its actuated angles: lattices, iso-curves, isotropic places ([CB])."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, floor

import numpy as np
from scipy.optimize import root_scalar
from skimage.measure import find_contours

from wsrender.mechanisms.five_bar.condition_numbers import Conditioning, conditioning
from wsrender.mechanisms.five_bar.loci import least_kappa_a_curves, pieces, postures
from wsrender.mechanisms.five_bar.mechanism import ASSEMBLY_MODES, WORKING_MODES, FiveBar

QUANTITIES = ("inverse_kappa_a", "inverse_kappa_b", "inverse_kappa_j", "det_a", "det_b")
ON_CURVE = 1e-9  # of 1/κ: vertices are moved until they are this near to their level
SHORTEST = 4  # vertices of a curve; what is left of one along a boundary is noise
STEPS = 5  # of Newton's method along the gradient, from where a straight line between cells has the level
_DIFFERENCE = 1e-6  # step of the gradient, in cells
SAMPLES = np.linspace(0.0, 2 * np.pi, 721)  # parameters of a curve
ON_LOCUS = 1e-9  # of κ(B)
HALVINGS = 60  # of the step in which a curve leaves the workspace

PlaneCurve = Callable[[np.ndarray], np.ndarray]
"""Points (N, 2) [m] at parameters (N,) in [0, 2π]."""


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


def isotropic_b(five_bar: FiveBar, working_mode: str) -> list[np.ndarray]:
    """Postures with κ(B) = 1 in a working mode: runs of θ1 … θ4 (N, 4) [rad] along plane curves.

    The triangles A C P and B D P then have equal areas. With ρ, ρ' the squared distances of P from A and B,
    a = L1 L2 and s = L1² + L2² (a', s' of the right leg): 4a² − (ρ − s)² = 4a'² − (ρ' − s')².
    """
    return [run for curve in _equal_areas(five_bar) for run in _runs_within(five_bar, working_mode, curve)]


def isotropic_points(five_bar: FiveBar, working_mode: str) -> np.ndarray:
    """Postures with κ(J) = 1 in a working mode, θ1 … θ4 (N, 4) [rad].

    The distal links are at right angles, and L1 |sin(θ3 − θ1)| = L1' |sin(θ4 − θ2)|.
    """
    found = []
    for piece in (piece for curve in least_kappa_a_curves(five_bar) for piece in pieces(curve)):
        if piece.working_mode != working_mode:
            continue

        def unlike(t: np.ndarray, angles: PlaneCurve = piece.curve.angles) -> np.ndarray:
            at = angles(np.atleast_1d(t))
            left, right = (np.array(five_bar.proximal_m) * np.abs(np.sin(at[:, 2:] - at[:, :2]))).T
            return left - right

        t = np.linspace(piece.low, piece.high, len(SAMPLES))
        values = unlike(t)
        steps = np.flatnonzero(values[:-1] * values[1:] < 0)
        roots = [root_scalar(lambda x: unlike(x)[0], bracket=(t[k], t[k + 1]), xtol=1e-14).root for k in steps]
        found.append(piece.curve.angles(np.array(roots)) if roots else np.empty((0, 4)))
    return np.concatenate([np.empty((0, 4)), *found])


def _equal_areas(five_bar: FiveBar) -> Iterator[PlaneCurve]:
    """The curves, not clipped to the workspace.

    With X = ρ + ρ' − s − s' and Y = ρ − ρ' − s + s' the equation is X Y = 4(a² − a'²); Y is linear in x. Legs with
    a = a' give the line Y = 0 and the circle X = 0, others a cubic, y² = g(x).
    """
    base = five_bar.base_m
    (first, second), (third, fourth) = zip(five_bar.proximal_m, five_bar.distal_m, strict=True)
    total = first**2 + second**2 + third**2 + fourth**2
    offset = first**2 + second**2 - third**2 - fourth**2 + base**2  # Y = 2 L0 x − offset
    product = 4 * ((first * second) ** 2 - (third * fourth) ** 2)
    reach = max(five_bar.reach_m(0)[1], five_bar.reach_m(1)[1])
    if abs(product) <= 1e-13 * five_bar.size_m**4:
        yield lambda t: np.stack([np.full(len(t), offset / (2 * base)), -reach * np.cos(t / 2)], axis=1)
        squared = total / 2 - base**2 / 4
        if squared > 0:
            yield lambda t: np.array([base / 2, 0]) + np.sqrt(squared) * np.stack([np.cos(t), np.sin(t)], axis=1)
        return

    def squared_y(x: np.ndarray) -> np.ndarray:
        with np.errstate(divide="ignore"):
            return (product / (2 * base * x - offset) + total - base**2 + 2 * base * x) / 2 - x**2

    # g(x) is at least 0 between some of its roots, its pole, and the ends of what is looked at.
    cubic = np.polyadd(np.polymul([2 * base, -offset], [-1.0, base, (total - base**2) / 2]), [product / 2])
    roots = np.roots(cubic)
    real = roots[np.abs(roots.imag) < 1e-9 * five_bar.size_m].real
    ends = sorted({*real, offset / (2 * base), -2 * reach, base + 2 * reach})
    for low, high in pairwise(ends):
        if squared_y(np.array([(low + high) / 2]))[0] > 0:
            yield _both_halves(squared_y, low, high, 4 * reach)


def _both_halves(squared_y: Callable[[np.ndarray], np.ndarray], low: float, high: float, farthest: float) -> PlaneCurve:
    """The branches y = ±√g(x) over an interval of x, there and back; y stops at ``farthest``, out of all reach."""

    def points(t: np.ndarray) -> np.ndarray:
        x = (low + high) / 2 - (high - low) / 2 * np.cos(t)
        y = np.sqrt(np.clip(squared_y(x), 0.0, farthest**2))
        return np.stack([x, np.where(np.sin(t) >= 0, y, -y)], axis=1)

    return points


def _runs_within(five_bar: FiveBar, working_mode: str, curve: PlaneCurve) -> Iterator[np.ndarray]:
    """The stretches of a curve that the mode reaches, up to where it leaves the workspace.

    At a corner of the workspace both legs are stretched or folded: B is 0 there, and κ(B) has no value.
    """

    def reached(t: np.ndarray) -> np.ndarray:
        found = conditioning(five_bar, five_bar.inverse_kinematics(curve(t), working_mode))
        return np.abs(found.inverse_kappa_b - 1.0) <= ON_LOCUS

    inside = reached(SAMPLES)
    starts = np.flatnonzero(inside & ~np.concatenate([[False], inside[:-1]]))
    stops = np.flatnonzero(inside & ~np.concatenate([inside[1:], [False]]))
    for start, stop in zip(starts, stops, strict=True):
        before = [_last_inside(reached, SAMPLES[start], SAMPLES[start - 1])] if start > 0 else []
        after = [_last_inside(reached, SAMPLES[stop], SAMPLES[stop + 1])] if stop + 1 < len(SAMPLES) else []
        t = np.concatenate([before, SAMPLES[start : stop + 1], after])
        yield five_bar.inverse_kinematics(curve(t), working_mode)


def _last_inside(reached: Callable[[np.ndarray], np.ndarray], inside: float, outside: float) -> float:
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if reached(np.array([middle]))[0] else (inside, middle)
    return inside
