"""Positions of an end effector at the samples of a joint space."""

from collections.abc import Callable
from typing import Any

import numpy as np

from wsrender.engine import configurations
from wsrender.robot import Robot
from wsrender.sampling import plan_sampling

CHUNK = 1 << 17


def sampled_positions(
    robot: Robot,
    sampling: Any,
    device: str,
    *,
    max_samples: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> np.ndarray:
    """World positions (N, 3) float64 [m] at the N samples of a sampling of the job document, in their order.

    Raises InputError, ResourceError as `plan_sampling` does.
    """
    plan = plan_sampling(robot.chain, sampling, max_samples)
    positions = np.empty((plan.count, 3))
    for first in range(0, plan.count, CHUNK):
        rows = configurations(plan, np.arange(first, min(first + CHUNK, plan.count)))
        positions[first : first + len(rows)] = robot.forward_kinematics(rows, device=device)[:, :3, 3]
        if progress:
            progress(first + len(rows))
    return positions
