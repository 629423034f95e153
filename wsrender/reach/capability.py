"""Capability: from which directions an end effector can approach each point of its workspace.

After Zacharias, Borst, Hirzinger, *Capturing robot workspace structure*, 2007, and [CB] 4.3; every pair of a voxel's
centre and a direction is decided by inverse kinematics, the turn about the direction being free.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from wsrender.engine import sampled_positions
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.admissible_search import Admissible, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.dimension import fills_volume, in_own_voxel
from wsrender.reach.evidence import REACHABLE, UNDECIDED
from wsrender.reach.inverse_solver import InverseSolver
from wsrender.reach.occupied_cells import occupied_cells
from wsrender.robots.kinematics import Kinematics
from wsrender.robots.reachable_box import reachable_box
from wsrender.volume.lattice import LatticeBlock, block_around
from wsrender.volume.voxels import inner_and_outer

SAMPLES_PER_CELL, LEAST_SAMPLES = 16, 1 << 20
SEARCHED_BYTES = 17  # of a voxel: its samples, whether it is occupied, inner, outer, and copies of them
BATCH = 1 << 16  # pairs decided at a time
# Columns: the tip frame turned so that its z is the axis that approaches.
AXES = {
    "x": ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
    "y": ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
    "z": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "-x": ((0, 0, -1), (1, 0, 0), (0, -1, 0)),
    "-y": ((0, 1, 0), (0, 0, -1), (-1, 0, 0)),
    "-z": ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
}


@dataclass(frozen=True, eq=False)
class Capability:
    """Of the voxels that are reached: cells (V, 3) int64, and from which of D directions they are, (V, D) bool.

    ``undecided`` (V,): directions about which the search was not conclusive; they count as not reached. Under C
    constraints ``blocked`` (V, C): directions from which it is reached in configurations alone that are rejected, by
    the constraint that rejects most of them; None without constraints.
    """

    cells: np.ndarray
    reached: np.ndarray
    undecided: np.ndarray
    blocked: np.ndarray | None = None

    @property
    def index(self) -> np.ndarray:
        """Reachability index: share of the directions that are reached, (V,)."""
        return self.reached.mean(axis=1)


def fibonacci_directions(count: int) -> np.ndarray:
    """Unit vectors (D, 3), spread evenly over the sphere (González, *Measurement of areas on a sphere*, 2010)."""
    k = np.arange(count)
    z = 1 - (2 * k + 1) / count
    angle = k * np.pi * (3 - np.sqrt(5))
    r = np.sqrt(1 - z**2)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


def approaching(chain: Kinematics, approach_axis: str) -> Kinematics:
    """The chain with a tip whose z is its ``approach_axis``."""
    turned = np.eye(4)
    turned[:3, :3] = AXES[approach_axis]
    return chain.placed(T_tip_tool=chain.T_tip_tool @ turned)


def capability(
    chain: Kinematics,
    voxel_size_m: float,
    directions: np.ndarray,
    *,
    cells: np.ndarray | None = None,
    approach_axis: str = "z",
    position_m: float = 1e-5,
    angle_rad: float = 1e-3,
    seed: int = 0,
    precision: str = "float64",
    device: str = "cpu",
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    constraints: Sequence[Constraint] = (),
) -> Capability:
    """Decide which voxel centres the end effector reaches with its ``approach_axis`` along each direction (D, 3).

    Where its positions fill no volume, as those of an arm that moves in a plane, the reachable point nearest to a
    centre stands for the voxel, if it lies in it.

    ``cells`` (V, 3): the voxels, of which each is decided by itself; None: the `candidates`. ``position_m`` and
    ``angle_rad``: what counts as there. ``progress``: called with the pairs decided. ``constraints`` must admit the
    configurations.
    """
    execution = {"seed": seed, "precision": precision, "device": device, "threads": threads}
    accuracy = {"position_m": position_m, "angle_rad": angle_rad}
    cells = candidates(chain, voxel_size_m, seed, device, threads) if cells is None else cells
    admission = Admission(chain, constraints, device, threads) if constraints else None
    points, reached = _points(
        InverseSolver(chain, kind="position", **accuracy, **execution), admission, cells, voxel_size_m, threads
    )
    cells, points = cells[reached], points[reached]

    solver = InverseSolver(approaching(chain, approach_axis), kind="axis", **accuracy, **execution)
    search = AdmissibleSearch(solver, admission) if admission else None
    labels = np.zeros((len(cells), len(directions)), np.int8)
    blocked = np.zeros((len(cells), len(constraints)), np.int64)
    each = max(1, BATCH // len(directions))
    for first in range(0, len(cells), each):
        batch = slice(first, first + each)
        position = np.repeat(points[batch], len(directions), axis=0)
        axes = np.tile(directions, (len(points[batch]), 1))
        found = search.decide(position, axes) if search else solver.solve(position, axes)
        labels[batch] = found.label.reshape(-1, len(directions))
        if isinstance(found, Admissible):
            reason = found.reason.reshape(-1, len(directions))
            blocked[batch] = np.stack([(reason == k + 1).sum(axis=1) for k in range(len(constraints))], axis=1)
        if progress:
            progress(min(first + each, len(cells)) * len(directions))
    undecided = (labels == UNDECIDED).sum(axis=1)
    return Capability(cells, labels == REACHABLE, undecided, blocked if constraints else None)


def searched_block(chain: Kinematics, voxel_size_m: float) -> LatticeBlock:
    """The voxels among which those that are reached are looked for."""
    return block_around(*reachable_box(chain, chain.lower_limits, chain.upper_limits), voxel_size_m)


def _points(
    solver: InverseSolver, admission: Admission | None, cells: np.ndarray, voxel_size_m: float, threads: int | None
) -> tuple[np.ndarray, np.ndarray]:
    """The point (V, 3) [m] that stands for each cell, and whether it is reached (V,)."""
    points = (cells + 0.5) * voxel_size_m
    held, solid = np.ones(len(cells), bool), fills_volume(solver.whole, threads)
    if not solid:
        points = sampled_positions(tip_pipeline(solver.whole, solver.solve(points).q), threads=threads)
        held = in_own_voxel(points, cells, voxel_size_m)
    if admission:
        return points, held & (AdmissibleSearch(solver, admission).decide(points).label == REACHABLE)
    return points, held & (solver.solve(points).label == REACHABLE if solid else True)


def candidates(chain: Kinematics, voxel_size_m: float, seed: int, device: str, threads: int | None) -> np.ndarray:
    """Cells (V, 3) that samples of the chain reach, and their neighbours."""
    block = searched_block(chain, voxel_size_m)
    count = max(LEAST_SAMPLES, SAMPLES_PER_CELL * block.size)
    _, outer = inner_and_outer(occupied_cells(chain, block, count, seed, device, threads))
    return np.argwhere(outer) + block.first_voxel - 1
