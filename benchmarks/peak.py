"""The machine's floating-point peak: matrix products on the CPU, a fused multiply-add kernel on a GPU."""

import os
import subprocess
import sys
import time

import numpy as np
import warp as wp

SIZE, CHAINS, STEPS, GPU_THREADS = 2048, 16, 4096, 1 << 20


def cpu_peak(precision: str, threads: int) -> float:
    """Operations per second of NumPy's matrix product on so many threads, in a process of its own."""
    limits = {f"{library}_NUM_THREADS": str(threads) for library in ("OPENBLAS", "OMP", "MKL")}
    limits["VECLIB_MAXIMUM_THREADS"] = str(threads)
    command = [sys.executable, __file__, precision]
    run = subprocess.run(command, env={**os.environ, **limits}, check=True, capture_output=True, text=True)
    return float(run.stdout)


def _matrix_product_rate(precision: str) -> float:
    matrix = np.random.default_rng(0).random((SIZE, SIZE)).astype(precision)
    return 2 * SIZE**3 / min(_seconds(lambda: matrix @ matrix) for _ in range(6))


def gpu_peak(precision: str, device: wp.Device) -> float:
    """Operations per second of independent chains of multiply-adds in registers."""
    real = wp.float32 if precision == "float32" else wp.float64
    kernel, out = _fma_kernel(real), wp.zeros(GPU_THREADS, dtype=real, device=device)

    def launch() -> None:
        wp.launch(kernel, GPU_THREADS, inputs=[out, STEPS], device=device)
        wp.synchronize_device(device)

    launch()
    return GPU_THREADS * CHAINS * STEPS * 2 / min(_seconds(launch) for _ in range(4))


def _fma_kernel(real) -> wp.Kernel:
    vector = wp.types.vector(CHAINS, real)
    SCALE, SHIFT = real(0.999), real(0.001)

    @wp.kernel(module="unique", enable_backward=False)
    def multiply_add(out: wp.array(dtype=real), steps: wp.int32):
        x = vector(real(wp.tid()))
        for _step in range(steps):
            for i in range(CHAINS):
                x[i] = x[i] * SCALE + SHIFT
        out[wp.tid()] = wp.dot(x, x)

    return multiply_add


def _seconds(work) -> float:
    started = time.perf_counter()
    work()
    return time.perf_counter() - started


if __name__ == "__main__":
    print(_matrix_product_rate(sys.argv[1]))
