"""Tip positions alone: a sweep without indices, which takes no Jacobian."""

from collections.abc import Callable

import numpy as np

from wsrender.engine.devices import devices_of
from wsrender.engine.evaluation import Evaluation
from wsrender.engine.sweep_plan import SweepPlan, from_origin, sweep
from wsrender.pipeline.sampling import SamplingPlan, given_sampling
from wsrender.robots.kinematics import Kinematics


def sampled_positions(
    chain: Kinematics,
    sampling: SamplingPlan,
    precision: str = "float64",
    device: str = "cpu",
    *,
    first: int = 0,
    count: int | None = None,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> np.ndarray:
    """World positions (N, 3) float64 [m] of the tip at samples of a plan, in their order: all, or a range of them.

    ``precision`` is that of the kernel, relative to the robot's base; ``progress`` is called with the number of samples
    done.
    """
    count = sampling.count - first if count is None else count
    plan = SweepPlan(
        Evaluation(chain, (), ()),
        sampling,
        block=None,
        statistics=frozenset(),
        scales=np.zeros(0),
        bounds=np.zeros(0),
        precision=precision,
        keep_rows=True,
    )
    partial = sweep(plan, first, count, devices_of(device), threads=threads, progress=progress)
    found = np.empty((count, 3))
    for start, rows in partial.rows.items():
        found[start - first : start - first + rows.shape[1]] = rows.T
    return from_origin(plan, found.T)


def positions_at(
    chain: Kinematics, q: np.ndarray, precision: str = "float64", device: str = "cpu", *, threads: int | None = None
) -> np.ndarray:
    """World positions (N, 3) float64 [m] of the tip at configurations ``q`` (N, n) [rad or m]."""
    return sampled_positions(chain, given_sampling(chain, q), precision, device, threads=threads)
