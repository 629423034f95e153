"""All postures of many poses in closed form, on CPU threads or a GPU."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp
from wsrender_kernels.closed_form import (
    BRANCHES,
    FIELDS,
    LANES,
    MARGIN,
    POSTURE_ROWS,
    TARGET_ROWS,
    WORLD_FIELDS,
    ClosedFormShape,
    bits_by_base_kernel,
    closed_bits_kernel,
    closed_form_kernel,
    closed_labels_kernel,
)

from wsrender.engine.devices import devices_of, thread_count
from wsrender.engine.evaluation import REAL, device_array, given_array
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.robots.closed_form import ClosedForm
from wsrender.robots.closed_form.numbers import packed

CLOSED_MARGIN = MARGIN[wp.float64]  # slack below which nothing is decided in float64
BATCH, KEPT_BATCH = 1 << 18, 1 << 14  # poses of a launch: their postures take 896 bytes each
PLACED_BATCH = 1 << 22  # bases of a launch on a GPU, of which bits come back
LARGEST_NUMBER = 1 << 30  # of a base in its batch, in kernels
LEAST_SHARE = 1 << 10  # poses that are worth a thread


@dataclass(frozen=True, eq=False)
class ClosedPostures:
    """Of N poses: ``count`` (N,) int32 of postures within the limits, windings apart; ``slack`` (N,) float64.

    Above the ``margin`` a pose is reached, below minus it is not, else undecided; what float32 finds unreachable
    float64 must confirm. ``flags`` (N,) int32: bits of FAMILY (joints 4 and 6 share what only their sum tells) and
    DOUBTFUL (another singular posture). ``rows`` (N, 8, 14), where they are kept: cosines and sines of the solved
    joints; the slack of each posture without its levers: below minus the margin it is none, but the nearest, or outside
    the limits; and how sure that is: the lever of a posture, else the slack with levers, both about 0 where little
    motions of the pose change much.
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
        return _Launcher(kernel, closed.targets(T[batch]), keep, real, workers[number % len(workers)]).solve(numbers)

    with ThreadPoolExecutor(len(workers)) as pool:
        parts = [np.concatenate(part) for part in zip(*pool.map(run, enumerate(batches)), strict=True)]
    count, slack, flags = parts[:3]
    return ClosedPostures(count, slack.astype(np.float64), flags, MARGIN[real], parts[3] if keep else None)


