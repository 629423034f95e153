"""Volume data from a partial result."""

import numpy as np
from wsrender_kernels.voxels import decode_extreme

from wsrender.engine.partial import Partial, added, union
from wsrender.engine.sums import scales_of
from wsrender.pipeline.pipeline import Pipeline
from wsrender.volume.lattice import LatticeBlock
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels


def volume_data(pipeline: Pipeline, partial: Partial, units: dict[str, str]) -> VolumeData:
    """The occupied part of the lattice block, cropped, with the chosen statistics as floats."""
    assert pipeline.block is not None
    return _cropped(pipeline.block, voxels_of(pipeline, partial), units)


def voxels_of(pipeline: Pipeline, partial: Partial) -> Voxels:
    """The occupied voxels of the lattice block, with the chosen statistics as floats."""
    assert pipeline.block is not None
    names, K = pipeline.evaluation.indices, len(pipeline.evaluation.indices)
    statistics: dict[str, dict[str, np.ndarray]] = {}
    column = 0
    for statistic in ("maximum", "minimum"):
        if statistic in pipeline.statistics:
            records = partial.records[:, column : column + K]
            statistics[statistic] = {
                name: decode_extreme(records[:, k], minimum=statistic == "minimum") for k, name in enumerate(names)
            }
            column += K
    if "mean" in pipeline.statistics:
        samples, scales = np.maximum(partial.count, 1), scales_of(pipeline)
        statistics["mean"] = {name: partial.sums[:, k] / scales[k] / samples for k, name in enumerate(names)}
    best = {} if pipeline.best is None else {pipeline.best: partial.best.astype(np.uint64)}
    return Voxels(pipeline.block.shape, partial.cells, partial.count, statistics, best=best)


def admission_data(pipeline: Pipeline, partial: Partial) -> VolumeData:
    """What constraints leave of each voxel that a sample was drawn in, admitted or not; ``count``: those drawn.

    ``statistics["samples"]`` holds those "admitted", and by reason those rejected; ``statistics["share"]`` of
    "admitted_samples" among those drawn.
    """
    assert pipeline.block is not None
    cells, admitted_at, blocked_at = union(partial.cells, partial.blocked_cells)
    admitted = added(len(cells), (admitted_at, partial.count))
    rejected = added(len(cells), (blocked_at, partial.blocked))
    drawn = admitted + rejected.sum(axis=1)
    names = [each.name for each in pipeline.constraints]
    statistics = {
        "share": {"admitted_samples": admitted / drawn},
        "samples": dict(zip(("admitted", *names), np.vstack([admitted, rejected.T]).astype(np.float64), strict=True)),
    }
    units = {"admitted_samples": "1"} | dict.fromkeys(statistics["samples"], "samples")
    return _cropped(pipeline.block, Voxels(pipeline.block.shape, cells, drawn, statistics), units)


def _cropped(block: LatticeBlock, voxels: Voxels, units: dict[str, str]) -> VolumeData:
    """The volume of a block's voxels, of the part of it that holds them."""
    at = voxels.at
    low = at.min(axis=1) if at.shape[1] else np.zeros(3, np.int64)
    nx, ny, nz = (int(size) for size in (at.max(axis=1) - low + 1)) if at.shape[1] else (0, 0, 0)
    x, y, z = (int(start) for start in block.first_voxel + low)
    return VolumeData.of_voxels(block.voxel_size_m, (x, y, z), voxels.moved((nx, ny, nz), -low), units)
