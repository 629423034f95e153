"""Voxels labelled by whether a robot reaches their centres."""

from collections.abc import Callable

import numpy as np

from wsrender.engine import sampled_positions
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.dimension import fills_volume, in_own_voxel
from wsrender.reach.evidence import LABELS, REACHABLE
from wsrender.reach.inverse_solver import InverseSolver
from wsrender.reach.reached_set import tolerance_m
from wsrender.reach.targets import INCONCLUSIVE, JOINT_LIMITS, OUT_OF_REACH, TOO_CLOSE, reasons_of
from wsrender.robots.kinematics import Kinematics
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels, inner_and_outer

REASONS = ("", JOINT_LIMITS, OUT_OF_REACH, TOO_CLOSE, INCONCLUSIVE)  # by the code in the volume
UNITS = {
    "label": ", ".join(f"{code} {name}" for code, name in LABELS.items()),
    "reason": ", ".join(f"{code} {name or 'none'}" for code, name in enumerate(REASONS)),
}


def label_voxels(
    chain: Kinematics,
    volume: VolumeData,
    *,
    seed: int = 0,
    device: str = "cpu",
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> VolumeData:
    """Labels of the occupied voxels of a workspace and their neighbours, decided at their centres.

    Where the positions fill no volume, as those of an arm that moves in a plane, a centre lies beside them: then a
    voxel is decided at the reachable point that is nearest to its centre, and one that holds a sample is reachable.

    ``statistics["center"]`` holds "label" (1 reachable, 0 unreachable, -1 undecided) and "reason" (the place in
    REASONS), float32, NaN in voxels farther off; the block has one more layer of voxels on every side.
    """
    _, outer = inner_and_outer(volume.occupied)
    cells = np.argwhere(outer)
    x, y, z = (first - 1 for first in volume.first_voxel)
    places = cells + np.array([x, y, z])
    points = (places + 0.5) * volume.voxel_size_m
    solver = InverseSolver(chain, position_m=tolerance_m(chain), seed=seed, device=device, threads=threads)
    found = solver.solve(points, progress=progress and (lambda done: progress(done, len(points))))
    reasons = reasons_of(solver, found, points)
    label = found.label
    if not fills_volume(chain, threads):
        nearest = sampled_positions(tip_pipeline(chain, found.q), threads=threads)
        held = in_own_voxel(nearest, places, volume.voxel_size_m) | (np.pad(volume.count, 1)[outer] > 0)
        label, reasons = np.where(held, REACHABLE, label), np.where(held, "", reasons)
    code = np.select([reasons == name for name in REASONS], list(range(len(REASONS))))
    arrays = {"label": label.astype(np.float32), "reason": code.astype(np.float32)}
    voxels = Voxels(outer.shape, np.flatnonzero(outer), np.pad(volume.count, 1)[outer], {"center": arrays})
    return VolumeData.of_voxels(volume.voxel_size_m, (x, y, z), voxels, dict(UNITS))


def counts(labelled: VolumeData) -> dict[str, dict[str, int]]:
    """Voxels by label, and by reason."""
    center = labelled.statistics["center"]
    return {
        "labels": {name: int((center["label"] == code).sum()) for code, name in LABELS.items()},
        "reasons": {name: int((center["reason"] == code).sum()) for code, name in enumerate(REASONS) if name},
    }
