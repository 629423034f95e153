"""Positions spread evenly over a mechanism's workspace at its level orientation."""

import numpy as np
from scipy.stats.qmc import Sobol

from wsrender.documents.mechanism import MechanismSpec
from wsrender.errors import InputError
from wsrender.mechanisms.hybrid import reachable_box_of, reached_by_any, variants

BATCH = 1 << 14
MOST_BATCHES = 512  # eight million positions tried


def workspace_points(
    spec: MechanismSpec, count: int, *, device: str = "auto", threads: int | None = None
) -> np.ndarray:
    """The first ``count`` points of a Sobol set that the platform reaches without being turned, (N, 3) [m], world.

    Fewer where eight million points of the box around the workspace hold fewer; InputError where they hold none.
    """
    found, level = variants(spec), np.eye(3)[None]
    box = reachable_box_of(found, level)
    points, sobol = np.zeros((0, 3)), Sobol(3, scramble=False)
    for _ in range(MOST_BATCHES):
        if box is None or len(points) >= count:
            break
        tried = box.lower + sobol.random(BATCH) * (box.upper - box.lower)
        reached = reached_by_any(found, tried, level, device=device, threads=threads)
        points = np.concatenate([points, tried[reached]])
    if not len(points):
        raise InputError("mechanism", "reaches no position without being turned")
    return points[:count]
