"""Inverse kinematics of a mechanism in closed form, leg by leg: actuated values, and what keeps a leg from its pose.

Of a leg only the platform joint e = P + R p matters. UPS: the length is |e - b|. PUS: the slider s solves
|e - b - s a| = l, so s = c ± √(l² - d²) with c = (e - b)·a and d the distance of e from the rail. RUS and delta: the
crank angle θ solves |e - b - r (cos θ u + sin θ a × u)| = l, A cos θ + B sin θ = C with A = (e - b)·u,
B = (e - b)·(a × u), C = (|e - b|² + r² - l²) / 2r; θ = atan2(B, A) ± acos(C / √(A² + B²)).
Merlet, *Parallel Robots*, 2006, chapter 3.
"""

from dataclasses import dataclass, fields
from itertools import product

import numpy as np

from wsrender.mechanisms.mechanism import Mechanism
from wsrender.pipeline.constraints.leg_distance import segment_distance

FAULTS = (
    "",
    "out of reach",
    "below its lower limit",
    "above its upper limit",
    "outside the cone of its base-side joint",
    "outside the cone of its platform joint",
)
FINE, OUT_OF_REACH, BELOW, ABOVE, BASE_CONE, PLATFORM_CONE = range(len(FAULTS))
ANGLE_ROUNDING = 1e-12  # [rad]: an angle this little below its lower limit is not a turn above it
SAME_ORIENTATION = 1e-9  # [1]: largest entry by which the platform of a delta may be turned against the base


@dataclass(frozen=True, eq=False)
class LegSolutions:
    """Legs of N poses.

    ``values`` (N, L) of the actuated joints [m or rad], ``elbows`` (N, L, 3) base-side ends of the links (the base
    joint, slider or end of the crank) and ``joints`` (N, L, 3) their platform ends, base frame [m].
    ``faults`` (N, L) int8: the place in FAULTS of what keeps the leg from the pose; of the legs without a solution the
    values are NaN. ``inside``, ``clear``, ``level`` (N,) bool: whether the platform is in its region, the legs keep
    their distance, and a platform on parallelograms is not turned; ``feasible`` (N,): whether all holds.
    """

    values: np.ndarray
    elbows: np.ndarray
    joints: np.ndarray
    faults: np.ndarray
    inside: np.ndarray
    clear: np.ndarray
    level: np.ndarray

    def at(self, rows: np.ndarray) -> "LegSolutions":
        """Of some of the poses alone."""
        return LegSolutions(*(getattr(self, each.name)[rows] for each in fields(self)))

    @property
    def feasible(self) -> np.ndarray:
        """Whether the mechanism reaches the pose, (N,) bool."""
        return (self.faults == FINE).all(axis=1) & self.inside & self.clear & self.level


def inverse_kinematics(mechanism: Mechanism, poses: np.ndarray) -> LegSolutions:
    """Legs in closed form of platform poses (N, 4, 4), base frame [m]."""
    position, rotation = poses[:, :3, 3], poses[:, :3, :3]
    joints = position[:, None] + np.einsum("nij,lj->nli", rotation, mechanism.platform)
    solved = [_solutions(mechanism, k, joints[:, k], rotation) for k in range(len(mechanism.kinds))]
    values, faults = np.zeros(joints.shape[:2]), np.zeros(joints.shape[:2], np.int8)
    elbows = np.zeros(joints.shape)
    for k, chosen in enumerate(_chosen(mechanism, solved, joints)):
        for branch, (value, elbow, fault) in solved[k].items():
            at = chosen == branch
            values[at, k], elbows[at, k], faults[at, k] = value[at], elbow[at], fault[at]
    links, anyhow = np.stack([elbows, joints], axis=2), np.ones(len(poses), bool)
    inside = np.all((position >= mechanism.region_lower) & (position <= mechanism.region_upper), axis=1)
    level = np.all(np.abs(rotation - np.eye(3)) <= SAME_ORIENTATION, axis=(1, 2))
    return LegSolutions(
        values,
        elbows,
        joints,
        faults,
        inside,
        clear=np.all([anyhow, *(each.host(values, links) == 0 for each in mechanism.constraints)], axis=0),
        level=level if mechanism.translational else anyhow,
    )


def fault_text(mechanism: Mechanism, legs: LegSolutions, pose: int) -> str:
    """What keeps the mechanism from one of the poses, in words; empty where nothing does."""
    if not legs.inside[pose]:
        return "the platform is outside its region"
    if not legs.level[pose]:
        return "the platform is turned, which its parallelograms prevent"
    bad = np.flatnonzero(legs.faults[pose])
    if len(bad):
        leg = int(bad[0])
        value, fault = legs.values[pose, leg], FAULTS[legs.faults[pose, leg]]
        unit = "m" if mechanism.kinds[leg] in ("UPS", "PUS") else "rad"
        limits = f"limits {mechanism.lower[leg]:.6g} … {mechanism.upper[leg]:.6g} {unit}"
        at = "" if np.isnan(value) else f" at {value:.6g} {unit}"
        return f"leg {mechanism.numbers[leg] + 1} ({mechanism.kinds[leg]}){at} is {fault} ({limits})"
    return "" if legs.clear[pose] else "leg_distance: two legs come closer than minimum_leg_distance_m"


