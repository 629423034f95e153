"""Planar workspace boundaries: Alciatore, Ng, Monte Carlo method and least squares segmentation ([AN])."""

import math
from typing import Any

from wsrender.reproduce.row import Row
from wsrender.run import execute
from wsrender.run.steps import Progress

EXAMPLE_1 = {  # RP: x = (5 + d) cos θ, y = (5 + d) sin θ
    "dh": {
        "convention": "standard",
        "rows": [
            {"alpha_deg": 90, "theta_deg": 90, "limits_deg": [-45, 45]},
            {"joint": "prismatic", "d": 5.0, "limits": [0, 3]},
        ],
    }
}
EXAMPLE_2 = {  # RR with whole turns
    "dh": {"convention": "standard", "rows": [{"a": length, "limits_deg": [-180, 180]} for length in (8.0, 5.0)]}
}


def example_3(low_deg: float, high_deg: float) -> dict[str, Any]:
    """PR: x = 2 sin θ, y = d − 2 cos θ."""
    rows = [
        {"joint": "prismatic", "alpha_deg": -90, "limits": [0, 6]},
        {"alpha_deg": 90, "theta_deg": -90, "limits_deg": [low_deg, high_deg]},
    ]
    return {"dh": {"convention": "modified", "rows": rows}, "tool": {"position_m": [2.0, 0.0, 0.0]}}


# As printed: (centre x, y, R) of the arcs and the vertices of example 1, radii of example 2, segments of example 3.
ARCS_1 = {5: (0.061, -0.004, 5.04), 8: (0.057, 0.011, 7.92)}
VERTICES_1 = {"A": (3.53, 3.54), "B": (3.54, -3.53), "C": (5.65, -5.66), "D": (5.66, 5.66)}
RADII_2 = {13: 12.91, 3: 3.05}
SEGMENTS_3 = (
    ("line", (1.02, -1.70), (0.82, 1.91)),
    ("line", (0.82, 1.91), (-0.81, 1.91)),
    ("line", (-0.82, 1.91), (-1.02, -1.70)),
    ("line", (-1.02, -1.70), (-1.71, -0.87)),
    ("line", (-1.87, -0.61), (-1.64, 7.10)),
    ("arc", (-1.64, 7.10), (1.96, 5.57)),
    ("line", (1.96, 5.57), (1.66, -1.04)),
    ("line", (1.66, -1.04), (1.02, -1.70)),
)
MISPRINTED = (2, 4, 8)  # segments that are arcs R2 though printed LINE
VERTEX = 0.3  # [m]: a printed point of example 3 that is farther from a vertex is not meant for it
INWARD = "boundary cells lie inside by 0.24–0.33 cell widths, whatever the number of samples"
TANGENT = "lines and arcs go over into each other smoothly: where, samples cannot tell"
RANGE = "0…360° in the paper's table, 30…330° in its figures"


def alciatore(progress: Progress | None = None) -> list[Row]:
    """The three examples: Monte Carlo with N_m = 100,000 and N_g = 2,500, and exact."""
    return [*_first(progress), *_second(progress), *_third(progress)]


def _run(robot: dict[str, Any], progress: Progress | None) -> dict[str, Any]:
    document = {"analysis": "planar_boundary", "robot": robot, "cells": 2500}
    return execute(document | {"sampling": {"method": "random", "count": 100_000}}, progress).document


def _segments(part: dict[str, Any], kind: str | None = None) -> list[dict[str, Any]]:
    return [s for loop in part["loops"] for s in loop["segments"] if kind in (None, s["kind"])]


def _nearest_arc(part: dict[str, Any], radius: float) -> dict[str, Any]:
    return min(_segments(part, "arc"), key=lambda segment: abs(segment["radius_m"] - radius))


def _first(progress: Progress | None) -> list[Row]:
    found, case, rows = _run(EXAMPLE_1, progress), "1: RP", []
    for radius, (x, y, printed) in ARCS_1.items():
        estimated, exact = (_nearest_arc(found[part], radius) for part in ("monte_carlo", "exact"))
        for k, published in enumerate((x, y)):
            name = f"arc R{radius}, centre {'xy'[k]}"
            rows.append(Row(case, name, "m", estimated["center_m"][k], published, exact["center_m"][k], note=INWARD))
        rows.append(Row(case, f"arc R{radius}, R", "m", estimated["radius_m"], printed, exact["radius_m"], note=INWARD))
    for name, printed in VERTICES_1.items():
        estimated = _nearest(found["monte_carlo"]["critical_points_m"], printed)
        exact = _nearest(found["exact"]["vertices_m"], printed)
        for k in (0, 1):
            rows.append(Row(case, f"vertex {name}, {'xy'[k]}", "m", estimated[k], printed[k], exact[k]))
    return [*rows, *_measures(case, found, 39 * math.pi / 4)]


def _second(progress: Progress | None) -> list[Row]:
    found, case = _run(EXAMPLE_2, progress), "2: RR"
    rows = []
    for radius, printed in RADII_2.items():
        estimated, exact = (_nearest_arc(found[part], radius)["radius_m"] for part in ("monte_carlo", "exact"))
        rows.append(Row(case, f"circle R{radius}, R", "m", estimated, printed, exact, note=INWARD))
    return [*rows, *_measures(case, found, 160 * math.pi)]


def _third(progress: Progress | None) -> list[Row]:
    found, case = _run(example_3(30, 330), progress), "3: PR"
    rows = []
    for kind in ("line", "arc"):
        counts = [len(_segments(found[part], kind)) for part in ("monte_carlo", "exact")]
        printed = sum(printed == kind for printed, *_ in SEGMENTS_3)
        rows.append(Row(case, f"{kind}s", "1", counts[0], printed, counts[1], note=TANGENT))
    ends = [end for s in _segments(found["monte_carlo"]) for end in (s["start_m"], s["end_m"])]
    for number, (kind, *printed_ends) in enumerate(SEGMENTS_3, 1):
        note = "printed LINE; it is an arc of R2" if number in MISPRINTED else f"printed {kind.upper()}"
        for which, printed in zip(("start", "end"), printed_ends, strict=True):
            estimated, exact = (_near(points, printed) for points in (ends, found["exact"]["vertices_m"]))
            split = "" if exact else "; the point is no vertex but where a fit ended"
            for k in (0, 1):
                reproduced, known = (near[k] if exact and near else None for near in (estimated, exact))
                name = f"segment {number}, {which} {'xy'[k]}"
                rows.append(Row(case, name, "m", reproduced, printed[k], known, note=note + split))
    whole = _run(example_3(0, 360), progress)
    area = 24 + 8 * math.pi / 3 - 2 * math.sqrt(3)
    return [*rows, *_measures(case, found, area), *_measures("3: PR, whole turn", whole, 24 + 4 * math.pi, RANGE)]


def _measures(case: str, found: dict[str, Any], area: float, note: str = "") -> list[Row]:
    """Area from the samples and by the sweep, each beside the closed form."""
    return [
        Row(case, "area, Monte Carlo", "m²", found["monte_carlo"]["area_m2"], None, area, note=note or INWARD),
        Row(case, "area, exact sweep", "m²", found["exact"]["area_m2"], None, area, note=note),
    ]


def _nearest(points: list[list[float]], to: tuple[float, ...]) -> list[float]:
    """The point nearest to another."""
    return min(points, key=lambda point: math.dist(point, to))


def _near(points: list[list[float]], to: tuple[float, ...]) -> list[float] | None:
    """The point nearest to another, None where none is near."""
    nearest = _nearest(points, to)
    return nearest if math.dist(nearest, to) < VERTEX else None
