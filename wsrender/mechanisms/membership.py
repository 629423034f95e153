"""Which poses a mechanism reaches, and the box that holds its workspace.

Legs in closed form are asked by kernels at a lattice of poses; where there are others too, poses are made here and
every numeric leg is asked at those that the legs before it leave (method B) or at all (method A). So are they where
legs on either branch must keep their distance: a pose is reached where some combination of their branches does.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from wsrender.engine import LegTest, OrientationCounts, count_orientations, count_orientations_at, joined, poses_reached
from wsrender.mechanisms.inverse_kinematics import fault_text, inverse_kinematics
from wsrender.mechanisms.keeping_apart import collision_at, stand
from wsrender.mechanisms.mechanism import Mechanism
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.robots.reachable_box import reachable_box as box_of_chain
from wsrender.volume.lattice import LatticeBlock

BATCH = 1 << 15  # poses that numeric legs are asked at a time


def leg_test(mechanism: Mechanism, precision: str = "float64") -> LegTest:
    """What the kernels ask of legs in closed form; subsystems are runs with a common base point ([SNK]'s pairs)."""
    count = mechanism.n
    ends = np.array([k + 1 == count or not np.array_equal(*mechanism.base[[k, k + 1]]) for k in range(count)])
    return LegTest(mechanism, ends, precision)


def _by_pose(mechanism: Mechanism) -> bool:
    """Whether poses are asked one by one, not by the kernels of lattices."""
    return bool(mechanism.numeric) or _joint_branches(mechanism) or mechanism.bodies is not None


def _joint_branches(mechanism: Mechanism) -> bool:
    """Whether the distance of legs depends on which of their branches are taken together."""
    return bool(mechanism.constraints) and mechanism.branched


@dataclass(frozen=True, eq=False)
class AxisBox:
    """An axis-aligned box [m]; empty where a lower side is not below the upper one."""

    lower: np.ndarray
    upper: np.ndarray

    @property
    def empty(self) -> bool:
        """Whether it holds nothing."""
        return bool(np.any(self.lower >= self.upper))

    @property
    def volume(self) -> float:
        """Its volume [m³]."""
        return 0.0 if self.empty else float(np.prod(self.upper - self.lower))


def reachable_box(mechanism: Mechanism, rotations: np.ndarray) -> AxisBox:
    """A box, base frame, that holds every position reached at any of the orientations (N, 3, 3).

    Each leg keeps its platform joint in a ball (UPS, cranks), in a capsule around its rail (PUS), or in a box.
    """
    legs = zip(mechanism.kinds, mechanism.lower, mechanism.upper, strict=True)
    low, high = mechanism.base.copy(), mechanism.base.copy()
    for k, (kind, lower, upper) in enumerate(legs):
        reach = upper if kind == "UPS" else mechanism.crank[k] + mechanism.link[k]
        ends = np.outer([lower, upper], mechanism.axis[k]) if kind == "PUS" else np.zeros((1, 3))
        low[k] += ends.min(axis=0) - reach
        high[k] += ends.max(axis=0) + reach
    boxes = [box_of_chain(leg.chain, leg.chain.lower_limits, leg.chain.upper_limits) for leg in mechanism.numeric]
    low, high = (np.vstack([rows, *(box[side] for box in boxes)]) for side, rows in enumerate((low, high)))
    joints = np.vstack([mechanism.platform, *(leg.T_platform_tip[:3, 3] for leg in mechanism.numeric)])
    shift = np.einsum("nij,lj->nli", rotations, joints)
    lower = np.maximum((low - shift).max(axis=1).min(axis=0), mechanism.region_lower)
    upper = np.minimum((high - shift).min(axis=1).max(axis=0), mechanism.region_upper)
    return AxisBox(lower, upper)


def placed_box(mechanism: Mechanism, box: AxisBox) -> AxisBox:
    """The smallest box in the world that holds a box of the base frame."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    world = in_world(mechanism, box.lower + corners * (box.upper - box.lower))
    return AxisBox(world.min(axis=0), world.max(axis=0))


def in_base_frame(mechanism: Mechanism, positions_world: np.ndarray) -> np.ndarray:
    """Positions (N, 3) of the world in the mechanism's base frame [m]."""
    T = mechanism.T_world_base
    return (positions_world - T[:3, 3]) @ T[:3, :3]


def in_world(mechanism: Mechanism, positions: np.ndarray) -> np.ndarray:
    """Positions (…, 3) of the base frame in the world [m]."""
    return positions @ mechanism.T_world_base[:3, :3].T + mechanism.T_world_base[:3, 3]


def count_lattice(
    mechanism: Mechanism,
    block: LatticeBlock,
    rotations: np.ndarray,
    first: int,
    count: int,
    *,
    weights: np.ndarray,
    by_subsystem: bool = True,
    precision: str = "float64",
    device: str = "auto",
    threads: int | None = None,
    chunk_size: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> OrientationCounts:
    """At how many of the orientations voxel centres are reached; as `wsrender.engine.count_orientations`."""
    options: dict[str, Any] = {"weights": weights, "by_subsystem": by_subsystem, "device": device, "threads": threads}
    if not _by_pose(mechanism):
        test, options = leg_test(mechanism, precision), {**options, "chunk_size": chunk_size, "progress": progress}
        return count_orientations(test, block, rotations, first, count, **options)
    places = max((chunk_size or BATCH) // len(rotations), 1)
    parts = []
    for start in range(first, first + count, places):
        cells = np.arange(start, min(start + places, first + count))
        positions = in_base_frame(mechanism, block.centers(cells))
        parts.append(_counted(mechanism, cells, positions, rotations, precision=precision, **options))
        if progress:
            progress(int(cells[-1]) + 1 - first)
    return joined(parts)


def count_at(
    mechanism: Mechanism,
    positions: np.ndarray,
    rotations: np.ndarray,
    *,
    weights: np.ndarray | None = None,
    precision: str = "float64",
    device: str = "auto",
    threads: int | None = None,
) -> OrientationCounts:
    """At how many of the orientations (M, 3, 3) positions (N, 3), base frame [m], are reached, by method B.

    Positions that are reached at none may be missing from the ``cells``, numbers of positions.
    """
    if not _by_pose(mechanism):
        test = leg_test(mechanism, precision)
        return count_orientations_at(test, positions, rotations, weights=weights, device=device, threads=threads)
    if weights is None:
        weights = np.ones(len(rotations), np.int32)
    options = {"weights": weights, "by_subsystem": True, "precision": precision, "device": device, "threads": threads}
    places = max(BATCH // len(rotations), 1)
    batches = [np.arange(n, min(n + places, len(positions))) for n in range(0, len(positions), places)]
    return joined([_counted(mechanism, cells, positions[cells], rotations, **options) for cells in batches])


def poses_labelled(
    mechanism: Mechanism,
    poses: np.ndarray,
    *,
    by_subsystem: bool = True,
    precision: str = "float64",
    fixed: np.ndarray | None = None,
    device: str = "auto",
    threads: int | None = None,
) -> tuple[np.ndarray, int]:
    """Labels (N,) int8 of platform poses (N, 4, 4), base frame, as of `InverseSolver`, and (pose, leg) pairs asked.

    ``fixed`` (N, 4, 4): as of `stand`.
    """
    asked = mechanism.n * len(poses)
    if mechanism.n:
        test = replace(mechanism, constraints=()) if _joint_branches(mechanism) else mechanism
        fits = poses_reached(leg_test(test, precision), poses, device=device, threads=threads)
        if _joint_branches(mechanism):
            some = np.flatnonzero(fits)
            fits[some] = inverse_kinematics(mechanism, poses[some]).feasible
    else:
        fits = inverse_kinematics(mechanism, poses).inside
    labels = np.where(fits, REACHABLE, UNREACHABLE).astype(np.int8)
    for leg in mechanism.numeric:
        left = np.flatnonzero(labels != UNREACHABLE) if by_subsystem else np.arange(len(poses))
        found = leg.solve(poses[left], device=device, threads=threads).label
        asked += len(left)
        none = (labels[left] == UNREACHABLE) | (found == UNREACHABLE)
        labels[left] = np.where(none, UNREACHABLE, np.minimum(labels[left], found))
    if mechanism.bodies:
        left = np.flatnonzero(labels == REACHABLE)
        there = None if fixed is None else fixed[left]
        labels[left] = stand(mechanism, poses[left], fixed=there, device=device, threads=threads).label
    return labels, asked


def rejections(mechanism: Mechanism, poses: np.ndarray, labels: np.ndarray, **options: Any) -> tuple[int, int]:
    """How many poses the legs reach by themselves, and how many of these the ``labels`` (N,) do not.

    0 of a mechanism without constraints; ``options`` of `poses_labelled`.
    """
    if not mechanism.constraints and not mechanism.bodies:
        return 0, 0
    fitting = poses_labelled(replace(mechanism, constraints=(), bodies=None), poses, **options)[0] == REACHABLE
    return int(fitting.sum()), int((fitting & (labels != REACHABLE)).sum())


def orientations_labelled(
    mechanism: Mechanism, position: np.ndarray, rotations: np.ndarray, **options: Any
) -> tuple[np.ndarray, tuple[int, int]]:
    """Labels (N,) of orientations (N, 3, 3) at one position (3,), base frame; ``options`` of `poses_labelled`.

    And their `rejections`.
    """
    poses = _poses(position[None], rotations)
    labels = poses_labelled(mechanism, poses, **options)[0]
    return labels, rejections(mechanism, poses, labels, **options)


def fault_at(mechanism: Mechanism, pose: np.ndarray) -> str:
    """What keeps the mechanism from a platform pose (4, 4), base frame, in words; empty where nothing does."""
    fault = fault_text(mechanism, inverse_kinematics(mechanism, pose[None]), 0)
    faults: Iterable[str] = (leg.reason(pose) for leg in mechanism.numeric)
    return fault or next((text for text in faults if text), "") or collision_at(mechanism, pose)


def _counted(
    mechanism: Mechanism,
    cells: np.ndarray,
    positions: np.ndarray,
    rotations: np.ndarray,
    *,
    weights: np.ndarray,
    **options: Any,
) -> OrientationCounts:
    """Counts of the positions (N, 3) with numbers ``cells`` that are reached at all."""
    poses = _poses(positions, rotations)
    labels, asked = poses_labelled(mechanism, poses, **options)
    fitting = rejections(mechanism, poses, labels, **options)
    hits = labels.reshape(len(positions), len(rotations)) == REACHABLE
    some = hits.any(axis=1)
    reached, weighted = hits[some].sum(axis=1).astype(np.int32), (hits[some] @ weights).astype(np.int32)
    return OrientationCounts(cells[some], reached, weighted, asked, int((labels == UNDECIDED).sum()), *fitting)


def _poses(positions: np.ndarray, rotations: np.ndarray) -> np.ndarray:
    """Every position (N, 3) at every orientation (M, 3, 3), the orientations fastest, (N M, 4, 4)."""
    poses = np.broadcast_to(np.eye(4), (len(positions), len(rotations), 4, 4)).copy()
    poses[..., :3, 3], poses[..., :3, :3] = positions[:, None], rotations
    return poses.reshape(-1, 4, 4)
