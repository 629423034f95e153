"""A smooth signed distance to the boundary of a workspace."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.ndimage import binary_closing, gaussian_filter
from scipy.spatial import KDTree
from scipy.special import ndtri

from wsrender.documents.kinetostatics import BoundaryForce
from wsrender.documents.sampling import Sobol
from wsrender.engine import sampled_positions
from wsrender.errors import InputError
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.evidence import REACHABLE
from wsrender.reach.inverse_solver import InverseSolver
from wsrender.robots.chain import Chain

SAMPLES_PER_CELL = 8
POSITION_M = 1e-6  # residual that counts as reached, far below any cell
FIRST, CHUNK = 1 << 14, 1 << 17
FLAT = 1e-6  # extent of a set of positions that counts as none, relative to its size
DECIDED = 2.0  # [cells] from the boundary of the samples within which cells are decided one by one
EDGE = 4  # cells around the workspace: the distance is known that far outside
NEAR, LEAST_SHARE = 1.5, 1e-6  # [cells] within which a Gaussian tells the distance; share that tells no more


@dataclass(frozen=True, eq=False)
class BoundaryDistance:
    """Distance to the boundary of a workspace [m], positive inside, twice differentiable.

    A uniform cubic B-spline over distances at the centres of cells of edge ``cell_m``. Axes (d, 3) span the workspace:
    a planar one is measured in its plane. Right to about half a cell; edges are rounded off over two cells.
    """

    values: np.ndarray  # (cells…) of d axes [m], at the centres of cells
    axes: np.ndarray  # (d, 3) orthonormal
    origin: np.ndarray  # (d,) centre of the first cell along the axes [m]
    cell_m: float

    def at(self, position: np.ndarray) -> tuple[float, np.ndarray]:
        """(distance [m], gradient (3,)) at a position (3,) in the world."""
        near, powers = [], []  # the four cells around the position along each axis, and 1, t, t², t³ between them
        for u, size in zip((self._to_cells.dot(position) - self._corner).tolist(), self.values.shape, strict=True):
            k = min(max(int(u), 1), size - 3)
            t = min(max(u - k, 0.0), 1.0)
            near.append(slice(k - 1, k + 3))
            powers.append((1.0, t, t * t, t * t * t))
        found = self.values[tuple(near)]
        for spline in np.array(powers).dot(_SPLINE).reshape(-1, 4, 2):
            found = found.reshape(4, -1).T.dot(spline)  # for the first axis, a last one: value and slope along it
        found = found.ravel()
        return float(found[0]), found.take(_SLOPES[len(near)]).dot(self._to_cells)

    @cached_property
    def _to_cells(self) -> np.ndarray:
        return self.axes / self.cell_m

    @cached_property
    def _corner(self) -> np.ndarray:
        return self.origin / self.cell_m


_SLOPES = {1: [1], 2: [2, 1], 3: [4, 2, 1]}  # where the slope along each axis is found
# The four weights of the uniform cubic B-spline by the powers of t in 0 … 1, and their derivatives, in turn.
_SPLINE = np.array([
    [1, -3, 4, 0, 1, 3, 0, 0],
    [-3, 6, 0, -12, 3, 6, 0, 0],
    [3, -3, -6, 9, 3, -9, 0, 3],
    [-1, 0, 3, 0, -3, 0, 1, 0],
]) / 6  # fmt: skip


def boundary_distance(
    chain: Chain, choice: BoundaryForce, device: str = "cpu", threads: int | None = None
) -> BoundaryDistance:
    """The distance to the boundary of all positions that a chain reaches within its joint limits.

    Raises InputError for an end effector that does not move.
    """
    positions = next(_positions(chain, FIRST, choice.seed, device, threads))
    axes = _spanning_axes(positions)
    low, high = (positions @ axes.T).min(axis=0), (positions @ axes.T).max(axis=0)
    cell = float(np.prod(high - low) ** (1 / len(axes))) / choice.cells
    origin = low - (EDGE + 0.5) * cell
    shape = np.ceil((high - low) / cell).astype(int) + 2 * EDGE + 2
    inside = np.zeros(shape, bool)
    for each in _positions(chain, SAMPLES_PER_CELL * inside.size, choice.seed, device, threads):
        at = np.round((each @ axes.T - origin) / cell).astype(np.int64)
        inside[tuple(np.clip(at, 0, shape - 1).T)] = True
    inside |= binary_closing(inside)  # gaps of one cell between samples
    if choice.refined:
        near = np.argwhere(np.abs(_signed_distance(inside)) < DECIDED)
        plane = (np.eye(3) - axes.T @ axes) @ positions[0]
        solver = InverseSolver(chain, position_m=POSITION_M, seed=choice.seed, device=device, threads=threads)
        inside[tuple(near.T)] = solver.solve((origin + near * cell) @ axes + plane).label == REACHABLE
    # A cell counts where a sample falls into any part of it: on average half a cell too far out.
    values = (_signed_distance(inside) - (0.0 if choice.refined else 0.5)) * cell
    return BoundaryDistance(values, axes, origin, cell)


def _signed_distance(inside: np.ndarray) -> np.ndarray:
    """Distance of every cell's centre to the boundary [cells], positive inside.

    The share of inner cells under a Gaussian is Φ(distance) near a flat boundary: its inverse gives distances to a
    fraction of a cell, and where they change sign the boundary, from which farther cells are measured.
    """
    share = gaussian_filter(inside.astype(np.float64), 1.0)
    near = np.asarray(ndtri(np.clip(share, LEAST_SHARE, 1 - LEAST_SHARE)))
    crossings = np.concatenate([_crossings(near, axis) for axis in range(near.ndim)])
    if not len(crossings):
        raise InputError("boundary.cells", "leaves nothing of the workspace: it is thinner than two cells; use more")
    cells = np.indices(near.shape).reshape(near.ndim, -1).T
    far, _ = KDTree(crossings).query(cells)
    far = np.where(near > 0, 1.0, -1.0) * far.reshape(near.shape)
    return np.where(np.abs(near) < NEAR, near, far)


def _crossings(near: np.ndarray, axis: int) -> np.ndarray:
    """Points (K, d) [cells] at which the distance changes its sign between neighbours along an axis."""
    before, after = (near.take(range(*ends), axis) for ends in ((0, near.shape[axis] - 1), (1, near.shape[axis])))
    changes = (before > 0) != (after > 0)
    points = np.argwhere(changes).astype(np.float64)
    points[:, axis] += before[changes] / (before[changes] - after[changes])
    return points


def _spanning_axes(positions: np.ndarray) -> np.ndarray:
    """Orthonormal axes (d, 3) of what positions (N, 3) span; the world's where they fill space."""
    centered = positions - positions.mean(axis=0)
    _, sizes, axes = np.linalg.svd(centered, full_matrices=False)
    dimensions = int((sizes > FLAT * max(sizes[0], 1e-12)).sum()) if sizes[0] > 1e-9 else 0
    if dimensions == 0:
        raise InputError("boundary", "cannot be felt: the end effector does not move")
    return np.eye(3) if dimensions == 3 else axes[:dimensions]


def _positions(chain: Chain, count: int, seed: int, device: str, threads: int | None) -> Iterator[np.ndarray]:
    """World positions (N, 3) of a Sobol set of configurations [m], piece by piece."""
    pipeline = tip_pipeline(chain, Sobol(count, seed=seed))
    for first in range(0, count, CHUNK):
        yield sampled_positions(pipeline, device, threads=threads, first=first, count=min(CHUNK, count - first))
