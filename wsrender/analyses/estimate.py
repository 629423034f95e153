"""What a sweep will take, before it runs."""

import math
from typing import Any

from wsrender.analyses.cost import Asks, Cost
from wsrender.engine import SweepPlan, fitted, label_bytes, thread_count
from wsrender.pipeline.pipeline import Pipeline

# Samples per second of one CPU core and one GPU for six kinematic indices in float32 with voxels, rounded
# down from the project's benchmarks on an AVX-512 core and an H200; dynamic indices and float64 each take about
# three times as long.
RATE_CPU_CORE, RATE_GPU = 1e7, 1e10
SLOWER = 3.0
RATE_HOST = 2e4  # where the host computes a part of every sample
RECORDS_PER_S = 2e8  # bytes of voxel records cleared and read, and of those kept


def sweep_cost(pipeline: Pipeline, devices: list[Any], voxels: float) -> Cost:
    """Of the sweep alone, of which so many ``voxels`` are expected to hold a sample: see `Cost`."""
    plan, on_gpu = SweepPlan(pipeline), devices[0].is_cuda
    workers = devices if on_gpu else devices * thread_count()
    rate = (RATE_GPU if on_gpu else RATE_CPU_CORE) * len(workers)
    if pipeline.evaluation.dynamic:
        rate /= SLOWER
    if pipeline.precision == "float64":
        rate /= SLOWER
    if pipeline.evaluation.on_host:
        rate = RATE_HOST
    samples, records = pipeline.sampling.count, 0.0
    if pipeline.block is not None:
        workers, slabs = fitted(pipeline.block, plan.shape, workers, samples)
        records = 0.0 if on_gpu else float(len(workers) * slabs[0].size * plan.shape.bytes_per_voxel)
    rows, kept = map_bytes(pipeline), kept_bytes(pipeline, voxels)
    seconds = samples / plan.structure.weight / rate + (records + 2 * kept) / RECORDS_PER_S
    # What is kept of the voxels is gathered in parts, and joined; so are the rows.
    labels = label_bytes(plan, workers)
    memory = max(records + 2 * kept + rows + labels, (2 + 3 / plan.shape.n_rows) * rows + 2 * kept)
    asks = Asks("voxel_size_m", voxel_size_m=pipeline.block and pipeline.block.voxel_size_m)
    if 2 * rows > records + 2 * kept:
        asks = Asks("keep_map", "take fewer samples or columns, or keep no map")
    return Cost(samples, memory, rows, seconds, asks)


def kept_bytes(pipeline: Pipeline, voxels: float) -> float:
    """Bytes of a partial result's voxels, of which so many hold a sample."""
    return voxels * (8 + SweepPlan(pipeline).shape.bytes_per_voxel)


def held(voxels: float, samples: float) -> float:
    """How many of so many voxels hold one of so many samples, spread evenly."""
    return voxels * -math.expm1(-samples / voxels)


def map_bytes(pipeline: Pipeline) -> int:
    """Bytes of the rows of a map; 0 where none is kept."""
    if pipeline.kept_rows is None:
        return 0
    width = 4 if pipeline.precision == "float32" else 8
    return pipeline.sampling.count * SweepPlan(pipeline).shape.n_rows * width
