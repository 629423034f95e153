"""Which of many poses an arm of seven hinges reaches, by a search along one of them, on CPU threads or a GPU."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import cycle

import numpy as np
import warp as wp
from wsrender_kernels.free_joint import (
    FREE_FIELDS,
    POSES,
    REACHED,
    UNDECIDED,
    UNREACHABLE,
    FreeJointShape,
    free_joint_kernel,
)

from wsrender.engine.closed_form import BATCH, LEAST_SHARE
from wsrender.engine.devices import devices_of, thread_count
from wsrender.engine.evaluation import REAL, device_array
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.robots.closed_form import FreeJointForm
from wsrender.robots.closed_form.numbers import packed

# The most balls of a pose, and the narrowest [rad]: few poses take many, which are searched again, side by side.
SEARCHES = ((32, 0.05), (256, 5e-3), (2048, 2e-5))


@dataclass(frozen=True, eq=False)
class FreeJointSearch:
    """Of N poses: ``reached`` and ``unreachable`` (N,) bool, undecided where neither; ``balls`` (N,) looked at.

    Of unreachable ones it is proven that no pose within the tolerances is reached. ``at`` (N,) float64: where the free
    joint has the posture with the largest slack that was found [rad from the middle of its range].
    """

    reached: np.ndarray
    unreachable: np.ndarray
    at: np.ndarray
    balls: np.ndarray


def search_free_joint(
    form: FreeJointForm,
    T: np.ndarray,
    *,
    position_m: float = 0.0,
    angle_rad: float = 0.0,
    unlimited: bool = False,
    device: str = "auto",
    threads: int | None = None,
) -> FreeJointSearch:
    """Decide poses (N, 4, 4) in the world; ``unlimited``: as if hinges had no limits.

    What is within ``position_m`` and ``angle_rad`` of a pose that is reached is not unreachable.
    """
    devices = devices_of(device)
    workers = devices if devices[0].is_cuda else devices * thread_count(threads)
    kernel = loaded(free_joint_kernel(kernel_shape(form), devices[0].is_cuda), *devices)
    numbers = packed(form.numbers(position_m, angle_rad, unlimited), FREE_FIELDS)
    state, at, balls = np.full(len(T), UNDECIDED), np.zeros(len(T)), np.zeros(len(T), int)
    for search in SEARCHES:
        rest = np.flatnonzero(state == UNDECIDED)
        least = LEAST_SHARE * SEARCHES[0][0] // search[0]
        size = min(BATCH, max(least, -(-len(rest) // len(workers))))
        parts = [rest[first : first + size] for first in range(0, len(rest), size)]
        solve = partial(_launch, kernel, numbers, search)
        poses = (T if len(part) == len(T) else T[part] for part in parts)
        with ThreadPoolExecutor(len(workers)) as pool:
            for part, found in zip(parts, pool.map(solve, poses, cycle(workers)), strict=True):
                state[part], at[part] = found[:2]
                balls[part] += found[2]
    return FreeJointSearch(state == REACHED, state == UNREACHABLE, at, balls)


def kernel_shape(form: FreeJointForm) -> FreeJointShape:
    """The compile-time part of the kernel."""
    first, second = form.solved.equations
    return FreeJointShape(wp.float64, (first.squares, second.squares), form.solved.axes.reversed)


def _launch(kernel, numbers, search, T, device) -> list[np.ndarray]:
    count, real = len(T), REAL["float64"]
    state, balls = (wp.empty(count, dtype=wp.int32, device=device) for _ in range(2))  # type: ignore[arg-type]
    at = wp.empty(count, dtype=real, device=device)
    given = [device_array(values, real, device) for values in (numbers, T.ravel())]
    dim = count if device.is_cuda else -(-count // POSES)
    launch(kernel, dim=dim, inputs=[count, *search, *given], outputs=[state, at, balls], device=device)
    return [state.numpy(), at.numpy(), balls.numpy()]
