"""Inverse kinematics of many targets: tries from given starts, on CPU threads or a GPU."""

from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache

import numpy as np
import warp as wp
from wsrender_kernels.inverse import FLAT, LANES, REACHED, STATIONARY, TARGET_SIZES, inverse_kernel, inverse_model

from wsrender.engine.devices import devices_of, thread_count
from wsrender.engine.evaluation import REAL, chain_model, device_array, drive, vector_of
from wsrender.engine.host_inverse import host_tries
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.engine.tries import Accuracy, Tries, angle_of, step_bounds
from wsrender.robots.chain import Chain
from wsrender.robots.kinematics import Kinematics

KINDS = {size: kind for kind, size in TARGET_SIZES.items()}
BATCH = 1 << 17  # tries of a launch
LEAST_SHARE = 8 * LANES  # tries that are worth a thread
STEPS = 300  # of a try: ten suffice where the target is reached, slow ones come to rest far from their targets


def solve_inverse(
    chain: Kinematics,
    targets: np.ndarray,
    starts: np.ndarray,
    accuracy: Accuracy,
    *,
    without_limits: bool = False,
    steps: int = STEPS,
    precision: str = "float64",
    device: str = "auto",
    threads: int | None = None,
) -> Tries:
    """One try from each start (N, n) to its target.

    ``targets``: positions (N, 3) [m], with the direction of the tip's z (N, 6), or with its axes x, y, z (N, 12).
    ``without_limits`` lets hinges turn for ever; slides keep their limits, which are their length. The kinematics of a
    robot that is defined by a Python class run on the host, in float64.
    """
    if (origin := chain.origin).any():
        chain, targets = chain.relative_to(origin), targets.copy()
        targets[:, :3] -= origin
    if (geometry := chain.geometry) is None:
        return host_tries(chain, targets, starts, accuracy, without_limits, steps)
    devices = devices_of(device)
    workers = devices if devices[0].is_cuda else devices * thread_count(threads)
    size = min(BATCH, max(LEAST_SHARE, -(-len(targets) // len(workers))))
    model = _model(geometry, accuracy, without_limits, precision)
    kind = KINDS[targets.shape[1]]
    kernel = loaded(inverse_kernel(REAL[precision], chain.n, *drive(geometry), kind, devices[0].is_cuda), *devices)
    batches = [slice(first, first + size) for first in range(0, max(len(targets), 1), size)]

    def run(numbered: tuple[int, slice]) -> list[np.ndarray]:
        number, batch = numbered
        worker = workers[number % len(workers)]
        return _launch(kernel, model, targets[batch], starts[batch], steps, REAL[precision], worker)

    with ThreadPoolExecutor(len(workers)) as pool:
        parts = list(pool.map(run, enumerate(batches)))
    q, distance_2, rotation_2, verdict = (np.concatenate(part) for part in zip(*parts, strict=True))
    distance, angle = np.sqrt(distance_2.astype(np.float64)), angle_of(rotation_2.astype(np.float64))
    return Tries(q.astype(np.float64), distance, angle, verdict == REACHED, verdict == STATIONARY)


def try_bytes(kind: str, n: int, precision: str) -> tuple[int, int]:
    """Numbers of a target and start of ``n`` coordinates, and the bytes that `solve_inverse` holds of a try of them."""
    target, real = TARGET_SIZES[kind], 4 if precision == "float32" else 8
    return target + n, 8 * (target + n) + real * (target + 3 * n + 2) + 4


def _launch(kernel, model, targets, starts, steps, real, device) -> list[np.ndarray]:
    count, n = starts.shape
    q = wp.empty(n * count, dtype=real, device=device)
    distance_2, rotation_2 = (wp.empty(count, dtype=real, device=device) for _ in range(2))
    verdict = wp.empty(count, dtype=wp.int32, device=device)  # type: ignore[arg-type]
    inputs = [model, device_array(targets.T.ravel(), real, device), device_array(starts.T.ravel(), real, device), count]
    if count:
        launch(
            kernel,
            dim=count if device.is_cuda else 1,
            inputs=[*inputs, steps],
            outputs=[q, distance_2, rotation_2, verdict],
            device=device,
        )
    return [q.numpy().reshape(n, count).T, distance_2.numpy(), rotation_2.numpy(), verdict.numpy()]


@lru_cache(maxsize=64)
def _model(chain: Chain, accuracy: Accuracy, without_limits: bool, precision: str):
    real = REAL[precision]
    model = inverse_model(real, chain.n, len(chain.joint_source))()
    model.chain = chain_model(chain, precision).chain
    lower, upper, scale = step_bounds(chain, accuracy, without_limits)
    model.lower, model.upper, model.scale = (vector_of(each, real) for each in (lower, upper, scale))
    model.length = accuracy.length
    model.position_2 = accuracy.position_m**2
    model.rotation_2 = accuracy.rotation_2
    model.flat_2 = (accuracy.flatness * FLAT[real]) ** 2
    return model
