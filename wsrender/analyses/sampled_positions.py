"""Positions of an end effector at the samples of a joint space."""

from collections.abc import Callable
from typing import Any

import numpy as np

from wsrender import engine
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot import Robot


def sampled_positions(
    robot: Robot,
    sampling: Any,
    device: str,
    *,
    max_samples: int | None = None,
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> np.ndarray:
    """World positions (N, 3) float64 [m] at the N samples of a sampling of the job document, in their order.

    Raises InputError, ResourceError as `plan_sampling` does.
    """
    plan = plan_sampling(robot.chain, sampling, max_samples)
    return engine.sampled_positions(robot.chain, plan, device=device, threads=threads, progress=progress)
