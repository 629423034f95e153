"""Sampling plans on a device."""

import numpy as np
import warp as wp
from wsrender_kernels.pointwise import configuration_kernel
from wsrender_kernels.sampling import lane_table, sample_space

from wsrender.engine.devices import devices_of
from wsrender.engine.evaluation import REAL, device_array, vector_of
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import SamplingPlan


def device_space(plan: SamplingPlan, precision: str, device: wp.Device, run: int = 0):
    """The SampleSpace struct of a plan on a device; ``run``: samples in a row that share leading coordinates."""
    real = REAL[precision]
    space = sample_space(real, len(plan.lower))()
    space.lower, space.upper = vector_of(plan.lower, real), vector_of(plan.upper, real)
    space.step, space.levels = vector_of(plan.step, real), vector_of(plan.levels, wp.int32)
    space.run = run
    space.key_0 = plan.seed & 0xFFFFFFFF
    space.key_1 = plan.seed >> 32
    if plan.directions is not None and plan.shift is not None:
        numbers = np.concatenate([plan.directions.ravel(), plan.shift])
        lanes = lane_table(plan.directions).ravel()
        for words, high, low in ((numbers, "sobol_high", "sobol_low"), (lanes, "lane_high", "lane_low")):
            setattr(space, high, device_array(words >> np.uint64(32), wp.uint32, device))
            setattr(space, low, device_array(words & np.uint64(0xFFFFFFFF), wp.uint32, device))
    return space


def given_space(q: np.ndarray, first: int, precision: str, device: wp.Device):
    """The SampleSpace struct of configurations (N, n) given by the host, sample ``first`` being the first."""
    real = REAL[precision]
    space = sample_space(real, q.shape[1])()
    space.given = device_array(q.T.ravel(), real, device)
    space.given_first = first
    space.given_stride = len(q)
    return space


def configurations(pipeline: Pipeline, indices: np.ndarray | None = None) -> np.ndarray:
    """Configurations (N, n) [rad or m] of samples with 64-bit indices (N,), or of all, evaluated on the CPU.

    Admitted or not: see `evaluate_samples`.
    """
    (device,) = devices_of("cpu")
    plan, real = pipeline.sampling, REAL[pipeline.precision]
    n, indices = len(plan.lower), np.arange(plan.count) if indices is None else indices
    q = wp.empty((len(indices), n), dtype=real, device=device)
    if len(indices):
        launch(
            loaded(configuration_kernel(real, n, plan.method), device),
            dim=len(indices),
            inputs=[device_space(plan, pipeline.precision, device), device_array(indices, wp.int64, device)],
            outputs=[q],
            device=device,
        )
    return q.numpy()


def drawn_or_given(pipeline: Pipeline, indices: np.ndarray) -> np.ndarray:
    """Configurations of samples (N,) as the kernels have them, (N, n) float64 [rad or m]."""
    given = pipeline.sampling.given
    return np.asarray(configurations(pipeline, indices) if given is None else given[indices], np.float64)
