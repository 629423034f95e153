"""Cells of a lattice block that samples of a chain reach."""

from dataclasses import replace

import numpy as np

from wsrender.documents.sampling import Sobol
from wsrender.engine import devices_of, sweep
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.robots.kinematics import Kinematics
from wsrender.volume.lattice import LatticeBlock


def occupied_cells(
    chain: Kinematics, block: LatticeBlock, count: int, seed: int, device: str, threads: int | None
) -> np.ndarray:
    """Whether one of ``count`` Sobol samples falls into a cell of a block that holds the reach, (nx, ny, nz) bool.

    Raises NumericalError where a robot that is defined by a Python class leaves the block.
    """
    pipeline = replace(tip_pipeline(chain, Sobol(count, seed=seed)), block=block, precision="float32")
    swept = sweep(pipeline, 0, count, devices_of(device), threads=threads)
    occupied = np.zeros(block.size, bool)
    occupied[swept.cells] = True
    return occupied.reshape(block.shape)
