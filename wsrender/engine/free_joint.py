"""Which of many poses an arm of seven joints reaches, by a search along one of them, on CPU threads or a GPU."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from itertools import cycle

import numpy as np
import warp as wp
from wsrender_kernels.free_joint import (
    FREE_FIELDS,
    REACHED,
    UNDECIDED,
    UNREACHABLE,
    FreeJointShape,
    free_joint_kernel,
)

from wsrender.engine.closed_form import LEAST_SHARE
from wsrender.engine.devices import devices_of, thread_count
from wsrender.engine.evaluation import REAL, device_array, given_array
from wsrender.engine.free_joint_levels import LevelSearch
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.robots.closed_form import FreeJointForm
from wsrender.robots.closed_form.numbers import packed

# The most balls of a pose, how many more once one of them is left undecided, as the pose is then, unless it is reached,
# and the narrowest [rad]. What that leaves is searched again, coarsely, side by side: it may be reached far from there.
SEARCHES = ((2048, 32, 2e-5), (256, 256, 5e-3))
FIRST_ON_CUDA = (16, 16, 2e-5)  # most poses take no more, and would wait for those beside them that do
WORTH_THREAD = (LEAST_SHARE, LEAST_SHARE // 16)  # poses of the first search, and of the others
TOGETHER, PART = 1 << 22, 1 << 13  # poses whose states a device holds, and that a thread takes at a time


@dataclass(frozen=True, eq=False)
class FreeJointSearch:
    """Of N poses: ``reached`` and ``unreachable`` (N,) bool, undecided where neither; ``balls`` (N,) looked at.

    Of unreachable ones it is proven that no pose within the tolerances is reached. ``at`` (N,) float64: where the free
    joint has the posture with the largest slack that was found [rad from the middle of its range].
    """

    reached: np.ndarray
    unreachable: np.ndarray
    at: np.ndarray | None
    balls: np.ndarray | None


def search_free_joint(
    form: FreeJointForm,
    T: np.ndarray,
    *,
    T_tip: np.ndarray | None = None,
    quat_wxyz: np.ndarray | None = None,
    position_m: float = 0.0,
    angle_rad: float = 0.0,
    unlimited: bool = False,
    places: bool = True,
    device: str = "auto",
    threads: int | None = None,
) -> FreeJointSearch:
    """Decide poses (N, 4, 4) in the world; ``unlimited``: as if hinges had no limits.

    Where no ``places`` of the free joint are asked for, a GPU decides level by level, which is faster.

    With ``T_tip`` (K, 4, 4) the poses are all products T @ T_tip, (N * K,), those of the first of T first, which are
    made on the device. With ``quat_wxyz`` (N, 4), of any length but 0, T are positions (N, 3) [m], and poses are
    composed where they are searched. What is within ``position_m`` and ``angle_rad`` of a pose that is reached is
    not unreachable.
    """
    devices = devices_of(device)
    shape = replace(kernel_shape(form), quaternions=quat_wxyz is not None)
    numbers = form.numbers(position_m, angle_rad, unlimited)
    tips = np.eye(4)[None] if T_tip is None else T_tip
    size = max(1, min(TOGETHER // max(len(tips), 1), -(-len(T) // len(devices))))
    shares = [slice(first, first + size) for first in range(0, max(len(T), 1), size)]
    counts = [len(T[share]) * (1 if shape.quaternions else len(tips)) for share in shares]
    given = [(T[share], tips if quat_wxyz is None else quat_wxyz[share]) for share in shares]
    if not places and worth_levels(devices[0]):
        solve = partial(_by_levels, shape, numbers)
    else:
        kernel = loaded(free_joint_kernel(shape, devices[0].is_cuda), *devices)
        solve = partial(_by_lanes, kernel, packed(numbers, FREE_FIELDS), threads)
    with ThreadPoolExecutor(len(devices)) as pool:
        found = zip(*pool.map(solve, counts, given, cycle(devices)), strict=False)
        state, *where = (np.concatenate(part) for part in found)
    at, balls = where or (None, None)
    return FreeJointSearch(state == REACHED, state == UNREACHABLE, at, balls)


def kernel_shape(form: FreeJointForm) -> FreeJointShape:
    """The compile-time part of the kernel."""
    first, second = form.solved.equations
    squares = first.squares, second.squares
    return FreeJointShape(wp.float64, squares, form.solved.axes.reversed, slide=not form.free.revolute)


def searches_on(device: wp.Device) -> tuple[tuple[int, int, float], ...]:
    """SEARCHES, one after the other of what those before leave, and what comes before them; labels are the same."""
    return (FIRST_ON_CUDA, *SEARCHES) if device.is_cuda else SEARCHES


def worth_levels(device: wp.Device) -> bool:
    """Whether a device decides faster level by level: where threads side by side wait for each other."""
    return device.is_cuda


def _by_levels(
    shape: FreeJointShape,
    numbers: dict[str, float],
    count: int,
    poses: tuple[np.ndarray, np.ndarray],
    device: wp.Device,
) -> list[np.ndarray]:
    """States of ``count`` poses, as the kernel takes them in two parts."""
    given = [given_array(values, wp.float64, device) for values in poses]
    return [LevelSearch(shape, numbers, device).states(count, *given).numpy()]


def _by_lanes(
    kernel: wp.Kernel,
    numbers: np.ndarray,
    threads: int | None,
    count: int,
    poses: tuple[np.ndarray, np.ndarray],
    device: wp.Device,
) -> list[np.ndarray]:
    """States, places of the free joint and numbers of balls of ``count`` poses, as the kernel takes them in two parts.

    Threads of the CPU take part after part, of which the lanes of one task take pose after pose.
    """
    real = REAL["float64"]
    state, balls = (wp.zeros(count, dtype=wp.int32, device=device) for _ in range(2))  # type: ignore[arg-type]
    at = wp.zeros(count, dtype=real, device=device)
    given = [given_array(values, real, device) for values in (numbers, *poses)]
    workers = 1 if device.is_cuda else thread_count(threads)

    def run(search: tuple[int, int, float], which: np.ndarray) -> None:
        each = 1 if device.is_cuda else len(which)
        inputs = [len(which), each, *search, *given, device_array(which, wp.int32, device)]
        launch(kernel, dim=len(which) // each, inputs=inputs, outputs=[state, at, balls], device=device)

    rest = np.arange(count, dtype=np.int32)
    with ThreadPoolExecutor(workers) as pool:
        for k, search in enumerate(searches_on(device)):
            least = WORTH_THREAD[min(k, 1)]
            size = max(1, len(rest)) if workers == 1 else max(least, min(PART, -(-len(rest) // workers)))
            list(pool.map(partial(run, search), [rest[k : k + size] for k in range(0, len(rest), size)]))
            rest = np.flatnonzero(state.numpy() == UNDECIDED).astype(np.int32)
    return [state.numpy(), at.numpy(), balls.numpy()]
