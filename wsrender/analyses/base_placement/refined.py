"""The best placement beyond the cells: steps that are halved, from a cell to what is better around it."""

from itertools import product

import numpy as np

from wsrender.analyses.base_placement.job import BasePlacementJob
from wsrender.analyses.base_placement.result import IN_DEGREES, least_value, told_apart
from wsrender.documents.placements import ANGLES, COORDINATES, TURN, placed
from wsrender.reach.evidence import REACHABLE
from wsrender.reach.placements import PlacementsOfKinds

HALVINGS, STEPS = 7, 6  # of the steps of the ranges, and moves with each


def refined(job: BasePlacementJob, weights: np.ndarray, search: PlacementsOfKinds, start: np.ndarray) -> np.ndarray:
    """Coordinates (6,) [m and °] within the ranges that serve no less than those at the ``start``, by no worse a score.

    ``weights`` (K,): what targets count.

    A pattern search (Hooke and Jeeves 1961): of all neighbours at the step's distance, diagonal ones too, the best, or
    half the step where none is better.
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
            around = _within(job, place + pattern * step)
            weight, score = _measured(weights, search, around)
            best = np.lexsort((-np.arange(len(around)), score, weight))[-1]
            if best == 0:
                break
            place = around[best]
        step /= 2
    return place


def _measured(weights: np.ndarray, search: PlacementsOfKinds, coordinates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weight and score of placements (N, 6)."""
    found = search.decide(coordinates * IN_DEGREES, placed(coordinates))
    return told_apart((found.label == REACHABLE) @ weights), told_apart(least_value(found.value))


def _within(job: BasePlacementJob, coordinates: np.ndarray) -> np.ndarray:
    """The nearest in the ranges; angles of a whole turn go on at its other end."""
    lower, upper = job.over.limits
    whole = [
        name in ANGLES and high - low >= TURN - 1e-9 for name, low, high in zip(COORDINATES, lower, upper, strict=True)
    ]
    turned = lower + np.remainder(coordinates - lower, TURN)
    return np.where(whole, turned, np.clip(coordinates, lower, upper))
