"""Voxels labelled by whether a robot reaches their centres."""

import numpy as np

from wsrender.reachability.inverse_solver import LABELS, InverseSolver
from wsrender.reachability.refined_volume import POSITION_M
from wsrender.reachability.targets import INCONCLUSIVE, JOINT_LIMITS, OUT_OF_REACH, TOO_CLOSE, reasons_of
from wsrender.robots.chain import Chain
from wsrender.volume.neighbours import inner_and_outer
from wsrender.volume.volume_data import VolumeData

REASONS = ("", JOINT_LIMITS, OUT_OF_REACH, TOO_CLOSE, INCONCLUSIVE)  # by the code in the volume
UNITS = {
    "label": ", ".join(f"{code} {name}" for code, name in LABELS.items()),
    "reason": ", ".join(f"{code} {name or 'none'}" for code, name in enumerate(REASONS)),
}


def label_voxels(
    chain: Chain, volume: VolumeData, *, seed: int = 0, device: str = "cpu", threads: int | None = None
) -> VolumeData:
    """Labels of the occupied voxels of a workspace and their neighbours, decided at their centres.

    ``statistics["center"]`` holds "label" (1 reachable, 0 unreachable, -1 undecided) and "reason" (the place in
    REASONS), float32, NaN in voxels farther off; the block has one more layer of voxels on every side.
    """
    _, outer = inner_and_outer(volume.occupied)
    cells = np.argwhere(outer)
    x, y, z = (first - 1 for first in volume.first_voxel)
    points = (cells + (x, y, z) + 0.5) * volume.voxel_size_m
    solver = InverseSolver(chain, position_m=POSITION_M, seed=seed, device=device, threads=threads)
    found = solver.solve(points)
    reasons = reasons_of(solver, found, points)
    code = np.select([reasons == name for name in REASONS], list(range(len(REASONS))))
    arrays = {}
    for name, values in {"label": found.label, "reason": code}.items():
        arrays[name] = np.full(outer.shape, np.nan, np.float32)
        arrays[name][outer] = values
    return VolumeData(volume.voxel_size_m, (x, y, z), np.pad(volume.count, 1), {"center": arrays}, dict(UNITS))


def counts(labelled: VolumeData) -> dict[str, dict[str, int]]:
    """Voxels by label, and by reason."""
    center = labelled.statistics["center"]
    return {
        "labels": {name: int((center["label"] == code).sum()) for code, name in LABELS.items()},
        "reasons": {name: int((center["reason"] == code).sum()) for code, name in enumerate(REASONS) if name},
    }
