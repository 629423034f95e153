"""The best placement beyond the cells.

Where all postures are known: steps that are halved, from the best cell to what is better around it.

Where a search finds one posture of many, its value says little. There placements and postures are improved together:
from several cells, in random directions by steps that shrink where they fail, each target by tries from near its best
posture so far. The placements that do best go on.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from wsrender.analyses.base_placement.job import BasePlacementJob
from wsrender.analyses.base_placement.result import DIGITS, least_value, told_apart
from wsrender.documents.placements import ANGLES, COORDINATES, IN_DEGREES, TURN, placed
from wsrender.reach.evidence import REACHABLE
from wsrender.reach.placements import Decided, PlacementsOfKinds
from wsrender.reach.starts import inwards
from wsrender.robots.kinematics import Kinematics

HALVINGS, STEPS = 7, 6  # of the steps of the ranges, and moves with each
# Where postures are continued: how many placements go on, for so many moves each, and how many are tried around one.
CELLS, GOING_ON, AROUND = 12, ((12, 24), (4, 48), (2, 96)), 16
# Starts of a target's tries: deviations from its best posture [rad, or reaches for slides].
DEVIATIONS = np.array([0.0, 0.01, 0.03, 0.03, 0.1, 0.1, 0.3, 1.0])
LONGER, SHORTER, LEAST, MOST = 1.5, 0.7, 1e-3, 1.0  # how steps change, and their bounds, in steps of the ranges


@dataclass(frozen=True, eq=False)
class RefinedPlacement:
    """A placement (6,) [m and °], what is known of K targets there, and their configurations (K, n) [rad or m]."""

    place: np.ndarray
    found: Decided
    q: np.ndarray
    step: float = MOST / 2  # to others, in steps of the ranges

    def rank(self, weights: np.ndarray) -> tuple[float, float]:
        """Weight and score."""
        weight, score = _ranks(weights, Decided(*(each[None] for each in self.found.arrays)))
        return float(weight[0]), float(score[0])

    def with_better(self, found: Decided, q: np.ndarray) -> "RefinedPlacement":
        """With what others (K,), at the same placement, serve that this does not, or by a better value."""
        better = (found.label == REACHABLE) & ~(found.value <= self.found.value)
        arrays = zip(found.arrays, self.found.arrays, strict=True)
        joined = Decided(*(np.where(better, theirs, own) for theirs, own in arrays))
        return RefinedPlacement(self.place, joined, np.where(better[:, None], q, self.q), self.step)


def looked_at(search: PlacementsOfKinds, place: np.ndarray) -> RefinedPlacement:
    """What is known at a placement (6,) without continuing from another."""
    return RefinedPlacement(place, *search.configurations(place[None] * IN_DEGREES, placed(place[None])))


def refined(
    job: BasePlacementJob, weights: np.ndarray, search: PlacementsOfKinds, chain: Kinematics, cells: np.ndarray
) -> RefinedPlacement:
    """A placement in the ranges that serves no less than the first of ``cells`` (B, 6) [m, °], by no worse a score.

    ``weights`` (K,): what targets count; ``chain``: whose configurations are continued.
    """
    if job.index and not search.exhaustive:
        return _continued(job, weights, search, chain, cells)
    return looked_at(search, _by_pattern(job, weights, search, cells[0]))


def _continued(
    job: BasePlacementJob, weights: np.ndarray, search: PlacementsOfKinds, chain: Kinematics, cells: np.ndarray
) -> RefinedPlacement:
    """An evolution strategy from each cell, the best of which go on."""
    random = np.random.Generator(np.random.Philox(key=job.seed))
    size = np.array([job.over.ranges[name][2] if name in job.over.ranges else 0.0 for name in COORDINATES])
    scale = np.where(chain.revolute, 1.0, chain.reach)[None, None, None]
    going = [looked_at(search, cell) for cell in cells]
    for count, moves in GOING_ON:
        going = sorted(going, key=lambda each: each.rank(weights), reverse=True)[:count]
        for k, each in enumerate(going):
            for _ in range(moves):
                directions = random.normal(size=(AROUND, 6))
                directions[0] = 0.0  # the place itself
                around = _within(job, each.place + each.step * size * directions, each.place)
                shape = (AROUND, len(weights), len(DEVIATIONS), chain.n)
                changes = random.normal(size=shape) * DEVIATIONS[:, None] * scale
                starts = inwards(chain, each.q[:, None] + changes, 0.0)
                found, q = search.continued(around * IN_DEGREES, placed(around), starts)
                each = each.with_better(Decided(*(array[0] for array in found.arrays)), q[0])
                weight, score = _ranks(weights, found)
                best = np.lexsort((score, weight))[-1]
                if (float(weight[best]), float(score[best])) > each.rank(weights):
                    part = Decided(*(array[best] for array in found.arrays))
                    each = RefinedPlacement(around[best], part, q[best], min(MOST, LONGER * each.step))
                else:
                    each = RefinedPlacement(each.place, each.found, each.q, max(LEAST, SHORTER * each.step))
            again = looked_at(search, each.place)
            going[k] = again.with_better(each.found, each.q)
    return max(going, key=lambda each: each.rank(weights))


def _by_pattern(job: BasePlacementJob, weights: np.ndarray, search: PlacementsOfKinds, start: np.ndarray) -> np.ndarray:
    """A pattern search (Hooke and Jeeves 1961) from a placement (6,).

    Of all neighbours at the step's distance, diagonal ones too, the best, or half the step where none is better.
    """
    axes = [COORDINATES.index(name) for name in job.over.ranges]
    if not axes:
        return start
    pattern = np.zeros((3 ** len(axes), 6))
    pattern[:, axes] = list(product((0, 1, -1), repeat=len(axes)))  # the place itself first
    step, place = np.zeros(6), start.copy()
    step[axes] = [each[2] / 2 for each in job.over.ranges.values()]
    for _ in range(HALVINGS):
        for _ in range(STEPS):
            around = _within(job, place + pattern * step, place)
            weight, score = _ranks(weights, search.decide(around * IN_DEGREES, placed(around)))
            best = np.lexsort((-np.arange(len(around)), told_apart(score), weight))[-1]
            if best == 0:
                break
            place = around[best]
        step /= 2
    return place


def _ranks(weights: np.ndarray, found: Decided) -> tuple[np.ndarray, np.ndarray]:
    """Weight, without rounding, and score, -inf where there is none, of placements (N,) by what is found (N, K)."""
    weight = np.round((found.label == REACHABLE) @ weights / weights.sum(), DIGITS)
    return weight, np.nan_to_num(least_value(found.value), nan=-np.inf)


def _within(job: BasePlacementJob, coordinates: np.ndarray, place: np.ndarray) -> np.ndarray:
    """The nearest in the ranges, ``place`` (6,) where no base may stand; whole turns go on at their other end."""
    lower, upper = job.over.limits
    whole = [
        name in ANGLES and high - low >= TURN - 1e-9 for name, low, high in zip(COORDINATES, lower, upper, strict=True)
    ]
    turned = lower + np.remainder(coordinates - lower, TURN)
    nearest = np.where(whole, turned, np.clip(coordinates, lower, upper))
    return np.where(job.stands(*nearest.T[:2])[:, None], nearest, place)
