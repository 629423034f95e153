"""Which of many poses an open arm of six hinges reaches, and all its postures, on CPU threads or a GPU."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import cycle

import numpy as np
import warp as wp
from wsrender_kernels.closed_form import MARGIN, POSTURE_ROWS
from wsrender_kernels.open_wrist import (
    OPEN_FIELDS,
    POSES,
    REACHED,
    SET,
    UNDECIDED,
    UNREACHABLE,
    OpenWristShape,
    open_wrist_kernel,
)

from wsrender.engine.closed_form import BATCH, KEPT_BATCH, LEAST_SHARE, ClosedPostures
from wsrender.engine.devices import devices_of, thread_count
from wsrender.engine.evaluation import REAL, device_array
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.robots.closed_form import OpenWristForm
from wsrender.robots.closed_form.numbers import packed

# The most evaluations of a pose, and the narrowest ball [rad]: few poses take many, which are searched again.
SEARCHES = ((128, 1e-3), (4096, 2e-5))
SET_SEARCH = (20_000, 1e-7)


@dataclass(frozen=True, eq=False)
class OpenWristSearch:
    """Of N poses: ``reached`` and ``unreachable`` (N,) bool, undecided where neither; ``evaluations`` (N,) of the arm.

    Of unreachable ones it is proven that no pose within the tolerances is reached. ``rows`` (N, 14): the posture with
    the largest slack that was found, as in `ClosedPostures`; its slack is -4 where none was.
    """

    reached: np.ndarray
    unreachable: np.ndarray
    rows: np.ndarray
    evaluations: np.ndarray


def search_open_wrist(
    form: OpenWristForm,
    T: np.ndarray,
    *,
    position_m: float = 0.0,
    angle_rad: float = 0.0,
    unlimited: bool = False,
    device: str = "auto",
    threads: int | None = None,
) -> OpenWristSearch:
    """Decide poses (N, 4, 4) in the world; ``unlimited``: as if hinges had no limits.

    What is within ``position_m`` and ``angle_rad`` of a pose that is reached is not unreachable.
    """
    numbers = packed(form.numbers(position_m, angle_rad, unlimited), OPEN_FIELDS)
    state, evaluations = np.full(len(T), UNDECIDED), np.zeros(len(T), int)
    rows = np.full((len(T), POSTURE_ROWS), -4.0)
    for search in SEARCHES:
        rest = np.flatnonzero(state == UNDECIDED)
        least = LEAST_SHARE * SEARCHES[0][0] // search[0]
        for part, found in _searched(form, False, T, rest, numbers, search, BATCH, least, device, threads):
            state[part], rows[part] = found[0], found[3][:, 0]
            evaluations[part] += found[2]
    return OpenWristSearch(state == REACHED, state == UNREACHABLE, rows, evaluations)


def open_wrist_postures(
    form: OpenWristForm, T: np.ndarray, *, device: str = "auto", threads: int | None = None
) -> ClosedPostures:
    """Postures of poses (N, 4, 4) in the world within the limits, ``rows`` (N, 24, 14), of none with the slack -4.

    Doubtful are those where one may be missing: near singular ones, and of poses that took too many evaluations.
    ``count``: of postures, whole turns not apart.
    """
    numbers = packed(form.numbers(0.0, 0.0), OPEN_FIELDS)
    flags, rows = np.zeros(len(T), np.int32), np.full((len(T), SET, POSTURE_ROWS), -4.0)
    whole = np.arange(len(T))
    for part, found in _searched(form, True, T, whole, numbers, SET_SEARCH, KEPT_BATCH, POSES, device, threads):
        flags[part], rows[part] = found[0], found[3]
    slack, margin = rows[..., 12], MARGIN[wp.float64]
    return ClosedPostures((slack >= -margin).sum(axis=1).astype(np.int32), slack.max(axis=1), flags, margin, rows)


def kernel_shape(form: OpenWristForm, sets: bool) -> OpenWristShape:
    """The compile-time part of the kernel."""
    first, second = form.solved.equations
    return OpenWristShape(wp.float64, (first.squares, second.squares), form.solved.axes.reversed, sets)


def _searched(form, sets, T, rest, numbers, search, most, least, device, threads):
    """Parts of poses by number ``rest``, and the arrays that were found of each."""
    devices = devices_of(device)
    workers = devices if devices[0].is_cuda else devices * thread_count(threads)
    kernel = loaded(open_wrist_kernel(kernel_shape(form, sets), devices[0].is_cuda), *devices)
    size = min(most, max(least, -(-len(rest) // len(workers))))
    parts = [rest[first : first + size] for first in range(0, len(rest), size)]

    def solve(part: np.ndarray, worker: wp.Device) -> list[np.ndarray]:
        return _launch(kernel, numbers, search, T if len(part) == len(T) else T[part], SET if sets else 1, worker)

    with ThreadPoolExecutor(len(workers)) as pool:
        yield from zip(parts, pool.map(solve, parts, cycle(workers)), strict=True)


def _launch(kernel, numbers, search, T, postures, device) -> list[np.ndarray]:
    count, real = len(T), REAL["float64"]
    integers = [wp.empty(count, dtype=wp.int32, device=device) for _ in range(3)]  # type: ignore[arg-type]
    kept = wp.full(count * postures * POSTURE_ROWS, -4.0, dtype=real, device=device)
    given = [device_array(values, real, device) for values in (numbers, T.ravel(), np.eye(4).ravel())]
    dim = count if device.is_cuda else -(-count // POSES)
    launch(kernel, dim=dim, inputs=[count, *search, *given], outputs=[*integers, kept], device=device)
    return [*(array.numpy() for array in integers), kept.numpy().reshape(count, postures, POSTURE_ROWS)]
