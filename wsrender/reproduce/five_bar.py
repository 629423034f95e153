"""The five-bar (6, 8, 5) of Chablat, Bennis: Realistic rendering of kinetostatic indices of mechanisms ([CB])."""

import math
from collections.abc import Iterator
from typing import Any

from wsrender.reproduce.row import Row
from wsrender.run import execute
from wsrender.run.steps import Progress

LENGTHS = (6.0, 8.0, 5.0)
POINT = (5.0, 7.0)
# |tan δ/2| or |cot δ/2|, whichever is larger, with δ of both legs' law of cosines at POINT, to ten digits.
EXACT_KAPPA_A = {"++": 1.777380134, "+-": 1.265642333, "-+": 10.668177061, "--": 3.921855162}
EXACT_KAPPA_B = 1.125001423
ROOT = "κ(A) = max(|tan δ/2|, |cot δ/2|): the paper prints a root of it, which is wrong"
NO_ROOT = "κ(B) = β_max/β_min, without a root; it is the same in all working modes"
SWAPPED = "A ṗ = B θ̇ with A of the distal links; the paper prints A and B swapped"


def five_bar(progress: Progress | None = None) -> list[Row]:
    """Workspace, condition numbers, forward kinematics, isotropic postures and aspects; the paper prints figures only.

    The published column holds nothing: the paper's numbers are in its figures 15 and 16, as curves.
    """
    base, proximal, distal = LENGTHS
    document = {
        "analysis": "five_bar",
        "base_m": base,
        "proximal_m": proximal,
        "distal_m": distal,
        "points_m": [list(POINT)],
        "joint_angles_rad": [[math.pi / 2, math.pi / 2]],
    }
    found = execute(document, progress).document
    return [*_workspaces(found), *_conditioning(found), *_assemblies(found), *_aspects(found)]


def _workspaces(found: dict[str, Any]) -> Iterator[Row]:
    """The intersection of two annuli of radii 3 and 13, whose holes touch."""
    exact = 338 * math.acos(3 / 13) - 24 * math.sqrt(10) - 18 * math.pi
    note = "338 acos(3/13) − 24√10 − 18π in every working mode"
    for entry in found["workspaces"]:
        yield Row(_case(entry), "workspace area", "m²", entry["area_m2"], exact=exact, note=note)


def _conditioning(found: dict[str, Any]) -> Iterator[Row]:
    for entry in found["points"]:
        exact = EXACT_KAPPA_A[entry["working_mode"]]
        yield Row(_case(entry), "κ(A) at (5, 7)", "1", entry["kappa_a"], exact=exact, note=ROOT)
    for entry in found["points"]:
        yield Row(_case(entry), "κ(B) at (5, 7)", "1", entry["kappa_b"], exact=EXACT_KAPPA_B, note=NO_ROOT)
    for entry in found["points"]:
        yield Row(_case(entry), "κ(J) at (5, 7)", "1", entry["kappa_j"], note=SWAPPED)


def _assemblies(found: dict[str, Any]) -> Iterator[Row]:
    """Both elbows straight up: P is 4 above or below them."""
    for entry, y in zip(found["assemblies"], (12.0, 4.0), strict=True):
        case = f"θ = (90°, 90°), assembly {entry['assembly_mode']}"
        for name, value, exact in zip("xy", entry["position_m"], (3.0, y), strict=True):
            yield Row(case, f"{name} of P", "m", value, exact=exact)
        yield Row(case, "κ(A)", "1", entry["kappa_a"], exact=4 / 3, note=ROOT)


def _aspects(found: dict[str, Any]) -> Iterator[Row]:
    """Areas with the bounds of their quadrature; by symmetry ++ and −− fall into halves of the workspace."""
    half = 169 * math.acos(3 / 13) - 12 * math.sqrt(10) - 9 * math.pi
    for entry in found["aspects"]:
        mode, area, error = entry["working_mode"], entry["area_m2"], entry["area_error_m2"]
        exact = half if mode in ("++", "--") else None
        quantity = f"aspect, assembly {entry['assembly_mode']}"
        yield Row(
            _case(entry), quantity, "m²", area, exact=exact, note=f"± {error:.1g} m² of quadrature along the loci"
        )
    for mode in ("++", "+-", "-+", "--"):
        count = sum(entry["working_mode"] == mode for entry in found["isotropic_points"])
        yield Row(f"working mode {mode}", "points with κ(J) = 1", "1", float(count))


def _case(entry: dict[str, Any]) -> str:
    return f"working mode {entry['working_mode']}"
