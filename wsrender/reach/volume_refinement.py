"""The reachable volume with a confidence interval; of several robots, the volumes that so many of them reach.

Membership of a point is decided by inverse kinematics. The strata are, for every robot, the inner voxels of what a
Sobol set of configurations reaches (all 26 neighbours occupied), the border by the number of neighbours that are
occupied, and the rest of what cannot be proven to be out of reach: inner points are decided too, which finds voids. In
a plane or on a line the same gives areas and lengths.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.pipeline.constraints.region import RegionConstraint
from wsrender.reach.dimension import TipSet, tip_set
from wsrender.reach.reached_set import CELLS, FalseNegatives, ReachedSet, hidden_share, tests_of
from wsrender.reach.volume_estimate import Inside, VolumeEstimate, estimate_volumes
from wsrender.robots.kinematics import Kinematics
from wsrender.volume.lattice import LatticeBlock, block_around

LEVELS = {1: 9, 2: 6, 3: 3}  # of the border, by the number of robots whose classes are combined; of more robots one


@dataclass(frozen=True)
class RefinedVolumes:
    """Volumes by event [m³; m² in a plane, m on a line], the points decided for them, each robot's false negatives.

    ``position_m``: the largest residual that counted as reached [m].
    """

    volumes: dict[Any, VolumeEstimate]
    points: int
    false_negatives: tuple[FalseNegatives, ...]
    position_m: float


def refined_volume(chain: Kinematics, tolerance: float, **options) -> tuple[VolumeEstimate, RefinedVolumes]:
    """The volume that the end effector of one chain reaches; options of `refined_volumes`.

    In the base frame, where the box that holds the reach is smallest, and near the base: no volume depends on a
    placement.
    """
    found = refined_volumes([chain], {"reachable": Inside(1, 1)}, tolerance, **options)
    return found.volumes["reachable"], found


def refined_volumes(
    chains: Sequence[Kinematics],
    events: Mapping[str, Inside],
    tolerance: float,
    *,
    seed: int = 0,
    max_points: int = 10_000_000,
    device: str = "cpu",
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> RefinedVolumes:
    """Volumes of the points that so many of the placed ``chains`` reach, to a relative ``tolerance``.

    ``events``: by name the least and largest number of chains, such as ``{"any": Inside(1, 2), "all": Inside(2, 2)}``;
    those that are not ``precise`` are estimated from the same points. ``progress``: called with the points decided
    and about how many there will be. Surfaces and curves have no volume: 0 (`refined_measures` gives what they have).
    """
    options = {"seed": seed, "max_points": max_points, "device": device, "threads": threads, "progress": progress}
    chains = by_the_origin(chains)
    return decided_volumes(
        chains, [tip_set(chain, threads) for chain in chains], np.eye(4), 3, events, tolerance, **options
    )


def by_the_origin(chains: Sequence[Kinematics]) -> list[Kinematics]:
    """The chains in a world where their measures are the same and their positions have all their digits.

    One chain stands with its base at the origin; of several that are far away, the first.
    """
    if len(chains) == 1:
        chains = [chains[0].placed(np.eye(4))]
    return [chain.relative_to(chains[0].origin) for chain in chains]


def decided_volumes(
    chains: Sequence[Kinematics],
    sets: Sequence[TipSet],
    T_world_own: np.ndarray,
    dimension: int,
    events: Mapping[str, Inside],
    tolerance: float,
    *,
    seed: int,
    max_points: int,
    device: str,
    threads: int | None,
    progress: Callable[[int, int], None] | None,
    region: RegionConstraint | None = None,
    bases: Sequence[np.ndarray] | None = None,
) -> RefinedVolumes:
    """`refined_volumes` in the space of the first ``dimension`` axes of a frame, in which all of ``chains`` move.

    ``sets``: what their positions fill; those of a smaller dimension add nothing. ``region``: where positions count, in
    a world in which the chains stand on ``bases``, (4, 4) each.
    """
    how = {"seed": seed, "device": device, "threads": threads}
    reached = [
        ReachedSet.within(chain, filled, T_world_own, dimension, base, region, **how)
        for chain, filled, base in zip(chains, sets, bases or [np.eye(4)] * len(chains), strict=True)
    ]
    position_m = max(each.position_m for each in reached)
    solid = [each for each in reached if each.solid]
    if not solid:
        volumes = {name: VolumeEstimate(0.0, 0.0, 0.0, 0.0, met=True) for name in events}
        return RefinedVolumes(volumes, 0, tuple(FalseNegatives(0, 0) for _ in reached), position_m)
    block = block_of(solid)
    levels = LEVELS.get(len(solid), 1)
    classes = [each.classes(block, levels) for each in solid]
    misses = [each.false_negatives(block, tests_of(tolerance)) for each in reached]
    hidden = hidden_share(misses)

    def membership(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        at = tuple(np.clip(block.places(points), 0, np.array(classes[0].shape) - 1).T)
        decided = [each.decided_among(points, own[at] > 0) for each, own in zip(solid, classes, strict=True)]
        return np.stack([label for label, _ in decided], axis=1), np.stack([far for _, far in decided], axis=1)

    strata, reaching = strata_of(classes, min(event.least for event in events.values()))
    found = estimate_volumes(
        membership,
        [cells + block.first_voxel[:dimension] for cells in strata],
        block.voxel_size_m,
        events,
        tolerance,
        sets=reaching,
        missed=lambda value: hidden * value,
        seed=seed,
        max_points=max_points,
        progress=progress,
    )
    return RefinedVolumes(found.volumes, found.points, tuple(misses), position_m)


def strata_of(classes: Sequence[np.ndarray], least: int) -> tuple[list[np.ndarray], list[int]]:
    """Cells (M, d) of the same classes, whichever set has which, and how many sets may hold anything of them.

    Without those of which fewer than ``least`` sets may: it is their number alone that events ask for.
    """
    wanted = np.argwhere(np.sum([own > 0 for own in classes], axis=0) >= least)
    of_each = np.sort([own[tuple(wanted.T)] for own in classes], axis=0)
    stratum = np.zeros(len(wanted), np.int64)
    for own in of_each:
        _, stratum = np.unique(stratum * (own.max(initial=0) + 1) + own, return_inverse=True)
    order = np.argsort(stratum, kind="stable")
    first = np.flatnonzero(np.diff(stratum[order], prepend=-1))
    sets = (of_each[:, order[first]] > 0).sum(axis=0)
    return np.split(wanted[order], first[1:]), sets.tolist()


def block_of(sets: Sequence[ReachedSet]) -> LatticeBlock:
    """The cells that hold all of the sets; beside their space, those around it."""
    low, high = np.min([each.low for each in sets], axis=0), np.max([each.high for each in sets], axis=0)
    edge = float(np.prod(high - low) ** (1 / len(low))) / CELLS
    beside = (0, 3 - len(low))
    return block_around(np.pad(low, beside), np.pad(high, beside), edge)
