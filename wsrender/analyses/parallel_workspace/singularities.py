"""Singular poses of a ``parallel_workspace``, on each combination of the legs' branches by itself."""

from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.analyses.partial_result import PartialResult
from wsrender.mechanisms.jacobians import SINGULARITY_TYPES, zeros
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    from wsrender.analyses.parallel_workspace.run import ParallelWorkspaceAnalysis

SIGNS = "-+"


def singularities(
    plan: "ParallelWorkspaceAnalysis", partial: PartialResult, volume: VolumeData
) -> tuple[dict[str, Any], Table]:
    """How often the determinants change sign between neighbouring voxels, and where.

    Two postures of one place that stand on different branches are no change of sign: each branch is searched by itself,
    and what is found joined. A determinant that is 0 everywhere says so. The table names the branch of every leg, such
    as ``+-+``, where there are several.
    """
    branches = _branches(plan) if plan.mechanism.branched else [""]
    entry: dict[str, Any] = {}
    positions, kinds, signs = [np.zeros((0, 3))], [], []
    for kind, name in SINGULARITY_TYPES.items():
        values = _values(plan, partial, volume, name)
        found = [_changes(volume, column) for column in values.T]
        positions += found
        kinds += [np.full(len(points), kind) for points in found]
        signs += [np.full(len(points), text) for points, text in zip(found, branches, strict=True)]
        entry[f"type_{kind}"] = {
            "determinant": name,
            "sign_changes": sum(map(len, found)),
            "positive_voxels": int((values > 0).any(axis=1).sum()),
            "negative_voxels": int((values < 0).any(axis=1).sum()),
            "everywhere": bool((values[~np.isnan(values)] == 0).all()),
        }
    columns = {"position": np.concatenate(positions), "type": np.concatenate(kinds).astype(np.int64)}
    if plan.mechanism.branched:
        entry["branches"] = int((~np.isnan(partial["branch_determinant_A"])).any(axis=0).sum())
        columns["branch"] = np.concatenate(signs)
    return entry, Table(columns, {"position": "m"})


def _branches(plan: "ParallelWorkspaceAnalysis") -> list[str]:
    """The branch of every leg, in the order of the columns of determinants."""
    return ["".join(SIGNS[int(plus)] for plus in each.branches[:, 1]) for each in plan.mechanism.on_each_branch()]


def _values(plan: "ParallelWorkspaceAnalysis", partial: PartialResult, volume: VolumeData, name: str) -> np.ndarray:
    """A determinant of the volume's voxels on each combination of branches, (V, C); NaN where it does not reach."""
    if plan.mechanism.branched:
        return partial[f"branch_{name}"]
    return volume.voxels.statistics["center"][name][:, None]


def _changes(volume: VolumeData, column: np.ndarray) -> np.ndarray:
    """Points (N, 3) [m] of a determinant (V,) of voxels."""
    if np.isnan(column).all():
        return np.zeros((0, 3))
    return zeros(volume.voxels.dense(column), np.array(volume.first_voxel), volume.voxel_size_m)
