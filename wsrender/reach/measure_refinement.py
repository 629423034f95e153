"""What arms reach, in the measure that their positions have: a volume, in a plane an area, on a line a length.

Where the end effector stays on a curved surface or curve there is none; the result says why.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.constraints.region import RegionConstraint
from wsrender.reach.admission import Admission
from wsrender.reach.dimension import FLAT, TipSet, tip_set
from wsrender.reach.free_volume import ALL_BLOCKED, FREE, FreeSet, free_volumes
from wsrender.reach.pair_search import PairSearch
from wsrender.reach.reached_set import FalseNegatives, ReachedSet, tolerance_m
from wsrender.reach.volume_estimate import Inside, VolumeEstimate
from wsrender.reach.volume_refinement import RefinedVolumes, by_the_origin, decided_volumes
from wsrender.robots.kinematics import Kinematics
from wsrender.volume.measure import QUANTITIES, UNITS

if TYPE_CHECKING:
    from wsrender.robot.arms_collision import ArmsApart

CURVED = {0: "the tip does not move", 1: "the tip stays on a curve", 2: "the tip stays on a surface"}
# Points that are decided at most: so many over the square of the tolerance, and never more than the most. Solid arms
# take a tenth or less; the interval of a shell thinner than a hundredth of its size is wider than asked instead.
BUDGET, MOST_POINTS = 10.0, 10_000_000
LESS = {
    1: "a tip that does not move reaches no length",
    2: "a tip that stays on a curve reaches no area",
    3: "a tip that stays in a plane, on a surface or on a curve reaches no volume",
}
APART = {1: "the tips move on different lines", 2: "the tips move in different planes"}


@dataclass(frozen=True)
class RefinedMeasure:
    """A volume, area or length with its 95 % interval.

    ``quantity``: "volume", "area" or "length"; ``unit``: "m3", "m2" or "m". ``value`` and ``ci95`` are None where the
    set has none, and ``reason`` says why; where too few chains have one to share, why ``value`` is 0; else it is "".
    ``met``: whether the interval is as narrow as asked. ``undecided``: how much inverse kinematics left open, in the
    same unit. ``points``: how many it decided. ``position_tolerance_m``: the largest residual that counted as reached.
    ``false_negatives``: of every chain; of each under constraints two, positions of admitted samples, and random ones
    that a longer search was tried on too; then of arms that keep apart such random ones. ``undecided_ci95``: the
    interval of what was left open.
    """

    quantity: str
    value: float | None
    ci95: tuple[float, float] | None
    unit: str
    reason: str
    met: bool
    undecided: float
    points: int
    position_tolerance_m: float
    false_negatives: tuple[FalseNegatives, ...]
    undecided_ci95: tuple[float, float] = (0.0, 0.0)


def refined_measure(
    chain: Kinematics,
    tolerance: float,
    *,
    seed: int = 0,
    device: str = "cpu",
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    region: RegionConstraint | None = None,
) -> RefinedMeasure:
    """What the end effector of one chain reaches, to a relative ``tolerance``; as in `refined_measures`."""
    options = {"seed": seed, "device": device, "threads": threads, "progress": progress, "region": region}
    return refined_measures([chain], {"reachable": Inside(1, 1)}, tolerance, **options)["reachable"]


def free_measures(
    chains: Sequence[Kinematics],
    constraints: Sequence[Sequence[Constraint]],
    least: Mapping[str, int],
    tolerance: float,
    *,
    apart: "Mapping[tuple[int, int], ArmsApart] | None" = None,
    seed: int = 0,
    device: str = "cpu",
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    region: RegionConstraint | None = None,
) -> dict[str, dict[str, RefinedMeasure]]:
    """What so many of the placed ``chains`` reach in configurations that each one's ``constraints`` admit.

    ``least`` by name: how many at least, to a relative ``tolerance``. Of each by part: FREE, ALL_BLOCKED, where they
    reach it in others alone, and of that what each constraint blocks, which have the same names for all chains; see
    `free_volumes`. ``apart``: chains, by their places, of which two must stand apart where two reach a point together.
    Options as in `refined_measures`.
    """
    space = _Space.of(chains, threads)
    parts = (FREE, ALL_BLOCKED, *(each.name for each in constraints[0]))
    if space.reason:
        nothing = _without(space.quantity, space.reason, max(map(tolerance_m, space.chains)), len(chains))
        return {name: dict.fromkeys(parts, nothing) for name in least}
    how = {"seed": seed, "device": device, "threads": threads}
    sets = {}
    for k in space.filling:
        base = chains[k].T_world_base
        filled = space.chains[k], space.sets[k], space.T_world_own, space.dimension, base, region
        reached = ReachedSet.within(*filled, **how)
        sets[k] = FreeSet(reached, Admission(chains[k], constraints[k], device, threads))
    numbers = list(sets)
    found = free_volumes(
        list(sets.values()),
        least,
        tolerance,
        pairs={
            (numbers.index(i), numbers.index(k)): PairSearch(sets[i].search, sets[k].search, each)
            for (i, k), each in (apart or {}).items()
            if i in sets and k in sets
        },
        seed=seed,
        max_points=most_points(tolerance),
        progress=progress,
    )
    measures: dict[str, dict[str, RefinedMeasure]] = {name: {} for name in least}
    for (name, part), estimate in found.volumes.items():
        reason = "" if least[name] <= len(sets) else LESS[space.dimension]
        measures[name][part] = _measure(space.quantity, estimate, reason, found, found.false_negatives)
    return measures


def refined_measures(
    chains: Sequence[Kinematics],
    events: Mapping[str, Inside],
    tolerance: float,
    *,
    seed: int = 0,
    device: str = "cpu",
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    region: RegionConstraint | None = None,
) -> dict[str, RefinedMeasure]:
    """By event, what so many of the placed ``chains`` reach, to a relative ``tolerance`` (half the 95 % interval).

    In the measure of the chains whose positions have the most dimensions: an arm that moves in a plane adds nothing to
    a volume. A number of points that depends on the tolerance alone bounds the work; where it is not enough, ``met`` is
    False and the interval as wide as it must be. ``progress``: called with the points decided and about how many there
    will be. ``region``: positions elsewhere in the world do not count.
    """
    space = _Space.of(chains, threads)
    if space.reason:
        nothing = _without(space.quantity, space.reason, max(map(tolerance_m, space.chains)), len(chains))
        return dict.fromkeys(events, nothing)
    filling = space.filling
    found = decided_volumes(
        [space.chains[k] for k in filling],
        [space.sets[k] for k in filling],
        space.T_world_own,
        space.dimension,
        events,
        tolerance,
        seed=seed,
        max_points=most_points(tolerance),
        device=device,
        threads=threads,
        progress=progress,
        region=region,
        bases=[chains[k].T_world_base for k in filling],
    )
    tried = dict(zip(filling, found.false_negatives, strict=True))
    misses = tuple(tried.get(k, FalseNegatives(0, 0)) for k in range(len(chains)))
    reasons = {name: "" if event.least <= len(filling) else LESS[space.dimension] for name, event in events.items()}
    return {
        name: _measure(space.quantity, estimate, reasons[name], found, misses)
        for name, estimate in found.volumes.items()
    }


@dataclass(frozen=True, eq=False)
class _Space:
    """Where chains are measured: near the origin, in the space of the first ``dimension`` axes of a frame.

    ``filling``: places of those whose positions have that many dimensions, the most; ``reason``: why they have no
    measure together, or "".
    """

    chains: list[Kinematics]
    sets: list[TipSet]
    filling: list[int]
    dimension: int
    quantity: str
    T_world_own: np.ndarray
    reason: str

    @classmethod
    def of(cls, chains: Sequence[Kinematics], threads: int | None) -> "_Space":
        own = by_the_origin(chains)
        sets = [tip_set(chain, threads) for chain in own]
        highest = max(filled.dimension for filled in sets)
        filling = [k for k, filled in enumerate(sets) if filled.dimension == highest]
        quantity = QUANTITIES[max(max(sets[k].span for k in filling), 1)]
        T_world_own = _own_frame([own[k] for k in filling], sets[filling[0]])
        reason = _without_measure([sets[k] for k in filling], T_world_own)
        return cls(own, sets, filling, highest, quantity, T_world_own, reason)


def most_points(tolerance: float) -> int:
    """Points that are decided at most."""
    return int(min(BUDGET / tolerance**2, MOST_POINTS))


def _own_frame(chains: list[Kinematics], first: TipSet) -> np.ndarray:
    """The frame (4, 4) whose first axes hold the positions of all chains, if any does.

    That of a volume is the base frame of a single chain, where the box that holds the reach is smallest.
    """
    if first.dimension < 3:
        return first.T_world_own
    return chains[0].T_world_base if len(chains) == 1 else np.eye(4)


def _without_measure(sets: list[TipSet], T_world_own: np.ndarray) -> str:
    """Why sets of the same dimension have no measure together, "" where they have one."""
    dimension = sets[0].dimension
    if dimension == 0 or not all(filled.flat for filled in sets):
        return CURVED[dimension]
    slack = FLAT * max(filled.extent_m for filled in sets)
    beside = [filled.thickness_m(T_world_own, dimension) for filled in sets]
    own = [filled.thickness_m(filled.T_world_own, dimension) for filled in sets]
    return APART[dimension] if (np.array(beside) > np.array(own) + slack).any() else ""


def _without(quantity: str, reason: str, position_m: float, chains: int) -> RefinedMeasure:
    misses = (FalseNegatives(0, 0),) * chains
    return RefinedMeasure(quantity, None, None, UNITS[quantity], reason, True, 0.0, 0, position_m, misses)


def _measure(
    quantity: str, estimate: VolumeEstimate, reason: str, found: RefinedVolumes, misses: tuple[FalseNegatives, ...]
) -> RefinedMeasure:
    return RefinedMeasure(
        quantity,
        estimate.value,
        (estimate.low, estimate.high),
        UNITS[quantity],
        reason,
        estimate.met,
        2 * estimate.undecided,
        found.points,
        found.position_m,
        misses,
        estimate.undecided_ci95,
    )
