"""Collaborative space of a 6R two-arm robot: Gao, Xu, body-elemental algorithm ([GX])."""

from typing import Any

from wsrender.reproduce.row import Row
from wsrender.run import execute
from wsrender.run.steps import Progress

PUBLISHED_MEAN, PUBLISHED_VARIANCE = 3.3577e-3, 9.2569e-10  # [m³], [m⁶] over 10 seeds, 200,000 points, 3 refinements
EXACT_PAIR, EXACT_ARM = 6.2190e-3, 0.403721  # [m³], ±0.05 %, longest rods, arms back to back
TOLERANCE = 0.005
UNSTATED = "the paper does not state its rods, placement and cells; here: longest rods, arms outward, 20³ cells"
BIASED = "the algorithm is biased: cells that hold points of both arms are not all reached by both"


def gao(progress: Progress | None = None) -> list[Row]:
    """Volume by the body-elemental algorithm over 10 seeds, and the true volume beside it."""
    document: dict[str, Any] = {
        "analysis": "collaborative_volume",
        "left": {"robot": {"library": "gao_6r"}},
        "right": {"robot": {"library": "gao_6r", "placement": {"rpy_deg": [0.0, 0.0, 180.0]}}},
        "samples": 200_000,
        "seeds": 10,
        "cells": [20, 20, 20],
        "refinements": 3,
        "refined_volume": TOLERANCE,
    }
    found = execute(document, progress).document
    levels, true = found["refinements"], found["volume_m3"]["true"]
    rows = [
        Row("two arms", f"V{level['refinement']}, mean", "m³", level["mean_m3"], exact=EXACT_PAIR, note=BIASED)
        for level in levels[:-1]
    ]
    last = levels[-1]
    rows.append(Row("two arms", "V3, mean", "m³", last["mean_m3"], PUBLISHED_MEAN, EXACT_PAIR, note=UNSTATED))
    rows.append(Row("two arms", "V3, variance", "m⁶", last["variance_m6"], PUBLISHED_VARIANCE, note=UNSTATED))
    low, high = true["ci95"]
    note = "by inverse kinematics"
    rows.append(Row("two arms", "true volume", "m³", true["value"], None, EXACT_PAIR, low, high, note))
    return [*rows, _one_arm(progress)]


def _one_arm(progress: Progress | None) -> Row:
    document = {
        "analysis": "workspace",
        "robot": {"library": "gao_6r"},
        "sampling": {"method": "random", "count": 1_000_000},
        "indices": ["manipulability"],
        "refined_volume": TOLERANCE,
    }
    found = execute(document, progress).document["volume_m3"]["refined"]
    low, high = found["ci95"]
    return Row("one arm", "volume", "m³", found["value"], None, EXACT_ARM, low, high, "by inverse kinematics")
