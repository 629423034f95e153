"""The machine's floating-point peak: chains of fused multiply-adds."""

import time
from concurrent.futures import ThreadPoolExecutor

import warp as wp
from wsrender_kernels.options import MODULE_OPTIONS
from wsrender_kernels.sampling import LANES

CHAINS, STEPS, GPU_THREADS, CPU_TASKS = 16, 4096, 1 << 20, 16


def cpu_peak(precision: str, threads: int) -> float:
    """Operations per second of multiply-adds on SIMD registers, on so many threads."""
    real = wp.float32 if precision == "float32" else wp.float64
    kernel = _lane_kernel(real)
    outs = [wp.zeros(CPU_TASKS, dtype=real, device="cpu") for _ in range(threads)]

    def launch(out: wp.array) -> None:
        wp.launch(kernel, CPU_TASKS, inputs=[out, STEPS], device="cpu")

    launch(outs[0])
    with ThreadPoolExecutor(threads) as pool:
        seconds = min(_seconds(lambda: list(pool.map(launch, outs))) for _ in range(6))
    return threads * CPU_TASKS * LANES * CHAINS * STEPS * 2 / seconds


def _lane_kernel(real) -> wp.Kernel:
    lanes = wp.types.vector(LANES, real)
    SCALE, SHIFT = real(0.999), real(0.001)

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
    def multiply_add_lanes(out: wp.array(dtype=real), steps: wp.int32):
        x = lanes(real(wp.tid()))
        for _step in range(steps):
            for lane in range(LANES):
                value = x[lane]
                for _i in range(CHAINS):
                    value = value * SCALE + SHIFT
                x[lane] = value
        out[wp.tid()] = wp.dot(x, x)

    return multiply_add_lanes


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
