"""The refined volume (area, length) of a ``parallel_workspace``: its 95 % interval covers what is sampled by levels.

Serial joints are searched, not sampled (`wsrender.mechanisms.serial_search`). Sets of orientations stand for ranges:
points are decided by the set and by one of half the steps, and what the two differ in widens the interval.
"""

import base64
import zlib
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.analyses.parallel_workspace.lattice import FlatLattice
from wsrender.analyses.partial_result import PartialResult
from wsrender.engine import OrientationCounts
from wsrender.mechanisms.flat import Flat
from wsrender.mechanisms.membership import count_at, in_base_frame, poses_labelled
from wsrender.mechanisms.orientations import OrientationSet, finer, orientation_set
from wsrender.mechanisms.serial_search import MOST_SLOW
from wsrender.reach import Inside, estimate_volumes
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.volume_estimate import VolumeEstimates
from wsrender.volume.lattice import LatticeBlock, block_around
from wsrender.volume.voxels import inner_and_outer

if TYPE_CHECKING:
    from wsrender.analyses.parallel_workspace.run import ParallelWorkspaceAnalysis

EVENTS = {"constant_orientation": "reached", "total_orientation": "all orientations", "dexterous": "dexterous"}
# Along the mean edge of the box that holds everything; fewer where each cell's middle is searched.
CELLS, CELLS_FLAT, CELLS_SEARCHED = 64, 256, 32
# Poses decided at most, of legs in closed form, with serial joints that are searched, and with numerical solutions.
BUDGET, BUDGET_SEARCHED, BUDGET_NUMERIC = 2_000_000_000, 100_000, 30_000
MOST_POINTS, FEWEST_POINTS = 10_000_000, 2_000
FINEST = 100_000  # orientations of the halved steps; of more the asked ones are the finer set

Labelled = Callable[[np.ndarray], np.ndarray]
"""Points (N, 3), world → labels (N, K) int8, as of `estimate_volumes`."""


