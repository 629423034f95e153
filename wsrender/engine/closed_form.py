"""All postures of many poses in closed form, on CPU threads or a GPU."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import warp as wp
from wsrender_kernels.closed_form import (
    BRANCHES,
    FIELDS,
    LANES,
    MARGIN,
    POSTURE_ROWS,
    TARGET_ROWS,
    ClosedFormShape,
    closed_form_kernel,
)

from wsrender.engine.devices import devices_of, thread_count
from wsrender.engine.evaluation import REAL, device_array
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.robots.closed_form import ClosedForm
from wsrender.robots.closed_form.numbers import packed

CLOSED_MARGIN = MARGIN[wp.float64]  # slack below which nothing is decided in float64
BATCH, KEPT_BATCH = 1 << 18, 1 << 14  # poses of a launch: their postures take 832 bytes each
LEAST_SHARE = 1 << 10  # poses that are worth a thread


@dataclass(frozen=True, eq=False)
class ClosedPostures:
    """Of N poses: ``count`` (N,) int32 of postures within the limits, windings apart; ``slack`` (N,) float64.

    Above the ``margin`` a pose is reached, below minus it is not, else undecided; what float32 finds unreachable
    float64 must confirm. ``flags`` (N,) int32: bits of FAMILY (joints 4 and 6 share what only their sum tells) and
    DOUBTFUL (another singular posture). ``rows`` (N, 8, 13), where they are kept: cosines and sines of the solved
    joints, and the slack of each posture: below minus the margin it is none, but the nearest, or outside the limits.
    """

    count: np.ndarray
    slack: np.ndarray
    flags: np.ndarray
    margin: float
    rows: np.ndarray | None = None


def closed_postures(
    closed: ClosedForm,
    T: np.ndarray,
    *,
    keep: bool = False,
    unlimited: bool = False,
    precision: str = "float64",
    device: str = "auto",
    threads: int | None = None,
) -> ClosedPostures:
    """Postures of poses (N, 4, 4) in the world; ``unlimited``: as if hinges had no limits."""
    devices, real = devices_of(device), REAL[precision]
    workers = devices if devices[0].is_cuda else devices * thread_count(threads)
    size = KEPT_BATCH if keep else BATCH
    size = min(size, max(LEAST_SHARE, -(-len(T) // len(workers))))
    kernel = loaded(closed_form_kernel(shape_of(closed, precision, keep), devices[0].is_cuda), *devices)
    numbers = packed(closed.numbers(unlimited), FIELDS)
    batches = [slice(first, first + size) for first in range(0, max(len(T), 1), size)]

    def run(numbered: tuple[int, slice]) -> list[np.ndarray]:
        number, batch = numbered
        return _launch(kernel, numbers, closed.targets(T[batch]), keep, real, workers[number % len(workers)])

    with ThreadPoolExecutor(len(workers)) as pool:
        parts = [np.concatenate(part) for part in zip(*pool.map(run, enumerate(batches)), strict=True)]
    count, slack, flags = parts[:3]
    return ClosedPostures(count, slack.astype(np.float64), flags, MARGIN[real], parts[3] if keep else None)


def shape_of(closed: ClosedForm, precision: str, keep: bool) -> ClosedFormShape:
    """The compile-time part of the kernel of a closed form."""
    solved = closed.solved
    first, second, third, *_ = (axis.revolute for axis in solved.axes.axes)
    squares = (solved.equations[0].squares, solved.equations[1].squares) if solved.equations else (0, 0)
    return ClosedFormShape(REAL[precision], solved.arm, (first, second, third), solved.first, squares, keep)


def _launch(kernel, numbers, targets, keep, real, device) -> list[np.ndarray]:
    count = len(targets)
    whole = -(-count // LANES) * LANES
    rows = np.zeros((TARGET_ROWS, whole))
    rows[:, :count] = targets.T
    postures, flags = (wp.empty(whole, dtype=wp.int32, device=device) for _ in range(2))  # type: ignore[arg-type]
    slack = wp.empty(whole, dtype=real, device=device)
    kept = wp.full(BRANCHES * POSTURE_ROWS * whole if keep else 0, -4.0, dtype=real, device=device)
    if count:
        inputs = [whole, device_array(numbers, real, device), device_array(rows.ravel(), real, device)]
        dim = whole if device.is_cuda else whole // LANES
        launch(kernel, dim=dim, inputs=inputs, outputs=[postures, slack, flags, kept], device=device)
    found = [postures.numpy()[:count], slack.numpy()[:count], flags.numpy()[:count]]
    if keep:
        by_branch = kept.numpy().reshape(BRANCHES, POSTURE_ROWS, whole)[:, :, :count]
        found.append(by_branch.transpose(2, 0, 1).astype(np.float64))
    return found
