"""Rows of samples in their order: what is computed of each, or the tip's position alone."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from wsrender.engine.devices import devices_of
from wsrender.engine.partial import Partial
from wsrender.engine.sweep_plan import SweepPlan, sweep
from wsrender.pipeline.pipeline import Pipeline


@dataclass(frozen=True, eq=False)
class Evaluated:
    """Tip positions (N, 3) [m], index values (K, N); where kept, configurations (N, n) and tip orientations (N, 4).

    ``rejected`` (N,) int8: the number, from 1, of the first constraint that rejects a configuration, or 0; of no
    constraints None.
    """

    position: np.ndarray
    values: np.ndarray
    q: np.ndarray | None = None
    quat_wxyz: np.ndarray | None = None
    rejected: np.ndarray | None = None


def evaluate_samples(pipeline: Pipeline, device: str = "cpu", *, threads: int | None = None) -> Evaluated:
    """All samples of a pipeline that keeps rows, in order."""
    found = sweep(pipeline, 0, pipeline.sampling.count, devices_of(device), threads=threads)
    return evaluated_of(pipeline, found)


def evaluated_of(pipeline: Pipeline, partial: Partial) -> Evaluated:
    """The rows of a whole sweep of a pipeline that keeps them."""
    blocks = [partial.rows[first] for first in sorted(partial.rows)]
    rows = np.concatenate(blocks or [np.zeros((SweepPlan(pipeline).shape.n_rows, 0), pipeline.precision)], axis=1)
    own = 3 + len(pipeline.evaluation.indices)
    widths = {"configuration": pipeline.evaluation.chain.n, "orientation": 4}
    kept, at = dict[str, np.ndarray](), own
    for column in sorted(pipeline.kept_rows or ()):
        kept[column] = rows[at : at + widths[column]].T
        at += widths[column]
    rejected = rows[-1].astype(np.int8) if pipeline.constraints else None
    position = _from_origin(pipeline, rows)
    return Evaluated(position, rows[3:own], kept.get("configuration"), kept.get("orientation"), rejected)


def sampled_positions(
    pipeline: Pipeline,
    device: str = "cpu",
    *,
    first: int = 0,
    count: int | None = None,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> np.ndarray:
    """World positions (N, 3) float64 [m] of the tip at samples in their order: all, or a range; admitted or not.

    The pipeline's precision is that of the kernel, relative to the robot's base; ``progress`` is called with the number
    of samples done.
    """
    tip, count = pipeline.of_tip, pipeline.sampling.count - first if count is None else count
    partial = sweep(tip, first, count, devices_of(device), threads=threads, progress=progress)
    found = np.empty((count, 3))
    for start, rows in partial.rows.items():
        found[start - first : start - first + rows.shape[1]] = rows.T
    return _from_origin(tip, found.T)


def _from_origin(pipeline: Pipeline, rows: np.ndarray) -> np.ndarray:
    """Positions (N, 3) [m] in the world of rows of a sweep; of a robot far from the world's origin in float64."""
    positions = np.ascontiguousarray(rows[:3].T)
    return positions + pipeline.origin if pipeline.origin.any() else positions
