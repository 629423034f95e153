"""Voxels labelled by whether a robot reaches their centres, under constraints in configurations that they admit."""

from collections.abc import Callable, Sequence

import numpy as np

from wsrender.engine import sampled_positions
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.constraints.region import RegionConstraint
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.admissible_search import BLOCKED, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.dimension import fills_volume, in_own_voxel
from wsrender.reach.evidence import LABELS, REACHABLE
from wsrender.reach.inverse_solver import InverseSolver
from wsrender.reach.reached_set import tolerance_m
from wsrender.reach.targets import (
    INCONCLUSIVE,
    JOINT_LIMITS,
    NAMES,
    OUT_OF_REACH,
    TOO_CLOSE,
    admissible_reasons,
    reasons_of,
)
from wsrender.robots.kinematics import Kinematics
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels, inner_and_outer

REASONS = ("", JOINT_LIMITS, OUT_OF_REACH, TOO_CLOSE, INCONCLUSIVE)  # by the code in the volume; constraints follow


def label_voxels(
    chain: Kinematics,
    volume: VolumeData,
    constraints: Sequence[Constraint] = (),
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

    Under ``constraints`` the volume is that of all samples, admitted or not: a voxel is reachable where an admitted
    configuration is found; where others are found alone its label is 2, blocked, and its reason the constraint, whose
    place is after REASONS.
    """
    _, outer = inner_and_outer(volume.occupied)
    cells = np.argwhere(outer)
    x, y, z = (first - 1 for first in volume.first_voxel)
    places = cells + np.array([x, y, z])
    points = (places + 0.5) * volume.voxel_size_m
    solver = InverseSolver(chain, position_m=tolerance_m(chain), seed=seed, device=device, threads=threads)
    tell = progress and (lambda done: progress(done, len(points)))
    admission = Admission(chain, constraints, device, threads)
    names, solid = (*REASONS, *admission.names), fills_volume(chain, threads)
    if solid:
        label, reasons = _decided(admission, solver, points, tell)
    else:
        found = solver.solve(points, progress=tell)
        nearest = sampled_positions(tip_pipeline(chain, found.q), threads=threads)
        held = in_own_voxel(nearest, places, volume.voxel_size_m) | (np.pad(volume.count, 1)[outer] > 0)
        label = np.where(held, REACHABLE, found.label)
        reasons = np.where(held, "", reasons_of(solver, found, points)).astype(object)
        if constraints:
            label[held], reasons[held] = _decided(admission, solver, nearest[held], None)
    code = np.select([reasons == name for name in names], list(range(len(names))))
    arrays = {"label": label.astype(np.float32), "reason": code.astype(np.float32)}
    voxels = Voxels(outer.shape, np.flatnonzero(outer), np.pad(volume.count, 1)[outer], {"center": arrays})
    units = {
        "label": ", ".join(f"{code} {name}" for code, name in _labels(constraints).items()),
        "reason": ", ".join(f"{code} {name or 'none'}" for code, name in enumerate(names)),
    }
    return VolumeData.of_voxels(volume.voxel_size_m, (x, y, z), voxels, units)


def _decided(
    admission: Admission, solver: InverseSolver, points: np.ndarray, progress: Callable[[int], None] | None
) -> tuple[np.ndarray, np.ndarray]:
    """Labels (N,) int8 and reasons (N,) of points (N, 3), under constraints if there are any.

    Outside a region, where no configuration is admitted, inverse kinematics tells which of them are reached at all.
    """
    if not admission.constraints:
        found = solver.solve(points, progress=progress)
        return found.label, reasons_of(solver, found, points)
    label, reasons = np.zeros(len(points), np.int8), np.full(len(points), "", object)
    outside = np.zeros(len(points), bool)
    for region in (each for each in admission.constraints if isinstance(each, RegionConstraint)):
        outside = region.distance(points) > solver.accuracy.position_m
        found = solver.solve(points[outside])
        reached = found.label == REACHABLE
        label[outside] = np.where(reached, BLOCKED, found.label)
        reasons[outside] = np.where(reached, region.name, reasons_of(solver, found, points[outside]))
    search = AdmissibleSearch(solver, admission)
    found = search.decide(points[~outside], progress=progress)
    label[~outside], reasons[~outside] = found.label, admissible_reasons(search, found, points[~outside])
    return label, reasons


def _labels(constraints: Sequence[object]) -> dict[int, str]:
    return NAMES if constraints else LABELS


def counts(labelled: VolumeData, constraints: Sequence[Constraint] = ()) -> dict[str, dict[str, int]]:
    """Voxels by label, and by reason."""
    center, names = labelled.statistics["center"], (*REASONS, *(each.name for each in constraints))
    return {
        "labels": {name: int((center["label"] == code).sum()) for code, name in _labels(constraints).items()},
        "reasons": {name: int((center["reason"] == code).sum()) for code, name in enumerate(names) if name},
    }