def refined_entry(
    plan: "ParallelWorkspaceAnalysis",
    occupied: np.ndarray,
    progress: Callable[[int, int], None] | None,
    threads: int | None,
) -> dict[str, Any]:
    """What is measured with its 95 % interval, from uniform points that inverse kinematics decides.

    The strata are inner cells, the border and the rest of a coarse lattice around what can be reached, of which
    `occupied_cells` are ``occupied``. ``progress``: points decided, and about how many there will be.
    """
    tolerance = plan.job.refined_volume
    assert tolerance is not None
    about = {"tolerance": tolerance, "of": EVENTS[plan.job.kind]}
    if plan.block is None:
        return {"value": 0.0, "ci95": [0.0, 0.0], **about, "met": True, "points": 0}
    cells = _cells(plan)
    flat = cells.flat if isinstance(cells, FlatLattice) else None
    sets = _sets(plan)
    labelled = _labelled(plan, sets, threads)

    def membership(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        labels = labelled(points if flat is None else flat.in_world(points))
        return labels, np.full(labels.shape, np.inf)  # how far points outside are: cells are judged by labels alone

    events = {"all": Inside(len(sets), len(sets)), "any": Inside(1, len(sets), precise=False)}
    found = estimate_volumes(
        membership,
        _strata(plan, occupied, cells, threads),
        cells.voxel_size_m,
        events if len(sets) > 1 else {"all": events["all"]},
        tolerance,
        seed=plan.job.seed,
        max_points=_most_points(plan, sets),
        progress=progress,
    )
    nested = plan.job.kind == "total_orientation" or plan.job.dexterous_threshold == 1
    return _entry(found, flat, cells.voxel_size_m, nested) | about | {"points": found.points}


def _entry(found: VolumeEstimates, flat: Flat | None, edge: float, nested: bool) -> dict[str, Any]:
    """Value and interval; where two sets of orientations differ, that much of the measure is added on both sides.

    ``nested``: all orientations are asked for, so that what the finer set allows is what both do.
    """
    across = edge ** (0 if flat is None else 3 - flat.dimension)  # cells of a flat are one edge thick
    both = found.volumes["all"]
    if "any" not in found.volumes:
        return {"value": both.value / across, "ci95": [both.low / across, both.high / across], "met": both.met}
    some = found.volumes["any"]
    spread = some.value - both.value
    value = both.value if nested else both.value + spread / 2
    low, high = max(both.low - spread, 0.0), some.high if nested else some.high + spread
    return {
        "value": value / across,
        "ci95": [low / across, high / across],
        "met": both.met,
        "orientation_steps": spread / across,
    }


def _sets(plan: "ParallelWorkspaceAnalysis") -> list[OrientationSet]:
    """The orientations asked for, and where they are levels of ranges a set of half the steps, or twice as wide."""
    spec = plan.job.orientations
    if spec is None:
        return [plan.orientations]
    halved = finer(spec)
    closed_form = len(plan.variants) == 1 and not plan.mechanism.numeric
    if halved.count <= (FINEST if closed_form else FINEST // 1000):
        return [plan.orientations, orientation_set(halved)]
    return [plan.orientations, orientation_set(_coarser(spec))]


def _coarser(spec):
    """The ranges with about twice the steps."""
    names = ("per_angle",) if hasattr(spec, "per_angle") else ("tilts", "azimuths", "torsions")
    update = {}
    for name in names:
        levels = getattr(spec, name)
        update[name] = tuple(map(_doubled, levels)) if isinstance(levels, tuple) else _doubled(levels)
    return spec.model_copy(update=update)


def _doubled(levels: int) -> int:
    return (levels + 1) // 2 if levels > 2 else levels


def _labelled(plan: "ParallelWorkspaceAnalysis", sets: list[OrientationSet], threads: int | None) -> Labelled:
    if plan.job.kind == "constant_orientation":
        rotations = plan.orientations.rotations[0]
        return lambda points: labels_at_poses(plan, points, rotations, threads)[:, None]
    return lambda points: np.stack([_of_set(plan, points, each, threads) for each in sets], axis=1)


def labels_at_poses(
    plan: "ParallelWorkspaceAnalysis", points: np.ndarray, rotations: np.ndarray, threads: int | None
) -> np.ndarray:
    """Labels (N,) int8 of points (N, 3), world, at orientations (3, 3) or (N, 3, 3) against the fixed base."""
    if plan.search is not None:
        return plan.search.labels(points, rotations, device=plan.device, threads=threads)
    mechanism = plan.mechanism
    there = in_base_frame(mechanism, points)
    if mechanism.numeric or rotations.ndim == 3:
        poses = np.broadcast_to(np.eye(4), (len(points), 4, 4)).copy()
        poses[:, :3, :3], poses[:, :3, 3] = rotations, there
        return poses_labelled(mechanism, poses, device=plan.device, threads=threads)[0]
    counts = count_at(mechanism, there, rotations[None], device=plan.device, threads=threads)
    labels = np.zeros(len(points), np.int8)
    labels[counts.cells[counts.reached > 0]] = REACHABLE
    return labels


def _of_set(
    plan: "ParallelWorkspaceAnalysis", points: np.ndarray, orientations: OrientationSet, threads: int | None
) -> np.ndarray:
    """Whether enough of a set's orientations are reached, labels (N,)."""
    weights = orientations.whole_weights.astype(np.int64)
    least = (
        int(np.ceil(plan.job.dexterous_threshold * weights.sum())) if plan.job.kind == "dexterous" else weights.sum()
    )
    if plan.search is None and not plan.mechanism.numeric:
        found: OrientationCounts = count_at(
            plan.mechanism,
            in_base_frame(plan.mechanism, points),
            orientations.rotations,
            weights=weights.astype(np.int32),
            device=plan.device,
            threads=threads,
        )
        labels = np.zeros(len(points), np.int8)
        labels[found.cells[found.weights >= least]] = REACHABLE
        return labels
    surely, lost = np.zeros(len(points), np.int64), np.zeros(len(points), np.int64)
    for rotation, weight in zip(orientations.rotations, weights, strict=True):
        open_points = np.flatnonzero(weights.sum() - lost >= least)  # others can have too few only
        labels = labels_at_poses(plan, points[open_points], rotation, threads)
        surely[open_points[labels == REACHABLE]] += weight
        lost[open_points[(labels != REACHABLE) & (labels != UNDECIDED)]] += weight
    may = weights.sum() - lost >= least
    return np.where(surely >= least, 1, np.where(may, -1, 0)).astype(np.int8)


def _most_points(plan: "ParallelWorkspaceAnalysis", sets: list[OrientationSet]) -> int:
    budget = BUDGET if plan.search is None else BUDGET_SEARCHED
    if plan.mechanism.numeric:
        budget = BUDGET_NUMERIC if plan.search is None else BUDGET_NUMERIC // MOST_SLOW
    poses = sum(len(each.rotations) for each in sets)
    return int(np.clip(budget // poses, FEWEST_POINTS, MOST_POINTS))


def _cells(plan: "ParallelWorkspaceAnalysis") -> LatticeBlock:
    """A coarse lattice around all that can be reached, no finer than the voxels."""
    block = plan.block
    assert block is not None
    voxel, shape = block.voxel_size_m, np.array(block.shape)
    if isinstance(block, FlatLattice):
        mean = float(np.prod(shape[: block.dimension]) ** (1 / block.dimension))
        ratio = max(int(mean / CELLS_FLAT), 1)  # whole voxels: cells are one thick across
        first = np.floor_divide(block.first_voxel, ratio)
        last = np.floor_divide(np.array(block.first_voxel) + shape - 1, ratio)
        (x, y, z), (nx, ny, nz) = first.tolist(), (last - first + 1).tolist()
        return FlatLattice(voxel * ratio, (x, y, z), (nx, ny, nz), block.dimension, block.origin_m, block.axes)
    lower = np.array(block.first_voxel) * voxel
    upper = lower + shape * voxel
    count = CELLS
    if plan.search is not None:
        (lower, upper), count = _between_levels(plan, lower, upper), CELLS_SEARCHED
    edge = max(float(np.cbrt(np.prod(upper - lower))) / count, voxel)
    return block_around(lower, upper, edge)


def _between_levels(
    plan: "ParallelWorkspaceAnalysis", lower: np.ndarray, upper: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """A box [m] around what is reached between the levels too: each joint moves by half a step at most."""
    search = plan.search
    assert search is not None
    most = sum(
        (search.reach_m if joint.type == "revolute" else 1.0) * np.ptp(joint.limits) / (joint.levels - 1) / 2
        for joint in search.joints
    )
    origin = search.mechanism.T_world_base[:3, 3]
    return np.maximum(lower - most, origin - search.reach_m), np.minimum(upper + most, origin + search.reach_m)


def occupied_cells(plan: "ParallelWorkspaceAnalysis", partial: PartialResult) -> np.ndarray:
    """The cells (nx, ny, nz) bool of the coarse lattice in which voxels were reached, none of it without a lattice."""
    if plan.block is None:
        return np.zeros((0, 0, 0), bool)
    cells = _cells(plan)
    centers = plan.block.centers(partial["cells"][plan.counted(partial)])
    if isinstance(cells, FlatLattice):
        centers = cells.flat.local(centers)
    at = np.floor(centers / cells.voxel_size_m).astype(np.int64) - cells.first_voxel
    occupied = np.zeros(cells.shape, bool)
    inside = np.all((at >= 0) & (at < cells.shape), axis=1)
    occupied[tuple(at[inside].T)] = True
    return occupied


def packed(occupied: np.ndarray) -> str:
    """Which cells are occupied, as text."""
    return base64.b64encode(zlib.compress(np.packbits(occupied).tobytes())).decode()


def unpacked(plan: "ParallelWorkspaceAnalysis", text: str) -> np.ndarray:
    """The cells (nx, ny, nz) bool that were `packed`."""
    shape = (0, 0, 0) if plan.block is None else _cells(plan).shape
    bits = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8)
    return np.unpackbits(bits, count=np.prod(shape)).astype(bool).reshape(shape)


def _strata(
    plan: "ParallelWorkspaceAnalysis", occupied: np.ndarray, cells: LatticeBlock, threads: int | None
) -> list[np.ndarray]:
    """Inner cells, the border and the rest: cells (M, 3) in which voxels were reached, and their neighbours."""
    searched = plan.search is not None and plan.job.kind == "constant_orientation"
    labels = _labels_of_cells(plan, cells, threads) if searched else np.full(cells.shape, UNDECIDED)
    inner, outer = inner_and_outer(occupied | (labels == REACHABLE))
    classes = (inner.astype(np.int8) + outer)[1:-1, 1:-1, 1:-1]
    kept = labels != UNREACHABLE  # by proof nothing in the others is reached
    return [np.argwhere((classes == code) & kept) + cells.first_voxel for code in np.unique(classes)]


def _labels_of_cells(plan: "ParallelWorkspaceAnalysis", cells: LatticeBlock, threads: int | None) -> np.ndarray:
    """Labels (nx, ny, nz) of cells: reachable where their middle is, unreachable where nothing in them is, by proof."""
    assert plan.search is not None
    flat = cells.flat if isinstance(cells, FlatLattice) else None
    centers = cells.centers(np.arange(cells.size))
    around = cells.voxel_size_m / 2 * np.sqrt(3 if flat is None else flat.dimension)
    rotation = plan.orientations.rotations[0]
    how = {"around_m": around, "device": plan.device, "threads": threads}
    return plan.search.labels(centers, rotation, **how).reshape(cells.shape)
