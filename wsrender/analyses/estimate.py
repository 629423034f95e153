"""What a sweep will take, before it runs."""

from typing import Any

from wsrender.analyses.cost import Cost
from wsrender.engine import SweepPlan, thread_count

# Samples per second of one CPU core and one GPU for six kinematic indices in float32 with voxels, rounded
# down from the project's benchmarks on an AVX-512 core and an H200; dynamic indices and float64 each take about
# three times as long.
RATE_CPU_CORE, RATE_GPU = 1e7, 1e10
SLOWER = 3.0
RATE_HOST = 2e4  # where the host computes a part of every sample


def sweep_cost(plan: SweepPlan, devices: list[Any]) -> Cost:
    """Of the sweep alone: voxel records of every worker, the map as memory and file, and seconds."""
    on_gpu = devices[0].is_cuda
    workers = len(devices) if on_gpu else thread_count()
    rate = (RATE_GPU if on_gpu else RATE_CPU_CORE) * workers
    if plan.evaluation.dynamic:
        rate /= SLOWER
    if plan.precision == "float64":
        rate /= SLOWER
    if plan.evaluation.on_host:
        rate = RATE_HOST
    samples = plan.sampling.count
    voxels = plan.block.size if plan.block else 0
    records = voxels * plan.shape.bytes_per_voxel
    seconds = samples / plan.structure.weight / rate
    return Cost(samples, records * workers + map_bytes(plan), map_bytes(plan), seconds)


def map_bytes(plan: SweepPlan) -> int:
    """Bytes of the rows of a map; 0 where none is kept."""
    width = 4 if plan.precision == "float32" else 8
    return plan.sampling.count * plan.shape.n_rows * width if plan.keep_rows else 0
