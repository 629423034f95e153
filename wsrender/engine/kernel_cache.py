"""Kernels ready to launch: compiled once, whatever number of processes needs them at the same time."""

from functools import cache
from pathlib import Path

import warp as wp
from filelock import FileLock

BLOCK_CPU, BLOCK_CUDA = 1, 256  # threads per block of wp.launch: kernels are compiled for a number


def loaded(kernel: wp.Kernel, *devices: wp.Device) -> wp.Kernel:
    """The kernel, compiled for devices or taken from Warp's cache; another process that compiles it is waited for.

    To be called before work is handed to threads: Warp's header costs each thread that compiles a second and a half.
    """
    for device in devices:
        _load(kernel, device.alias)
    return kernel


@cache
def _load(kernel: wp.Kernel, device: str) -> None:
    folder = wp.config.kernel_cache_dir
    assert folder is not None  # set by wp.init
    with FileLock(Path(folder) / f"{kernel.module.name}.lock"):
        kernel.module.load(device, block_dim=BLOCK_CPU if device == "cpu" else BLOCK_CUDA)
