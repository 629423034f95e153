"""What a sweep will take, before it runs."""

from typing import Any

from wsrender.analyses.cost import Cost
from wsrender.engine import SweepPlan, thread_count
from wsrender.pipeline.pipeline import Pipeline

# Samples per second of one CPU core and one GPU for six kinematic indices in float32 with voxels, rounded
# down from the project's benchmarks on an AVX-512 core and an H200; dynamic indices and float64 each take about
# three times as long.
RATE_CPU_CORE, RATE_GPU = 1e7, 1e10
SLOWER = 3.0
RATE_HOST = 2e4  # where the host computes a part of every sample


def sweep_cost(pipeline: Pipeline, devices: list[Any]) -> Cost:
    """Of the sweep alone: voxel records of every worker, the map as memory and file, and seconds."""
    plan, on_gpu = SweepPlan(pipeline), devices[0].is_cuda
    workers = len(devices) if on_gpu else thread_count()
    rate = (RATE_GPU if on_gpu else RATE_CPU_CORE) * workers
    if pipeline.evaluation.dynamic:
        rate /= SLOWER
    if pipeline.precision == "float64":
        rate /= SLOWER
    if pipeline.evaluation.on_host:
        rate = RATE_HOST
    samples = pipeline.sampling.count
    voxels = pipeline.block.size if pipeline.block else 0
    records = voxels * plan.shape.bytes_per_voxel
    seconds = samples / plan.structure.weight / rate
    return Cost(samples, records * workers + map_bytes(pipeline), map_bytes(pipeline), seconds)


def map_bytes(pipeline: Pipeline) -> int:
    """Bytes of the rows of a map; 0 where none is kept."""
    if pipeline.kept_rows is None:
        return 0
    width = 4 if pipeline.precision == "float32" else 8
    return pipeline.sampling.count * SweepPlan(pipeline).shape.n_rows * width
