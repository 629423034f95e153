"""Volume data from a partial result."""

from math import prod

import numpy as np
from wsrender_kernels.voxels import decode_extreme

from wsrender.engine.memory import SHARE, available_bytes
from wsrender.engine.partial import Partial
from wsrender.engine.sweep import SweepPlan
from wsrender.errors import ResourceError
from wsrender.volume.volume_data import VolumeData


def volume_data(plan: SweepPlan, partial: Partial, units: dict[str, str]) -> VolumeData:
    """The occupied part of the lattice block, cropped, with the chosen statistics as floats.

    Raises ResourceError, with the numbers, where its arrays do not fit in memory.
    """
    assert plan.block is not None
    names, K = plan.evaluation.indices, len(plan.evaluation.indices)
    at = np.stack(np.unravel_index(partial.cells, plan.block.shape))
    low = at.min(axis=1) if at.shape[1] else np.zeros(3, np.int64)
    shape = tuple(int(s) for s in (at.max(axis=1) - low + 1)) if at.shape[1] else (0, 0, 0)
    place = tuple(at - low[:, None])
    _check_memory(plan, shape)

    def dense(values: np.ndarray, empty, dtype) -> np.ndarray:
        block = np.full(shape, empty, dtype)
        block[place] = values
        return block

    statistics: dict[str, dict[str, np.ndarray]] = {}
    column = 0
    for statistic in ("maximum", "minimum"):
        if statistic in plan.statistics:
            values = decode_extreme(partial.records[:, column : column + K], minimum=statistic == "minimum")
            statistics[statistic] = {n: dense(values[:, k], np.nan, values.dtype) for k, n in enumerate(names)}
            column += K
    if "mean" in plan.statistics:
        means = partial.sums / plan.scales / np.maximum(partial.count, 1)[:, None]
        statistics["mean"] = {n: dense(means[:, k], np.nan, np.float64) for k, n in enumerate(names)}
    first = tuple(int(f + o) for f, o in zip(plan.block.first_voxel, low, strict=True))
    return VolumeData(
        plan.block.voxel_size_m,
        first,  # type: ignore[arg-type]
        dense(partial.count, 0, np.int64),
        statistics,
        units,
    )


def _check_memory(plan: SweepPlan, shape: tuple[int, ...]) -> None:
    width, K = (4 if plan.precision == "float32" else 8), len(plan.evaluation.indices)
    extremes = len(plan.statistics & {"maximum", "minimum"})
    needed = prod(shape) * (8 + K * (width * extremes + 8 * ("mean" in plan.statistics)))
    free = available_bytes()
    if needed > SHARE * free:
        voxels = " x ".join(map(str, shape))
        raise ResourceError(
            "voxel_size_m",
            f"the {voxels} voxels of the workspace need {needed / 2**30:.1f} GiB for their values; {free / 2**30:.1f} "
            "GiB are free: choose larger voxels or fewer statistics or indices",
        )