Solved = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Values (N,), elbows (N, 3), faults (N,) of one leg."""


MOST_CHOICES = 1 << 20  # (pose, combination of branches) at a time


def _solutions(mechanism: Mechanism, k: int, joint: np.ndarray, rotation: np.ndarray) -> dict[int, Solved]:
    """What a leg does on each branch that counts, "plus" (1) before "minus" (0)."""
    found = {}
    for branch in (1, 0):
        if mechanism.branches[k, branch]:
            value, elbow = _solution(mechanism, k, joint, branch)
            found[branch] = value, elbow, _faults(mechanism, k, value, elbow, joint, rotation)
    return found


def _chosen(mechanism: Mechanism, solved: list[dict[int, Solved]], joints: np.ndarray) -> list[np.ndarray]:
    """The branch (N,) of every leg: the first that is within all limits, or the leg's first.

    Where the distance of legs is limited, that of the first combination of branches that keep it, if there is one.
    """
    chosen = []
    for branches in solved:
        first, *others = branches
        best = np.full(len(joints), first)
        for other in others:
            best[(branches[first][2] != FINE) & (branches[other][2] == FINE)] = other
        chosen.append(best)
    if not mechanism.constraints or not mechanism.branched:
        return chosen
    combinations = list(product(*solved))
    at_once = max(MOST_CHOICES // len(combinations), 1)
    for start in range(0, len(joints), at_once):
        part = slice(start, start + at_once)
        rows = [{b: tuple(x[part] for x in one) for b, one in branches.items()} for branches in solved]
        clear = _clear(mechanism, rows, joints[part], combinations)
        some, first_clear = clear.any(axis=1), clear.argmax(axis=1)
        for k, best in enumerate(chosen):
            best[part] = np.where(some, np.array(combinations)[first_clear, k], best[part])
    return chosen


def _clear(mechanism: Mechanism, solved, joints: np.ndarray, combinations: list[tuple[int, ...]]) -> np.ndarray:
    """Whether all legs are within limits and keep their distance on each combination of branches, (N, C) bool."""
    taken = np.array(combinations)
    clear = np.ones((len(joints), len(combinations)), bool)
    for k, branches in enumerate(solved):
        for branch, (_, _, fault) in branches.items():
            clear[:, taken[:, k] == branch] &= (fault == FINE)[:, None]
    for least, (a, b) in ((each.least_m, pair) for each in mechanism.constraints for pair in each.pairs):
        for (one, (_, elbow_a, _)), (other, (_, elbow_b, _)) in product(solved[a].items(), solved[b].items()):
            far = segment_distance(elbow_a, joints[:, a], elbow_b, joints[:, b]) >= least
            clear[:, (taken[:, a] == one) & (taken[:, b] == other)] &= far[:, None]
    return clear


def _solution(mechanism: Mechanism, k: int, joint: np.ndarray, branch: int) -> tuple[np.ndarray, np.ndarray]:
    """Actuated value (N,), NaN where there is none, and base-side end of the link (N, 3)."""
    base, axis, zero = mechanism.base[k], mechanism.axis[k], mechanism.zero[k]
    link, crank, sign = mechanism.link[k], mechanism.crank[k], 2 * branch - 1
    reach = joint - base
    if mechanism.kinds[k] == "UPS":
        return np.linalg.norm(reach, axis=1), np.broadcast_to(base, joint.shape)
    if mechanism.kinds[k] == "PUS":
        along = reach @ axis
        value = along + sign * _root(link**2 - ((reach - along[:, None] * axis) ** 2).sum(axis=1))
        return value, base + value[:, None] * axis
    across = np.cross(axis, zero)
    a, b = reach @ zero, reach @ across
    c = ((reach**2).sum(axis=1) + crank**2 - link**2) / (2 * crank)
    value = np.arctan2(b, a) + sign * np.arctan2(_root(a**2 + b**2 - c**2), c)
    lower = mechanism.lower[k] - ANGLE_ROUNDING
    value = lower + np.mod(value - lower, 2 * np.pi)
    return value, base + crank * (np.cos(value)[:, None] * zero + np.sin(value)[:, None] * across)


def _root(square: np.ndarray) -> np.ndarray:
    """Square root; NaN where there is none."""
    return np.sqrt(np.where(square >= 0, square, np.nan))


def _faults(
    mechanism: Mechanism, k: int, value: np.ndarray, elbow: np.ndarray, joint: np.ndarray, rotation: np.ndarray
) -> np.ndarray:
    """The first fault of a leg at each pose, (N,) int8."""
    length = np.linalg.norm(joint - elbow, axis=1)
    at_base = (joint - elbow) @ mechanism.base_cone_axis[k]
    if mechanism.crank[k] > 0:  # its axis turns with the crank
        at_base = ((joint - elbow) * _turned(mechanism.base_cone_axis[k], mechanism.axis[k], value)).sum(axis=1)
    at_platform = ((joint - elbow) * (rotation @ mechanism.platform_cone_axis[k])).sum(axis=1)
    lower = mechanism.lower[k] - (ANGLE_ROUNDING if mechanism.crank[k] > 0 else 0.0)
    conditions = {
        OUT_OF_REACH: np.isnan(value),
        BELOW: value < lower,
        ABOVE: value > mechanism.upper[k],
        BASE_CONE: at_base < mechanism.base_cone_cosine[k] * length,
        PLATFORM_CONE: at_platform < mechanism.platform_cone_cosine[k] * length,
    }
    return np.select(list(conditions.values()), list(conditions), FINE).astype(np.int8)


def _turned(vector: np.ndarray, axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """A vector turned about a unit axis by angles (N,) (Rodrigues 1840), (N, 3)."""
    cosine, sine = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return cosine * vector + sine * np.cross(axis, vector) + (1 - cosine) * (axis @ vector) * axis
