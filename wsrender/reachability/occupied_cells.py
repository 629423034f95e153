"""Cells of a lattice block that samples of a chain reach."""

import numpy as np

from wsrender.engine import Evaluation, SweepPlan, configurations, devices_of, sweep
from wsrender.errors import NumericalError
from wsrender.robots.chain import Chain
from wsrender.robots.host_chain import SAMPLES, HostChain
from wsrender.sampling import SamplingPlan, plan_sampling
from wsrender.spec.sampling import Sobol
from wsrender.volume.lattice import LatticeBlock

CHUNK = 1 << 16


def occupied_cells(
    chain: Chain, block: LatticeBlock, count: int, seed: int, device: str, threads: int | None
) -> np.ndarray:
    """Whether one of ``count`` Sobol samples falls into a cell of a block that holds the reach, (nx, ny, nz) bool.

    Raises NumericalError where a robot that is defined by a Python class leaves the block.
    """
    sampling = plan_sampling(chain, Sobol(count, seed=seed))
    if isinstance(chain, HostChain):
        return _of_host(chain, sampling, block)
    plan = SweepPlan(
        Evaluation(chain, ("manipulability",)),
        sampling,
        block,
        frozenset(),
        scales=np.zeros(1),
        bounds=np.full(1, np.inf),
        precision="float32",
    )
    swept = sweep(plan, 0, count, devices_of(device), threads=threads)
    occupied = np.zeros(block.size, bool)
    occupied[swept.cells] = True
    return occupied.reshape(block.shape)


def _of_host(chain: HostChain, sampling: SamplingPlan, block: LatticeBlock) -> np.ndarray:
    """The same from poses alone: Jacobians, which a sweep takes too, may cost a Python class many times as much."""
    occupied = np.zeros(block.shape, bool)
    for first in range(0, sampling.count, CHUNK):
        q = configurations(sampling, np.arange(first, min(first + CHUNK, sampling.count)))
        cells = np.floor(chain.poses(q)[:, :3, 3] / block.voxel_size_m).astype(np.int64) - block.first_voxel
        if ((cells < 0) | (cells >= block.shape)).any():
            raise NumericalError(f"{chain.name} reaches beyond the box that was found for it from {SAMPLES} samples")
        occupied[tuple(cells.T)] = True
    return occupied