def closed_labels(
    closed: ClosedForm,
    position: np.ndarray,
    quat_wxyz: np.ndarray | None = None,
    *,
    margin: float,
    device: str = "auto",
    threads: int | None = None,
) -> np.ndarray:
    """Labels (N,) int8 of positions (N, 3) [m], or poses with quaternions (N, 4) of any length but 0, in the world.

    REACHABLE where the slack is above that of rounding, UNREACHABLE where it is below minus the ``margin``, else
    UNDECIDED. Poses are composed where they are solved for.
    """
    devices, real = devices_of(device), REAL["float64"]
    workers = devices if devices[0].is_cuda else devices * thread_count(threads)
    shape, backwards = shape_of(closed, "float64", False), closed.solved.axes.reversed
    kernel = loaded(closed_labels_kernel(shape, backwards, quat_wxyz is not None, devices[0].is_cuda), *devices)
    numbers, found = packed(closed.numbers_in_world(), WORLD_FIELDS), np.empty(len(position), np.int8)
    size = min(BATCH, max(LEAST_SHARE, -(-len(position) // len(workers))))
    given = [position, np.empty((0, 4)) if quat_wxyz is None else quat_wxyz]

    def run(numbered: tuple[int, int]) -> None:
        number, first = numbered
        rows, device = [part[first : first + size] for part in given], workers[number % len(workers)]
        count, whole = len(rows[0]), max(len(rows[0]), LANES)
        if count < whole:  # a task of the CPU takes as many
            rows = [np.resize(part, (whole, part.shape[1])) for part in rows]
        rows = [given_array(part, real, device) for part in (numbers, *rows)]
        labels = wp.empty(whole, dtype=wp.int8, device=device)  # type: ignore[arg-type]
        dim = whole if device.is_cuda else -(-whole // LANES)
        launch(kernel, dim=dim, inputs=[whole, -margin, *rows], outputs=[labels], device=device)
        found[first : first + count] = labels.numpy()[:count]

    with ThreadPoolExecutor(len(workers)) as pool:
        list(pool.map(run, enumerate(range(0, len(position), size))))
    return found


def placed_slacks(
    closed: ClosedForm,
    T_world_base: np.ndarray,
    T_world_tip: np.ndarray,
    *,
    device: str = "auto",
    threads: int | None = None,
) -> np.ndarray:
    """Slacks (K, P) of poses (K, 4, 4) from bases (P, 4, 4), both in the world, as in `ClosedPostures` of float64.

    Poses of moved bases are made on the device: a launch solves for one pose from many bases, which go there once.
    """
    devices = devices_of(device)
    workers = devices if devices[0].is_cuda else devices * thread_count(threads)
    size = min(BATCH, max(LEAST_SHARE, -(-len(T_world_base) // len(workers))))
    kernel = loaded(closed_form_kernel(shape_of(closed, "float64", False), devices[0].is_cuda), *devices)
    numbers = [packed(closed.numbers_to(T), FIELDS) for T in T_world_tip]
    found = np.empty((len(T_world_tip), len(T_world_base)))

    def run(numbered: tuple[int, slice]) -> None:
        number, batch = numbered
        device = workers[number % len(workers)]
        solver = _Launcher(kernel, closed.bases(T_world_base[batch]), False, wp.float64, device)
        for k, each in enumerate(numbers):
            found[k, batch] = solver.solve(each)[1]

    batches = [slice(first, first + size) for first in range(0, len(T_world_base), size)]
    with ThreadPoolExecutor(len(workers)) as pool:
        list(pool.map(run, enumerate(batches)))
    return found


def placed_bits(
    closed: ClosedForm,
    motions: np.ndarray,
    positions: np.ndarray,
    numbers: range,
    T_world_tip: np.ndarray,
    targets: np.ndarray,
    *,
    origin: np.ndarray,
    margin: float,
    device: str = "auto",
    threads: int | None = None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Which bases reach poses (K, 4, 4), and which are proven not to, as bits: (N, B) uint8 each, of N ``numbers``.

    And those (M,), by their place among the N, of which some pose is neither.

    A base of number i stands at ``motions`` (A, 4, 4) number i modulo A, moved by ``positions`` (S, 3) [m] number
    i // A. Poses are seen from the ``origin`` (3,) [m] of the world of those. Pose k sets bit ``targets[k]`` modulo 8
    of byte ``targets[k]`` // 8, of as many bytes as the largest needs: reached where the slack is above that of
    rounding, missed where it is below minus the ``margin``.

    Bases are made on the device, where a table of the rotations and one of the positions go; bits come back.
    """
    devices, real = devices_of(device), REAL["float64"]
    workers = devices if devices[0].is_cuda else devices * thread_count(threads)
    backwards = not closed.solved.axes.reversed
    kernel = loaded(closed_bits_kernel(shape_of(closed, "float64", False), backwards, devices[0].is_cuda), *devices)
    A, rows = len(motions), np.concatenate([motions[:, :3, :3].reshape(-1, 9), motions[:, :3, 3]], axis=1)
    world = {f"origin{k}": x for k, x in enumerate(origin)} | {"scale": 1 / closed.solved.axes.reach}
    arms = np.stack([packed(closed.numbers_to(T) | world, WORLD_FIELDS) for T in T_world_tip])
    by_base = loaded(bits_by_base_kernel(devices[0].is_cuda), *devices)
    asked = np.zeros(int(targets.max()) // 8 + 1, np.uint8)
    np.bitwise_or.at(asked, targets // 8, np.left_shift(1, targets % 8).astype(np.uint8))
    found = np.empty((2, len(numbers), B := len(asked)), np.uint8)
    size = min(max(LEAST_SHARE, -(-len(numbers) // len(workers))), PLACED_BATCH if devices[0].is_cuda else BATCH)
    size = min(size, max(LANES, LARGEST_NUMBER // numbers.step))

    def run(numbered: tuple[int, int]) -> np.ndarray:
        number, begin = numbered
        of, device = numbers[begin : begin + size], workers[number % len(workers)]
        whole = max(len(of), LANES)  # a task of the CPU takes as many
        start, first = divmod(of.start, A)
        places = np.arange(start, start + (first + (whole - 1) * of.step) // A + 1)
        tables = [np.ravel(arms), rows, positions[np.minimum(places, len(positions) - 1)]]
        given, *rest = (given_array(part, real, device) for part in tables)
        bits = wp.zeros(2 * B * whole, dtype=wp.uint8, device=device)
        dim, F = whole if device.is_cuda else -(-whole // LANES), len(WORLD_FIELDS)
        for k, target in enumerate(targets.tolist()):
            reached, missed = (bits[at * whole : (at + 1) * whole] for at in (target // 8, target // 8 + B))
            inputs = [whole, first, of.step, A, 1 << target % 8, -margin, given[k * F : (k + 1) * F], *rest]
            launch(kernel, dim=dim, inputs=inputs, outputs=[reached, missed], device=device)
        kept = [given_array(part[begin : begin + len(of)], wp.uint8, host) for part in found]
        outputs = [wp.empty_like(part, device=device) for part in kept] if device.is_cuda else kept
        left, lefts = (wp.zeros(count, dtype=wp.int32, device=device) for count in (len(of), 1))
        inputs = [B, whole, given_array(asked, wp.uint8, device), bits]
        launch(by_base, dim=len(of), inputs=inputs, outputs=[*outputs, left, lefts], device=device)
        if device.is_cuda:
            for part, output in zip(kept, outputs, strict=True):
                wp.copy(part, output)
        count = int(lefts.numpy()[0])  # waits for all of it
        return begin + np.sort(left[:count].numpy() if count else np.zeros(0, np.int32))

    host = wp.get_device("cpu")
    with ThreadPoolExecutor(len(workers)) as pool:
        left = list(pool.map(run, enumerate(range(0, len(numbers), size))))
    return found[0], found[1], np.concatenate(left)


def shape_of(closed: ClosedForm, precision: str, keep: bool) -> ClosedFormShape:
    """The compile-time part of the kernel of a closed form."""
    solved = closed.solved
    first, second, third, *_ = (axis.revolute for axis in solved.axes.axes)
    squares = (solved.equations[0].squares, solved.equations[1].squares) if solved.equations else (0, 0)
    return ClosedFormShape(REAL[precision], solved.arm, (first, second, third), solved.first, squares, keep)


class _Launcher:
    """Solves for rows (N, 12) on a device, with the numbers of an arm; the rows are moved there once."""

    def __init__(self, kernel: wp.Kernel, targets: np.ndarray, keep: bool, real: Any, device: wp.Device):
        self.kernel, self.count, self.keep, self.real, self.device = kernel, len(targets), keep, real, device
        self.whole = whole = -(-self.count // LANES) * LANES
        rows = np.zeros((TARGET_ROWS, whole))
        rows[:, : self.count] = targets.T
        self.rows = device_array(rows.ravel(), real, device)
        integers = (wp.empty(whole, dtype=wp.int32, device=device) for _ in range(2))  # type: ignore[arg-type]
        self.postures, self.flags = integers
        self.slack = wp.empty(whole, dtype=real, device=device)
        self.kept = wp.full(BRANCHES * POSTURE_ROWS * whole if keep else 0, -4.0, dtype=real, device=device)

    def solve(self, numbers: np.ndarray) -> list[np.ndarray]:
        """Counts, slacks, flags (N,), and the rows (N, 8, 14) where they are kept; valid until it solves again."""
        if self.count:
            inputs = [self.whole, device_array(numbers, self.real, self.device), self.rows]
            dim = self.whole if self.device.is_cuda else self.whole // LANES
            outputs = [self.postures, self.slack, self.flags, self.kept]
            launch(self.kernel, dim=dim, inputs=inputs, outputs=outputs, device=self.device)
        found = [array.numpy()[: self.count] for array in (self.postures, self.slack, self.flags)]
        if self.keep:
            by_branch = self.kept.numpy().reshape(BRANCHES, POSTURE_ROWS, self.whole)[:, :, : self.count]
            found.append(by_branch.transpose(2, 0, 1).astype(np.float64))
        return found
